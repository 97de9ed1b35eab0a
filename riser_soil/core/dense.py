"""Dense LU factorisation with partial pivoting in compiled code: LAPACK's, which numba reaches, but tells by raising.

LAPACK takes a matrix by columns, so of one that lies by rows it factorises the transpose, P A' = L U. A x = b is solved
with U' first and with L' then, both of them read along their rows.
"""

from __future__ import annotations

from numba import types
from numba.np.linalg import _LAPACK, F_INT_nptype

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit

HUGE = 1e300  # a pivot beyond it is no number to divide by
PIVOT = F_INT_nptype  # the type of LAPACK's pivots
_DOUBLE = ord("d")
_getrf = _LAPACK().numba_xxgetrf(types.float64)


@njit
def factorise(a: Array, pivots: IntArray) -> bool:
    """Factorise a matrix (n, n) in place; whether it is regular. pivots (n,) of type PIVOT."""
    n = pivots.size
    if n == 0:
        return True
    if _getrf(_DOUBLE, n, n, a.ctypes, n, pivots.ctypes) != 0:
        return False
    regular = True
    for k in range(n):
        regular = regular and 0.0 < abs(a[k, k]) < HUGE
    return regular


@njit
def solve(a: Array, pivots: IntArray, x: Array) -> None:
    """Solve with the factors of `factorise`: the right-hand side x (n,) becomes the solution."""
    n = pivots.size
    for i in range(n):
        x[i] = (x[i] - product(a, i, 0, i, x)) / a[i, i]
    for i in range(n - 2, -1, -1):
        x[i] -= product(a, i, i + 1, n, x)
    for k in range(n - 1, -1, -1):
        p = pivots[k] - 1
        if p != k:
            x[k], x[p] = x[p], x[k]


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
