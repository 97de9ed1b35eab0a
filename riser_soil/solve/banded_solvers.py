"""PETSc solvers in Python by a riser's band: LU with a dense border, and the riser alone above untouched soil.

    [B  U] [x]   [f]
    [V  D] [y] = [g]

B is factorised by its band, and the Schur complement D - V inv(B) U densely, both with partial pivoting. Few rows of U
and columns of V, the touched ones, are not zero: it costs the band's solutions for so many unit vectors. Where the
whole is positive definite, so is B, and of no larger condition: eliminating it first is as stable as any order.
Source: Golub & Van Loan, Matrix Computations (2013), 4.3 and 3.4.

The riser of a coupled system solved by itself, where nothing touches the soil and the soil is in balance.

The tangent then has a block of the riser and one of the soil and nothing beside them, and the soil's right-hand side is
zero: so is its increment, and the riser's is that of its own band. No block is left out that is not zero, and what the
soil's rows have left of a residual counts in Newton's test as ever.
"""

from __future__ import annotations

import atexit
from typing import ClassVar

import numpy as np
from petsc4py import PETSc
from scipy.linalg.lapack import dgetrf, dgetrs

from riser_soil.core import banded
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.communicator import all_of
from riser_soil.core.compiled import njit
from riser_soil.core.system import System
from riser_soil.solve.chain import ChainFactors, SingularError

WIDEST = 32  # entries beside the diagonal up to which a matrix is a chain's


class PythonContext:
    """Context of a KSP or preconditioner of type python. in_use: all whose object is not destroyed."""

    in_use: ClassVar[dict[PythonContext, PETSc.KSP | PETSc.PC]] = {}

    def work_for(self, thing: PETSc.KSP | PETSc.PC) -> None:
        """Be what this object calls."""
        PythonContext.in_use[self] = thing
        thing.setType("python")
        thing.setPythonContext(self)

    def reset(self, thing: PETSc.KSP | PETSc.PC) -> None:
        """Called as the object is destroyed."""
        PythonContext.in_use.pop(self, None)


@atexit.register
def let_go() -> None:
    """Part all objects from their contexts here."""
    while PythonContext.in_use:
        _, thing = PythonContext.in_use.popitem()
        thing.setType("none" if isinstance(thing, PETSc.PC) else "preonly")


class BorderedBand(PythonContext):
    """PETSc's preconditioner of type python for such matrices: an exact solver. chain: rows of B, the first ones."""

    def __init__(self, matrix: PETSc.Mat, chain: int) -> None:
        self._indptr, self._indices, _ = matrix.getValuesCSR()
        border = matrix.getSize()[0] - chain
        self._band, self._wide = banded.workspace(chain, bandwidth(matrix, chain))
        self._pivots = np.zeros(chain, dtype=np.int64)
        self._right, self._below, self._corner = (
            np.zeros(shape) for shape in ((chain, border), (border, chain), (border, border))
        )

    def setUp(self, pc: PETSc.PC) -> None:
        """Factorise the present matrix; SingularError where it can't be."""
        values = pc.getOperators()[1].getValuesCSR()[2]
        parts = self._band, self._right, self._below, self._corner
        self._touched = np.flatnonzero(_spread(self._indptr, self._indices, values, *parts))
        if not banded.factorise(self._band, self._pivots, self._wide):
            raise SingularError
        between = banded.inverse_at(self._band, self._pivots, self._touched, self._wide)
        self._by_chain = np.ascontiguousarray(self._below[:, self._touched])
        self._by_border = np.ascontiguousarray(self._right[self._touched])
        schur = self._corner - self._by_chain @ (between @ self._by_border)
        if schur.size:
            schur, self._exchanged, singular = dgetrf(schur)
            if singular:
                raise SingularError
        self._schur = schur

    def apply(self, pc: PETSc.PC, load: PETSc.Vec, found: PETSc.Vec) -> None:
        """Solve."""
        x, chain = load.getArray(readonly=True).copy(), len(self._pivots)
        if self._schur.size:
            inner = x[:chain].copy()
            banded.solve(self._band, self._pivots, inner, self._wide)
            x[chain:] -= self._by_chain @ inner[self._touched]
            x[chain:] = dgetrs(self._schur, self._exchanged, x[chain:])[0]
            x[self._touched] -= self._by_border @ x[chain:]
        banded.solve(self._band, self._pivots, x[:chain], self._wide)
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
    """Write the values of a CSR matrix to its four parts; which rows of the chain the border touches. band: as `banded`
    has it.
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
                below[i - chain, j] = values[k]
                touched[j] |= values[k] != 0.0
            else:
                corner[i - chain, j - chain] = values[k]
    return touched


class RiserAboveSoil(PythonContext):
    """Linear solver of such systems; collective."""

    def __init__(self, system: System) -> None:
        self._system, self._rows = system, system.line_rows
        self._factors = ChainFactors(system.matrix, self._rows)

    def serve(self, ksp: PETSc.KSP) -> None:
        """Solve what this KSP is asked for."""
        self.work_for(ksp)
        ksp.getPC().setType(PETSc.PC.Type.NONE)

    def suits(self, f: Array, negligible: float) -> bool:
        """Whether the tangent couples the riser with nothing, all other rows of a residual f (owned,) have no more than
        what is negligible [N], and the riser's own band has an inverse; the same on all ranks.
        """
        rest = f[self._rows :]
        coupled, squares = self._system.sum([float(self._system.couples), float(rest @ rest)])
        if coupled > 0.0 or not squares <= negligible**2:
            return False
        return all_of(self._system.comm, self._factorised())

    def _factorised(self) -> bool:
        try:
            if self._rows > 0:
                self._factors.factorise()
        except SingularError:
            return False
        return True

    def solve(self, ksp: PETSc.KSP, b: PETSc.Vec, x: PETSc.Vec) -> None:
        """Called by PETSc."""
        found = np.zeros(x.getLocalSize())
        if self._rows > 0:
            found[: self._rows] = self._factors.solve(np.array(b.array_r[: self._rows]))
        x.array_w[:] = found
        ksp.setConvergedReason(PETSc.KSP.ConvergedReason.CONVERGED_RTOL)
