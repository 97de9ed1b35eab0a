"""The deformed soil surface under contact, and candidate pairs of a node or element of the riser and a facet.

Candidate pairs are all that may touch. They set the sparsity pattern of contact in the tangent.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.contact.facets import QUAD, heights, strips
from riser_soil.contact.pairing import Cover, FacetSearch, bounds
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.part import State
from riser_soil.soil.surface import vector_areas

if TYPE_CHECKING:
    from riser_soil.soil.condensed import SoilSurface

EMPTY = np.empty(0, dtype=np.int64)


class DeformedSurface:
    """The deformed surface: its facets, and the dofs of their nodes."""

    def __init__(self, surface: SoilSurface) -> None:
        self._surface = surface
        self._pairing = FacetSearch(surface.points, surface.facets)
        self.corners = self.facets = np.ascontiguousarray(surface.facets, dtype=np.int64)  # without those beside strips

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
        """Points (np, 3) of the surface where areas are measured [m]."""
        return np.asarray(self._surface.points + self._surface.placed)

    @property
    def settled(self) -> Array:
        """Points (np, 3) of the surface as accepted so far [m]."""
        return np.asarray(self._surface.points + self._surface.committed)

    @property
    def committed(self) -> Array:
        """Displacement (np, 3) of the surface as accepted so far [m]: another array once a step is."""
        return self._surface.committed

    def stretch(self, deformed: Array, facets: IntArray) -> float:
        """Largest area of some facets of a deformed surface (np, 3), projected along their first normals, over their
        first area; 1 of none.
        """
        now, before = (vector_areas(points[self.facets[facets]]) for points in (deformed, self.at_first))
        return float(np.max(np.sum(now * before, axis=1) / np.sum(before * before, axis=1), initial=1.0))

    def height(self, xy: Array, points: Array) -> Array:
        """Height (n,) [m] of the surface of some points at horizontal positions (n, 2) [m]; nan beside it."""
        height = self.heights(xy, points)
        return np.where(np.isfinite(height), height, np.nan)

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


@njit
def add_blocks(values: Array, places: IntArray, blocks: Array) -> None:
    """Add blocks (n, nr, nr) to values[places], which may repeat; blocks at −1 are left out."""
    for i in range(places.size):
        if places[i] >= 0:
            values[places[i]] += blocks[i]


@dataclass(frozen=True, eq=False)
class CandidatePairs:
    """Candidate pairs of a node or an element of the line and a facet, sorted and without repetition.

    pairs (mp,): number on the line · facets + facet, where `facets` is the number of facets.
    """

    facets: int
    pairs: IntArray

    @classmethod
    def of(cls, facets: int, on_line: IntArray, facet: IntArray) -> CandidatePairs:
        """Candidates from lists (n,) of a node or element and a facet near it."""
        return cls(facets, np.unique(on_line * facets + facet))

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
    def on_line(self) -> IntArray:
        """Nodes or elements (mp,) of the pairs."""
        return self.pairs // self.facets

    @property
    def facet(self) -> IntArray:
        """Facets (mp,) of the pairs."""
        return self.pairs % self.facets

    def places(self, on_line: IntArray, facet: IntArray) -> IntArray:
        """Position (n,) of pairs in the list, −1 for what is no candidate."""
        wanted = on_line * self.facets + facet
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
    touching, top = [(0, 0) for _ in range(0)], levels[:, 1].max() if len(levels) else -np.inf
    for i in range(len(low)):
        if low[i, 2] > top:
            continue
        for f in range(len(boxes)):
            beside = low[i, 0] > boxes[f, 2] or high[i, 0] < boxes[f, 0]
            beside = beside or low[i, 1] > boxes[f, 3] or high[i, 1] < boxes[f, 1]
            if not (beside or low[i, 2] > levels[f, 1] or high[i, 2] < levels[f, 0]):
                touching.append((i, f))
    first, second = np.empty(len(touching), np.int64), np.empty(len(touching), np.int64)
    for k, (i, f) in enumerate(touching):
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
