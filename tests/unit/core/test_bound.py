"""Tuples packed in memory, and kernels that are called with them by their address."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, NamedTuple

import numba
import numpy as np
import pytest

from riser_soil.core.bound import Bound, Packed, call_each, call_span, calls, in_turn, spans
from riser_soil.core.entries import WANTED, compile_wanted
from tests.support.on_ranks import environment, finished


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


@numba.njit
def copy_number(number: np.ndarray, out: np.ndarray) -> None:
    out[0] = number[0]


@pytest.mark.parametrize(("number", "called"), [(0, True), (2, False)])
def test_kernels_in_turn_end_at_a_failure(number: int, called: bool) -> None:
    failure, out = np.zeros(1, dtype=np.int64), np.zeros(2)
    fails = Bound(copy_number, Packed(np.array([number])), Packed(failure))
    after = Bound(add, Packed(given(np.ones((2, 4)))), Packed(out))
    in_turn(fails, after, until=Packed(failure))()
    assert failure[0] == number
    assert out.any() == called


def test_some_of_several_lists_of_kernels_are_called() -> None:
    out = np.zeros((3, 2))
    each = [Bound(add, Packed(given(np.full((2, 4), 1.0 + k))), Packed(row)) for k, row in enumerate(out)]
    kernels, (first, none, rest) = spans(each[:1], [], each[1:])
    Bound(call_span, Packed(kernels), Packed(none))()
    assert not out.any()
    Bound(call_span, Packed(kernels), Packed(rest))()
    assert out.any(axis=1).tolist() == [False, True, True]
    Bound(call_span, Packed(kernels), Packed(first))()
    np.testing.assert_allclose(out[1:], [2.0 * out[0], 3.0 * out[0]])


def test_what_is_bound_waits_where_kernels_run_as_python(monkeypatch: pytest.MonkeyPatch) -> None:
    out = np.zeros(2)
    bound = Bound(add, Packed(given(np.ones((2, 4)))), Packed(out))
    addresses = calls(bound).functions
    assert bound.entry in WANTED
    with monkeypatch.context() as uncompiled:
        uncompiled.setattr(numba.config, "DISABLE_JIT", True)
        compile_wanted()
    assert not addresses.any()
    bound()
    assert addresses.all()
    assert out.all()


def test_kernels_that_are_bound_after_a_call_are_there_at_the_next() -> None:
    """Also among those that are called in turn by what has been called before."""
    out = np.zeros(2)
    first = Bound(add, Packed(given(np.ones((2, 4)))), Packed(out))
    turns = Packed(calls(first))
    each = Bound(call_each, turns)
    each()

    @numba.njit
    def negate(out: np.ndarray) -> None:
        out[:] *= -1.0

    turns.renew(calls(first, Bound(negate, Packed(out))))
    each()
    np.testing.assert_allclose(out, -2 * 2.0 * (3 + 7 + 11))


def test_python_does_not_call_kernels_with_addresses_that_may_not_be_there_yet() -> None:
    given_bound = calls(Bound(add, Packed(given(np.ones((2, 4)))), Packed(np.zeros(2))))
    with pytest.raises(TypeError, match="call_each: bound kernels are among its arguments; it is called by Bound"):
        call_each(given_bound)


MANY = """
import os
import numpy as np
from numba.core import event
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.compiled import njit

@njit
def add(out, value):
    out[0] += value

@njit
def set_zero(out):
    out[0] = 0.0

@njit
def times(out, value):
    out[0] *= value

@njit
def less(out, value):
    out[0] -= value

out = np.ones(1)
with event.install_recorder("numba:compile") as compiled:
    kernels = [Bound(set_zero, Packed(out)), *(Bound(each, Packed(out), Packed(3.0)) for each in (add, times, less))]
    assert len(compiled.buffer) == 0
    for kernel in kernels:
        kernel()
print(out[0], len(compiled.buffer) // 2)
"""


def test_what_is_bound_is_compiled_side_by_side_and_kept(tmp_path: Path) -> None:
    """At the first call: a fork takes a share of it; what it has compiled is read, and all is in another process."""
    (tmp_path / "many.py").write_text(MANY, encoding="utf-8")

    def compiled(cache: str, processes: int) -> int:
        more = {"NUMBA_CACHE_DIR": str(tmp_path / cache), "RISER_SOIL_COMPILERS": f"{processes}"}
        done = finished([sys.executable, str(tmp_path / "many.py")], tmp_path, environment() | more)
        value, pieces = done.stdout.split()
        assert float(value) == 6.0
        return int(pieces)

    assert 0 < compiled("shared", 2) < compiled("alone", 1)
    assert compiled("shared", 1) == 0


UNFIT = "an array that is not contiguous or may not be written"


@pytest.mark.parametrize(
    ("value", "message"),
    [("steel", "str"), (np.zeros((2, 8))[:, ::2], UNFIT), (np.broadcast_to(np.ones(4), (2, 4)), UNFIT)],
)
def test_what_cannot_be_packed_is_reported(value: Any, message: str) -> None:
    with pytest.raises(TypeError, match=f"{message} can't be packed"):
        Packed(Inner(True, False, value))
