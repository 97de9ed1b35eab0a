"""Compliance of linear elastic soil: the displacements that forces on its top cause, from one factorisation."""

from __future__ import annotations

import numpy as np
from petsc4py import PETSc

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.factor_memory import Room
from riser_soil.core.matrix import Matrix
from riser_soil.core.numbering import Numbering
from riser_soil.core.part import State, Weights
from riser_soil.errors import SolveError
from riser_soil.soil.soil import Soil

AT_ONCE = 16  # nodes whose columns are solved for in one call
SAME_ROW = 1e-6  # of the top's longer side: how far points of a row are apart across it


class Compliance:
    """Inverse of the stiffness of soil in linear elasticity, as far as it is asked for; on one rank.

    The stiffness is factorised once. columns: displacements of the top by unit forces on a node's three dofs; those of
    supported dofs are zero.
    """

    def __init__(self, soil: Soil) -> None:
        self._soil, self._known = soil, dict[int, Array]()
        self._numbering = Numbering(soil.grid.nodes.comm, [soil.field])
        self._solver = self._factorised()
        rows = np.full(int(soil.field.global_index.max()) + 1, -1, dtype=np.int64)
        rows[soil.field.global_index] = self._numbering.index
        self.top: IntArray = rows[soil.surface.global_index]
        self._rank = np.argsort(_in_rows(soil.surface.points[:, :2]))

    def _factorised(self) -> PETSc.PC:
        soil, size = self._soil, self._numbering.size
        matrix = Matrix(self._numbering, soil.blocks(), symmetric=True)
        soil.tangent(State.at_rest(0.0, size), Weights(0.0, 1.0, 0.0, 0.0), matrix.values)
        matrix.assemble()
        room = Room()
        while True:
            solver = PETSc.PC().create(self._numbering.comm)
            solver.setOperators(matrix.mat)
            solver.setType("cholesky")
            solver.setFactorSolverType("mumps")
            solver.setFactorSetUpSolverType()
            for control, value in room.controls.items():
                solver.getFactorMatrix().setMumpsIcntl(control, value)
            try:
                solver.setUp()
            except PETSc.Error as err:
                raise SolveError(f"the stiffness of the elastic soil can't be factorised: {err}") from err
            if not room.grows_after(solver):
                return solver
            solver.destroy()

    def columns(self, nodes: IntArray) -> Array:
        """Displacements (3 np, n, 3) [m/N] of the top's dofs by unit forces on the three dofs of some of its nodes."""
        unknown = np.array([node for node in nodes if int(node) not in self._known], dtype=np.int64)
        for group in np.unique(self._rank[unknown] // AT_ONCE):
            self._solve_for(np.flatnonzero(self._rank // AT_ONCE == group))
        if not len(nodes):
            return np.zeros((len(self.top), 0, 3))
        return np.stack([self._known[int(node)] for node in nodes], axis=1)

    def _solve_for(self, nodes: IntArray) -> None:
        """Columns of some nodes of the top."""
        rows = self.top.reshape(-1, 3)[nodes].ravel()
        loads = np.zeros((self._numbering.free, len(rows)), order="F")
        free = np.flatnonzero(rows >= 0)
        loads[rows[free], free] = 1.0
        at_top = np.where((self.top >= 0)[:, None], self._solved(loads)[self.top], 0.0)
        self._known |= {int(node): at_top[:, 3 * i : 3 * i + 3].copy() for i, node in enumerate(nodes)}

    def _solved(self, loads: Array) -> Array:
        """Displacements (n, k) by loads (n, k), of the free dofs."""
        given = PETSc.Mat().createDense(loads.shape, array=loads, comm=PETSc.COMM_SELF)
        found = PETSc.Mat().createDense(loads.shape, comm=PETSc.COMM_SELF)
        found.setUp()
        self._solver.getFactorMatrix().matSolve(given, found)
        out: Array = found.getDenseArray().copy()
        given.destroy()
        found.destroy()
        return out

    def displacement(self, on_top: Array) -> Array:
        """Displacement (size,) of the whole field [m] by forces (3 np,) on the top's dofs [N]."""
        loads, out = np.zeros((self._numbering.free, 1), order="F"), np.zeros(self._numbering.size)
        free = self.top >= 0
        loads[self.top[free], 0] = on_top[free]
        moving = self._numbering.index >= 0
        out[moving] = self._solved(loads)[self._numbering.index[moving], 0]
        return out


def _in_rows(xy: Array) -> IntArray:
    """Order of points (n, 2): row by row along the longer side of their box, which is most often the riser's."""
    extent = np.ptp(xy, axis=0)
    along = int(extent.argmax())
    rows = np.round(xy[:, 1 - along] / (SAME_ROW * float(extent.max())))
    return np.lexsort((xy[:, along], rows))
