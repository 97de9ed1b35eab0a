"""Exact factors of lines' matrices, bands one behind the other, with a dense border of few other rows.

A riser alone has no border. Where joints couple lines and bodies, the fewest rows that all entries beside the bands lie
in are the border: a body's own six, of two lines' ends those of one; in time steps, too (`joint_border`). Condensed
soil, whose rows all couple with each other, is border as well. Where the whole is positive definite, so is the band,
and of no larger condition: eliminating it first is as stable as any order (Golub & Van Loan, Matrix Computations, 2013,
4.3). The elimination is that of `core.bordered`. It needs no PETSc.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from riser_soil.core import banded
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.banded import SingularError
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.matrix import Matrix
from riser_soil.core.part import LineField
from riser_soil.core.system import System
from riser_soil.solve.newton_settings import MOST_JOINTS

MOST_ROWS = 6 * MOST_JOINTS  # of the border, that joints have


class BorderedBand:
    """Factors of some rows of a matrix and the same columns, made anew where it has changed.

    rows: of the band and of the border, each in order; entries in other columns don't count.
    """

    def __init__(self, matrix: Matrix, band: IntArray, border: IntArray) -> None:
        self._matrix, self._factored, self.rows = matrix, -1, (band, border)
        self._places = _places(matrix, band, border)
        self._wide = _width(_half_bandwidth(matrix, self._places, len(band)))
        self._parts = self._new_parts()
        self._band, self._right, self._below, self._schur = self._parts
        self._pivots, self._exchanged = np.zeros(len(band), dtype=np.int64), np.zeros(0)
        self._coupled: IntArray = np.zeros(0, dtype=np.int64)

    def _new_parts(self) -> tuple[Array, Array, Array, Array]:
        """Band as `banded` has it, block to its right, transpose of that below, corner."""
        (band, border), wide = map(len, self.rows), len(self._wide)
        right, below, corner = (np.zeros((rows, border)) for rows in (band, band, border))
        return np.zeros((band + wide, 3 * wide + 1)), right, below, corner

    def factorise(self) -> None:
        """Factorise the present matrix, unless its factors are known; SingularError where it has none."""
        if self._factored == self._matrix.changes:
            return
        self._factored, factors = -1, (self._band, self._pivots, self._wide)
        self._coupled = np.flatnonzero(_spread(*self._matrix.stored.csr(), self._places, *self._parts))
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
        """Solution for a load, in the matrix' first rows, those of band and border; SingularError where there is none.
        """
        self.factorise()
        x, factors = np.empty_like(load), (self._band, self._pivots, self._wide)
        inner, border = (load[rows] for rows in self.rows)
        if border.size:
            from riser_soil.core import bordered, dense

            bordered.forward_eliminate(*factors, self._coupled, self._below, inner, border)
            dense.solve(self._schur, self._exchanged, border)
            bordered.back_substitute(self._coupled, self._right, border, inner)
        banded.solve(self._band, self._pivots, inner, self._wide)
        for rows, solution in zip(self.rows, (inner, border), strict=True):
            x[rows] = solution
        return x

    def negative_pivots(self) -> int:
        """Negative pivots of a symmetric matrix without row exchanges: its number of negative eigenvalues, as many as
        the band and its Schur complement have together (Haynsworth, Linear Algebra Appl. 1, 1968), whatever the units
        of rows.
        """
        band, right, below, corner = self._new_parts()
        _spread(*self._matrix.stored.csr(), self._places, band, right, below, corner)
        wide = np.zeros(len(self._wide))
        return int(banded.count_negative_pivots(band, len(self._pivots), wide, right, corner))


def band_of(system: System) -> BorderedBand | None:
    """Factors of a serial system whose matrix is its lines' bands with a dense border, or none; else None."""
    if system.comm.size > 1:
        return None
    rows, of_lines = system.numbering.free, system.line_rows
    if rows - of_lines > 0 and (len(system.model.lines) > 1 or not _is_dense_behind(system.matrix, of_lines)):
        return None
    joined = _rows_beside(system.matrix, of_lines, max(map(_band_of_elements, system.model.lines)))
    if len(joined) > MOST_ROWS:
        return None
    band = np.setdiff1d(np.arange(of_lines), joined)
    return BorderedBand(system.matrix, band, np.concatenate([joined, np.arange(of_lines, rows)]))


def band_alone(matrix: Matrix, rows: int) -> BorderedBand:
    """Factors of a matrix' first rows, which are a band."""
    return BorderedBand(matrix, np.arange(rows), np.zeros(0, dtype=np.int64))


def _band_of_elements(line: LineField) -> int:
    """Entries beside the diagonal of a line's element matrices, or of a body's."""
    nodes = len(line.translation_dofs)
    return min(nodes, 2) * (line.size // nodes) - 1


def _is_dense_behind(matrix: Matrix, first: int) -> bool:
    """Whether all of the rows from `first` on couple with each other."""
    indptr, indices, _ = matrix.stored.csr()
    behind = len(indptr) - 1 - first
    return bool(np.count_nonzero(indices[indptr[first] :] >= first) == behind**2)


def _rows_beside(matrix: Matrix, rows: int, wide: int) -> IntArray:
    """The fewest of the first rows that all entries farther from the diagonal than a band is wide lie in, or in whose
    columns.
    """
    indptr, indices, _ = matrix.stored.csr()
    of_entry, columns = np.repeat(np.arange(rows), np.diff(indptr[: rows + 1])), indices[: indptr[rows]]
    beside = (np.abs(of_entry - columns) > wide) & (columns < rows)
    return fewest_rows(of_entry[beside], columns[beside])


def fewest_rows(row: IntArray, column: IntArray) -> IntArray:
    """The fewest unknowns, as a greedy choice finds them, so that each coupling (k,) of two unknowns has one of them;
    sorted. What joints couple beside the lines' bands has these as its border, in statics and in time steps.
    """
    chosen = list[int]()
    while row.size:
        chosen.append(int(np.bincount(np.concatenate([row, column])).argmax()))
        uncovered = (row != chosen[-1]) & (column != chosen[-1])
        row, column = row[uncovered], column[uncovered]
    return np.array(sorted(chosen), dtype=np.int64)


def _width(wide: int) -> Any:
    """A band's width as `banded` takes it: fixed for lines, else an array of that length, for matrices of all widths.
    """
    return fixed(wide) if wide in banded.OF_LINES else np.zeros(wide)


def _places(matrix: Matrix, band: IntArray, border: IntArray) -> IntArray:
    """Place (n,) of each row and column of a matrix: its number in the band, or -1 less its number in the border; the
    number of all rows of the band where it is in neither.
    """
    indptr, indices, _ = matrix.stored.csr()
    places = np.full(max(len(indptr) - 1, int(indices.max(initial=-1)) + 1), len(band), dtype=np.int64)
    places[band], places[border] = np.arange(len(band)), -1 - np.arange(len(border))
    return places


def _half_bandwidth(matrix: Matrix, places: IntArray, band: int) -> int:
    """Largest distance from the diagonal of an entry within the band, of so many rows."""
    indptr, indices, _ = matrix.stored.csr()
    row, column = np.repeat(places[: len(indptr) - 1], np.diff(indptr)), places[indices]
    within = (row >= 0) & (row < band) & (column >= 0) & (column < band)
    return int(np.abs(row - column)[within].max(initial=0))


@njit
def _spread(
    indptr: IntArray,
    indices: IntArray,
    values: Array,
    places: IntArray,
    band: Array,
    right: Array,
    below: Array,
    corner: Array,
) -> BoolArray:
    """Write the values of a CSR matrix to its four parts; which rows of the band are coupled with the border. band: as
    `banded` has it; below (band, border): the transpose of the block below.
    """
    chain, middle = right.shape[0], (band.shape[1] - 1) // 3
    touched = np.zeros(chain, np.bool_)
    for part in (band, right, below, corner):
        part[...] = 0.0
    for row in range(indptr.size - 1):
        i = places[row]
        if i >= chain:
            continue
        for k in range(indptr[row], indptr[row + 1]):
            j = places[indices[k]]
            if j >= chain:
                continue
            if i >= 0 and j >= 0:
                band[i, j - i + middle] = values[k]
            elif i >= 0:
                right[i, -1 - j] = values[k]
                touched[i] |= values[k] != 0.0
            elif j >= 0:
                below[j, -1 - i] = values[k]
                touched[j] |= values[k] != 0.0
            else:
                corner[-1 - i, -1 - j] = values[k]
    return touched
