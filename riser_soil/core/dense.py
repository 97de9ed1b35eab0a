"""Dense LU factorisation with partial pivoting in compiled code: LAPACK's dgetrf, as SciPy has it for Cython.

LAPACK takes a matrix by columns, so of one that lies by rows it factorises the transpose, P A' = L U. A x = b is solved
with U' first and with L' then, both of them read along their rows.

Compiled code calls it by a name that stands for its address in this process, as an address is nothing to keep on disk.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import types
from numba.extending import get_cython_function_address, overload
from scipy.linalg import cython_lapack, lapack

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.rows import name_in_machine_code

HUGE = 1e300  # a pivot beyond it is no number to divide by
PIVOT = np.intc if "(int *" in str(cython_lapack.__pyx_capi__["dgetrf"]) else np.int64  # LAPACK's integers
_DGETRF = types.ExternalFunction("riser_soil_dgetrf", types.void(*[types.voidptr] * 6))

name_in_machine_code(_DGETRF.symbol, get_cython_function_address("scipy.linalg.cython_lapack", "dgetrf"))


def _factorise(size: IntArray, a: Array, pivots: IntArray, info: IntArray) -> None:
    """LAPACK's factors of a matrix of the size (1,) by columns, in its place; info (1,): 0 where all went well."""
    factors, exchanged, info[0] = lapack.dgetrf(a.T)
    a[...], pivots[...] = factors.T, exchanged + 1


@overload(_factorise)
def _by_name(size: IntArray, a: Array, pivots: IntArray, info: IntArray) -> Callable[..., None]:
    def call(size: IntArray, a: Array, pivots: IntArray, info: IntArray) -> None:
        _DGETRF(size.ctypes, size.ctypes, a.ctypes, size.ctypes, pivots.ctypes, info.ctypes)

    return call


@njit
def factorise(a: Array, pivots: IntArray) -> bool:
    """Factorise a matrix (n, n) in place; whether it is regular. pivots (n,) of type PIVOT."""
    n = pivots.size
    if n == 0:
        return True
    size, info = np.full(1, n, pivots.dtype), np.zeros(1, pivots.dtype)
    _factorise(size, a, pivots, info)
    if info[0] != 0:
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
