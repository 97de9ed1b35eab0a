"""Rows as whole vectors: in compiled code they do what the plain loops beside them say."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.rows import (
    Size,
    add_multiple,
    add_pulled_back,
    add_shares,
    add_weighed,
    as_tuple,
    combined,
    numbers_at,
    times,
    two_polynomials,
    write_blocks,
    write_weighed,
)


@njit
def _added(out: Array, at: int, factor: float, rows: Array, start: int, N: Size) -> None:
    add_multiple(out, at, factor, rows, start, N)


@pytest.mark.parametrize("N", [fixed(0), fixed(1), fixed(5), fixed(12), np.zeros(5), np.zeros(17)])
def test_a_row_is_added_where_it_is_asked_for(N: Size) -> None:
    rows, out, n = np.arange(48.0).reshape(4, 12), np.ones((2, 3, 12)), len(N)
    expected = out.copy()
    expected.ravel()[7 : 7 + n] += -2.5 * rows.ravel()[30 : 30 + n]
    interpreted = out.copy()
    add_multiple(interpreted, 7, -2.5, rows, 30, N)
    _added(out, 7, -2.5, rows, 30, N)
    np.testing.assert_array_equal(out, expected)
    np.testing.assert_array_equal(interpreted, expected)


@njit
def _polynomials(c: Array, start: int, x: float, y: float, N: Size) -> Any:
    return two_polynomials(c, start, x, y, N)


@pytest.mark.parametrize("N", [fixed(1), fixed(2), fixed(5)])
def test_polynomials_have_their_values_and_derivatives(N: Size) -> None:
    """Two complex ones by sums of powers."""
    c, x = np.random.default_rng(1).uniform(-1.0, 1.0, (3, 4 * len(N))), 0.7 - 0.4j
    row, powers = c[1].reshape(-1, 2, 2), np.arange(len(N))
    first, second = (row[:, k, 0] + 1j * row[:, k, 1] for k in range(2))
    values = [np.sum(each * x**powers) for each in (first, second)]
    slopes = [np.sum(each[1:] * powers[1:] * x ** (powers[1:] - 1)) for each in (first, second)]
    expected = np.array([*values, *slopes]).view(float)
    for function in (_polynomials, two_polynomials):
        np.testing.assert_allclose(function(c, 4 * len(N), x.real, x.imag, N), expected, atol=1e-14)


@njit
def _read(values: Array, rest: Array, D: Size) -> Any:
    vector = numbers_at(values, 5, D)
    kept = as_tuple(vector, D), as_tuple(values[1], D), times(2.0, vector)
    values[...] = 0.0
    return kept, combined(((2.0, rest, 3), (-1.0, rest, 7)), D)


@pytest.mark.parametrize("d", [2, 3])
def test_numbers_are_read_as_vectors(d: int) -> None:
    values, rest = np.arange(12.0).reshape(3, 4), np.arange(10.0, 22.0)
    expected = [5.0, 6.0, 7.0][:d], [4.0, 5.0, 6.0][:d], [10.0, 12.0, 14.0][:d]
    for read in (_read, _read.py_func):
        kept, total = read(values.copy(), rest, fixed(d))
        np.testing.assert_array_equal(kept, expected)
        np.testing.assert_array_equal(total, 2.0 * rest[3 : 3 + d] - rest[7 : 7 + d])


@njit
def _shared(F: Array, start: int, four: Array, first: int, f: tuple[float, ...], D: Size) -> None:
    add_shares(F, start, four, first, f, D)


@pytest.mark.parametrize("f", [(2.0, -3.0), (2.0, -3.0, 5.0)])
def test_shares_of_a_vector_are_added(f: tuple[float, ...]) -> None:
    rng, d = np.random.default_rng(1), len(f)
    F, four = rng.normal(size=(2, 4, d)), rng.normal(size=(3, 4))
    expected, interpreted = F.copy(), F.copy()
    expected[1] += np.outer(four[2], f)
    add_shares(interpreted, 4 * d, four, 8, f, fixed(d))
    _shared(F, 4 * d, four, 8, f, fixed(d))
    np.testing.assert_allclose(F, expected, rtol=1e-14)
    np.testing.assert_allclose(interpreted, expected, rtol=1e-14)


@njit
def _weighed(S: Array, weights: Array, terms: Any, D: Size, R: Size) -> None:
    add_weighed(S, weights, terms, D, R)


@njit
def _write_weighed(S: Array, stations: Any, D: Size, R: Size) -> None:
    write_weighed(S, stations, D, R)


@njit
def _blocks(S: Array, M: Array, factor: float, rows: Array, D: Size, R: Size) -> None:
    write_blocks(S, M, factor, rows, D, R)


@njit
def _pulled_back(out: Array, P: Array, S: Array, D: Size, R: Size) -> None:
    add_pulled_back(out, P, S, D, R)


PLANE_AND_SPACE = pytest.mark.parametrize(("d", "r"), [(2, 1), (3, 3)])


@PLANE_AND_SPACE
@pytest.mark.parametrize("count", [1, 3])
def test_rows_are_weighed_by_four_shape_functions(d: int, r: int, count: int) -> None:
    rng, n = np.random.default_rng(1), 2 * (d + r)
    S, weights = rng.normal(size=(4, d, n)), rng.normal(size=4)
    terms = tuple((rng.normal(size=4), rng.normal(size=(d, d)), rng.normal(size=(d, n))) for _ in range(count))
    expected, interpreted = S.copy(), S.copy()
    for c in range(n):
        block = 2 * (c // (d + r)) + (c % (d + r) >= d)
        for four, A, rows in terms:
            expected[:, :, c] += np.outer(weights, four[block] * (A @ rows[:, c]))
    add_weighed(interpreted, weights, terms, fixed(d), fixed(r))
    _weighed(S, weights, terms, fixed(d), fixed(r))
    np.testing.assert_allclose(S, expected, rtol=1e-12)
    np.testing.assert_allclose(interpreted, expected, rtol=1e-12)


@PLANE_AND_SPACE
def test_rows_of_three_stations_are_written_at_once(d: int, r: int) -> None:
    rng, n = np.random.default_rng(1), 2 * (d + r)

    def term() -> tuple[Array, Array, Array]:
        return rng.normal(size=4), rng.normal(size=(d, d)), rng.normal(size=(d, n))

    stations = tuple((rng.normal(size=4), (term(), term())) for _ in range(3))
    expected, written, interpreted = np.zeros((4, d, n)), np.full((4, d, n), np.nan), np.full((4, d, n), np.nan)
    for weights, terms in stations:
        _weighed(expected, weights, terms, fixed(d), fixed(r))
    write_weighed(interpreted, stations, fixed(d), fixed(r))
    _write_weighed(written, stations, fixed(d), fixed(r))
    np.testing.assert_allclose(written, expected, rtol=1e-12)
    np.testing.assert_allclose(interpreted, expected, rtol=1e-12)


@PLANE_AND_SPACE
def test_blocks_of_rows_are_written_by_the_rows_of_a_matrix(d: int, r: int) -> None:
    rng, n = np.random.default_rng(1), 2 * (d + r)
    M, rows, expected = rng.normal(size=(4, 4)), rng.normal(size=(d, n)), np.empty((4, d, n))
    for c in range(n):
        block = 2 * (c // (d + r)) + (c % (d + r) >= d)
        expected[:, :, c] = 2.5 * np.outer(M[:, block], rows[:, c])
    written, interpreted = np.empty_like(expected), np.empty_like(expected)
    write_blocks(interpreted, M, 2.5, rows, fixed(d), fixed(r))
    _blocks(written, M, 2.5, rows, fixed(d), fixed(r))
    np.testing.assert_allclose(written, expected, rtol=1e-13)
    np.testing.assert_allclose(interpreted, expected, rtol=1e-13)


@PLANE_AND_SPACE
def test_rows_of_tangents_are_pulled_back(d: int, r: int) -> None:
    rng, ndof = np.random.default_rng(1), d + r
    out, P, S = (rng.normal(size=shape) for shape in ((2 * ndof, 2 * ndof), (2, d, r), (4, d, 2 * ndof)))
    expected, interpreted = out.copy(), out.copy()
    for side in range(2):
        for i in range(d):
            expected[side * ndof + i] += S[2 * side, i]
            for k in range(r):
                expected[side * ndof + d + k] += P[side, i, k] * S[2 * side + 1, i]
    add_pulled_back(interpreted, P, S, fixed(d), fixed(r))
    _pulled_back(out, P, S, fixed(d), fixed(r))
    np.testing.assert_allclose(out, expected, rtol=1e-13)
    np.testing.assert_allclose(interpreted, expected, rtol=1e-13)


@njit
def _all(
    values: Array, rows: Array, at: int, x: float, terms: Any, P: Array, N: Size, D: Size, R: Size
) -> tuple[Array, Array, Array, Any, Any, Any]:
    """What each function finds or writes of the same numbers, its place in them `at`."""
    d, n = len(D), 2 * (len(D) + len(R))
    S, other, out = np.ones((4, d, n)), np.ones((4, d, n)), np.ones((n, n))
    four, _, lines = terms[0]
    add_multiple(S, at, x, rows, 2 * at, N)
    add_shares(S, at, rows, at, as_tuple(values, D), D)
    add_weighed(S, four, terms, D, R)
    write_weighed(other, ((four, terms), (four, terms)), D, R)
    add_pulled_back(out, P, other, D, R)
    write_blocks(other, rows, x, lines, D, R)
    polynomials = two_polynomials(rows, at, 0.3 * x, 0.4, fixed_two)
    return S, other, out, polynomials, numbers_at(rows, at, D), combined(((x, rows, at), (2.0, values, 0)), D)


fixed_two = fixed(2)


@pytest.mark.parametrize("seed", range(4))
def test_each_function_is_its_plain_loops(seed: int) -> None:
    """Both write the same of random numbers, at random places, in a plane and in space."""
    rng = np.random.default_rng(seed)
    d, r = ((2, 1), (3, 3))[seed % 2]
    n, count, at, x = 2 * (d + r), int(rng.integers(1, 9)), int(rng.integers(0, 5)), float(rng.normal())
    terms = tuple((rng.normal(size=4), rng.normal(size=(d, d)), rng.normal(size=(d, n))) for _ in range(2))
    given = rng.normal(size=5), rng.normal(size=(5, 4)), at, x, terms, rng.normal(size=(2, d, r))
    sizes = fixed(count), fixed(d), fixed(r)
    for result, expected in zip(_all(*given, *sizes), _all.py_func(*given, *sizes), strict=True):
        np.testing.assert_allclose(result, expected, rtol=1e-12, atol=1e-14)
