"""Penalty contact between the riser's nodes and the deformable soil below them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from riser_soil.contact.facets import gap_forms, penalty_hessian, within_line
from riser_soil.contact.ground import (
    ASPECT,
    CandidatePairs,
    ContactDetection,
    ContactPoints,
    ContactState,
    DeformedSurface,
    PointsBelow,
    add_blocks,
    add_shares,
    find_below,
    pairs_around,
    points_below,
)
from riser_soil.contact.pairing import Cover, renew_boxes
from riser_soil.contact.soil_contact import SOIL, CandidateRange, LoopContact, SoilContact
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.compiled import njit
from riser_soil.core.identity_cache import IdentityCache
from riser_soil.core.part import Energy, Forces, State, Weights, Work
from riser_soil.core.saved_state import Saved
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.line import Line
from riser_soil.riser.part_kernels import BEYOND, LEFT, POINTS, Border, LineForces, TopMotion
from riser_soil.seabed.compiled_law import answer, may_act
from riser_soil.seabed.law import NormalLaw

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
        law: NormalLaw,
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
        self._points = ContactPoints.of_nodes(line.tributary_length, self._footprint, axis)
        self._basis = np.ascontiguousarray(line.basis)
        self._detection = ContactDetection(line, radius, self._points, law, self._soil, self._reach.above)

    def detect(self, state: State) -> ContactState:
        """Riser and ground at a state; kept for the state asked last, whose arrays must not change then."""
        return self._detected.made_of(state, self._detection.detect)

    def pair_dofs(self, on_line: IntArray, facet: IntArray) -> IntArray:
        """Translations of a node and dofs of a facet."""
        return np.hstack([self.line.translation_dofs[on_line], self._soil.facet_dofs(facet)])

    def candidates(self, state: State) -> CandidatePairs:
        detected = self.detect(state)
        nodes = np.unique(detected.points.node[detected.below.gap < self._reach.above])
        xy = self.line.positions3(state)[nodes, :2]
        return pairs_around(nodes, xy, detected.surface, self._soil.facets, self._distance)

    @property
    def _distance(self) -> float:
        """How far beside a node facets are candidates [m]."""
        return ASPECT * self._footprint + self._reach.around

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
            np.maximum.at(deepest, points.node, self._soil.heights_at(facet, xi, surface) - underside)
        return deepest

    def max_penetration(self, state: State) -> float:
        """Largest penetration [m], ≥ 0: an error."""
        return max(0.0, -float(self.detect(state).below.gap.min(initial=np.inf))) if self.active else 0.0

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

    def in_loop(self, friction: None) -> NodesInLoop:
        data = NodeTouchData(self.line.origin, self._basis, self._radius, self._points, self.law.kernel_data)
        return NodesInLoop(self, data, self._soil.cover(), self._reach.around)

    def watch(self, x: Array, cover: Cover, slack: float) -> tuple[IntArray, float]:
        """Facets near nodes at x (nn, 3) that may come to touch, and the level [m] above which none does."""
        level = float(cover.points[:, 2].max()) + slack + self.law.start
        nodes = np.flatnonzero(x[:, 2] - self._radius < level + self._reach.above)
        return pairs_around(nodes, x[nodes, :2], cover.points, self._soil.facets, self._distance).facet, level

    def stretch(self, state: State) -> float:
        if not self.active:
            return 1.0
        detected = self.detect(state)
        return self._soil.stretch(detected.surface, detected.touching.facet)

    def clearance(self, state: State) -> Array:
        """Gap (nn,) less that at which the force begins [m], the least of a node's points; inf far away."""
        detected = self.detect(state)
        least = np.full(self.line.nodes, np.inf)
        np.minimum.at(least, detected.points.node, detected.below.gap - self.law.start)
        return least

    def restore(self, saved: Saved) -> None:
        super().restore(saved)
        self._detected.forget()


class NodeTouchData(NamedTuple):
    """The nodes, for compiled code: origin (3,) and basis (3, d) of the line, radius (nn,) [m] and points; the law."""

    origin: Array
    basis: Array
    radius: Array
    points: ContactPoints
    law: Any


class WatchedFacets(NamedTuple):
    """Facets (k,) that may come to touch, as marked (nf,), as long as no other lies below a node whose underside is
    below a level [m].
    """

    facets: IntArray
    marked: BoolArray
    level: float


class NodeTouch(NamedTuple):
    """What was found last: places x (nn, 3) of the nodes; where all points (n,) stand; those that touch, with force [N]
    and its derivative by the penetration [N/m], length included; found, met, energy: see `LoopContact`.
    """

    x: Array
    below: PointsBelow
    touching: IntArray
    force: Array
    slope: Array
    found: IntArray
    met: BoolArray
    energy: Array


@njit
def write_places(touch: NodeTouchData, x: Array, out: Array) -> None:
    """Write places x (nn, d) of a line's nodes in global axes (nn, 3)."""
    for n in range(out.shape[0]):
        for i in range(3):
            out[n, i] = touch.origin[i]
            for j in range(x.shape[1]):
                out[n, i] += touch.basis[i, j] * x[n, j]


@njit
def touching_forms(touch: NodeTouchData, cover: Cover, found: NodeTouch) -> tuple[IntArray, IntArray, Array, Array]:
    """Node and facet (n,) of the points that touch, and their forms by node and facet, see `gap_forms`."""
    at = found.touching[: found.found[POINTS]]
    facet = found.below.facet[at]
    forms, H = gap_forms(facet, found.below.xi[at], cover.facets, cover.points)
    return touch.points.node[at], facet, within_line(forms, touch.basis), H


@njit
def add_node_touch(
    touch: NodeTouchData,
    cover: Cover,
    watched: WatchedFacets,
    top: TopMotion,
    at: Configuration,
    out: LineForces,
    border: Border,
    found: NodeTouch,
) -> None:
    """Add the contact's residual to that of the line and to the border's."""
    write_places(touch, at.x, found.x)
    renew_boxes(cover, watched.facets)
    below, length = found.below, touch.points.length
    find_below(found.x, touch.radius, touch.points, watched.level, cover, below)
    for a in range(found.met.size):
        found.met[a] = False
    found.found[POINTS], found.found[LEFT], found.energy[0] = 0, 0, 0.0
    nothing, n = np.empty(0), 0
    for p in range(length.size):
        if below.facet[p] >= 0 and not watched.marked[below.facet[p]]:
            found.found[LEFT] = 1
        if may_act(touch.law, -below.gap[p], nothing):
            force, slope, stored = answer(touch.law, -below.gap[p], nothing, nothing)
            found.touching[n], found.force[n], found.slope[n] = p, length[p] * force, length[p] * slope
            found.energy[0] += length[p] * stored
            n += 1
    found.found[POINTS] = n
    nodes, facets, forms, _ = touching_forms(touch, cover, found)
    d = touch.basis.shape[1]
    for i in range(n):
        for j in range(d):
            out.end[nodes[i], j] -= found.force[i] * forms[i, 0, j]
        for k in range(d, forms.shape[2]):
            a, share = cover.facets[facets[i], (k - d) // 3], found.force[i] * forms[i, 0, k]
            row = top.rows[a, (k - d) % 3]
            if row >= 0:
                border.residual[row] -= share
            elif row == BEYOND and share != 0.0:
                found.met[a] = True


@njit
def add_node_touch_tangent(
    touch: NodeTouchData, cover: Cover, top: TopMotion, K: Array, border: Border, found: NodeTouch
) -> None:
    """Add the derivative of the contact's residual, found last, to K (ne, n, n) and to the border's."""
    nodes, facets, forms, H = touching_forms(touch, cover, found)
    blocks = penalty_hessian(forms, H, found.force[: nodes.size], found.slope[: nodes.size])
    d, ndof = touch.basis.shape[1], K.shape[1] // 2
    for i in range(nodes.size):
        n, f = nodes[i], facets[i]
        e = min(n, K.shape[0] - 1)
        first = (n - e) * ndof
        border.coupled[n] = True
        for a in range(d):
            for b in range(d):
                K[e, first + a, first + b] += blocks[i, a, b]
        for a in range(d, blocks.shape[1]):
            row = top.rows[cover.facets[f, (a - d) // 3], (a - d) % 3]
            if row < 0:
                continue
            for b in range(d):
                border.right[n * ndof + b, row] += blocks[i, b, a]
                border.below[n * ndof + b, row] += blocks[i, a, b]
            for b in range(d, blocks.shape[1]):
                column = top.rows[cover.facets[f, (b - d) // 3], (b - d) % 3]
                if column >= 0:
                    border.corner[row, column] += blocks[i, a, b]


@njit
def write_node_touch_work(
    touch: NodeTouchData, cover: Cover, top: TopMotion, first: Configuration, found: NodeTouch, work: Array
) -> None:
    """Write to work (1,) what the force at a step's end, found last, takes along the step [J]."""
    before = np.empty_like(found.x)
    write_places(touch, first.x, before)
    at = found.touching[: found.found[POINTS]]
    facet, node = found.below.facet[at], touch.points.node[at]
    forms, _ = gap_forms(facet, found.below.xi[at], cover.facets, cover.points)
    work[0] = 0.0
    for i in range(at.size):
        way = 0.0
        for j in range(3):
            way += forms[i, 0, j] * (found.x[node[i], j] - before[node[i], j])
            for k in range(cover.facets.shape[1]):
                a = cover.facets[facet[i], k]
                way += forms[i, 0, 3 + 3 * k + j] * (cover.points[a, j] - top.accepted[a, j])
        work[0] -= found.force[i] * way


class NodesInLoop(LoopContact):
    """`NodeContact` in the line solver. cover: with the workspace for the top's points; around: range beside a node
    in which facets are candidates [m].
    """

    contact: NodeContact

    def __init__(self, contact: NodeContact, data: NodeTouchData, cover: Cover, around: float) -> None:
        super().__init__(contact, around)
        self.parts, self._cover, self.deformed = (contact,), cover, cover.points
        self.met: BoolArray = np.zeros(len(cover.points), dtype=np.bool_)
        n, x = len(data.points.node), np.zeros((contact.line.nodes, 3))
        forces = np.zeros(n, dtype=np.int64), np.zeros(n), np.zeros(n)
        self._found = NodeTouch(x, points_below(n), *forces, self.found, self.met, self.energy)
        self._data, self._packed_cover, self._workspace = Packed(data), Packed(cover), Packed(self._found)
        none = np.empty(0, dtype=np.int64), np.zeros(len(cover.facets), dtype=np.bool_)
        self._watched = Packed(WatchedFacets(*none, 0.0))

    def begin(self, before: State) -> None:
        self._cover.renew(self.deformed)

    def look(self, before: State, tried: bool) -> IntArray:
        found, places = list[IntArray](), [self.contact.line.positions3(before)]
        for x in [*places, self._found.x] if tried else places:
            facets, level = self.contact.watch(x, self._cover, self.slack)
            found.append(facets)
        facets, marked = np.unique(np.concatenate(found)), np.zeros(len(self._cover.facets), dtype=np.bool_)
        marked[facets] = True
        self._watched.renew(WatchedFacets(facets, marked, level))
        return np.unique(self._cover.facets[facets])

    def forces(self, top: Packed, at: Packed, forces: Packed, border: Packed) -> list[Bound]:
        given = self._data, self._packed_cover, self._watched, top, at
        return [Bound(add_node_touch, *given, forces, border, self._workspace)]

    def tangent(self, top: Packed, at: Packed, K: Packed, border: Packed) -> list[Bound]:
        given = self._data, self._packed_cover, top, K, border
        return [Bound(add_node_touch_tangent, *given, self._workspace)]

    def account(self, top: Packed, first: Packed) -> list[Bound]:
        given = self._data, self._packed_cover, top, first, self._workspace
        return [Bound(write_node_touch_work, *given, Packed(self.work))]


def _default_reach(line: Line, soil: DeformedSurface) -> CandidateRange:
    length = float(line.arc[-1] - line.arc[0])
    return CandidateRange(0.01 * length, 0.5 * soil.facet_size)
