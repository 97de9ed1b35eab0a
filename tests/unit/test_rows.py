"""Rows added as whole vectors."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.rows import Size, add_multiple


@njit
def _added(out: Array, at: int, factor: float, rows: Array, start: int, N: Size) -> None:
    add_multiple(out, at, factor, rows, start, N)


@pytest.mark.parametrize("N", [fixed(0), fixed(1), fixed(5), fixed(12), np.zeros(5)])
def test_a_row_is_added_where_it_is_asked_for(N: Size) -> None:
    rows, out, n = np.arange(48.0).reshape(4, 12), np.ones((2, 3, 12)), len(N)
    expected = out.copy()
    expected.ravel()[7 : 7 + n] += -2.5 * rows.ravel()[30 : 30 + n]
    interpreted = out.copy()
    add_multiple(interpreted, 7, -2.5, rows, 30, N)
    _added(out, 7, -2.5, rows, 30, N)
    np.testing.assert_array_equal(out, expected)
    np.testing.assert_array_equal(interpreted, expected)


@pytest.mark.parametrize("to", [0, 2, 6])
def test_what_is_read_is_read_before_anything_is_written(to: int) -> None:
    values = np.arange(20.0)
    expected = values.copy()
    expected[to : to + 8] += values[4:12]
    _added(values, to, 1.0, values, 4, fixed(8))
    np.testing.assert_array_equal(values, expected)
