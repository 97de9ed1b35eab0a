"""Kernels are called from compiled code, and from Python with arguments of several types."""

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


def test_what_kernels_call_may_be_called_from_python_too() -> None:
    assert _four_times(1.5) == 6.0
    assert [_twice(6.0), _twice(8), _twice(6.0)] == [12.0, 16.0, 12.0]
    np.testing.assert_array_equal(_twice(np.array([1.0, 2.0])), [2.0, 4.0])
