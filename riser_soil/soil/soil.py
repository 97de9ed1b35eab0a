"""The Soil part: a quasi-static, small-strain, elasto-plastic block of seabed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Block, Energy, Forces, State, Traits, Weights, Work
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.core.snapshot import SoilMesh, SoilSnapshot
from riser_soil.errors import MeshError, SceneError
from riser_soil.soil import kernels, mandel
from riser_soil.soil.element import cell_gradients
from riser_soil.soil.field import SoilField, components
from riser_soil.soil.gathered import Gathered, gather, gather_rows
from riser_soil.soil.grid import Grid, on_all_ranks
from riser_soil.soil.law import Law
from riser_soil.soil.surface import SoilTop


class Soil:
    """Part "soil": internal force of the soil minus its weight, in group E (taken at the end of the step).

    law: makes the constitutive law from depths (n,) below `level` [m]. unit_weight: submerged [N/m3].
    start: "geostatic": vertical stress −unit_weight·depth, horizontal K0 times that, in equilibrium with the
    weight, so that displacement and strain count from there; "unstressed": no initial stress, the weight acts
    at once. MeshError if the level misses the mesh or a cell is inverted, SceneError if the initial stress is
    beyond the law's limit. Construction is collective.
    """

    name = "soil"

    def __init__(
        self,
        grid: Grid,
        law: Callable[[Array], Law],
        *,
        level: float,
        unit_weight: float,
        K0: float = 1.0,
        start: Literal["geostatic", "unstressed"] = "geostatic",
    ) -> None:
        _check_level(grid, level)
        self.grid = grid
        self.field = SoilField(grid)
        self.mesh: Gathered = gather(grid)
        self.surface = SoilTop(grid, self.mesh)
        self._cells = np.ascontiguousarray(grid.nodes.cells)
        self._gradients = on_all_ranks(
            grid.nodes.comm, lambda: cell_gradients(grid.family, grid.nodes.points, self._cells)
        )
        self._shape = self._gradients.weights.shape
        depth = np.maximum(level - self._gradients.points[..., 2], 0.0).ravel()
        self.law = law(depth)
        self.traits = Traits("E", self.law.symmetric, roles=(Stateful,))
        initial = _geostatic(depth, unit_weight, K0) if start == "geostatic" else np.zeros((depth.size, 6))
        self._check_start(initial, depth, K0)
        self._initial, self._stress, self._history = initial, initial.copy(), self.law.start()
        self._load = self._internal(initial) if start == "geostatic" else self._weight(unit_weight)

    def blocks(self) -> dict[str, Block]:
        rows = self.field.offset + components(self._cells)
        return {"soil": Block(rows, rows)}

    def residual(self, state: State, forces: Forces) -> None:
        stress, _ = self.law.stress(self._strain(state), self._stress, self._history)
        self.field.own(forces.end)[:] += self._internal(stress) - self._load

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        moduli = self.law.tangent(self._strain(state), self._stress, self._history)
        g = self._gradients
        kernels.add_stiffness(g.full, g.volume, g.weights, moduli.reshape(*self._shape, 6, 6), values["soil"])

    def energy(self, state: State) -> Energy:
        """Strain energy of the stress change since the start, and potential of the unbalanced weight.

        With σ0 the initial stress and εe the elastic strain of σ − σ0: strain = ∫ ½ (σ−σ0):εe, potential =
        ∫ σ0:εe − load·u, which is −∫ σ0:εp for a geostatic start: nothing, as long as K0 = 1.
        """
        stress, _ = self.law.stress(self._strain(state), self._stress, self._history)
        change = stress - self._initial
        elastic = self.law.elastic_strain(change)
        displacement = self.field.total + self.field.own(state.u)
        return Energy(
            strain=0.5 * self._integral(change, elastic),
            potential=self._integral(self._initial, elastic) - float(self._load @ displacement),
        )

    def work(self, before: State, after: State) -> Work:
        """Dissipation ∫ (σ:Δεp + ½ Δσ:C⁻¹:Δσ) ≥ 0, σ at the end of the step.

        The second term is the scheme's own: group E acts with its end value over the whole step, so the riser
        gives up that much more than the soil stores; counting it closes the energy balance exactly.
        """
        strain = self._strain(after)
        stress, _ = self.law.stress(strain, self._stress, self._history)
        change = stress - self._stress
        elastic = self.law.elastic_strain(change)
        plastic = self._integral(stress, strain - elastic)
        return Work(dissipated=plastic + 0.5 * self._integral(change, elastic))

    def commit(self, state: State) -> None:
        self._stress, self._history = self.law.stress(self._strain(state), self._stress, self._history)

    def output_mesh(self) -> SoilMesh:
        """The whole mesh for output on rank 0; empty elsewhere."""
        return SoilMesh(self.mesh.points, self.mesh.cells[:, self.grid.family.vtk])

    def output_fields(self) -> SoilSnapshot:
        """Committed displacement and cell averages on rank 0, empty elsewhere (collective)."""
        owned = self.field.total[: 3 * self.grid.nodes.owned].reshape(-1, 3)
        return SoilSnapshot(
            gather_rows(self.grid, owned),
            gather_rows(self.grid, self._cell_mean(mandel.von_mises(self._stress))),
            gather_rows(self.grid, self._cell_mean(self.law.plastic_strain(self._history))),
        )

    def _strain(self, state: State) -> Array:
        """Strain increment (n, 6) of a trial state."""
        g, out = self._gradients, np.empty((*self._shape, 6))
        kernels.strain(g.full, g.volume, self._cells, self.field.own(state.u), out)
        return out.reshape(-1, 6)

    def _internal(self, stress: Array) -> Array:
        g, out = self._gradients, np.zeros(self.field.size)
        points = stress.reshape(*self._shape, 6)
        kernels.add_internal_force(g.full, g.volume, g.weights, self._cells, points, out)
        return out

    def _weight(self, unit_weight: float) -> Array:
        """Nodal forces [N] of the submerged weight, this rank's cells."""
        shape = self.grid.family.values(self.grid.family.quadrature()[0])
        down = -unit_weight * np.einsum("cq,qa->ca", self._gradients.weights, shape)
        out = np.zeros(self.field.size)
        out[2::3] = np.bincount(self._cells.ravel(), down.ravel(), minlength=self.field.size // 3)
        return out

    def _integral(self, a: Array, b: Array) -> float:
        return float(np.einsum("n,ni,ni->", self._gradients.weights.ravel(), a, b))

    def _cell_mean(self, values: Array) -> Array:
        w = self._gradients.weights
        result: Array = np.einsum("cq,cq->c", w, values.reshape(self._shape)) / w.sum(axis=1)
        return result

    def _check_start(self, stress: Array, depth: Array, K0: float) -> None:
        over = self.law.overstress(stress)
        worst = int(np.argmax(over)) if over.size else -1
        mine = (float(over[worst]), float(depth[worst])) if over.size else (0.0, 0.0)
        ratio, at = max(self.grid.nodes.comm.allgather(mine))
        if ratio > 1.0:
            raise SceneError(
                f"soil.K0 = {K0}: at depth {at:.3g} m the geostatic stress is {ratio:.3g} times "
                "what the soil bears; bring K0 nearer to 1 or raise su"
            )

    def state(self) -> Saved:
        return {"stress": self._stress, "history": self._history}

    def restore(self, saved: Saved) -> None:
        self._stress, self._history = saved["stress"], saved["history"]


def _check_level(grid: Grid, level: float) -> None:
    low, high = float(grid.low[2]), float(grid.high[2])
    slack = 1e-6 * (high - low)
    if not low + slack < level <= high + slack:
        raise MeshError(
            f"soil mesh: it spans z = {low:.4g} to {high:.4g} m, which misses seabed.level = {level:.4g} m; "
            "move the mesh or the level"
        )


def _geostatic(depth: Array, unit_weight: float, K0: float) -> Array:
    vertical = -unit_weight * depth
    none = np.zeros_like(depth)
    return np.column_stack((K0 * vertical, K0 * vertical, vertical, none, none, none))
