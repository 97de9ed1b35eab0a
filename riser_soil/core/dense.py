"""Dense LU factorisation with partial pivoting, for compiled code, where LAPACK's errors could not be told.

Source: Golub & Van Loan, Matrix Computations (2013), 3.4.
"""

from __future__ import annotations

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit

HUGE = 1e300  # a pivot beyond it is no number to divide by


@njit
def factorise(a: Array, pivots: IntArray) -> bool:
    """Factorise a matrix (n, n) in place; whether it is regular. pivots (n,): the rows that were taken as pivots'."""
    n = pivots.size
    for k in range(n):
        p = k
        for i in range(k + 1, n):
            if abs(a[i, k]) > abs(a[p, k]):
                p = i
        if not 0.0 < abs(a[p, k]) < HUGE:
            return False
        pivots[k] = p
        if p != k:
            for j in range(n):
                a[k, j], a[p, j] = a[p, j], a[k, j]
        inverse, row = 1.0 / a[k, k], a[k, k + 1 :]
        for i in range(k + 1, n):
            factor = a[i, k] * inverse
            a[i, k] = factor
            if factor != 0.0:
                below = a[i, k + 1 :]
                for j in range(row.size):
                    below[j] -= factor * row[j]
    return True


@njit
def solve(a: Array, pivots: IntArray, x: Array) -> None:
    """Solve with the factors of `factorise`: the right-hand side x (n,) becomes the solution."""
    n = pivots.size
    for k in range(n):
        p = pivots[k]
        if p != k:
            x[k], x[p] = x[p], x[k]
    for i in range(1, n):
        x[i] -= product(a, i, 0, i, x)
    for i in range(n - 1, -1, -1):
        x[i] = (x[i] - product(a, i, i + 1, n, x)) / a[i, i]


@njit
def product(a: Array, i: int, first: int, last: int, x: Array) -> float:
    """Row i times x between two columns, in four sums that needn't wait for each other."""
    s0 = s1 = s2 = s3 = 0.0
    j = first
    while j + 4 <= last:
        s0 += a[i, j] * x[j]
        s1 += a[i, j + 1] * x[j + 1]
        s2 += a[i, j + 2] * x[j + 2]
        s3 += a[i, j + 3] * x[j + 3]
        j += 4
    while j < last:
        s0 += a[i, j] * x[j]
        j += 1
    return (s0 + s1) + (s2 + s3)
