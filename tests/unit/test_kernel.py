"""Kernels are compiled for compiled code alone, and for Python where it calls them."""

from __future__ import annotations

import numpy as np

from riser_soil.core.compiled import njit


@njit
def _twice(x: float) -> float:
    return 2.0 * x


@njit
def _four_times(x: float) -> float:
    doubled: float = _twice(_twice(x))
    return doubled


def test_what_kernels_alone_call_is_not_compiled_for_python() -> None:
    assert _four_times(1.5) == 6.0
    assert not _twice.called.overloads
    assert not _four_times.overloads
    assert _four_times.called.overloads


@njit
def _half(x: float) -> float:
    return 0.5 * x


@njit
def _quarter(x: float) -> float:
    halved: float = _half(_half(x))
    return halved


def test_python_may_call_what_kernels_call() -> None:
    assert _quarter(6.0) == 1.5
    assert [_half(6.0), _half(8), _half(6.0)] == [3.0, 4.0, 3.0]
    np.testing.assert_array_equal(_half(np.array([1.0, 2.0])), [0.5, 1.0])
