"""Penalty contact between the riser's nodes and the deformable soil below them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from riser_soil.contact.facets import heights
from riser_soil.contact.ground import (
    ASPECT,
    CandidatePairs,
    ContactDetection,
    ContactPoints,
    ContactState,
    DeformedSurface,
    add_blocks,
    add_shares,
    pairs_around,
)
from riser_soil.contact.law import Penalty
from riser_soil.contact.soil_contact import SOIL, CandidateRange, SoilContact
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.identity_cache import IdentityCache
from riser_soil.core.part import Energy, Forces, State, Weights, Work
from riser_soil.core.saved_state import Saved
from riser_soil.riser.line import Line

if TYPE_CHECKING:
    from riser_soil.soil.condensed import SoilSurface

FOOTPRINT = 0.25  # default half width of the footprint over the outer radius


class NodeContact(SoilContact):
    """Part "contact": between riser nodes and the soil below them, see `SoilContact`.

    Node i carries f(δ_i) times its tributary length. All forces derive from the potential Σ ψ(δ_i)·length_i: the
    tangent is symmetric, and the forces on riser and soil sum to zero in all directions.

    Each node stands on four points around it, ±footprint [m] across the riser and a golden ratio more along it; on one
    where footprint = 0. A node presses a kink into the surface where facets meet below it; there the slope, and with it
    the horizontal force, jumps from side to side, and Newton finds no balance. Four points straddle the kink. The
    default is an eighth of the outer diameter, half the chord by which a pipe touches once it has sunk in by 3 % of its
    radius.

    radius (nn,): distance [m] from the axis to the line that touches, 0 for the axis itself. along (2,): horizontal
    unit vector of the riser on the ground; by default its first axis. reach: by default 1 % of the riser's length above
    the ground and half a facet around a node.
    """

    def __init__(
        self,
        line: Line,
        radius: Array,
        surface: SoilSurface,
        law: Penalty,
        *,
        footprint: float | None = None,
        along: Array | None = None,
        reach: CandidateRange | None = None,
    ) -> None:
        super().__init__(line, law, surface)
        self._radius = radius
        self._detected = IdentityCache[State, ContactState]()
        if not self.active:
            return
        self._reach = reach or _default_reach(line, self._soil)
        self._footprint = FOOTPRINT * float(radius.mean()) if footprint is None else footprint
        axis = line.basis[:2, 0] if along is None else along
        points = ContactPoints.of_nodes(line.tributary_length, self._footprint, axis)
        self._detection = ContactDetection(line, radius, points, law, self._soil, self._reach.above)

    def detect(self, state: State) -> ContactState:
        """Riser and ground at a state; kept for the state asked last, whose arrays must not change then."""
        return self._detected.made_of(state, self._detection.detect)

    def pair_dofs(self, on_line: IntArray, facet: IntArray) -> IntArray:
        """Translations of a node and dofs of a facet."""
        return np.hstack([self.line.translation_dofs[on_line], self._soil.facet_dofs(facet)])

    def candidates(self, state: State) -> CandidatePairs:
        detected = self.detect(state)
        nodes = np.unique(detected.points.node[detected.gap < self._reach.above])
        xy = self.line.positions3(state)[nodes, :2]
        distance = ASPECT * self._footprint + self._reach.around
        return pairs_around(nodes, xy, detected.surface, self._soil.facets, distance)

    def residual(self, state: State, forces: Forces) -> None:
        """Add dψ/du: minus the force on the riser, minus the force on the soil."""
        touching = self.detect(state).touching
        add_shares(forces.end, touching.rows, touching.gradient)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Add d²ψ/du², unweighted: contact stands at the end of the step."""
        touching = self.detect(state).touching
        add_blocks(values[SOIL], self.places(values[SOIL], touching.node, touching.facet), touching.hessian)

    def energy(self, state: State) -> Energy:
        """Potential of the penalty."""
        return Energy(potential=self.detect(state).touching.potential)

    def work(self, before: State, after: State) -> Work:
        """Energy dissipated: the work of the force at the end of the step less the change of its potential, all of it
        by the time scheme.

        ψ is convex in the gap, so this is ≥ 0 where the gap is linear in the step, as where soil and riser move
        vertically. Sliding along a sloping ground adds terms of second order in the sliding distance, of either sign.
        """
        touching = self.detect(after).touching
        taken = float(np.sum(touching.gradient * (after.u - before.u)[touching.rows]))
        lost = taken - self.energy(after).potential + self.energy(before).potential
        return Work(dissipated=lost, by_scheme=lost)

    def commit(self, state: State) -> None:
        """Nothing is kept but the pattern."""
        super().commit(state)
        self._detected.forget()

    def force_per_length(self, state: State) -> Array:
        """Contact force per length at the nodes (nn,) [N/m], ≥ 0."""
        total = np.zeros(self.line.nodes)
        if self.active:
            touching = self.detect(state).touching
            add_shares(total, touching.node[:, None], touching.force[:, None])
        return np.asarray(total / self.line.tributary_length)

    def depth(self, state: State) -> Array:
        """Depth (nn,) [m] of the nodes' undersides below the soil's surface before the riser came, 0 above it."""
        deepest = np.zeros(self.line.nodes)
        if self.active:
            points, x, surface = self.detect(state).points, self.line.positions3(state), self._soil.at_first
            facet, xi = self._soil.locate(x[points.node, :2] + points.offset, surface)
            underside = (x[:, 2] - self._radius)[points.node]
            np.maximum.at(deepest, points.node, heights(facet, xi, self._soil.facets, surface) - underside)
        return deepest

    def max_penetration(self, state: State) -> float:
        """Largest penetration [m], ≥ 0: an error."""
        return max(0.0, -float(self.detect(state).gap.min(initial=np.inf))) if self.active else 0.0

    def force_on_riser(self, state: State) -> Array:
        """Sum of the contact forces on the riser (3,) [N], global axes."""
        if not self.active:
            return np.zeros(3)
        d = self.line.basis.shape[1]
        return np.asarray(-self.line.basis @ self.detect(state).touching.gradient[:, :d].sum(axis=0))

    def nodal_forces(self, state: State) -> Array:
        """Residual (nn, ndof) at the riser's nodes."""
        forces = Forces.zeros(state.u.size)
        self.residual(state, forces)
        return self.line.nodal(forces.end)

    def force_on_soil(self, state: State) -> Array:
        """Sum of the contact forces on the soil (3,) [N], global axes."""
        if not self.active:
            return np.zeros(3)
        d = self.line.basis.shape[1]
        return np.asarray(-self.detect(state).touching.gradient[:, d:].reshape(-1, 3).sum(axis=0))

    def force_on_soil_per_length(self, state: State) -> Array:
        """Forces on the nodes of the facets under the riser's nodes (nn, 3) [N/m]."""
        total = np.zeros((self.line.nodes, 3))
        if self.active:
            touching, d = self.detect(state).touching, self.line.basis.shape[1]
            on_nodes = -touching.gradient[:, d:].reshape(-1, (touching.gradient.shape[1] - d) // 3, 3)
            np.add.at(total, touching.node, on_nodes.sum(axis=1))
        return np.asarray(total / self.line.tributary_length[:, None])

    def stretch(self, state: State) -> float:
        if not self.active:
            return 1.0
        detected = self.detect(state)
        return self._soil.stretch(detected.surface, detected.touching.facet)

    def clearance(self, state: State) -> Array:
        """Gap (nn,) less that at which the force begins [m], the least of a node's points; inf far away."""
        detected = self.detect(state)
        least = np.full(self.line.nodes, np.inf)
        np.minimum.at(least, detected.points.node, detected.gap - self.law.start)
        return least

    def restore(self, saved: Saved) -> None:
        super().restore(saved)
        self._detected.forget()


def _default_reach(line: Line, soil: DeformedSurface) -> CandidateRange:
    length = float(line.arc[-1] - line.arc[0])
    return CandidateRange(0.01 * length, 0.5 * soil.facet_size)
