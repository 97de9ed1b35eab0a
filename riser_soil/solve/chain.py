"""Linear systems of a riser alone on one rank: those of a chain, whose matrix is a band. They need no PETSc."""

from __future__ import annotations

import numpy as np

from riser_soil.core import banded
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.matrix import Matrix
from riser_soil.core.system import System


class SingularError(Exception):
    """A matrix without an inverse."""


def is_chain(system: System) -> bool:
    """Whether a system is one line's on one rank."""
    return system.comm.size == 1 and len(system.model.fields) == 1


class ChainFactors:
    """Factors of a chain's matrix, made anew where it has changed."""

    def __init__(self, matrix: Matrix) -> None:
        self._matrix, self._factored = matrix, -1

    def solve(self, load: Array) -> Array:
        """What the matrix makes the load of; SingularError where there is nothing."""
        if self._factored != self._matrix.changes:
            self._factorise()
        found = load.copy()
        banded.solve(self._band, self._pivots, found, self._width)
        return found

    def _factorise(self) -> None:
        self._factored = -1
        self._band, self._width = band_of(self._matrix)
        self._pivots = np.zeros(len(self._band) - len(self._width), dtype=np.int64)
        if not banded.factorise(self._band, self._pivots, self._width):
            raise SingularError
        self._factored = self._matrix.changes


def negative_pivots(matrix: Matrix) -> int:
    """Negative pivots of a chain's symmetric matrix: its number of negative eigenvalues."""
    band, width = band_of(matrix)
    return int(banded.count_negative_pivots(band, len(band) - len(width), width))


def band_of(matrix: Matrix) -> tuple[Array, Array]:
    """The matrix as in `banded`, and an array as long as its band is wide: of any length, where that is not fixed."""
    indptr, indices, values = matrix.stored.csr()
    n = len(indptr) - 1
    rows = np.repeat(np.arange(n), np.diff(indptr))
    b = int(np.abs(rows - indices).max(initial=0))
    band = np.zeros((n + b, 3 * b + 1))
    _spread(indptr, indices, values, band, b)
    return band, np.zeros(b)


@njit
def _spread(indptr: IntArray, indices: IntArray, values: Array, band: Array, b: int) -> None:
    for i in range(indptr.size - 1):
        for k in range(indptr[i], indptr[i + 1]):
            band[i, indices[k] - i + b] = values[k]
