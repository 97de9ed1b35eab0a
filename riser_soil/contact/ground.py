"""The deformed soil surface as a contact surface: gaps, forces and stiffness at candidate pairs of node and facet.

Candidate pairs set the sparsity pattern of contact in the tangent.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from riser_soil.contact.facets import (
    QUAD,
    gap_forms,
    height_at,
    heights,
    penalty_hessian,
    strips,
    within_line,
)
from riser_soil.contact.pairing import Cover, FacetSearch, bounds, facet_below
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.part import State
from riser_soil.riser.line import Line
from riser_soil.seabed.law import NormalLaw, SeabedResponse
from riser_soil.soil.surface import vector_areas

if TYPE_CHECKING:
    from riser_soil.soil.condensed import SoilSurface

EMPTY = np.empty(0, dtype=np.int64)
ASPECT = (
    1.618  # the golden ratio: sides of facets, also diagonals of simple grids, miss all four points of a node
)


class ContactPoints(NamedTuple):
    """Points fixed to nodes that carry the nodes' contact forces.

    node (n,). offset (n, 2): horizontal distance from the node [m]. length (n,): riser length that a point
    stands for [m].
    """

    node: IntArray
    offset: Array
    length: Array

    @classmethod
    def of_nodes(cls, tributary: Array, footprint: float, along: Array) -> ContactPoints:
        """Four points a node, ±ASPECT·footprint along a horizontal unit vector, ±footprint across; or one."""
        across = np.array([-along[1], along[0]])
        corners = np.array([i * ASPECT * along + j * across for i in (-1.0, 1.0) for j in (-1.0, 1.0)])
        corners = footprint * corners if footprint > 0.0 else np.zeros((1, 2))
        node = np.repeat(np.arange(len(tributary)), len(corners))
        return cls(node, np.tile(corners, (len(tributary), 1)), tributary[node] / len(corners))


class PointsBelow(NamedTuple):
    """Where contact points (n,) stand: soil facet below, −1 where there is none or none is looked for; place on it (n,
    2); gap, the height [m] of the riser's underside over the ground, inf without a facet.
    """

    facet: IntArray
    xi: Array
    gap: Array


def points_below(count: int) -> PointsBelow:
    """Workspace for so many points."""
    return PointsBelow(np.full(count, -1), np.zeros((count, 2)), np.full(count, np.inf))


@njit
def find_below(x: Array, radius: Array, points: ContactPoints, level: float, cover: Cover, out: PointsBelow) -> None:
    """Write where the points of nodes at x (nn, 3) stand whose undersides are below a level [m]. radius (nn,): [m] from
    the axis to the line that touches.
    """
    for p in range(points.node.size):
        n = points.node[p]
        out.facet[p], out.gap[p] = -1, np.inf
        if not x[n, 2] - radius[n] < level:
            continue
        out.facet[p] = facet_below(cover, x[n, 0] + points.offset[p, 0], x[n, 1] + points.offset[p, 1], -1)
        if out.facet[p] >= 0:
            out.xi[p, 0], out.xi[p, 1] = cover.xi[0], cover.xi[1]
            ground = height_at(cover.facets[out.facet[p]], cover.xi[0], cover.xi[1], cover.points)
            out.gap[p] = x[n, 2] - radius[n] - ground


class DeformedSurface:
    """The deformed surface: its facets, and the dofs of their nodes."""

    def __init__(self, surface: SoilSurface) -> None:
        self._surface = surface
        self._pairing = FacetSearch(surface.points, surface.facets)
        self.corners = self.facets = np.ascontiguousarray(surface.facets, dtype=np.int64)  # without those beside strips

    @property
    def moves(self) -> bool:
        """Whether the geometry follows the soil, as at large strain."""
        return bool(self._surface.moves)

    @property
    def has_quads(self) -> bool:
        """Whether facets have four nodes."""
        return self.corners.shape[1] == len(QUAD)

    def smooth(self, along: Array) -> None:
        """Join facets of four nodes across a horizontal direction (2,): to strip8, eta across it."""
        a, b, c, d = np.moveaxis(self._surface.points[self.corners][:, :, :2] @ along, 1, 0)
        lengthwise = np.abs(c + d - a - b) > np.abs(b + c - a - d)
        corners = self.corners.copy()
        corners[lengthwise] = np.roll(corners[lengthwise], 1, axis=1)
        self.facets = strips(corners)

    @property
    def part(self) -> slice:
        """The surface's slice of local arrays."""
        return slice(self._surface.offset, self.end)

    @property
    def end(self) -> int:
        """First local dof number behind the surface's."""
        return self._surface.offset + self._surface.size

    @property
    def facet_size(self) -> float:
        """Median over the facets of their largest horizontal extent [m]."""
        at = self._surface.points[self.facets][:, :, :2]
        return float(np.median((at.max(axis=1) - at.min(axis=1)).max(axis=1)))

    def deformed(self, state: State) -> Array:
        """Points (np, 3) of the surface at a state [m]."""
        return np.asarray(self._surface.points + self._surface.displacement(state))

    @property
    def at_first(self) -> Array:
        """Points (np, 3) of the surface before the riser came [m]."""
        return self._surface.points

    @property
    def measured(self) -> Array:
        """Points (np, 3) of the surface where areas are taken [m]."""
        return np.asarray(self._surface.points + self._surface.placed)

    @property
    def settled(self) -> Array:
        """Points (np, 3) of the surface as accepted so far [m]."""
        return np.asarray(self._surface.points + self._surface.committed)

    def stretch(self, deformed: Array, facets: IntArray) -> float:
        """Largest area of some facets of a deformed surface (np, 3), seen square to them at first, over that at first;
        1 of none.
        """
        now, before = (vector_areas(points[self.facets[facets]]) for points in (deformed, self.at_first))
        return float(np.max(np.sum(now * before, axis=1) / np.sum(before * before, axis=1), initial=1.0))

    def height(self, xy: Array, points: Array) -> Array:
        """Height (n,) [m] of the surface of some points at horizontal positions (n, 2) [m]; nan beside it."""
        found = self.heights(xy, points)
        return np.where(np.isfinite(found), found, np.nan)

    def heights(self, xy: Array, points: Array) -> Array:
        """Height (n,) [m] of the surface of some points at horizontal positions (n, 2) [m]; −inf beside it."""
        return np.asarray(heights(*self.locate(xy, points), self.corners, points))

    def heights_at(self, facet: IntArray, xi: Array, points: Array) -> Array:
        """Height (n,) [m] of the surface of some points at places on facets (n,); −inf where there is none."""
        return np.asarray(heights(facet, xi, self.facets, points))

    def locate(self, xy: Array, points: Array) -> tuple[IntArray, Array]:
        """Facet (n,), −1 outside, and place on it (n, 2) below positions xy (n, 2), at deformed points."""
        return self._pairing.locate(xy, points)

    def cover(self, points: Array | None = None) -> Cover:
        """The surface as what covers all below it, with its points at (np, 3) [m]; as accepted so far where none are
        given.
        """
        return self._pairing.cover(self.settled if points is None else points)

    def facet_dofs(self, facet: IntArray) -> IntArray:
        """Local dof numbers (n, 3·nv) of facets, node by node."""
        dofs = self._surface.offset + 3 * self.facets[facet][:, :, None] + np.arange(3)
        return dofs.reshape(len(facet), 3 * self.facets.shape[1])


@dataclass(frozen=True, eq=False)
class ActiveContacts:
    """Contact points that carry force; n points, nr dofs each, the riser's d translations first.

    node, facet (n,). length (n,): of riser [m]. penetration (n,) [m]. rows (n, nr): local dofs. forms (n, 5, nr),
    H (n, 2, 2): derivatives of the gap, see `gap`.
    """

    law: NormalLaw
    node: IntArray
    facet: IntArray
    length: Array
    penetration: Array
    rows: IntArray
    forms: Array
    H: Array

    @cached_property
    def _response(self) -> SeabedResponse:
        return self.law.update(self.penetration, self.law.initial_history(self.penetration.shape))

    @cached_property
    def force(self) -> Array:
        """Contact force of each point (n,) [N], ≥ 0."""
        return self.length * self._response.force

    @cached_property
    def gradient(self) -> Array:
        """dψ/du (n, nr) [N]: minus the forces on riser and soil."""
        return np.asarray(-self.force[:, None] * self.forms[:, 0])

    @property
    def hessian(self) -> Array:
        """d²ψ/du² (n, nr, nr) [N/m]."""
        return penalty_hessian(self.forms, self.H, self.force, self.length * self._response.slope)

    @property
    def potential(self) -> float:
        """ψ [J]."""
        return float(self.length @ self._response.stored)


@dataclass(frozen=True, eq=False)
class ContactState:
    """Contact points at a state, and where they stand. surface (np, 3): deformed points of the soil [m]. touching: what
    of them touches.
    """

    points: ContactPoints
    below: PointsBelow
    surface: Array
    touching: ActiveContacts


class ContactDetection:
    """Contact detection between riser and soil: `detect` gives gaps and contact forces at a state.

    radius (nn,): [m] from the axis to the line that touches. near: height [m] over the soil's highest point up to which
    nodes are looked at.
    """

    def __init__(
        self, line: Line, radius: Array, points: ContactPoints, law: NormalLaw, soil: DeformedSurface, near: float
    ) -> None:
        self._line, self._radius, self._points = line, radius, points
        self._law, self._soil, self._near = law, soil, near

    def detect(self, state: State) -> ContactState:
        """Gaps at a state, and forces where the riser touches."""
        x, surface = self._line.positions3(state), self._soil.deformed(state)
        below = points_below(len(self._points.node))
        level = float(surface[:, 2].max()) + self._near
        find_below(x, self._radius, self._points, level, self._soil.cover(surface), below)
        return ContactState(self._points, below, surface, self._touch(below, surface))

    def _touch(self, below: PointsBelow, surface: Array) -> ActiveContacts:
        at = np.flatnonzero(below.gap < self._law.start)
        node, facet = self._points.node[at], below.facet[at]
        forms, H = gap_forms(facet, below.xi[at], self._soil.facets, surface)
        rows = np.hstack((self._line.translation_dofs[node], self._soil.facet_dofs(facet)))
        given = self._points.length[at], -below.gap[at], rows, within_line(forms, self._line.basis), H
        return ActiveContacts(self._law, node, facet, *given)


@njit
def add_shares(values: Array, rows: IntArray, shares: Array) -> None:
    """Add shares (n, nr) to values at rows (n, nr), which may repeat."""
    for i in range(rows.shape[0]):
        for j in range(rows.shape[1]):
            values[rows[i, j]] += shares[i, j]


@njit
def add_blocks(values: Array, places: IntArray, blocks: Array) -> None:
    """Add blocks (n, nr, nr) to values[places], which may repeat; blocks at −1 are left out."""
    for i in range(places.size):
        if places[i] >= 0:
            values[places[i]] += blocks[i]


@dataclass(frozen=True, eq=False)
class CandidatePairs:
    """Candidate pairs of a node and a facet, sorted and without repetition.

    pairs (mp,): node·facets + facet, where `facets` is the number of facets.
    """

    facets: int
    pairs: IntArray

    @classmethod
    def of(cls, facets: int, node: IntArray, facet: IntArray) -> CandidatePairs:
        """Candidates from lists (n,) of a node and the facet below it."""
        return cls(facets, np.unique(node * facets + facet))

    @classmethod
    def none(cls, facets: int) -> CandidatePairs:
        """No candidates."""
        return cls(facets, EMPTY)

    def joined(self, other: CandidatePairs) -> CandidatePairs:
        """The candidates of both."""
        return CandidatePairs(self.facets, np.union1d(self.pairs, other.pairs).astype(np.int64))

    @cached_property
    def filled(self) -> BoolArray:
        """Whether each pair's block of the tangent was written to, see `MatrixBlock`."""
        return np.zeros(len(self.pairs), dtype=bool)

    @property
    def nodes(self) -> IntArray:
        return self.pairs // self.facets

    @property
    def facet(self) -> IntArray:
        return self.pairs % self.facets

    def places(self, node: IntArray, facet: IntArray) -> IntArray:
        """Position (n,) of pairs in the list, −1 for what is no candidate."""
        wanted = node * self.facets + facet
        if len(self.pairs) == 0:
            return np.full(len(wanted), -1)
        at = np.minimum(np.searchsorted(self.pairs, wanted), len(self.pairs) - 1)
        return np.where(self.pairs[at] == wanted, at, -1)


def pairs_around(nodes: IntArray, xy: Array, points: Array, facets: IntArray, distance: float) -> CandidatePairs:
    """Nodes (n,) at xy (n, 2), paired with all facets whose horizontal box is within a distance [m].

    points (np, 3): deformed points. facets (nf, nv).
    """
    boxes = bounds(points, facets)
    low, high = boxes[None, :, :2] - distance, boxes[None, :, 2:] + distance
    i, facet = np.nonzero(np.all((xy[:, None] >= low) & (xy[:, None] <= high), axis=2))
    return CandidatePairs.of(len(facets), nodes[i], facet)


@njit
def touching_boxes(low: Array, high: Array, points: Array, facets: IntArray) -> tuple[IntArray, IntArray]:
    """Pairs of boxes, low and high (n, 3), with facets whose boxes they touch, in increasing order: numbers of both,
    (m,) each.

    points (np, 3): deformed points. facets (nf, nv).
    """
    boxes, levels = bounds(points, facets), _levels(points, facets)
    found, top = [(0, 0) for _ in range(0)], levels[:, 1].max() if len(levels) else -np.inf
    for i in range(len(low)):
        if low[i, 2] > top:
            continue
        for f in range(len(boxes)):
            beside = low[i, 0] > boxes[f, 2] or high[i, 0] < boxes[f, 0]
            beside = beside or low[i, 1] > boxes[f, 3] or high[i, 1] < boxes[f, 1]
            if not (beside or low[i, 2] > levels[f, 1] or high[i, 2] < levels[f, 0]):
                found.append((i, f))
    first, second = np.empty(len(found), np.int64), np.empty(len(found), np.int64)
    for k, (i, f) in enumerate(found):
        first[k], second[k] = i, f
    return first, second


@njit
def _levels(points: Array, facets: IntArray) -> Array:
    """Lowest and highest level (nf, 2) of facets by those of their points (np, 3) [m]; curved ones bulge out."""
    out = np.empty((len(facets), 2))
    for f in range(len(facets)):
        lowest, highest = np.inf, -np.inf
        for a in facets[f]:
            lowest, highest = min(lowest, points[a, 2]), max(highest, points[a, 2])
        bulge = 0.2 * (highest - lowest)
        out[f, 0], out[f, 1] = lowest - bulge, highest + bulge
    return out
