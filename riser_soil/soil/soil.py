"""Quasi-static, elastoplastic soil at small or large strain: the part "soil"."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.communicator import raised_on_all_ranks
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.core.roles import Limited, UpdatedLagrangian, Yielding
from riser_soil.core.saved_state import Saved, Stateful, within
from riser_soil.core.snapshot import SoilMesh, SoilSnapshot
from riser_soil.errors import MeshError, SceneError
from riser_soil.soil import kernels, mandel
from riser_soil.soil.families import FOLDS, skewness
from riser_soil.soil.field import GatheredMesh, SoilField, components, gather, gather_rows, top_of
from riser_soil.soil.grid import DistributedMesh
from riser_soil.soil.large_strain import carried_depths, carried_rows, moved_on
from riser_soil.soil.law import PLASTIC_STRAIN, STRESS, Formula, StressUpdate
from riser_soil.soil.layered import LayeredWeight
from riser_soil.soil.requested_fields import NO_FIELDS, RequestedFields
from riser_soil.soil.slices import slabs, top_of_slices
from riser_soil.soil.soil_cells import SoilCells

ZERO_DEPTH = 1e-9  # depths and movements below this share of the block's height count as zero


class Soil:
    """Part "soil": internal force of the soil minus its weight, in group E (taken at the end of the step); in group F
    for soil with inertia, see `inertia`.

    Each step is linear about a geometry: that at first, or for soil at large strain (`moves`) the one on which it is
    placed last, see `place` and `large_strain`. Strength belongs to the material and moves along.

    law: makes the law's formula from depths (n,) below `level` [m] and initial stress. unit_weight: submerged [N/m3],
    or by layers. start: "geostatic": vertical stress the weight above, horizontal K0 times that, in equilibrium with
    the weight, so that displacement and strain count from there; "unstressed": no initial stress, the weight acts
    at once. fields: that the output has beyond those of all soil. MeshError if the level misses the mesh or a cell is
    inverted, SceneError if the initial stress is beyond the law's limit. Construction is collective.
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
        moves: bool = False,
        inertia: bool = False,
        fields: RequestedFields = NO_FIELDS,
    ) -> None:
        _check_level(grid, level)
        self.grid, self.moves, self._has_inertia = grid, moves, inertia
        self.field = SoilField(grid)
        self.mesh: GatheredMesh = gather(grid)
        self.surface = (top_of_slices if grid.family.plane else top_of)(grid, self.mesh, moves)
        self.cells = SoilCells(grid)
        weight = LayeredWeight((), (unit_weight,)) if isinstance(unit_weight, int | float) else unit_weight
        self._ground = _Ground(fields.with_histories(law), weight, K0, start == "geostatic")
        depth, self._zero_depth = level - grid.nodes.points[:, 2], ZERO_DEPTH * float(grid.high[2] - grid.low[2])
        self._depth = np.where(depth > self._zero_depth, depth, 0.0)  # of the nodes, before anything moved
        with raised_on_all_ranks(grid.nodes.comm):
            self._initial, self._unit_weight, self.law = self._material()
        roles = Limited, Stateful, UpdatedLagrangian, Yielding
        self.traits = Traits("F" if inertia else "E", self.law.symmetric, roles=roles)
        self._requested = fields.of_law(self.law.columns)
        _check_start(grid, self.law, self._initial, self.cells.at_points(self._depth), K0)
        self._law_state = _at_rest(self.law, self._initial)
        self._in_balance = self._law_state.stress  # of the last step, before the law is evaluated again for moved cells
        self._last: _Response | None = None
        self._elastic_share = 0.0
        self._volumes: Array = self.cells.volumes.flatten()
        self._load = self._internal(self._initial) if start == "geostatic" else self._weight()
        self._initial_reaction = self._load - self._weight()  # at sides and bottom, and of soil that is dug out
        self._mesh_at = self.cells.made_at.copy() if moves else np.empty(0)  # (nc, nn, 3): nodes of cells when made
        self._stored = self._lifted = 0.0
        self._cells_ahead = False  # whether the cells lie elsewhere than accepted, see `place`

    def _material(self) -> tuple[Array, Array, Formula]:
        """Initial stress, unit weight and law at the points, of the depths that their material had at first."""
        depth = self.cells.at_points(self._depth)
        initial = self._ground.stress(depth)
        return initial, self._ground.weight.at(depth), self._ground.law(depth, initial)

    def _renew_material(self) -> None:
        self._initial, self._unit_weight, self.law = self._material()

    def blocks(self) -> dict[str, MatrixBlock]:
        rows = self.field.offset + components(self.cells.nodes, self.grid.family.axes)
        return {"soil": MatrixBlock(rows, rows)}

    def residual(self, state: State, forces: Forces) -> None:
        self.field.own(forces.force if self._has_inertia else forces.end)[:] += self._response(state).force

    def fix_boundary(self, fixed: bool) -> None:
        """Fix bottom and sides as by default, or let them move; in systems that are made from then on."""
        self.field.fix_boundary(fixed)
        self.surface.prescribed = self.grid.fixed_directions(self.surface.points, fixed).ravel()

    def mean_by_depth(self, of_depth: Callable[[Array], Array]) -> Array:
        """Means (nc,) in the cells of values by depth (n,) [m]."""
        return self.cells.mean(of_depth(self.cells.at_points(self._depth)))

    def mix_elastic(self, share: float) -> None:
        """Give the tangent a share of the elastic one; with 1 it is that of unloading, as in small
        vibrations about rest.
        """
        self._elastic_share = share

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        K = self.cells.stiffness(self._moduli(self._response(state).update.tangent))
        values["soil"] += weights.force * K if self._has_inertia else K

    def _moduli(self, consistent: Array) -> Array:
        """The law's (n, 6, 6) [Pa], with the elastic ones' share."""
        if self._elastic_share == 0.0:
            return consistent
        out = np.empty_like(consistent)
        kernels.write_moduli(self.law.bulk, self.law.shear, consistent, self._elastic_share, out)
        return out

    def energy(self, state: State) -> Energy:
        """Strain energy by the law since the start, and potential of the unbalanced weight.

        With σ0 the initial stress and εe the elastic strain since then, potential = ∫ σ0:εe − load·u, which is −∫ σ0:εp
        for a geostatic start: nothing, as long as K0 = 1.
        """
        u, _, _, update, _ = self._response(state)
        started = float(np.einsum("n,ni,ni->", self._volumes, self._initial, update.elastic))
        return Energy(
            strain=float(self._volumes @ update.stored), potential=started + self._lifted - float(self._load @ u)
        )

    def work(self, before: State, after: State) -> Work:
        """Dissipation: the work ∫ σ:Δε of the stress at the end of the step less the change of what is stored.

        That is the law's own, ∫ σ:Δεp less what plastic strain stores, and the scheme's, ∫ ½ Δσ:Δεe: group E acts with
        its end value over the whole step, so the riser gives up that much more than the soil stores; counting it
        closes the energy balance exactly. The law's own is that of its backward Euler step: exact where the stress
        stays at its limit, nothing where no plastic strain grows; backstress and elements in parallel add half the
        product of the changes of their own stress and strain. With inertia the mean stress of the step counts, and
        nothing is the scheme's.
        """
        _, _, strain, update, _ = self._response(after)
        if self._has_inertia:
            absorbed = self.cells.integral(0.5 * (update.stress + self._law_state.stress), strain)
            return Work(dissipated=absorbed - self._stores(update) + self._stored)
        absorbed = self.cells.integral(update.stress, strain)
        change = update.stress - self._law_state.stress, update.elastic - self._law_state.elastic
        by_scheme = 0.5 * self.cells.integral(*change)
        return Work(dissipated=absorbed - self._stores(update) + self._stored, by_scheme=by_scheme)

    def _stores(self, update: StressUpdate) -> float:
        """Energy [J] since the start, what the initial stress has done included."""
        return float(self._volumes @ (update.stored + mandel.product(self._initial, update.elastic)))

    def commit(self, state: State) -> None:
        """Soil that has not moved, and whose history has not changed, answers as before."""
        u, dt, _, update, _ = self._response(state)
        self._stored, self._lifted = self._stores(update), self._lifted - float(self._load @ u)
        self._in_balance = update.stress
        if u.any() and self.moves:
            update = self._move(u, dt)
        if u.any() or not np.array_equal(update.history, self._law_state.history):
            self._last = None
        self._law_state = update._replace(tangent=np.empty(0))

    def _move(self, u: Array, dt: float) -> StressUpdate:
        """Let the nodes move by u within dt [s]; the law's response to that."""
        self._cells_ahead = False
        update = moved_on(self.cells, self.points, u, self.law, self._law_state.history, dt)
        self.cells.renew(self.points + u.reshape(-1, 3))
        self._load = self._initial_reaction + self._weight()
        return update

    def place(self, state: State) -> None:
        """Take gradients, weight and areas of contact at large strain where a state of the step has the nodes; where
        they are accepted, if a cell would fold there. Collective.
        """
        if self.inadmissible(state):
            state = State.at_rest(state.t, state.u.size)
        self.surface.place(state)  # on the first rank, which may have no cells that move
        u = self.field.own(state.u)
        if self._cells_ahead or u.any():
            self._cells_ahead = bool(u.any())
            self.cells.renew(self.points + u.reshape(-1, 3))
            self._load, self._last = self._initial_reaction + self._weight(), None

    def lag(self, state: State) -> float:
        """Largest change of a facet's area from where the surface is placed to a state, as a share of it."""
        return self.surface.lag(state)

    @property
    def points(self) -> Array:
        """Positions of this rank's nodes (n, 3) [m]."""
        return np.asarray(self.grid.nodes.points + self.field.total.reshape(-1, 3))

    def gathered_points(self) -> Array:
        """Positions of all nodes (n, 3) [m], on rank 0; collective."""
        return self.mesh.unfolding.points(gather_rows(self.grid, self.points[: self.grid.nodes.owned]))

    @property
    def worn(self) -> Array:
        """Largest strain (nc,) of each of this rank's cells since they were made."""
        strain = np.empty(len(self.cells.nodes))
        kernels.write_largest_strains(self._mesh_at, self.points, self.cells.nodes, strain)
        return strain

    def gathered_wear(self, worn: Array) -> Array:
        """Largest of the ranks' values (nc,) for the cells around each node (n,), on rank 0; collective."""
        gathered = gather_rows(self.grid, self.grid.nodes.number[self.cells.nodes])
        out = np.zeros(len(self.mesh.points))
        np.maximum.at(out, gathered, gather_rows(self.grid, worn)[:, None])
        return out

    def inadmissible(self, state: State) -> str:
        """Message about a cell that a step would fold, by its place as the step begins, "" for none; collective."""
        moved = self.points + self.field.own(state.u).reshape(-1, 3)
        skew = skewness(self.grid.family, moved, self.cells.nodes) if self.moves else np.ones(1)
        worst = int(skew.argmin()) if skew.size else 0
        place = self.points[self.cells.nodes[worst]].mean(axis=0).tolist() if skew.size else []
        mine = float(skew.min(initial=1.0)), place
        least, at = min(self.grid.nodes.comm.allgather(mine))
        if least > FOLDS:
            return ""
        return "a cell of the soil at ({:.4g}, {:.4g}, {:.4g}) m would fold".format(*at)

    def take_mesh(self, points: Array, made: BoolArray | None = None) -> None:
        """Go on with all nodes at points (n, 3) [m]; made (n,): those of new cells, all by default. Collective."""
        before, number = self.points, self.grid.nodes.number
        after, top = points[number], self.surface.global_index[::3] // 3
        self.field.total = (after - self.grid.nodes.points).ravel()
        self._move_to(before, after, np.ones(len(number), dtype=bool) if made is None else made[number])
        if len(top):
            moved = points[top] - self.mesh.points[top]
            self.surface.move_to(self.surface.sign.reshape(-1, 3) * moved)
        self._stored = self._stores(self._law_state)

    def _move_to(self, before: Array, after: Array, made: BoolArray) -> None:
        """made (n,): this rank's nodes of new cells."""
        new = made[self.cells.nodes].any(axis=1)
        here, new_points = self.cells.at_points(before), np.repeat(new, self.cells.shape[1])
        there = self.cells.at_points(after)[new_points]
        self._depth = carried_depths(self.grid, self.cells, self._depth, before, after, self._zero_depth)
        history = self._history_beyond_weight(before)
        history[new_points] = carried_rows(self.grid, here, there, history, self.law.columns)
        self._mesh_at[new] = after[self.cells.nodes[new]]
        self.cells.make_anew(np.flatnonzero(new), self._mesh_at[new])
        self._volumes[new_points] = self.cells.volumes.ravel()[new_points]
        self._renew_material()
        self._load, self._last = self._initial_reaction + self._weight(), None
        update = self.law.update(np.zeros((len(history), 6)), self._balanced(history), dt=0.0)
        for after_move, before_move in zip(update, self._law_state._replace(tangent=update.tangent), strict=True):
            after_move[~new_points] = before_move[~new_points]
        self._law_state = update._replace(tangent=np.empty(0))

    def _history_beyond_weight(self, points: Array) -> Array:
        """The history with the stress beyond what the weight makes of it by height, nodes at points (n, 3)."""
        history = self._law_state.history.copy()
        self._stress_in(history)[:] -= self._by_height(points)
        return history

    def _balanced(self, history: Array) -> Array:
        """A history of stress beyond the weight's with all of it: its mean beyond is one for all points of a cell."""
        stress = self._stress_in(history)
        beyond = mandel.mean(stress)
        stress += (np.repeat(self.cells.mean(beyond), self.cells.shape[1]) - beyond)[:, None] * mandel.UNIT
        stress += self._by_height(self.points)
        return history

    def _stress_in(self, history: Array) -> Array:
        first = self.law.columns.index(STRESS[0])
        return history[:, first : first + 6]

    def _by_height(self, points: Array) -> Array:
        """Stress by the weight (n, 6) at heights counted from z = 0, nodes at points (n, 3)."""
        return (self._unit_weight * self.cells.at_points(points)[:, 2])[:, None] * self._ground.ratios

    def output_mesh(self) -> SoilMesh:
        """The whole mesh for output on rank 0; empty elsewhere."""
        if self.grid.family.plane:
            return slabs(self.grid, self.mesh)
        return SoilMesh(self.mesh.points, self.mesh.cells[:, self.grid.family.vtk])

    def output_fields(self) -> SoilSnapshot:
        """Committed displacement and cell averages on rank 0, empty elsewhere (collective)."""
        owned = self.field.total[: 3 * self.grid.nodes.owned].reshape(-1, 3)
        all_of = self.mesh.unfolding
        moved = all_of.vectors(gather_rows(self.grid, owned))
        mean, mises, used, plastic = (self._mean_of_all(values) for values in self._invariants())
        requested = self._requested.at_points(self._in_balance, self._law_state)
        displacement = np.concatenate([moved, moved]) if self.grid.family.plane else moved
        of_cells = {name: self._mean_of_all(values) for name, values in requested}
        return SoilSnapshot(displacement, mean, mises, used, plastic, of_cells)

    def _mean_of_all(self, values: Array) -> Array:
        """Means (nc,), or (nc, 9) of tensors (n, 6), of all cells; collective."""
        if values.ndim == 1:
            return self.mesh.unfolding.of_cells(gather_rows(self.grid, self.cells.mean(values)))
        means = np.column_stack([self.cells.mean(component) for component in mandel.components(values).T])
        return self.mesh.unfolding.tensors(gather_rows(self.grid, means))

    def stress_change(self) -> Array:
        """Equivalent stress of the change since the start, mean of each of this rank's cells [Pa]."""
        return self.cells.mean(mandel.von_mises(self._law_state.stress - self._initial))

    def _invariants(self) -> tuple[Array, Array, Array, Array]:
        """Invariants (n,) of the stress in balance, each in the order of `SoilSnapshot`.

        The stress that the law gives to cells that moved is out of balance by the square of the step over the cell, in
        the mean stress of clay by many times its strength.
        """
        stress = self._in_balance
        strength_used = self.law.overstress(stress)
        return -mandel.mean(stress), mandel.von_mises(stress), strength_used, self._plastic_strain()

    def _response(self, state: State) -> _Response:
        """The response at a trial state: the last one, as long as neither the soil's increments, their time, where it
        counts, nor its history change.
        """
        u, dt = self.field.own(state.u), state.dt if self.law.by_rate else math.inf
        if self._last is None or dt != self._last.dt or not np.array_equal(u, self._last.u):
            self._last = self._new_response(u.copy(), dt)
        return self._last

    def _new_response(self, u: Array, dt: float) -> _Response:
        strain = self.cells.strain(u)
        update = self.law.update(strain, self._law_state.history, dt)
        return _Response(u, dt, strain, update, self._internal(update.stress) - self._load)

    def _plastic_strain(self) -> Array:
        """Equivalent plastic strain (n,), 0 for a law without plasticity."""
        history, columns = self._law_state.history, self.law.columns
        return history[:, columns.index(PLASTIC_STRAIN)] if PLASTIC_STRAIN in columns else np.zeros(len(history))

    def _internal(self, stress: Array) -> Array:
        return self.cells.internal_force(stress, self.field.size)

    def _weight(self) -> Array:
        """Nodal forces [N] of the submerged weight, this rank's cells."""
        return self.cells.weight(self._unit_weight, self.field.size)

    def state(self) -> Saved:
        update, energy = self._law_state, np.array([self._stored, self._lifted])
        of_law = {"stress": update.stress, "history": update.history, "stored": update.stored}
        of_law["elastic"] = update.elastic
        return {"law/" + name: values for name, values in of_law.items()} | {"energy": energy} | self._moved

    @property
    def _moved(self) -> Saved:
        """Geometry of the gradients, and the last mesh, where cells move."""
        if not self.moves:
            return {}
        arrays = {"in_balance": self._in_balance, "made_at": self.cells.made_at, "mesh_at": self._mesh_at}
        arrays |= {"depth": self._depth, "volumes": self._volumes}
        return {name: values.copy() for name, values in arrays.items()}

    def restore(self, saved: Saved) -> None:
        self._law_state, self._last = self._law_state._replace(**within(saved, "law")), None
        self._in_balance = self._law_state.stress
        self._stored, self._lifted = (float(joules) for joules in saved["energy"])
        if self.moves:
            self.cells.make_anew(np.arange(len(self.cells.nodes)), saved["made_at"])
            self._depth, self._volumes = saved["depth"].copy(), saved["volumes"].copy()
            self._in_balance = saved["in_balance"].copy()
            self._mesh_at = saved["mesh_at"].copy()
            self._renew_material()
            self._load = self._initial_reaction + self._weight()


class _Response(NamedTuple):
    """Response of the soil to its increments u within dt [s]: strain increment (n, 6), that of the law, and residual
    [N].
    """

    u: Array
    dt: float
    strain: Array
    update: StressUpdate
    force: Array


@dataclass(frozen=True, eq=False)
class _Ground:
    """What soil is made of, by depth: law, submerged unit weight and initial stress, if any."""

    law: Callable[[Array, Array], Formula]
    weight: LayeredWeight
    K0: float
    geostatic: bool

    @property
    def ratios(self) -> Array:
        """Ratios (6,) of the initial stress to its vertical component."""
        return np.array([self.K0, self.K0, 1.0, 0.0, 0.0, 0.0]) * float(self.geostatic)

    def stress(self, depth: Array) -> Array:
        """Initial stress (n, 6) at depths (n,) [Pa]."""
        return -self.weight.stress(depth)[:, None] * self.ratios


def _at_rest(law: Formula, initial: Array) -> StressUpdate:
    """Before the first step."""
    return StressUpdate(initial, np.empty(0), law.start(), np.zeros(len(initial)), np.zeros_like(initial))


def _check_start(grid: DistributedMesh, law: Formula, stress: Array, depth: Array, K0: float) -> None:
    over = law.overstress(stress)
    worst = int(np.argmax(over)) if over.size else -1
    mine = (float(over[worst]), float(depth[worst])) if over.size else (0.0, 0.0)
    ratio, at = max(grid.nodes.comm.allgather(mine))
    if ratio > 1.0:
        raise SceneError(
            f"soil.K0 = {K0}: at depth {at:.3g} m the geostatic stress is {ratio:.3g} times "
            "what the soil bears; bring K0 nearer to 1 or raise the strength"
        )


def _check_level(grid: DistributedMesh, level: float) -> None:
    low, high = float(grid.low[2]), float(grid.high[2])
    slack = 1e-6 * (high - low)
    if not low + slack < level <= high + slack:
        raise MeshError(
            f"soil mesh: it spans z = {low:.4g} to {high:.4g} m, which misses seabed.level = {level:.4g} m; "
            "move the mesh or the level"
        )
