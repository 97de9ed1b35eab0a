"""Compliance of linear elastic soil: the displacements that forces on its top cause, from one factorisation at most."""

from __future__ import annotations

from collections import deque
from functools import cached_property

import numpy as np
from petsc4py import PETSc

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.factor_memory import Room
from riser_soil.core.matrix import Matrix
from riser_soil.core.numbering import Numbering
from riser_soil.core.part import State, Weights
from riser_soil.errors import SolveError
from riser_soil.soil.kept_compliance import KeptColumns, key_of
from riser_soil.soil.soil import Soil

AT_ONCE = 16  # nodes whose columns are solved for in one call
HELD = 1 << 28  # bytes of columns in memory, where they can't be kept on disk; others are solved for again
SAME_ROW = 1e-6  # of the top's longer side: how far points of a row are apart across it


class Compliance:
    """Inverse of the stiffness of soil in linear elasticity, as far as it is asked for; on one rank.

    columns: displacements of the top by unit forces on a node's three dofs; those of supported dofs are zero. They are
    found for groups of nodes, in the whole soil. The stiffness is factorised, once, where an earlier run has not kept
    a group. kept: whether one has kept any.
    """

    def __init__(self, soil: Soil) -> None:
        self._soil, self._known, self._groups = soil, dict[int, Array](), dict[int, Array]()
        self._in_memory = deque[int]()  # groups that could not be kept on disk
        self._numbering = Numbering(soil.grid.nodes.comm, [soil.field])
        rows = np.full(int(soil.field.global_index.max()) + 1, -1, dtype=np.int64)
        rows[soil.field.global_index] = self._numbering.index
        self.top: IntArray = rows[soil.surface.global_index]
        rank = np.argsort(_in_rows(soil.surface.points[:, :2]))
        self._group: IntArray = rank // AT_ONCE
        self._files = KeptColumns(self._key())
        self.kept = self._files.holds_any()

    def _key(self) -> str:
        """By the cells' matrices, which follow from mesh and law, their places in the system, and the top's."""
        block = self._soil.blocks()["soil"]
        values = {"soil": block.zeros()}
        _add_stiffness(self._soil, self._numbering.size, values)
        return key_of((values["soil"], self._numbering.index, block.rows, self.top, self._group))

    @cached_property
    def _solver(self) -> PETSc.PC:
        return self._factorised()

    def _factorised(self) -> PETSc.PC:
        soil, size = self._soil, self._numbering.size
        matrix = Matrix(self._numbering, soil.blocks(), symmetric=True)
        _add_stiffness(soil, size, matrix.values)
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
        for node in nodes:
            if int(node) not in self._known:
                at_top = self._whole(int(node)).T[self.top]
                self._known[int(node)] = np.where((self.top >= 0)[:, None], at_top, 0.0)
        if not len(nodes):
            return np.zeros((len(self.top), 0, 3))
        return np.stack([self._known[int(node)] for node in nodes], axis=1)

    def _whole(self, node: int) -> Array:
        """Displacements (3, n) of the system's dofs by unit forces on a node of the top."""
        group = int(self._group[node])
        nodes = np.flatnonzero(self._group == group)
        if group not in self._groups:
            self._groups[group] = self._kept(group, nodes)
        first = 3 * int(np.searchsorted(nodes, node))
        return self._groups[group][first : first + 3]

    def _kept(self, group: int, nodes: IntArray) -> Array:
        """Columns (3 nn, n) of a group: on disk, else in memory in the place of those that were found first."""
        columns = self._files.find(group, (3 * len(nodes), self._numbering.free))
        if columns is not None:
            return columns
        found = self._found(nodes)
        columns = self._files.keep(group, found)
        if columns is found:
            while self._in_memory and (len(self._in_memory) + 1) * found.nbytes > HELD:
                del self._groups[self._in_memory.popleft()]
            self._in_memory.append(group)
        return columns

    def _found(self, nodes: IntArray) -> Array:
        """Columns (3 nn, n) of nodes of the top, by a solve."""
        rows = self.top.reshape(-1, 3)[nodes].ravel()
        loads = np.zeros((self._numbering.free, len(rows)), order="F")
        free = np.flatnonzero(rows >= 0)
        loads[rows[free], free] = 1.0
        return np.ascontiguousarray(self._solved(loads).T)

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
        """Displacement (size,) of the whole field [m] by forces (3 np,) on the top's dofs [N]: a sum of columns."""
        forces = np.where(self.top >= 0, on_top, 0.0).reshape(-1, 3)
        found, out = np.zeros(self._numbering.free), np.zeros(self._numbering.size)
        for node in np.flatnonzero(forces.any(axis=1)):
            for force, column in zip(forces[node], self._whole(int(node)), strict=True):
                found += force * column
        moving = self._numbering.index >= 0
        out[moving] = found[self._numbering.index[moving]]
        return out


def _add_stiffness(soil: Soil, size: int, values: dict[str, Array]) -> None:
    soil.tangent(State.at_rest(0.0, size), Weights(0.0, 1.0, 0.0, 0.0), values)


def _in_rows(xy: Array) -> IntArray:
    """Order of points (n, 2): row by row along the longer side of their box, which is most often the riser's."""
    extent = np.ptp(xy, axis=0)
    along = int(extent.argmax())
    rows = np.round(xy[:, 1 - along] / (SAME_ROW * float(extent.max())))
    return np.lexsort((xy[:, along], rows))
