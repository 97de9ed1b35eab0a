"""Which entries of the tangent contact may need: the candidates, kept until the riser moves out of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.arrays import Array, IntArray
from riser_soil.contact.pairing import bounds

EMPTY = np.empty(0, dtype=np.int64)


@dataclass(frozen=True, eq=False)
class Patch:
    """Candidate nodes and candidate pairs of a node and a facet, each list sorted and without repetition.

    nodes (m,). pairs (mp,): node·facets + facet, where `facets` is the number of facets.
    """

    facets: int
    nodes: IntArray
    pairs: IntArray

    @classmethod
    def of(cls, facets: int, node: IntArray, facet: IntArray) -> Patch:
        """Candidates from lists (n,) of a node and the facet below it, −1 for a plane."""
        on_soil = facet >= 0
        return cls(facets, np.unique(node[~on_soil]), np.unique(node[on_soil] * facets + facet[on_soil]))

    def joined(self, other: Patch) -> Patch:
        """The candidates of both."""
        nodes, pairs = np.union1d(self.nodes, other.nodes), np.union1d(self.pairs, other.pairs)
        return Patch(self.facets, nodes.astype(np.int64), pairs.astype(np.int64))

    @property
    def pair_nodes(self) -> IntArray:
        return self.pairs // max(self.facets, 1)

    @property
    def pair_facets(self) -> IntArray:
        return self.pairs % max(self.facets, 1)

    def places(self, node: IntArray, facet: IntArray) -> IntArray:
        """Position (n,) of nodes (facet −1) or pairs in their list, −1 for what is no candidate."""
        on_plane = _places(self.nodes, node)
        return np.where(facet < 0, on_plane, _places(self.pairs, node * self.facets + facet))


def nothing(facets: int) -> Patch:
    """No candidates."""
    return Patch(facets, EMPTY, EMPTY)


def around(nodes: IntArray, xy: Array, points: Array, facets: IntArray, distance: float) -> Patch:
    """Nodes (n,) at xy (n, 2), paired with all facets whose horizontal box is within a distance [m].

    points (np, 3): deformed points. facets (nf, nv), nf = 0 where there is no soil.
    """
    if len(facets) == 0:
        return Patch(0, nodes, EMPTY)
    boxes = bounds(points, facets)
    low, high = boxes[None, :, :2] - distance, boxes[None, :, 2:] + distance
    i, facet = np.nonzero(np.all((xy[:, None] >= low) & (xy[:, None] <= high), axis=2))
    return Patch(len(facets), nodes, np.unique(nodes[i] * len(facets) + facet))


def _places(known: IntArray, wanted: IntArray) -> IntArray:
    if len(known) == 0:
        return np.full(len(wanted), -1)
    at = np.minimum(np.searchsorted(known, wanted), len(known) - 1)
    return np.where(known[at] == wanted, at, -1)
