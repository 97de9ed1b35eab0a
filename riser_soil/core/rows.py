"""Rows of numbers as whole vectors, for compiled code.

A loop over a short row isn't vectorised, as its compiler can't know that what is written lies apart from what is read.
Here a row whose length is known beforehand is read as whole vectors before anything is written (`row_code`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numba import types
from numba.extending import overload

from riser_soil.core import row_code
from riser_soil.core.arrays import Array, as_list
from riser_soil.core.row_code import Size

Term = tuple[Array, Array, Array]
Vector = Array | tuple[float, ...]


def add_multiple(out: Array, at: int, factor: float, rows: Array, start: int, N: Size) -> None:
    """Add `factor` times len(N) numbers of `rows`, from `start` on, to those of `out` from `at` on.

    out, rows: contiguous, of any shape; at and start count single numbers in them.
    """
    flat, given = out.reshape(-1), rows.reshape(-1)
    flat[at : at + len(N)] += factor * given[start : start + len(N)]


@overload(add_multiple, inline="always", strict=False)
def _chosen(out: Any, at: Any, factor: Any, rows: Any, start: Any, N: Any) -> Any:
    if isinstance(N, types.BaseTuple) and len(N) == 0:
        return lambda out, at, factor, rows, start, N: None
    if isinstance(N, types.BaseTuple):
        return lambda out, at, factor, rows, start, N: row_code.add_multiple(out, at, factor, rows, start, N)

    def one_by_one(out: Array, at: int, factor: float, rows: Array, start: int, N: Array) -> None:
        flat, given = out.reshape(out.size), rows.reshape(rows.size)
        for n in range(N.size):
            flat[at + n] += factor * given[start + n]

    return one_by_one


def as_tuple(values: Vector, D: Size) -> tuple[float, ...]:
    """Two or three numbers, as D says, apart from the array: what is written later can't change them."""
    return tuple(values[: len(D)])


@overload(as_tuple, inline="always", strict=False)
def _as_tuple(values: Any, D: Any) -> Any:
    if len(D) == 2:
        return lambda values, D: (values[0], values[1])
    return lambda values, D: (values[0], values[1], values[2])


def times(factor: float, vector: tuple[float, ...]) -> tuple[float, ...]:
    """A vector of two or three numbers times a factor."""
    return tuple(factor * each for each in vector)


@overload(times, inline="always", strict=False)
def _times(factor: Any, vector: Any) -> Any:
    if len(vector) == 2:
        return lambda factor, vector: (factor * vector[0], factor * vector[1])
    return lambda factor, vector: (factor * vector[0], factor * vector[1], factor * vector[2])


def numbers_at(values: Array, start: int, D: Size) -> tuple[float, ...]:
    """len(D) numbers of a contiguous array of any shape, from `start` on, counted in single numbers."""
    return tuple(as_list(values.reshape(-1)[start : start + len(D)]))


@overload(numbers_at, inline="always", strict=False)
def _numbers(values: Any, start: Any, D: Any) -> Any:
    return lambda values, start, D: row_code.numbers_at(values, start, D)


def combined(terms: Sequence[tuple[float, Array, int]], D: Size) -> tuple[float, ...]:
    """Sum of vectors (d,), each a factor times numbers of an array from a place on, as in `numbers_at`."""
    factors, vectors = zip(*((factor, numbers_at(values, at, D)) for factor, values, at in terms), strict=True)
    return tuple((np.array(factors) @ np.array(vectors)).tolist())


@overload(combined, inline="always", strict=False)
def _sum(terms: Any, D: Any) -> Any:
    return lambda terms, D: row_code.combined(terms, D)


def add_shares(F: Array, start: int, four: Array, first: int, f: tuple[float, ...], D: Size) -> None:
    """Add to four vectors of `F`, from `start` on, f (d,) times one of `four`, from `first` on; as in `numbers_at`."""
    d = len(D)
    shares = np.outer(four.reshape(-1)[first : first + 4], f)
    F.reshape(-1)[start : start + 4 * d] += shares.ravel()


@overload(add_shares, inline="always", strict=False)
def _shares(F: Any, start: Any, four: Any, first: Any, f: Any, D: Any) -> Any:
    return lambda F, start, four, first, f, D: row_code.add_shares(F, start, four, first, f, D)


def two_polynomials(c: Array, start: int, x: float, y: float, N: Size) -> tuple[float, ...]:
    """Two complex polynomials of len(N) terms at x + i y, real and imaginary part of each, and of their derivatives.

    c: for each power, the lowest first, real and imaginary part of both coefficients, from `start` on, as in
    `numbers_at`.
    """
    coefficients = c.reshape(-1)[start : start + 4 * len(N)].reshape(-1, 2, 2)
    both = [np.polynomial.Polynomial(each) for each in (coefficients @ np.array([1.0, 1.0j])).T]
    at = complex(x, y)
    found = np.array([*(each(at) for each in both), *(each.deriv()(at) for each in both)])
    return tuple(as_list(np.stack([found.real, found.imag], axis=1).ravel()))


@overload(two_polynomials, inline="always", strict=False)
def _polynomials(c: Any, start: Any, x: Any, y: Any, N: Any) -> Any:
    return lambda c, start, x, y, N: row_code.two_polynomials(c, start, x, y, N)


def add_weighed(S: Array, weights: Array, terms: Sequence[Term], D: Size, R: Size) -> None:
    """Add to each of S (4, d, n) its weight (4,) times a sum of terms: a matrix (d, d) times rows (d, n), whose blocks
    of d, r, d and r columns count with four factors (4,). A term is the three of them, factors first.

    All contiguous; n = 2 (d + r), d = len(D), r = len(R).
    """
    blocks = [len(D), len(R)] * 2
    change = sum(np.repeat(four, blocks) * (A @ rows) for four, A, rows in terms)
    S += weights[:, None, None] * change


@overload(add_weighed, inline="always", strict=False)
def _weighed(S: Any, weights: Any, terms: Any, D: Any, R: Any) -> Any:
    return lambda S, weights, terms, D, R: row_code.add_weighed(S, weights, terms, D, R)


def write_weighed(S: Array, stations: Sequence[tuple[Array, Sequence[Term]]], D: Size, R: Size) -> None:
    """Write to S the sum over some stations, each its weights (4,) and its terms as in `add_weighed`."""
    S[...] = 0.0
    for weights, terms in stations:
        add_weighed(S, weights, terms, D, R)


@overload(write_weighed, inline="always", strict=False)
def _write_weighed(S: Any, stations: Any, D: Any, R: Any) -> Any:
    return lambda S, stations, D, R: row_code.write_weighed(S, stations, D, R)


def write_blocks(S: Array, M: Array, factor: float, rows: Array, D: Size, R: Size) -> None:
    """Write to S (4, d, n) rows (d, n), whose blocks of d, r, d and r columns count with `factor` times a row of
    M (4, 4). All contiguous.
    """
    S[...] = factor * np.repeat(M, [len(D), len(R)] * 2, axis=1)[:, None, :] * rows


@overload(write_blocks, inline="always", strict=False)
def _blocks(S: Any, M: Any, factor: Any, rows: Any, D: Any, R: Any) -> Any:
    return lambda S, M, factor, rows, D, R: row_code.write_blocks(S, M, factor, rows, D, R)


def add_pulled_back(out: Array, P: Array, S: Array, D: Size, R: Size) -> None:
    """Add to out (n, n) rows of S (4, d, n): the first and third d as they are, the second and fourth by the transposes
    of P (2, d, r). All contiguous.
    """
    d, ndof = len(D), len(D) + len(R)
    for side in range(2):
        at = side * ndof
        out[at : at + d] += S[2 * side]
        out[at + d : at + ndof] += P[side].T @ S[2 * side + 1]


@overload(add_pulled_back, inline="always", strict=False)
def _pulled_back(out: Any, P: Any, S: Any, D: Any, R: Any) -> Any:
    return lambda out, P, S, D, R: row_code.add_pulled_back(out, P, S, D, R)
