"""Quasi-static, small-strain, elastoplastic soil: the part "soil"."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.core.snapshot import SoilMesh, SoilSnapshot
from riser_soil.errors import MeshError, SceneError
from riser_soil.soil import kernels, mandel
from riser_soil.soil.element import Gradients, cell_gradients
from riser_soil.soil.field import SoilField, components
from riser_soil.soil.gathered import GatheredMesh, gather, gather_rows, top_of
from riser_soil.soil.grid import DistributedMesh, on_all_ranks
from riser_soil.soil.law import PLASTIC_STRAIN, Formula, StressUpdate
from riser_soil.soil.layered import LayeredWeight


class Soil:
    """Part "soil": internal force of the soil minus its weight, in group E (taken at the end of the step).

    law: makes the law's formula from depths (n,) below `level` [m] and initial stress. unit_weight: submerged [N/m3],
    or by layers. start: "geostatic": vertical stress the weight above, horizontal K0 times that, in equilibrium with
    the weight, so that displacement and strain count from there; "unstressed": no initial stress, the weight acts
    at once. MeshError if the level misses the mesh or a cell is inverted, SceneError if the initial stress is
    beyond the law's limit. Construction is collective.
    """

    name = "soil"
    active = True

    def __init__(
        self,
        grid: DistributedMesh,
        law: Callable[[Array, Array], Formula],
        *,
        level: float,
        unit_weight: float | LayeredWeight,
        K0: float = 1.0,
        start: Literal["geostatic", "unstressed"] = "geostatic",
    ) -> None:
        _check_level(grid, level)
        self.grid = grid
        self.field = SoilField(grid)
        self.mesh: GatheredMesh = gather(grid)
        self.surface = top_of(grid, self.mesh)
        self._cells = np.ascontiguousarray(grid.nodes.cells)
        self._gradients = on_all_ranks(
            grid.nodes.comm, lambda: cell_gradients(grid.family, grid.nodes.points, self._cells)
        )
        self._shape = self._gradients.weights.shape
        depth = np.maximum(level - self._gradients.points[..., 2], 0.0).ravel()
        weight = LayeredWeight((), (unit_weight,)) if isinstance(unit_weight, int | float) else unit_weight
        initial = _geostatic(weight.stress(depth), K0) if start == "geostatic" else np.zeros((depth.size, 6))
        self.law = law(depth, initial)
        self.traits = Traits("E", self.law.symmetric, roles=(Stateful,))
        self._check_start(initial, depth, K0)
        self._initial, self._found = initial, _at_rest(self.law, initial)
        self._last: _Answer | None = None
        self._unloads = False
        self._load = self._internal(initial) if start == "geostatic" else self._weight(weight.at(depth))

    def blocks(self) -> dict[str, MatrixBlock]:
        rows = self.field.offset + components(self._cells)
        return {"soil": MatrixBlock(rows, rows)}

    def residual(self, state: State, forces: Forces) -> None:
        self.field.own(forces.end)[:] += self._answer(state).force

    def unload(self) -> None:
        """From now on the tangent is that of unloading, which is elastic, as in small vibrations about rest."""
        self._unloads = True

    @cached_property
    def _stiffness(self) -> _Stiffness:
        """There from the first tangent on."""
        return _Stiffness.unknown(self._gradients)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        found = self._answer(state).found
        by_strain = mandel.stiffness(self.law.bulk, self.law.shear) if self._unloads else found.tangent
        g, moduli = self._gradients, by_strain.reshape(*self._shape, 6, 6)
        kernels.renew_stiffness(g.full, g.volume, g.weights, moduli, *self._stiffness)
        values["soil"] += self._stiffness.matrices

    def energy(self, state: State) -> Energy:
        """Strain energy by the law since the start, and potential of the unbalanced weight.

        With σ0 the initial stress and εe the elastic strain since then, potential = ∫ σ0:εe − load·u, which is −∫ σ0:εp
        for a geostatic start: nothing, as long as K0 = 1.
        """
        found = self._answer(state).found
        displacement = self.field.total + self.field.own(state.u)
        return Energy(
            strain=self._sum(found.stored),
            potential=self._integral(self._initial, found.elastic) - float(self._load @ displacement),
        )

    def work(self, before: State, after: State) -> Work:
        """Dissipation: the work ∫ σ:Δε of the stress at the end of the step less the change of what is stored.

        That is the law's own, ∫ σ:Δεp less what plastic strain stores, and the scheme's, ∫ ½ Δσ:Δεe: group E acts with
        its end value over the whole step, so the riser gives up that much more than the soil stores; counting it
        closes the energy balance exactly. The law's own is that of its backward Euler step: exact where the stress
        stays at its limit, nothing where no plastic strain grows; backstress and elements in parallel add half the
        product of the changes of their own stress and strain.
        """
        _, strain, found, _ = self._answer(after)
        stored, elastic = found.stored - self._found.stored, found.elastic - self._found.elastic
        taken = self._integral(found.stress, strain) - self._integral(self._initial, elastic)
        by_scheme = 0.5 * self._integral(found.stress - self._found.stress, elastic)
        return Work(dissipated=taken - self._sum(stored), by_scheme=by_scheme)

    def commit(self, state: State) -> None:
        """Soil that has not moved, and whose history has not changed, answers as before."""
        u, _, found, _ = self._answer(state)
        if u.any() or not np.array_equal(found.history, self._found.history):
            self._last = None
        self._found = found._replace(tangent=np.empty(0))

    def output_mesh(self) -> SoilMesh:
        """The whole mesh for output on rank 0; empty elsewhere."""
        return SoilMesh(self.mesh.points, self.mesh.cells[:, self.grid.family.vtk])

    def output_fields(self) -> SoilSnapshot:
        """Committed displacement and cell averages on rank 0, empty elsewhere (collective)."""
        owned = self.field.total[: 3 * self.grid.nodes.owned].reshape(-1, 3)
        return SoilSnapshot(
            gather_rows(self.grid, owned),
            *(gather_rows(self.grid, self._cell_mean(values)) for values in self._invariants()),
        )

    def stress_change(self) -> Array:
        """Equivalent stress of the change since the start, mean of each of this rank's cells [Pa]."""
        return self._cell_mean(mandel.von_mises(self._found.stress - self._initial))

    def _invariants(self) -> tuple[Array, Array, Array, Array]:
        """Of the committed stress, (n,) each, in the order of `SoilSnapshot`."""
        stress = self._found.stress
        strength_used = self.law.overstress(stress)
        return -mandel.mean(stress), mandel.von_mises(stress), strength_used, self._plastic_strain()

    def _answer(self, state: State) -> _Answer:
        """At a trial state: the last one, as long as neither the soil's increments nor its history change."""
        u = self.field.own(state.u)
        if self._last is None or not np.array_equal(u, self._last.u):
            self._last = self._new_answer(u.copy())
        return self._last

    def _new_answer(self, u: Array) -> _Answer:
        strain = self._strain(u)
        found = self.law.update(strain, self._found.history)
        return _Answer(u, strain, found, self._internal(found.stress) - self._load)

    def _plastic_strain(self) -> Array:
        """Equivalent plastic strain (n,), 0 for a law without plasticity."""
        history, columns = self._found.history, self.law.columns
        return history[:, columns.index(PLASTIC_STRAIN)] if PLASTIC_STRAIN in columns else np.zeros(len(history))

    def _strain(self, u: Array) -> Array:
        g, out = self._gradients, np.empty((*self._shape, 6))
        kernels.strain(g.full, g.volume, self._cells, u, out)
        return out.reshape(-1, 6)

    def _internal(self, stress: Array) -> Array:
        g, out = self._gradients, np.zeros(self.field.size)
        points = stress.reshape(*self._shape, 6)
        kernels.add_internal_force(g.full, g.volume, g.weights, self._cells, points, out)
        return out

    def _weight(self, unit_weight: Array) -> Array:
        """Nodal forces [N] of the submerged weight (n,) [N/m3], this rank's cells."""
        shape = self.grid.family.values(self.grid.family.quadrature()[0])
        down = -np.einsum("cq,cq,qa->ca", unit_weight.reshape(self._shape), self._gradients.weights, shape)
        out = np.zeros(self.field.size)
        out[2::3] = np.bincount(self._cells.ravel(), down.ravel(), minlength=self.field.size // 3)
        return out

    def _integral(self, a: Array, b: Array) -> float:
        return float(np.einsum("n,ni,ni->", self._gradients.weights.ravel(), a, b))

    def _sum(self, values: Array) -> float:
        return float(self._gradients.weights.ravel() @ values)

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
                "what the soil bears; bring K0 nearer to 1 or raise the strength"
            )

    def state(self) -> Saved:
        found = self._found
        return {"stress": found.stress, "history": found.history, "stored": found.stored, "elastic": found.elastic}

    def restore(self, saved: Saved) -> None:
        self._found, self._last = self._found._replace(**saved), None


class _Answer(NamedTuple):
    """Of the soil to its increments u: strain increment (n, 6), the law's answer, and residual [N]."""

    u: Array
    strain: Array
    found: StressUpdate
    force: Array


class _Stiffness(NamedTuple):
    """Cell matrices (nc, 3nn, 3nn) [N/m] and the moduli (nc, nq, 6, 6) [Pa] that they are of: most keep them."""

    moduli: Array
    matrices: Array

    @classmethod
    def unknown(cls, gradients: Gradients) -> _Stiffness:
        nc, nq, nn, _ = gradients.full.shape
        return cls(np.full((nc, nq, 6, 6), np.nan), np.zeros((nc, 3 * nn, 3 * nn)))


def _at_rest(law: Formula, initial: Array) -> StressUpdate:
    """Before the first step."""
    return StressUpdate(initial, np.empty(0), law.start(), np.zeros(len(initial)), np.zeros_like(initial))


def _check_level(grid: DistributedMesh, level: float) -> None:
    low, high = float(grid.low[2]), float(grid.high[2])
    slack = 1e-6 * (high - low)
    if not low + slack < level <= high + slack:
        raise MeshError(
            f"soil mesh: it spans z = {low:.4g} to {high:.4g} m, which misses seabed.level = {level:.4g} m; "
            "move the mesh or the level"
        )


def _geostatic(above: Array, K0: float) -> Array:
    """Stress (n, 6) under a weight above (n,) [Pa]."""
    vertical, none = -above, np.zeros_like(above)
    return np.column_stack((K0 * vertical, K0 * vertical, vertical, none, none, none))
