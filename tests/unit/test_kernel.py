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


def test_what_kernels_alone_call_is_compiled_for_python_when_it_calls_it() -> None:
    assert _four_times(1.5) == 6.0
    assert not _twice.called.overloads
    assert not _four_times.overloads
    assert _four_times.called.overloads
    assert [_twice(6.0), _twice(8), _twice(6.0)] == [12.0, 16.0, 12.0]
    np.testing.assert_array_equal(_twice(np.array([1.0, 2.0])), [2.0, 4.0])
