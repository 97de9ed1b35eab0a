"""Tuples packed in memory, and kernels that are called with them by their address."""

from __future__ import annotations

from typing import Any, NamedTuple

import numba
import numpy as np
import pytest

from riser_soil.core.bound import Bound, Packed, call_each, calls


class Inner(NamedTuple):
    on: bool
    also: bool
    values: Any


class Outer(NamedTuple):
    first: bool
    weight: float
    inner: Inner
    lengths: tuple[int, ...]
    last: bool


float_: Any = np.float64
bool_: Any = np.bool_


@numba.njit
def add(given: Outer, out: np.ndarray) -> None:
    inner = given.inner
    for i in range(inner.values.shape[0]):
        for j in range(len(given.lengths)):
            on = (given.first, inner.on, inner.also, given.last)[j % 4]
            out[i] += given.weight * inner.values[i, j] * given.lengths[j] if on else 0.0


def given(values: np.ndarray, weight: float = 2.0, last: bool = True) -> Outer:
    return Outer(True, weight, Inner(False, True, values), (3, 5, 7, 11), last)


def test_a_kernel_finds_what_was_packed() -> None:
    values = np.arange(8.0).reshape(2, 4)
    packed, out = Packed(given(values)), np.zeros(2)
    call = Bound(add, packed, Packed(out))
    for weight, last in ((2.0, True), (float_(-1.5), bool_(True)), (1.0, False)):
        out[:], expected = 1.0, np.ones(2)
        packed.renew(given(values, weight, last))
        call()
        add(given(values, weight, last), expected)
        np.testing.assert_allclose(out, expected)
    assert out[1] > 50.0


def test_kernels_are_called_in_turn() -> None:
    out = np.zeros(2)
    both = Packed(calls(*(Bound(add, Packed(given(np.full((2, 4), k))), Packed(out)) for k in (1.0, 2.0))))
    Bound(call_each, both)()
    np.testing.assert_allclose(out, 3 * 2.0 * (3 + 7 + 11))


UNFIT = "an array that is not contiguous or may not be written"


@pytest.mark.parametrize(
    ("value", "message"),
    [("steel", "str"), (np.zeros((2, 8))[:, ::2], UNFIT), (np.broadcast_to(np.ones(4), (2, 4)), UNFIT)],
)
def test_what_cannot_be_packed_is_reported(value: Any, message: str) -> None:
    with pytest.raises(TypeError, match=f"{message} can't be packed"):
        Packed(Inner(True, False, value))
