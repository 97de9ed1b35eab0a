"""Penalty contact between the riser's nodes and the deformable soil below them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.contact.ground import CandidatePairs, DeformedSurface, add_blocks, pairs_around
from riser_soil.contact.on_condensed_soil import POINTS, Touched
from riser_soil.contact.soil_contact import SOIL, CandidateRange, SoilContact
from riser_soil.contact.touching_nodes import (
    ASPECT,
    ContactPoints,
    NodeContactData,
    PointsBelow,
    TouchingNodes,
    TouchingPoints,
    WatchedFacets,
    find_below,
    find_touching,
    first_touching,
    points_below,
    touching_workspace,
)
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Forces, State, Weights
from riser_soil.riser.line import Line
from riser_soil.riser.moving_nodes import Trial
from riser_soil.seabed.law import NormalLaw

if TYPE_CHECKING:
    from riser_soil.soil.condensed import SoilSurface

FOOTPRINT = 0.25  # default half width of the footprint over the outer radius


class NodeContact(SoilContact):
    """Part "contact": between riser nodes and the soil below them, see `SoilContact`.

    Node i carries f(δ_i) times its tributary length. All forces derive from the potential Σ ψ(δ_i)·length_i: the
    tangent is symmetric, and the forces on riser and soil sum to zero in all directions.

    Each node rests on four points around it, ±footprint [m] across the riser and a golden ratio more along it; on one
    where footprint = 0. A node presses a kink into the surface where facets meet below it; there the slope, and with it
    the horizontal force, jumps from side to side, and Newton finds no balance. Four points straddle the kink. The
    default is an eighth of the outer diameter, half the chord by which a pipe touches once it has sunk in by 3 % of its
    radius.

    radius (nn,): distance [m] from the axis to the line that touches, 0 for the axis itself. along (2,): horizontal
    unit vector of the riser on the ground; by default its first axis. reach: by default 1 % of the riser's length above
    the ground and half a facet around a node. points: the contact points of all nodes.
    """

    points: ContactPoints

    def __init__(
        self,
        line: Line,
        radius: Array,
        surface: SoilSurface,
        law: NormalLaw,
        *,
        footprint: float | None = None,
        along: Array | None = None,
        reach: CandidateRange | None = None,
    ) -> None:
        super().__init__(line, law, surface)
        self._radius = radius
        if not self.active:
            return
        self._reach = reach or _default_reach(line, self._soil)
        self._footprint = FOOTPRINT * float(radius.mean()) if footprint is None else footprint
        axis = line.basis[:2, 0] if along is None else along
        self.points = ContactPoints.of_nodes(line.tributary_length, self._footprint, axis)
        self._basis = np.ascontiguousarray(line.basis)

    def below(self, state: State) -> PointsBelow:
        """Facets below the points and gaps over them, evaluated once at a state."""
        below: PointsBelow = self.line.trial(state).once((self, "below"), self._find_below)
        return below

    def _find_below(self, trial: Trial) -> PointsBelow:
        state = trial.state
        surface, below = self._soil.deformed(state), points_below(len(self.points.node))
        level = float(surface[:, 2].max()) + self._reach.above
        find_below(self.place(state), self._radius, self.points, level, self._soil.cover(surface), below)
        return below

    def touching(self, state: State) -> TouchingNodes:
        """What touches, evaluated once at a state."""
        touching: TouchingNodes = self.line.trial(state).once((self, "touching"), self._find_touching)
        return touching

    def _find_touching(self, trial: Trial) -> TouchingNodes:
        state = trial.state
        workspace = touching_workspace(len(self.points.node))
        n, energy = find_touching(self.law.kernel_data, self.points, self.below(state), workspace)
        return self._touching_nodes(first_touching(workspace, n), energy, self._soil.deformed(state))

    def _touching_nodes(self, points: TouchingPoints, energy: float, surface: Array) -> TouchingNodes:
        return TouchingNodes(points, energy, surface, self._soil.facets, self._basis)

    def pair_dofs(self, on_line: IntArray, facet: IntArray) -> IntArray:
        """Translations of a node and dofs of a facet."""
        return np.hstack([self.line.translation_dofs[on_line], self._soil.facet_dofs(facet)])

    def place(self, state: State) -> Array:
        """Places (nn, 3) of the nodes [m], global axes."""
        return self.line.positions3(state)

    def candidates(self, places: Sequence[Array], surface: Array) -> CandidatePairs:
        highest = float(surface[:, 2].max()) + self.law.start + self._reach.above + self._reach.around
        pairs, distance = CandidatePairs.none(len(self._soil.facets)), ASPECT * self._footprint + self._reach.around
        for x in places:
            low = np.flatnonzero(x[:, 2] - self._radius < highest)
            pairs = pairs.joined(pairs_around(low, x[low, :2], surface, self._soil.facets, distance))
        return pairs

    def residual(self, state: State, forces: Forces) -> None:
        """Add dψ/du: minus the force on the riser, minus the force on the soil."""
        self.touching(state).add_residual(self.line.nodal(forces.end), forces.end[self._soil.part])

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Add d²ψ/du², unweighted: contact forces are those at the end of the step."""
        touching = self.touching(state)
        places = self.places(values[SOIL], touching.points.node, touching.points.facet)
        add_blocks(values[SOIL], places, touching.hessian)

    def potential(self, state: State) -> float:
        return self.touching(state).potential

    def work_to(self, state: State) -> float:
        touching = self.touching(state)
        rows = self.pair_dofs(touching.points.node, touching.points.facet)
        return float(np.sum(touching.gradient * state.u[rows]))

    def force_per_length(self, state: State) -> Array:
        """Contact force per length at the nodes (nn,) [N/m], ≥ 0."""
        total = np.zeros(self.line.nodes)
        if self.active:
            points = self.touching(state).points
            np.add.at(total, points.node, points.force)
        return np.asarray(total / self.line.tributary_length)

    def depth(self, state: State) -> Array:
        """Depth (nn,) [m] of the nodes' undersides below the soil's surface before the riser came, 0 above it."""
        deepest = np.zeros(self.line.nodes)
        if self.active:
            points, x, surface = self.points, self.place(state), self._soil.at_first
            facet, xi = self._soil.locate(x[points.node, :2] + points.offset, surface)
            underside = (x[:, 2] - self._radius)[points.node]
            np.maximum.at(deepest, points.node, self._soil.heights_at(facet, xi, surface) - underside)
        return deepest

    def max_penetration(self, state: State) -> float:
        """Largest penetration [m], ≥ 0: an error."""
        return max(0.0, -float(self.below(state).gap.min(initial=np.inf))) if self.active else 0.0

    def force_on_riser(self, state: State) -> Array:
        """Sum of the contact forces on the riser (3,) [N], global axes."""
        if not self.active:
            return np.zeros(3)
        d = self.line.basis.shape[1]
        return np.asarray(-self.line.basis @ self.touching(state).gradient[:, :d].sum(axis=0))

    def nodal_forces(self, state: State) -> Array:
        """Residual (nn, ndof) at the riser's nodes."""
        forces = Forces.zeros(state.u.size)
        self.residual(state, forces)
        return self.line.nodal(forces.end)

    def force_on_soil(self, state: State) -> Array:
        """Sum of the contact forces on the soil (3,) [N], global axes."""
        return self._on_soil(state).sum(axis=0) if self.active else np.zeros(3)

    def _on_soil(self, state: State) -> Array:
        """Force (n, 3) [N] on the soil of each point that touches."""
        gradient, d = self.touching(state).gradient, self.line.basis.shape[1]
        return np.asarray(-gradient[:, d:].reshape(-1, (gradient.shape[1] - d) // 3, 3).sum(axis=1))

    def force_on_soil_per_length(self, state: State) -> Array:
        """Forces on the nodes of the facets under the riser's nodes (nn, 3) [N/m]."""
        total = np.zeros((self.line.nodes, 3))
        if self.active:
            np.add.at(total, self.touching(state).points.node, self._on_soil(state))
        return np.asarray(total / self.line.tributary_length[:, None])

    def kernel_data(self, deformed: Array, touched: Touched) -> NodeContactData:
        n, x = len(self.points.node), np.zeros((self.line.nodes, 3))
        cover = self._soil.cover()._replace(points=deformed)
        none = np.empty(0, dtype=np.int64), np.zeros(len(cover.facets), dtype=np.bool_)
        line = self.line.origin, self._basis, self._radius, self.points
        outcome = x, points_below(n), touching_workspace(n), touched
        return NodeContactData(*line, self.law.kernel_data, cover, WatchedFacets(*none, 0.0), *outcome)

    def at_start(self, data: NodeContactData) -> NodeContactData:
        data.cover.renew(data.cover.points)
        return data

    def place_in(self, data: NodeContactData) -> Array:
        return data.x.copy()

    def watch(
        self, data: NodeContactData, places: Sequence[Array], pairs: CandidatePairs, slack: float
    ) -> NodeContactData:
        marked = np.zeros(len(self._soil.facets), dtype=np.bool_)
        marked[pairs.facet] = True
        level = float(data.cover.points[:, 2].max()) + self.law.start + slack
        return data._replace(watched=WatchedFacets(np.flatnonzero(marked), marked, level))

    def adopt(self, state: State, data: NodeContactData) -> None:
        n = data.touched.counts[POINTS]
        points = TouchingPoints._make(each[:n].copy() for each in data.touching)
        touching = self._touching_nodes(points, float(data.touched.energy[0]), data.cover.points.copy())
        self.line.trial(state).once((self, "touching"), lambda _: touching)

    def stretch(self, state: State) -> float:
        if not self.active:
            return 1.0
        return self._soil.stretch(self._soil.deformed(state), self.touching(state).points.facet)

    def clearance(self, state: State) -> Array:
        """Gap (nn,) less that at which the force begins [m], the least of a node's points; inf far away."""
        least = np.full(self.line.nodes, np.inf)
        np.minimum.at(least, self.points.node, self.below(state).gap - self.law.start)
        return least


def _default_reach(line: Line, soil: DeformedSurface) -> CandidateRange:
    length = float(line.arc[-1] - line.arc[0])
    return CandidateRange(0.01 * length, 0.5 * soil.facet_size)
