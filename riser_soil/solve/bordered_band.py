"""Exact factors of a riser's matrix, a band, with a dense border of few other dofs that all couple with each other.

A riser alone has no border. Where the whole is positive definite, so is the band, and of no larger condition:
eliminating it first is as stable as any order (Golub & Van Loan, Matrix Computations, 2013, 4.3). The elimination is
that of `core.bordered`. It needs no PETSc.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from riser_soil.core import banded
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.banded import SingularError
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.matrix import Matrix
from riser_soil.core.system import System

WIDEST = 32  # entries beside the diagonal up to which a matrix is a riser's
OF_LINES = 5, 11  # entries beside it of a line in a plane and in space, for which the loops over a row are compiled


class BorderedBand:
    """Factors of the first rows of a matrix, made anew where it has changed.

    band: rows of the band; border: of the border, the next ones. Entries in other columns don't count.
    """

    def __init__(self, matrix: Matrix, band: int, border: int = 0) -> None:
        self._matrix, self._factored, wide = matrix, -1, _half_bandwidth(matrix, band)
        self._band, self._wide = np.zeros((band + wide, 3 * wide + 1)), _width(wide)
        self._pivots, self._exchanged = np.zeros(band, dtype=np.int64), np.zeros(0)
        self._right, self._below, self._schur = (np.zeros((rows, border)) for rows in (band, band, border))
        self._coupled: IntArray = np.zeros(0, dtype=np.int64)

    def factorise(self) -> None:
        """Where that has not been done; SingularError where it can't be."""
        if self._factored == self._matrix.changes:
            return
        self._factored, factors = -1, (self._band, self._pivots, self._wide)
        parts = self._band, self._right, self._below, self._schur
        self._coupled = np.flatnonzero(_spread(*self._matrix.stored.csr(), *parts))
        if not banded.factorise(*factors):
            raise SingularError
        if self._schur.size:
            from riser_soil.core import bordered, dense  # with SciPy, which a riser alone does without

            bordered.condense(*factors, self._coupled, self._right, self._below, self._schur)
            self._exchanged = np.zeros(len(self._schur), dense.PIVOT)
            if not dense.factorise(self._schur, self._exchanged):
                raise SingularError
        self._factored = self._matrix.changes

    def solve(self, load: Array) -> Array:
        """Solution for a load, in the rows of band and border; SingularError where there is none."""
        self.factorise()
        x, factors = load.copy(), (self._band, self._pivots, self._wide)
        inner, border = x[: len(self._pivots)], x[len(self._pivots) :]
        if border.size:
            from riser_soil.core import bordered, dense

            bordered.forward_eliminate(*factors, self._coupled, self._below, inner, border)
            dense.solve(self._schur, self._exchanged, border)
            bordered.back_substitute(self._coupled, self._right, border, inner)
        banded.solve(self._band, self._pivots, inner, self._wide)
        return x


def band_of(system: System) -> BorderedBand | None:
    """Factors of a serial system whose matrix is a riser's band with a dense border, or none; else None."""
    rows = system.numbering.free
    if system.is_chain:
        return BorderedBand(system.matrix, rows)
    if system.comm.size > 1 or len(system.model.lines) > 1:
        return None
    at = slice(0, sum(line.size for line in system.model.lines))
    chain = int(np.count_nonzero(system.numbering.index[at] >= 0))
    indptr, indices, _ = system.matrix.stored.csr()
    coupled = np.count_nonzero(indices[indptr[chain] :] >= chain)
    if coupled < (rows - chain) ** 2 or _half_bandwidth(system.matrix, chain) > WIDEST:
        return None
    return BorderedBand(system.matrix, chain, rows - chain)


def _width(wide: int) -> Any:
    """A band's width as `banded` takes it: fixed for lines, else an array of that length, for matrices of all widths.
    """
    return fixed(wide) if wide in OF_LINES else np.zeros(wide)


def negative_pivots(matrix: Matrix, rows: int) -> int:
    """Negative pivots of a symmetric matrix' first rows, a band: its number of negative eigenvalues."""
    wide, none = _half_bandwidth(matrix, rows), np.zeros((rows, 0))
    band = np.zeros((rows + wide, 3 * wide + 1))
    _spread(*matrix.stored.csr(), band, none, none, np.zeros((0, 0)))
    return int(banded.count_negative_pivots(band, rows, np.zeros(wide)))


def _half_bandwidth(matrix: Matrix, rows: int) -> int:
    """Largest distance from the diagonal of an entry among the first rows and columns."""
    indptr, indices, _ = matrix.stored.csr()
    of_entry, columns = np.repeat(np.arange(rows), np.diff(indptr[: rows + 1])), indices[: indptr[rows]]
    return int(np.abs(of_entry - columns)[columns < rows].max(initial=0))


@njit
def _spread(
    indptr: IntArray, indices: IntArray, values: Array, band: Array, right: Array, below: Array, corner: Array
) -> BoolArray:
    """Write the values of a CSR matrix to its four parts; which rows of the band are coupled with the border. band: as
    `banded` has it; below (band, border): the transpose of the block below.
    """
    chain, rows, middle = right.shape[0], right.shape[0] + corner.shape[0], (band.shape[1] - 1) // 3
    touched = np.zeros(chain, np.bool_)
    for part in (band, right, below, corner):
        part[...] = 0.0
    for i in range(rows):
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
            if j >= rows:
                continue
            if i < chain and j < chain:
                band[i, j - i + middle] = values[k]
            elif i < chain:
                right[i, j - chain] = values[k]
                touched[i] |= values[k] != 0.0
            elif j < chain:
                below[j, i - chain] = values[k]
                touched[j] |= values[k] != 0.0
            else:
                corner[i - chain, j - chain] = values[k]
    return touched
