"""Inertia of the soil, and its boundary where waves leave: the parts "soil inertia" and "soil boundary".

Soil and its pore water move as one: undrained. The mass is consistent, of one density in a cell. Outside the block the
soil goes on; waves that arrive square to its sides or bottom are not thrown back by dashpots of the impedance rho c_p
along the normal and rho c_s along the side (J. Lysmer & R. L. Kuhlemeyer, Finite dynamic model for infinite media,
Journal of the Engineering Mechanics Division 95, 1969), with the speeds of waves of the elastic moduli. While they act
sides and bottom are not fixed: their reactions at rest go on acting as constant forces.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import basix
import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.core.roles import Starting
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.soil.families import Family
from riser_soil.soil.field import components
from riser_soil.soil.grid import DistributedMesh
from riser_soil.soil.soil import Soil


@dataclass(frozen=True, eq=False)
class CellMatrices:
    """Matrices (m, n, n) of cells, and the local dofs (m, n) of the soil that they act on."""

    matrices: Array
    dofs: IntArray

    def times(self, x: Array) -> Array:
        """Product (size,) with a field (size,)."""
        parts = np.einsum("cij,cj->ci", self.matrices, x[self.dofs])
        return np.asarray(np.bincount(self.dofs.ravel(), parts.ravel(), minlength=x.size), dtype=float)

    def product(self, x: Array, y: Array) -> float:
        """x'My of two fields (size,)."""
        return float(x @ self.times(y))


class SoilInertia:
    """Part "soil inertia": mass times acceleration, in group I. density (nc,): of this rank's cells [kg/m3]."""

    name = "soil inertia"
    active = True
    traits = Traits("I", symmetric=True)

    def __init__(self, soil: Soil, density: Array) -> None:
        self._soil = soil
        dofs = components(soil.cells.nodes, soil.grid.family.axes)
        self.mass = CellMatrices(soil.cells.mass(density), dofs)

    def blocks(self) -> dict[str, MatrixBlock]:
        return self._soil.blocks()

    def residual(self, state: State, forces: Forces) -> None:
        field = self._soil.field
        field.own(forces.inertia)[:] += self.mass.times(field.own(state.a))

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        values["soil"] += weights.inertia * weights.shift_a * self.mass.matrices

    def energy(self, state: State) -> Energy:
        v = self._soil.field.own(state.v)
        return Energy(kinetic=0.5 * self.mass.product(v, v))

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        """The mass is the same wherever the soil moves."""


class SoilBoundary:
    """Part "soil boundary": dashpots on sides and bottom, and their reactions at rest, in group F.

    density (nc,): of this rank's cells [kg/m3]; their moduli are the law's elastic ones.
    """

    name = "soil boundary"
    active = True
    traits = Traits("F", symmetric=True, roles=(Stateful, Starting))

    def __init__(self, soil: Soil, density: Array) -> None:
        self._soil, grid = soil, soil.grid
        facets = outer_facets(grid, soil.cells.nodes)
        bulk, shear = (soil.cells.mean(modulus)[facets[:, 0]] for modulus in (soil.law.bulk, soil.law.shear))
        rho = density[facets[:, 0]]
        impedances = np.sqrt(rho[:, None] * np.stack([bulk + 4.0 / 3.0 * shear, shear], axis=1))
        dofs = components(soil.cells.nodes[facets[:, 0]], grid.family.axes)
        self.damping = CellMatrices(soil.cells.dashpots(facets, impedances), dofs)
        self._boundary_dofs = soil.field.boundary_dofs
        self._reaction, self._work_done = np.zeros(soil.field.size), 0.0  # of the fixed boundary

    def blocks(self) -> dict[str, MatrixBlock]:
        rows = self._soil.field.offset + self.damping.dofs
        return {self.name: MatrixBlock(rows, rows)}

    def begin_stage(self, state: State) -> None:
        """From now on the boundary's present reactions act on it as constant forces."""
        forces = Forces.zeros(len(state.u))
        self._soil.residual(State.at_rest(state.t, len(state.u)), forces)
        self._reaction = np.where(self._boundary_dofs, self._soil.field.own(forces.force), 0.0)
        self._work_done = 0.0

    def residual(self, state: State, forces: Forces) -> None:
        field = self._soil.field
        field.own(forces.force)[:] += self.damping.times(field.own(state.v)) - self._reaction

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        values[self.name] += weights.force * weights.shift_v * self.damping.matrices

    def energy(self, state: State) -> Energy:
        """Potential of the constant boundary forces."""
        return Energy(potential=-self._work_done - float(self._reaction @ self._soil.field.own(state.u)))

    def work(self, before: State, after: State) -> Work:
        """Work of the dashpots: their mean force over the step."""
        own = self._soil.field.own
        return Work(dissipated=0.5 * self.damping.product(own(after.u), own(before.v) + own(after.v)))

    def commit(self, state: State) -> None:
        self._work_done += float(self._reaction @ self._soil.field.own(state.u))

    def state(self) -> Saved:
        return {"held": self._reaction.copy(), "done": np.array(self._work_done)}

    def restore(self, saved: Saved) -> None:
        self._reaction, self._work_done = saved["held"].copy(), float(saved["done"])


def outer_facets(grid: DistributedMesh, nodes: IntArray, boundary: str = "") -> IntArray:
    """Cells and their local facets (nf, 2) on the "sides" or the "bottom" of the soil, or on both."""
    family = grid.family
    on_plane = planes_of(grid, boundary)[nodes[:, : family.vertices]]  # (nc, nv, planes)
    facets_of_cells = [
        np.stack([cells, np.full(len(cells), number)], axis=1)
        for number, facet in enumerate(facets_of(family))
        for cells in [np.flatnonzero(on_plane[:, facet].all(axis=1).any(axis=1))]
    ]
    return np.concatenate(facets_of_cells).astype(np.int64)


def facets_of(family: Family) -> list[list[int]]:
    """Vertices of each facet, in the order of basix and FFCx."""
    topology: Any = basix.topology(family.cell)
    return [list(facet) for facet in topology[len(family.axes) - 1]]


def planes_of(grid: DistributedMesh, boundary: str = "") -> BoolArray:
    """Which nodes (n, planes) lie on each of the planes that end the soil, sides along its cells' axes and the bottom;
    a mirror ends nothing. boundary: as of `outer_facets`.
    """
    points, near = grid.nodes.points, 1e-6 * float(np.max(grid.high - grid.low))
    sides = [(axis, end[axis]) for axis in grid.family.axes if axis < 2 for end in (grid.low, grid.high)]
    bottom = [(2, grid.low[2])]
    planes = {"sides": sides, "bottom": bottom}.get(boundary, [*sides, *bottom])
    return np.stack([np.abs(points[:, axis] - at) < near for axis, at in planes], axis=1)
