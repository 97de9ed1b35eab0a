"""Linear solver of a riser that does not touch its soil, which is in balance: the riser's band alone.

The tangent then has a block of the riser and one of the soil and nothing beside them, so that each is its own Schur
complement; and the soil's right-hand side is zero: so is its increment, and the riser's is that of its own band. No
block is left out that is not zero, and the residual of the soil's rows counts in Newton's test as ever.
"""

from __future__ import annotations

import numpy as np
from petsc4py import PETSc

from riser_soil.core.arrays import Array
from riser_soil.core.banded import SingularError
from riser_soil.core.communicator import all_of
from riser_soil.core.system import System
from riser_soil.solve.bordered_band import band_alone
from riser_soil.solve.linear_solver import LinearSolver
from riser_soil.solve.python_context import PythonContext


class RiserAboveSoil(PythonContext, LinearSolver):
    """Linear solver of a system by the band of its riser alone; collective."""

    def __init__(self, system: System) -> None:
        self._system, self._rows = system, system.line_rows
        self._factors = band_alone(system.matrix, self._rows)

    def attach(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
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
        solution = np.zeros(x.getLocalSize())
        if self._rows > 0:
            solution[: self._rows] = self._factors.solve(np.array(b.array_r[: self._rows]))
        x.array_w[:] = solution
        ksp.setConvergedReason(PETSc.KSP.ConvergedReason.CONVERGED_RTOL)
