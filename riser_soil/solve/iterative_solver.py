"""Iterative solver for soil too large to be factorised: GMRES, preconditioned by multigrid on the soil.

The preconditioner makes three corrections, each for the residual after the one before (Schwarz' method, symmetric and
multiplicative): the riser with the soil's unknowns that it may touch, factorised together, as a stiff contact couples
the two; all of the soil by a cycle of plain aggregation (PETSc's GAMG), which is given the soil's rigid motions; the
riser once more. Memory and work of a cycle grow in proportion to the unknowns. The riser's corrections need only their
own columns and rows of the matrix. Smoothed aggregation would take as many iterations on clay that hardly changes its
volume, and three times as long to be set up for a tangent.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, cast

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import local
from riser_soil.core.system import System
from riser_soil.solve.linear_solver import LinearSolver
from riser_soil.solve.petsc_options import PREFIX, defaults
from riser_soil.solve.python_context import PythonContext

if TYPE_CHECKING:
    from riser_soil.soil.field import SoilField

TOLERANCE, MOST_ITERATIONS, RESTART = 1e-4, 500, 100  # largest final share of the residual
MULTIGRID = {  # read when it is made and, of its levels, when it is set up
    "soil_pc_gamg_reuse_interpolation": "true",  # of the first tangent, for all of its pattern
    "soil_pc_gamg_agg_nsmooths": "0",
    "soil_mg_levels_ksp_max_it": "3",
    "soil_mg_levels_ksp_chebyshev_esteig": "0,0.03,0,1.1",  # stretched cells: all that aggregates don't correct
}


def solid_of(system: System) -> SoilField | None:
    """The soil, where it is solved for as a whole."""
    return cast("SoilField | None", system.whole_soil)


class IterativeSolver(PythonContext, LinearSolver):
    """Linear solver of a system with a solid, and the context of its preconditioner; collective."""

    factorises: ClassVar[bool] = False

    def __init__(self, system: System, solid: SoilField) -> None:
        self._system, self._solid = system, solid
        self._corrections: _Corrections | None = None

    def attach(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        """Set a KSP up, which solves to a relative tolerance."""
        ksp.setType(PETSc.KSP.Type.GMRES)
        ksp.setPCSide(PETSc.PC.Side.RIGHT)
        ksp.setTolerances(rtol=TOLERANCE, atol=0.0, max_it=MOST_ITERATIONS)
        ksp.setGMRESRestart(RESTART)
        self.work_for(ksp.getPC())

    def setUp(self, pc: PETSc.PC) -> None:
        """Called by PETSc for each new tangent."""
        matrix, _ = pc.getOperators()
        with defaults(MULTIGRID):
            if self._corrections is None:
                self._corrections = _Corrections(matrix, self._near(matrix), self._soil(matrix))
            self._corrections.update(matrix)

    def apply(self, pc: PETSc.PC, x: PETSc.Vec, y: PETSc.Vec) -> None:
        """Called by PETSc: y, about the solution of the system for x."""
        assert self._corrections is not None
        self._corrections.apply(x, y)

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
        solver.setFromOptions()
        soil = _Correction(matrix, index[mine], solver)
        soil.matrix.setNearNullSpace(_rigid_motions(self._solid.points[mine // 3], mine % 3, soil.matrix))
        return soil

    def failed(self, ksp: PETSc.KSP) -> tuple[str, bool]:
        """Message about iterations that did not converge, with their number and residual."""
        self.forget()
        return (
            f"the iterative linear solver has not converged in {ksp.getIterationNumber()} iterations: a residual of "
            f"{ksp.getResidualNorm():.3g} is left; take solver: {{linear: direct}}, or cells that are less stretched"
        ), False

    def forget(self) -> None:
        """Drop all that belongs to the present matrix."""
        if self._corrections is not None:
            self._corrections.destroy()
        self._corrections = None


class _Corrections:
    """Corrections by the riser and what it may touch, by the soil, and by the first once more."""

    def __init__(self, matrix: PETSc.Mat, near: _Correction, soil: _Correction) -> None:
        first, last = matrix.getOwnershipRange()
        self._all = PETSc.IS().createStride(last - first, first, 1, comm=matrix.comm)
        self._near, self._soil = near, soil
        self._columns = matrix.createSubMatrix(self._all, near.rows)
        self._rows = matrix.createSubMatrix(near.rows, self._all)
        self._residual, self._near_rows = self._columns.createVecLeft(), self._rows.createVecLeft()

    def update(self, matrix: PETSc.Mat) -> None:
        """Use the values of another matrix of the same pattern."""
        matrix.createSubMatrix(self._all, self._near.rows, self._columns)
        matrix.createSubMatrix(self._near.rows, self._all, self._rows)
        for correction in (self._near, self._soil):
            correction.update(matrix)

    def apply(self, x: PETSc.Vec, y: PETSc.Vec) -> None:
        """y, about the solution of the system for x: each correction is for the residual after the ones before."""
        near, soil = self._near, self._soil
        load = x.array_r[near.place]
        y.set(0.0)
        near.add(load, y)
        self._columns.mult(near.solution, self._residual)
        self._residual.aypx(-1.0, x)
        soil.add(self._residual.array_r[soil.place], y)
        self._rows.mult(y, self._near_rows)
        near.add(load - self._near_rows.array_r, y)

    def destroy(self) -> None:
        for correction in (self._near, self._soil):
            correction.destroy()
        for thing in (self._columns, self._rows, self._residual, self._near_rows, self._all):
            thing.destroy()


class _Correction:
    """Solver of some rows of a matrix, on the rank that owns them: sorted (n,).

    place: (n,) of them among the rank's rows; solution: for the last residual.
    """

    def __init__(self, matrix: PETSc.Mat, rows: IntArray, solver: PETSc.PC) -> None:
        self.place = rows - matrix.getOwnershipRange()[0]
        self.rows = PETSc.IS().createGeneral(rows.astype(PETSc.IntType), comm=matrix.comm)
        self.matrix = matrix.createSubMatrix(self.rows, self.rows)
        self.solution, self._residual = self.matrix.createVecs()
        self._solver = solver
        solver.setOperators(self.matrix)

    def update(self, matrix: PETSc.Mat) -> None:
        """Use the values of another matrix of the same pattern."""
        matrix.createSubMatrix(self.rows, self.rows, self.matrix)
        self._solver.setUp()

    def add(self, residual: Array, to: PETSc.Vec) -> None:
        """Solve for a residual (n,) of the rows, and add the solution."""
        self._residual.array_w[:] = residual
        self._solver.apply(self._residual, self.solution)
        to.array_w[self.place] += self.solution.array_r

    def destroy(self) -> None:
        for thing in (self._solver, self.matrix, self.solution, self._residual, self.rows):
            thing.destroy()


def _rigid_motions(points: Array, axis: IntArray, matrix: PETSc.Mat) -> PETSc.NullSpace:
    """Three shifts and three turns of unknowns (n,), displacements along an axis of their points (n, 3)."""
    comm = matrix.comm.tompi4py()
    total = np.append(points.sum(axis=0), float(len(points)))
    comm.Allreduce(MPI.IN_PLACE, total)
    arm = points - total[:3] / total[3]
    shifts = [np.eye(3)[i][axis] for i in range(3)]
    turns = [np.cross(np.eye(3)[i], arm)[np.arange(len(axis)), axis] for i in range(3)]
    basis: list[PETSc.Vec] = []
    for motion in (*shifts, *turns):
        vector = matrix.createVecLeft()
        vector.array_w[:] = motion
        for other in basis:
            vector.axpy(-float(vector.dot(other)), other)
        vector.normalize()
        basis.append(vector)
    return PETSc.NullSpace().create(vectors=basis, comm=matrix.comm)
