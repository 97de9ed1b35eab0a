"""Candidate contact pairs, which set the sparsity pattern of contact in the tangent."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.contact.pairing import bounds
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import njit

EMPTY = np.empty(0, dtype=np.int64)


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
        """Those pairs whose blocks of the tangent are written to, see `MatrixBlock`."""
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
