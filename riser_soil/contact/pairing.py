"""Which facet of a surface lies under a point, and where on it."""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.spatial import cKDTree

from riser_soil.arrays import Array, IntArray
from riser_soil.contact.facets import centre, inside, shape

NEIGHBOURS = 8  # facets tried first; a point that none of them holds is looked for in all facets
RIM = 1e-9  # widening of a facet in (ξ, η): round-off must not open a slit between neighbours
MAX_ITERATIONS = 25
CONVERGED = 1e-10  # step in (ξ, η) after which one more Newton step would be below round-off


class Pairing:
    """Finds facets below points by a tree over the facets' centres and Newton's method on the facets' map.

    The tree holds the reference geometry and only proposes; the answer depends on the deformed geometry
    alone. A point on the rim of several facets belongs to the one with the lowest number.

    points (np, 3): reference points [m]. facets (nf, 4 or 6): their points, ordered as in `facets`.
    """

    def __init__(self, points: Array, facets: IntArray) -> None:
        self._facets = np.ascontiguousarray(facets, dtype=np.int64)
        corners = self._facets[:, : 4 if facets.shape[1] == 4 else 3]
        self._tree = cKDTree(points[corners].mean(axis=1)[:, :2])
        self._tried = np.arange(1, min(NEIGHBOURS, len(facets)) + 1)

    def locate(self, xy: Array, points: Array) -> tuple[IntArray, Array]:
        """Facet (n,), −1 where there is none, and (ξ, η) on it (n, 2), of horizontal positions xy (n, 2).

        points (np, 3): the deformed points [m].
        """
        xy = np.ascontiguousarray(xy)
        _, near = self._tree.query(xy, self._tried)
        boxes = bounds(points, self._facets)
        found: tuple[IntArray, Array] = _locate(xy, near.astype(np.int64), self._facets, points, boxes)
        return found


def bounds(points: Array, facets: IntArray) -> Array:
    """Horizontal boxes (nf, 2, 2) around facets, [lowest, highest] × [x, y] in m.

    They are widened by a fifth of their size: the sides of a curved facet may bulge out of the box of its
    points.
    """
    at = points[facets][:, :, :2]
    low, high = at.min(axis=1), at.max(axis=1)
    margin = 0.2 * (high - low)
    return np.stack((low - margin, high + margin), axis=1)


@njit(cache=True)
def _locate(
    xy: Array, near: IntArray, facets: IntArray, points: Array, boxes: Array
) -> tuple[IntArray, Array]:
    facet, xi = np.full(len(xy), -1), np.zeros((len(xy), 2))
    everything = np.arange(len(facets))
    for i in range(len(xy)):
        facet[i] = _lowest_holding(xy[i], near[i], facets, points, boxes, xi[i])
        if facet[i] < 0:
            facet[i] = _lowest_holding(xy[i], everything, facets, points, boxes, xi[i])
    return facet, xi


@njit(cache=True)
def _lowest_holding(
    xy: Array, tried: IntArray, facets: IntArray, points: Array, boxes: Array, xi: Array
) -> int:
    """The lowest-numbered facet among the tried ones that holds the point, else −1; its (ξ, η) go to xi."""
    best = -1
    for f in tried:
        box = boxes[f]
        out_of_box = xy[0] < box[0, 0] or xy[0] > box[1, 0] or xy[1] < box[0, 1] or xy[1] > box[1, 1]
        if out_of_box or (best >= 0 and f > best):
            continue
        converged, s, t = invert(xy, points, facets[f])
        if converged and inside(facets.shape[1], s, t, RIM):
            best = f
            xi[0], xi[1] = s, t
    return best


@njit(cache=True)
def invert(xy: Array, points: Array, nodes: IntArray) -> tuple[bool, float, float]:
    """Solve Σ N_a(ξ, η) p_a = xy for (ξ, η) by Newton's method from the facet's middle; the first value tells
    success.
    """
    s, t = centre(len(nodes))
    for _ in range(MAX_ITERATIONS):
        N, dN, _ = shape(len(nodes), s, t)
        rx, ry = xy
        a = b = c = d = 0.0
        for i, p in enumerate(nodes):
            x, y = points[p, 0], points[p, 1]
            rx, ry = rx - N[i] * x, ry - N[i] * y
            a, b = a + dN[i, 0] * x, b + dN[i, 1] * x
            c, d = c + dN[i, 0] * y, d + dN[i, 1] * y
        det = a * d - b * c
        if det == 0.0:
            return False, s, t
        ds, dt = (d * rx - b * ry) / det, (a * ry - c * rx) / det
        s, t = s + ds, t + dt
        if abs(ds) + abs(dt) < CONVERGED:
            return True, s, t
        if abs(s) + abs(t) > 100.0:
            return False, s, t
    return False, s, t
