"""Iterative solver for soil too large to be factorised: GMRES, preconditioned by multigrid on the soil.

The preconditioner takes three corrections, each of what the one before has left (Schwarz' method, symmetric and
multiplicative): the riser with the soil's unknowns that it may touch, factorised together, as neither knows the other's
answer to a stiff contact; all of the soil by a cycle of smoothed aggregation (PETSc's GAMG), which is told the soil's
rigid motions; the riser once more. Memory and work of a cycle grow in proportion to the unknowns.
"""

from __future__ import annotations

from typing import ClassVar, Protocol, cast

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Field, local
from riser_soil.core.system import System
from riser_soil.solve.linear_solver import PREFIX, LinearSystems, defaults
from riser_soil.solve.python_context import PythonContext

TOLERANCE, MOST_ITERATIONS, RESTART = 1e-4, 500, 100  # share of the residual that may be left
MULTIGRID = {"soil_pc_gamg_reuse_interpolation": "true"}  # of the first tangent, for all of its pattern


class Solid(Field, Protocol):
    """A field of three displacements at each of its points (n, 3) [m]."""

    points: Array


def solid_of(system: System) -> Solid | None:
    """The soil, where it is solved for as a whole."""
    return cast(Solid | None, system.whole_soil)


class IterativeSolver(PythonContext, LinearSystems):
    """Linear solver of a system with a solid, and the context of its preconditioner; collective."""

    factorises: ClassVar[bool] = False

    def __init__(self, system: System, solid: Solid) -> None:
        self._system, self._solid = system, solid
        self._corrections: list[_Correction] = []

    def serve(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        """Solve what this KSP is asked for, to a relative tolerance."""
        ksp.setType(PETSc.KSP.Type.GMRES)
        ksp.setPCSide(PETSc.PC.Side.RIGHT)
        ksp.setTolerances(rtol=TOLERANCE, atol=0.0, max_it=MOST_ITERATIONS)
        ksp.setGMRESRestart(RESTART)
        self.work_for(ksp.getPC())

    def setUp(self, pc: PETSc.PC) -> None:
        """Called by PETSc for each new tangent."""
        matrix, _ = pc.getOperators()
        if not self._corrections:
            near, soil = self._near(matrix), self._soil(matrix)
            self._corrections = [near, soil, near]
            self._left = matrix.createVecLeft()
        for correction in self._corrections[:2]:
            correction.take(matrix)

    def apply(self, pc: PETSc.PC, x: PETSc.Vec, y: PETSc.Vec) -> None:
        """Called by PETSc: y, about the solution of the system for x."""
        matrix, _ = pc.getOperators()
        y.set(0.0)
        x.copy(self._left)
        for number, correction in enumerate(self._corrections):
            if number > 0:
                matrix.mult(y, self._left)
                self._left.aypx(-1.0, x)
            correction.add(self._left, y)

    def _near(self, matrix: PETSc.Mat) -> _Correction:
        """The riser and all that the pattern couples it with."""
        first, last = matrix.getOwnershipRange()
        index = self._system.numbering.index
        rows = np.concatenate([index[local(line)] for line in self._system.model.lines])
        rows = rows[(rows >= first) & (rows < last)]
        coupled = np.unique(np.concatenate([rows, *(matrix.getRow(int(row))[0] for row in rows)]))
        everywhere = np.unique(np.concatenate(matrix.comm.tompi4py().allgather(coupled)))
        solver = PETSc.PC().create(matrix.comm)
        solver.setType("lu")
        solver.setFactorSolverType("mumps")
        return _Correction(matrix, everywhere[(everywhere >= first) & (everywhere < last)], solver)

    def _soil(self, matrix: PETSc.Mat) -> _Correction:
        first, last = matrix.getOwnershipRange()
        index = self._system.numbering.index[local(self._solid)]
        mine = np.flatnonzero((index >= first) & (index < last) & self._solid.owned)
        mine = mine[np.argsort(index[mine])]
        solver = PETSc.PC().create(matrix.comm)
        solver.setType("gamg")
        solver.setOptionsPrefix(PREFIX + "soil_")
        with defaults(MULTIGRID):
            solver.setFromOptions()
        soil = _Correction(matrix, index[mine], solver)
        soil.matrix.setNearNullSpace(_rigid_motions(self._solid.points[mine // 3], mine % 3, soil.matrix))
        return soil

    def failed(self, ksp: PETSc.KSP) -> tuple[str, bool]:
        """How far the iterations came that did not converge."""
        self.forget()
        return (
            f"the iterative linear solver has not converged in {ksp.getIterationNumber()} iterations: a residual of "
            f"{ksp.getResidualNorm():.3g} is left; take solver: {{linear: direct}}, or cells that are less stretched"
        ), False

    def forget(self) -> None:
        """Drop all that belongs to the present matrix."""
        for correction in self._corrections[:2]:
            correction.destroy()
        self._corrections = []


class _Correction:
    """Solver of some rows of a matrix, on the rank that owns them: sorted (n,)."""

    def __init__(self, matrix: PETSc.Mat, rows: IntArray, solver: PETSc.PC) -> None:
        self._rows = PETSc.IS().createGeneral(rows.astype(PETSc.IntType), comm=matrix.comm)
        self.matrix = matrix.createSubMatrix(self._rows, self._rows)
        self._found = self.matrix.createVecLeft()
        self._solver = solver
        solver.setOperators(self.matrix)

    def take(self, matrix: PETSc.Mat) -> None:
        """Take the values of a matrix of the same pattern."""
        matrix.createSubMatrix(self._rows, self._rows, self.matrix)
        self._solver.setUp()

    def add(self, residual: PETSc.Vec, to: PETSc.Vec) -> None:
        """Add what the rows' residual asks for."""
        mine = residual.getSubVector(self._rows)
        self._solver.apply(mine, self._found)
        residual.restoreSubVector(self._rows, mine)
        part = to.getSubVector(self._rows)
        part.axpy(1.0, self._found)
        to.restoreSubVector(self._rows, part)

    def destroy(self) -> None:
        for thing in (self._solver, self.matrix, self._found, self._rows):
            thing.destroy()


def _rigid_motions(points: Array, axis: IntArray, matrix: PETSc.Mat) -> PETSc.NullSpace:
    """Three shifts and three turns of unknowns (n,), displacements along an axis of their points (n, 3)."""
    comm = matrix.comm.tompi4py()
    total = np.append(points.sum(axis=0), float(len(points)))
    comm.Allreduce(MPI.IN_PLACE, total)
    arm = points - total[:3] / total[3]
    shifts = [np.eye(3)[i][axis] for i in range(3)]
    turns = [np.cross(np.eye(3)[i], arm)[np.arange(len(axis)), axis] for i in range(3)]
    found: list[PETSc.Vec] = []
    for motion in (*shifts, *turns):
        vector = matrix.createVecLeft()
        vector.array_w[:] = motion
        for other in found:
            vector.axpy(-float(vector.dot(other)), other)
        vector.normalize()
        found.append(vector)
    return PETSc.NullSpace().create(vectors=found, comm=matrix.comm)
