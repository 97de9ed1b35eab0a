"""Newton's method for a riser alone on one rank, whose matrix is a band: a chain. It needs no PETSc."""

from __future__ import annotations

import numpy as np

from riser_soil.core import banded
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.banded import SingularError
from riser_soil.core.compiled import njit
from riser_soil.core.matrix import Matrix
from riser_soil.core.system import System
from riser_soil.solve.convergence import ITERATING, NOT_SOLVED
from riser_soil.solve.newton_loop import Balance, Loop, iterate


class ChainFactors:
    """Factors of a chain's matrix, made anew where it has changed. rows: its first ones, which are the chain's; all by
    default.
    """

    def __init__(self, matrix: Matrix, rows: int | None = None) -> None:
        self._matrix, self._rows, self._factored = matrix, rows, -1

    def solve(self, load: Array) -> Array:
        """What the matrix makes the load of; SingularError where there is nothing."""
        self.factorise()
        found = load.copy()
        banded.solve(self._band, self._pivots, found, self._width)
        return found

    def factorise(self) -> None:
        """Where that has not been done; SingularError where it can't be."""
        if self._factored == self._matrix.changes:
            return
        self._factored = -1
        self._band, self._width = band_of(self._matrix, self._rows)
        self._pivots = np.zeros(len(self._band) - len(self._width), dtype=np.int64)
        if not banded.factorise(self._band, self._pivots, self._width):
            raise SingularError
        self._factored = self._matrix.changes


def negative_pivots(matrix: Matrix, rows: int | None = None) -> int:
    """Negative pivots of a chain's symmetric matrix: its number of negative eigenvalues. rows: as of `ChainFactors`."""
    band, width = band_of(matrix, rows)
    return int(banded.count_negative_pivots(band, len(band) - len(width), width))


def band_of(matrix: Matrix, rows: int | None = None) -> tuple[Array, Array]:
    """The matrix as in `banded`, and an array as long as its band is wide: of any length, where that is not fixed.
    rows: of the matrix, the first ones, and as many columns.
    """
    indptr, indices, values = matrix.stored.csr()
    n = len(indptr) - 1 if rows is None else rows
    of_entry = np.repeat(np.arange(n), np.diff(indptr[: n + 1]))
    columns = indices[: indptr[n]]
    b = int(np.abs(of_entry - columns)[columns < n].max(initial=0))
    band = np.zeros((n + b, 3 * b + 1))
    _spread(indptr[: n + 1], indices, values, band, b)
    return band, np.zeros(b)


@njit
def _spread(indptr: IntArray, indices: IntArray, values: Array, band: Array, b: int) -> None:
    n = indptr.size - 1
    for i in range(n):
        for k in range(indptr[i], indptr[i + 1]):
            if indices[k] < n:
                band[i, indices[k] - i + b] = values[k]


class ChainLoop(Loop):
    """Newton's iteration with banded factors."""

    def __init__(self, system: System, max_iterations: int, balance: Balance) -> None:
        self._system, self.max_iterations, self._balance = system, max_iterations, balance
        self.renew()

    def iterate(self, x: Array) -> str:
        self._x = x
        return iterate(self)

    def judge(self) -> str:
        self._f = self._balance.residual(self._x)
        return self._balance.judge(self._x, self._f)

    def improve(self) -> str:
        self._balance.tangent(self._x)
        failure, response = self.respond(self._f)
        if failure:
            return failure
        self._x = self._x - self._balance.shortened(self._x, response)
        return ITERATING

    def respond(self, f: Array) -> tuple[str, Array]:
        try:
            return "", self._factors.solve(f)
        except SingularError:
            return NOT_SOLVED, f

    def renew(self) -> None:
        self._factors = ChainFactors(self._system.matrix)
