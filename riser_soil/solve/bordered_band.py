"""Exact solver of a riser on few other dofs that all couple with each other: a band with a dense border.

Where the whole is positive definite, so is the band, and of no larger condition: eliminating it first is as stable as
any order (Golub & Van Loan, Matrix Computations, 2013, 4.3). The elimination is that of `core.bordered`.
"""

from __future__ import annotations

import numpy as np
from petsc4py import PETSc

from riser_soil.core import banded, bordered, dense
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.banded import SingularError
from riser_soil.core.compiled import njit
from riser_soil.core.dense import PIVOT
from riser_soil.core.system import System
from riser_soil.solve.python_context import PythonContext

WIDEST = 32  # entries beside the diagonal up to which a matrix is a chain's


def bordered_chain(system: System) -> int | None:
    """Rows of a serial system that are a chain's, the first ones, where all the others couple with each other."""
    if system.comm.size > 1 or system.is_chain or len(system.model.lines) > 1:
        return None
    at = slice(0, sum(line.size for line in system.model.lines))
    chain, rows = int(np.count_nonzero(system.numbering.index[at] >= 0)), system.numbering.free
    indptr, indices, _ = system.matrix.mat.getValuesCSR()
    coupled = np.count_nonzero(indices[indptr[chain] :] >= chain)
    if coupled < (rows - chain) ** 2 or bandwidth(system.matrix.mat, chain) > WIDEST:
        return None
    return chain


class BorderedBand(PythonContext):
    """PETSc's preconditioner of type python for such matrices: an exact solver. chain: rows of B, the first ones."""

    def __init__(self, matrix: PETSc.Mat, chain: int) -> None:
        self._indptr, self._indices, _ = matrix.getValuesCSR()
        border = matrix.getSize()[0] - chain
        self._band, self._wide = banded.workspace(chain, bandwidth(matrix, chain))
        self._pivots, self._exchanged = np.zeros(chain, dtype=np.int64), np.zeros(border, PIVOT)
        self._right, self._below, self._schur = (np.zeros((rows, border)) for rows in (chain, chain, border))

    def setUp(self, pc: PETSc.PC) -> None:
        """Factorise the present matrix; SingularError where it can't be."""
        values, factors = pc.getOperators()[1].getValuesCSR()[2], (self._band, self._pivots, self._wide)
        parts = self._band, self._right, self._below, self._schur
        self._coupled = np.flatnonzero(_spread(self._indptr, self._indices, values, *parts))
        if not banded.factorise(*factors):
            raise SingularError
        bordered.condense(*factors, self._coupled, self._right, self._below, self._schur)
        if not dense.factorise(self._schur, self._exchanged):
            raise SingularError

    def apply(self, pc: PETSc.PC, load: PETSc.Vec, found: PETSc.Vec) -> None:
        """Solve."""
        x, factors = load.getArray(readonly=True).copy(), (self._band, self._pivots, self._wide)
        inner, border = x[: len(self._pivots)], x[len(self._pivots) :]
        if border.size:
            bordered.forward_eliminate(*factors, self._coupled, self._below, inner, border)
            dense.solve(self._schur, self._exchanged, border)
            bordered.back_substitute(self._coupled, self._right, border, inner)
        banded.solve(self._band, self._pivots, inner, self._wide)
        found.setArray(x)


def bandwidth(matrix: PETSc.Mat, chain: int) -> int:
    """Largest distance from the diagonal of an entry among the first rows and columns of a serial matrix."""
    indptr, indices, _ = matrix.getValuesCSR()
    rows = np.repeat(np.arange(len(indptr) - 1), np.diff(indptr))
    inner = (rows < chain) & (indices < chain)
    return int(np.abs(rows[inner] - indices[inner]).max(initial=0))


@njit
def _spread(
    indptr: IntArray, indices: IntArray, values: Array, band: Array, right: Array, below: Array, corner: Array
) -> BoolArray:
    """Write the values of a CSR matrix to its four parts; which rows of the chain are coupled with the border. band: as
    `banded` has it; below (chain, border): the transpose of the block below.
    """
    chain, middle = right.shape[0], (band.shape[1] - 1) // 3
    touched = np.zeros(chain, np.bool_)
    for part in (band, right, below, corner):
        part[...] = 0.0
    for i in range(indptr.size - 1):
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
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
