"""Rows added as whole vectors."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.rows import Size, add_multiple, add_shaped


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


@njit
def _shaped(out: Array, at: int, four: Array, A: Array, row: int, rows: Array, D: Size, R: Size) -> None:
    add_shaped(out, at, four, 4, A, row, rows, rows.size // 2, D, R)


@pytest.mark.parametrize(("d", "r"), [(2, 1), (3, 3)])
def test_rows_are_weighed_by_four_shape_functions(d: int, r: int) -> None:
    rng, n = np.random.default_rng(1), 2 * (d + r)
    out, four, A, rows = (rng.normal(size=shape) for shape in ((3, n), (2, 4), (d, d), (2, d, n)))
    expected, interpreted = out.copy(), out.copy()
    for c in range(n):
        block = 2 * (c // (d + r)) + (c % (d + r) >= d)
        expected[1, c] += four[1, block] * sum(A[1, j] * rows[1, j, c] for j in range(d))
    add_shaped(interpreted, n, four, 4, A, 1, rows, d * n, fixed(d), fixed(r))
    _shaped(out, n, four, A, 1, rows, fixed(d), fixed(r))
    np.testing.assert_allclose(out, expected, rtol=1e-13)
    np.testing.assert_allclose(interpreted, expected, rtol=1e-13)
