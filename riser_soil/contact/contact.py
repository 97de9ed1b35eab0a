"""The contact part: couples the riser's nodes to what lies under them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.arrays import Array, BoolArray
from riser_soil.contact.encounter import (
    PLANE,
    SOIL,
    Encounter,
    Grounds,
    RiserNodes,
    Touching,
    add_blocks,
    add_shares,
)
from riser_soil.contact.ground import ASPECT, ContactPoints, Soil, SoilSurface
from riser_soil.contact.law import Penalty
from riser_soil.contact.patch import Patch, around, nothing
from riser_soil.contact.touchdown import touchdown
from riser_soil.part import Block, Energy, Forces, State, Weights, Work
from riser_soil.seabed.plane import Plane

FOOTPRINT = 0.25  # default half width of the footprint over the outer radius


@dataclass(frozen=True)
class Reach:
    """Candidates: nodes up to `above` [m] over the ground, facets up to `around` [m] beside a node."""

    above: float
    around: float = 0.0


class Contact:
    """Part "contact": frictionless penalty contact between riser nodes and the ground below them, in group E.

    Node i carries f(δ_i) times its tributary length. The ground is the soil's surface where the node is over
    it, else the plane, if there is one. All forces derive from the potential Σ ψ(δ_i)·length_i: the tangent
    is symmetric, and the forces on riser and soil sum to zero in all directions.

    On soil each node stands on four points around it, ±footprint [m] across the riser and a golden ratio more
    along it; on one where footprint = 0. A node presses a kink into the surface where facets meet below it;
    there the slope, and with it the horizontal force, jumps from side to side, and Newton finds no balance.
    Four points straddle the kink. The default is an eighth of the outer diameter, half the chord by which a
    pipe touches once it has sunk in by 3 % of its radius.

    radius (nn,): distance [m] from the axis to the line that touches, 0 for the axis itself. penalty: law on
    the soil; a plane brings its own numbers. along (2,): horizontal unit vector of the riser on the ground; by
    default its first axis. reach: by default 1 % of the riser's length above the ground and half a facet
    around a node. active: whether this rank, which then holds the surface, evaluates contact.
    outgrown: a point has touched that had no place in the tangent's pattern and was left out there, not in
    the residual.
    """

    name = "contact"
    symmetric = True

    def __init__(
        self,
        riser: RiserNodes,
        radius: Array,
        *,
        plane: Plane | None = None,
        surface: SoilSurface | None = None,
        penalty: Penalty | None = None,
        footprint: float | None = None,
        along: Array | None = None,
        reach: Reach | None = None,
        active: bool = True,
    ) -> None:
        if surface is not None and penalty is None:
            raise ValueError("contact with a soil surface needs its penalty law")
        self.active, self.outgrown = active, False
        self._riser, self._has_plane = riser, plane is not None
        self._soil = Soil(surface) if surface is not None and active else None
        self._reach = reach or _default_reach(riser, self._soil)
        self._footprint = 0.0
        if self._soil is not None:
            self._footprint = FOOTPRINT * float(radius.mean()) if footprint is None else footprint
        axis = riser.basis[:2, 0] if along is None else along
        points = ContactPoints.of_nodes(riser.tributary_length, self._footprint, axis)
        level = plane.level if plane is not None else -np.inf
        laws = _laws(plane, self._soil, penalty)
        self._rounding = max((law.smoothing for law in laws.values()), default=0.0)
        self._grounds = Grounds(riser, radius, points, laws, level, self._soil, self._reach.above)
        self._patch: Patch | None = None
        self._missed = nothing(0)
        self._met: Encounter | None = None

    def meet(self, state: State) -> Encounter:
        """Riser and ground at a state; kept for the state asked last, whose arrays must not change then."""
        if self._met is None or self._met.state is not state:
            self._met = self._grounds.meet(state)
        return self._met

    def blocks(self) -> dict[str, Block]:
        """On a plane the translations of candidate nodes; on soil, pair by pair, with the facet's dofs."""
        if not self.active:
            return {}
        patch, translations = self._present_patch(), self._riser.translation_dofs
        rows = {}
        if self._has_plane:
            rows[PLANE] = translations[patch.nodes]
        if self._soil is not None:
            rows[SOIL] = np.hstack([translations[patch.pair_nodes], self._soil.facet_dofs(patch.pair_facets)])
        return {key: Block(r, r) for key, r in rows.items()}

    def rebuild(self, state: State) -> None:
        """Choose the candidates anew: around a state, and what was missed since the last time."""
        if self.active:
            self._patch = self._patch_around(state)
        self._missed, self.outgrown = nothing(0), False

    def residual(self, state: State, forces: Forces) -> None:
        """Add dψ/du: minus the force on the riser, minus the force on the soil."""
        for touching in self._touching(state):
            add_shares(forces.end, touching.rows, touching.gradient)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Add d²ψ/du², unweighted: contact stands at the end of the step."""
        for touching in self._touching(state):
            places = self._present_patch().places(touching.node, touching.facet)
            add_blocks(values[touching.key], places, touching.hessian)
            self._note_missed(touching, places < 0)

    def energy(self, state: State) -> Energy:
        """Potential of the penalty."""
        return Energy(potential=self.meet(state).potential) if self.active else Energy()

    def work(self, before: State, after: State) -> Work:
        """What the force at the end of the step took out beyond the change of its potential.

        ψ is convex in the gap, so this is ≥ 0 where the gap is linear in the step: on a plane, and on soil
        that moves vertically under a riser that does. Sliding along a sloping ground adds terms of second
        order in the sliding distance, of either sign.
        """
        du = after.u - before.u
        taken = sum(float(np.sum(t.gradient * du[t.rows])) for t in self._touching(after))
        return Work(dissipated=taken - self.energy(after).potential + self.energy(before).potential)

    def commit(self, state: State) -> None:
        """Nothing is kept but the pattern."""
        self._met = None

    def force_per_length(self, state: State) -> Array:
        """Contact force per length at the nodes (nn,) [N/m], ≥ 0."""
        total = np.zeros(len(self._riser.arc))
        for touching in self._touching(state):
            add_shares(total, touching.node[:, None], touching.force[:, None])
        return np.asarray(total / self._riser.tributary_length)

    def max_penetration(self, state: State) -> float:
        """Largest penetration [m], ≥ 0: an error, except into a plane that stands for springs."""
        return max(0.0, -float(self.meet(state).gap.min(initial=np.inf))) if self.active else 0.0

    def force_on_riser(self, state: State) -> Array:
        """Sum of the contact forces on the riser (3,) [N], global axes."""
        d = self._riser.basis.shape[1]
        residual = sum((t.gradient[:, :d].sum(axis=0) for t in self._touching(state)), np.zeros(d))
        return np.asarray(-self._riser.basis @ residual)

    def force_on_soil(self, state: State) -> Array:
        """Sum of the contact forces on the soil (3,) [N], global axes; what a plane bears is not in it."""
        d = self._riser.basis.shape[1]
        on_soil = [t.gradient[:, d:].reshape(-1, 3) for t in self._touching(state) if t.key == SOIL]
        return np.asarray(-sum((g.sum(axis=0) for g in on_soil), np.zeros(3)))

    def touchdown_arc(self, state: State) -> float:
        """Arc length [m] of the touchdown point; nan where nothing touches. See `touchdown`."""
        if not self.active:
            return float("nan")
        return touchdown(self._riser.arc, self._clearance(state))

    def improve(self, guess: State) -> Array:
        """First guess of a step: the guess's increment, lifted where a node would sink below its present depth.

        The motion of the last step carries landing nodes deep into the ground, where the law is far stiffer than
        at the depth at which they come to rest. They start instead from half the law's rounded corner.
        """
        if not self.active:
            return guess.u
        now = np.minimum(self._clearance(State.at_rest(guess.t, guess.u.size)), -0.5 * self._rounding)
        improved = guess.u.copy()
        lift = np.maximum(now - self._clearance(guess), 0.0)
        improved[self._riser.translation_dofs[:, -1]] += lift
        return improved

    def _touching(self, state: State) -> list[Touching]:
        return self.meet(state).touching if self.active else []

    def _clearance(self, state: State) -> Array:
        """Gap (nn,) less that at which the force begins [m], the least of a node's points; inf far away."""
        met = self.meet(state)
        least = np.full(len(self._riser.arc), np.inf)
        np.minimum.at(least, met.points.node, met.gap - self._grounds.starts(met.facet))
        return least

    def _note_missed(self, touching: Touching, missed: BoolArray) -> None:
        if missed.any():
            self.outgrown = True
            node, facet = touching.node[missed], touching.facet[missed]
            self._missed = self._missed.joined(Patch.of(self._present_patch().facets, node, facet))

    def _present_patch(self) -> Patch:
        if self._patch is None:
            ends = [self._riser.offset + self._riser.size, self._soil.end if self._soil is not None else 0]
            self._patch = self._patch_around(State.at_rest(0.0, max(ends)))
        return self._patch

    def _patch_around(self, state: State) -> Patch:
        met = self.meet(state)
        nodes = np.unique(met.points.node[met.gap < self._reach.above])
        xy = self._riser.positions3(state)[nodes, :2]
        facets = self._soil.facets if self._soil is not None else np.empty((0, 4), dtype=np.int64)
        patch = around(nodes, xy, met.surface, facets, ASPECT * self._footprint + self._reach.around)
        return patch.joined(self._missed)


def _laws(plane: Plane | None, soil: Soil | None, penalty: Penalty | None) -> dict[str, Penalty]:
    laws = {}
    if plane is not None:
        laws[PLANE] = Penalty(plane.stiffness, plane.smoothing)
    if soil is not None and penalty is not None:
        laws[SOIL] = penalty
    return laws


def _default_reach(riser: RiserNodes, soil: Soil | None) -> Reach:
    length = float(riser.arc[-1] - riser.arc[0])
    return Reach(0.01 * length, 0.5 * soil.facet_size if soil is not None else 0.0)
