"""Banded LU factorisation with threshold pivoting, for chains such as a riser alone.

A matrix of n rows with b entries on either side of its diagonal lies there by rows: entry (i, j) at ab[i, j - i + b],
|j - i| <= b. Row exchanges fill b further places to the right. Below the last row there are b rows of zeros, so that
all rows are alike and their loops have lengths that are known beforehand. The factors of elimination lie to the left of
their pivot: that of row k + i at ab[k, i - 1]. In the pivot's own place lies its inverse.

Rows are exchanged only for a pivot below a tenth of the largest entry: a riser's matrix then needs hardly any exchange,
and rows without fill have half the work. Source: Golub & Van Loan, Matrix Computations (2013), 4.3; Duff, Erisman &
Reid, Direct Methods for Sparse Matrices (2017), 5.2.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.rows import Size, add_multiple

HUGE = 1e300  # a pivot beyond it is no number to divide by
THRESHOLD = 0.1
OF_LINES = 5, 11  # entries beside the diagonal, in a plane and in space, for which loops over a row are compiled


class SingularError(Exception):
    """A matrix without an inverse."""


def workspace(n: int, b: int) -> tuple[Array, Size]:
    """Workspace for a matrix (n + b, 3 b + 1), all zero, and its band as `factorise` takes it."""
    return np.zeros((n + b, 3 * b + 1)), fixed(b)


@njit
def factorise(ab: Array, pivots: IntArray, B: Size) -> bool:
    """Factorise a matrix in place; whether it is regular. pivots (n,): the rows of the pivots; B: see
    `workspace`.
    """
    b, width, reach = len(B), ab.shape[1], 0
    for k in range(pivots.size):
        p = _pivot(ab, k, B)
        if p < 0:
            return False
        pivots[k], reach = p, max(reach, p + b)  # the last column that this row or one above it has
        if p != k:
            for j in range(2 * len(B) + 1):
                ab[k, b + j], ab[p, b + j - (p - k)] = ab[p, b + j - (p - k)], ab[k, b + j]
        inverse, start = 1.0 / ab[k, b], k * width + b + 1
        ab[k, b] = inverse
        for i in range(1, len(B) + 1):
            factor = ab[k + i, b - i] * inverse
            ab[k, i - 1] = factor
            if factor != 0.0:
                at = start + i * (width - 1)
                add_multiple(ab, at, -factor, ab, start, B)
                if reach > k + b:
                    add_multiple(ab, at + b, -factor, ab, start + b, B)
    return True


@njit
def _pivot(ab: Array, k: int, B: Size) -> int:
    """The row of the pivot of column k; -1 where there is none."""
    b = len(B)
    p, largest = k, abs(ab[k, b])
    own = largest
    for i in range(1, len(B) + 1):
        if abs(ab[k + i, b - i]) > largest:
            p, largest = k + i, abs(ab[k + i, b - i])
    if not 0.0 < largest < HUGE:
        return -1
    return k if own >= THRESHOLD * largest else p


@njit
def solve(ab: Array, pivots: IntArray, x: Array, B: Size) -> None:
    """Solve with the factors of `factorise`: the right-hand side x (n,) becomes the solution."""
    b, wide = len(B), _forward_eliminate(ab, pivots, x, B)
    whole = max(pivots.size - 2 * b, 0) if b > 0 else 0  # rows that have all of their numbers within the matrix
    _back_substitute(ab, x, pivots.size, whole, b)
    if b > 0:
        _back_substitute_whole(ab, x, whole, min(wide, whole), b, b)
        _back_substitute_whole(ab, x, min(wide, whole), 0, b, 2 * b)


@njit
def _forward_eliminate(ab: Array, pivots: IntArray, x: Array, B: Size) -> int:
    """Forward elimination of a right-hand side; the row from which on none has any fill."""
    n, wide = pivots.size, 0
    for k in range(n):
        p = pivots[k]
        if p != k:
            x[k], x[p], wide = x[p], x[k], max(wide, p)
        own = x[k]
        if k + len(B) < n:
            for i in range(len(B)):
                x[k + 1 + i] -= ab[k, i] * own
        else:
            for i in range(n - 1 - k):
                x[k + 1 + i] -= ab[k, i] * own
    return wide


@njit
def _back_substitute(ab: Array, x: Array, end: int, first: int, b: int) -> None:
    """Back substitution for the rows before `end`, down to `first`; the matrix' end may cut rows short."""
    for k in range(end - 1, first - 1, -1):
        total = x[k]
        for j in range(1, min(2 * b, x.size - 1 - k) + 1):
            total -= ab[k, b + j] * x[k + j]
        x[k] = total * ab[k, b]


@njit
def _back_substitute_whole(ab: Array, x: Array, end: int, first: int, b: int, reach: int) -> None:
    """Back substitution for rows with as many numbers beyond their pivots as `reach` says.

    All products but one are summed before the unknown solved last is there; the rest is added in two sums.
    """
    if end <= first:
        return
    unknown = x[end]
    for k in range(end - 1, first - 1, -1):
        even, odd = x[k], 0.0
        for j in range(2, reach + 1):
            if j % 2:
                odd += ab[k, b + j] * x[k + j]
            else:
                even -= ab[k, b + j] * x[k + j]
        inverse = ab[k, b]
        unknown = (even - odd) * inverse - ab[k, b + 1] * inverse * unknown
        x[k] = unknown


@njit
def solve_at(ab: Array, pivots: IntArray, at: IntArray, loads: Array, B: Size) -> Array:
    """Rows `at` (m,), in increasing order, of the solution (m, nl) for loads (m, nl) in these rows, with the factors of
    `factorise`; all other rows bear nothing.
    """
    n, b, m = pivots.size, len(B), loads.shape[1]
    x = np.zeros((n, m))
    each: Any = np.zeros(m)
    if at.size == 0:
        return x[at]
    for k in range(at.size):
        for c in range(m):
            x[at[k], c] = loads[k, c]
    for k in range(max(at[0] - b, 0), n):
        p = pivots[k]
        if p != k:
            for c in range(m):
                x[k, c], x[p, c] = x[p, c], x[k, c]
        for i in range(1, min(b, n - 1 - k) + 1):
            factor = ab[k, i - 1]
            if factor != 0.0:
                add_multiple(x, (k + i) * m, -factor, x, k * m, each)
    for k in range(n - 1, at[0] - 1, -1):
        for j in range(1, min(2 * b, n - 1 - k) + 1):
            factor = ab[k, b + j]
            if factor != 0.0:
                add_multiple(x, k * m, -factor, x, (k + j) * m, each)
        for c in range(m):
            x[k, c] *= ab[k, b]
    return x[at]


@njit
def count_negative_pivots(ab: Array, n: int, B: Size, right: Array, corner: Array) -> int:
    """Negative pivots of a symmetric matrix without row exchanges: its negative eigenvalues. The matrix is lost.

    right (n, nb), corner (nb, nb): of a border, which is eliminated last; it counts, too.
    """
    b, negative = len(B), 0
    for k in range(n):
        pivot = ab[k, b]
        negative += pivot < 0.0
        if pivot == 0.0:
            continue
        for i in range(1, min(b, n - 1 - k) + 1):
            factor = ab[k, b + i] / pivot
            if factor != 0.0:
                for j in range(i, b + 1):
                    ab[k + i, b + j - i] -= factor * ab[k, b + j]
                for c in range(right.shape[1]):
                    right[k + i, c] -= factor * right[k, c]
        for c in range(right.shape[1]):
            factor = right[k, c] / pivot
            if factor != 0.0:
                for d in range(right.shape[1]):
                    corner[c, d] -= factor * right[k, d]
    for c in range(corner.shape[0]):
        pivot = corner[c, c]
        negative += pivot < 0.0
        if pivot == 0.0:
            continue
        for i in range(c + 1, corner.shape[0]):
            factor = corner[i, c] / pivot
            for j in range(c + 1, corner.shape[0]):
                corner[i, j] -= factor * corner[c, j]
    return negative


def solve_symmetric(upper: Array, loads: Array) -> Array:
    """Solution (n, k) for loads (n, k) of a symmetric matrix whose entry (i, j), j >= i, lies at upper[b + i - j, j].

    upper (b + 1, n): as scipy.linalg.solveh_banded takes it. Raises LinAlgError where the matrix is singular.
    """
    given, n = len(upper) - 1, upper.shape[1]
    b = next((width for width in OF_LINES if width >= given), given)  # those of lines are compiled sooner or later
    (band, width), pivots = workspace(n, b), np.zeros(n, dtype=np.int64)
    for d in range(min(given + 1, n)):
        band[: n - d, b + d] = band[d:n, b - d] = upper[given - d, d:]
    if not factorise(band, pivots, width):
        raise np.linalg.LinAlgError("singular matrix")
    columns = np.array(loads.T, order="C")
    for column in columns:
        solve(band, pivots, column, width)
    return np.asarray(columns.T)
