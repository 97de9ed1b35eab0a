"""Contact search: the surface facet below a point, and the local coordinates on it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.contact.facets import QUAD, centre, fill_shape, inside
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit

RIM = 1e-9  # widening of a facet in (ξ, η): round-off must not open a slit between neighbours
ON_SIDE = 1e-12  # part of a side's length up to which a point is on it
MAX_ITERATIONS = 25
DIVERGED = 100.0  # (ξ, η) of a point that is nowhere near
CONVERGED = 1e-10  # step in (ξ, η) after which one more Newton step would be below round-off


class Plan(NamedTuple):
    """Equal rectangles over a surface in plan, row by row along y, and the facets whose boxes touch each.

    corner, size (2,): of the lowest rectangle [m]. counts (2,): of rectangles along x and y. Facets of rectangle k:
    facets[first[k] : first[k + 1]].
    """

    corner: Array
    size: Array
    counts: IntArray
    first: IntArray
    facets: IntArray


class Cover(NamedTuple):
    """A surface that covers what lies below it, for compiled code. points (np, 3) [m] with the boxes of their facets,
    see `bounds`, and the box around these; work (nv, 3), xy and xi (2,): workspace.
    """

    plan: Plan
    facets: IntArray
    points: Array
    boxes: Array
    limits: Array
    work: Array
    xy: Array
    xi: Array

    def renew(self, points: Array) -> None:
        """Move the points to other places (np, 3) [m]."""
        self.points[...] = points
        self.boxes[...] = bounds(points, self.facets)
        self.limits[...] = limits_of(self.boxes)


class FacetSearch:
    """Finds facets below points by a plan of the facets and Newton's method on the facets' map.

    The plan shows the reference geometry and only proposes: a point that no facet proposed holds is looked for in all
    of them. The answer depends on the deformed geometry alone. A point on the rim of several facets belongs to the one
    with the lowest number.

    points (np, 3): reference points [m]. facets (nf, 4 or 6): their points, ordered as in `facets`.
    """

    def __init__(self, points: Array, facets: IntArray) -> None:
        self._facets = np.ascontiguousarray(facets, dtype=np.int64)
        self._plan = _plan(bounds(points, self._facets))

    def cover(self, points: Array) -> Cover:
        """The facets as what covers all below them, with their points at (np, 3) [m], which may be renewed."""
        boxes, work = bounds(points, self._facets), np.empty((self._facets.shape[1], 3))
        cover = Cover(self._plan, self._facets, points.copy(), boxes, np.empty(4), work, np.empty(2), np.empty(2))
        cover.renew(points)
        return cover

    def locate(self, xy: Array, points: Array) -> tuple[IntArray, Array]:
        """Facet (n,), −1 where there is none, and (ξ, η) on it (n, 2), of horizontal positions xy (n, 2).

        points (np, 3): the deformed points [m].
        """
        facet_and_xi: tuple[IntArray, Array] = _locate(np.ascontiguousarray(xy), self._plan, self._facets, points)
        return facet_and_xi


def _plan(boxes: Array) -> Plan:
    """A grid of about as many rectangles as facets, each about as long as wide; boxes as of `bounds`."""
    corner, extent = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0) - boxes[:, :2].min(axis=0)
    counts = np.ceil(np.sqrt(len(boxes) * extent / extent[::-1])).astype(np.int64)
    size = extent / counts
    low, high = (((ends - corner) / size).astype(np.int64) for ends in (boxes[:, :2], boxes[:, 2:]))
    high = np.minimum(high, counts - 1)
    touched = [
        (np.arange(y0, y1 + 1)[:, None] * counts[0] + np.arange(x0, x1 + 1)).ravel()
        for (x0, y0), (x1, y1) in zip(low, high, strict=True)
    ]
    rectangles, facets = np.concatenate(touched), np.repeat(np.arange(len(boxes)), [len(part) for part in touched])
    order = np.argsort(rectangles, kind="stable")
    first = np.append(0, np.cumsum(np.bincount(rectangles, minlength=int(counts.prod()))))
    return Plan(corner, size, counts, first, facets[order])


@njit
def renew_boxes(cover: Cover, facets: IntArray) -> None:
    """Write the boxes of facets (k,) whose points have moved, and the box around all."""
    for f in facets:
        box = _box(cover.points, cover.facets[f])
        for i in range(4):
            cover.boxes[f, i] = box[i]
    limits = limits_of(cover.boxes)
    for i in range(4):
        cover.limits[i] = limits[i]


@njit
def bounds(points: Array, facets: IntArray) -> Array:
    """Horizontal boxes (nf, 4) around facets: lowest x and y, highest x and y [m]; see `_box`."""
    boxes = np.empty((len(facets), 4))
    for i in range(len(facets)):
        boxes[i] = _box(points, facets[i])
    return boxes


@njit
def _box(points: Array, nodes: IntArray) -> tuple[float, float, float, float]:
    """Horizontal box around points, wider by a fifth: curved facets may bulge out of their nodes' box."""
    x0, y0, x1, y1 = np.inf, np.inf, -np.inf, -np.inf
    for p in nodes:
        x0, x1 = min(x0, points[p, 0]), max(x1, points[p, 0])
        y0, y1 = min(y0, points[p, 1]), max(y1, points[p, 1])
    dx, dy = 0.2 * (x1 - x0), 0.2 * (y1 - y0)
    return x0 - dx, y0 - dy, x1 + dx, y1 + dy


@njit
def _locate(xy: Array, plan: Plan, facets: IntArray, points: Array) -> tuple[IntArray, Array]:
    facet, xi = np.full(len(xy), -1), np.zeros((len(xy), 2))
    boxes, work = bounds(points, facets), np.empty((facets.shape[1], 3))
    limits = limits_of(boxes)
    for i in range(len(xy)):
        facet[i] = _holding(xy[i], plan, facets, points, boxes, limits, work, xi[i])
    return facet, xi


@njit
def limits_of(boxes: Array) -> Array:
    """The box (4,) around boxes (nf, 4)."""
    low_x, low_y, high_x, high_y = np.inf, np.inf, -np.inf, -np.inf
    for f in range(len(boxes)):
        low_x, low_y = min(low_x, boxes[f, 0]), min(low_y, boxes[f, 1])
        high_x, high_y = max(high_x, boxes[f, 2]), max(high_y, boxes[f, 3])
    return np.array([low_x, low_y, high_x, high_y])


@njit
def _holding(
    xy: Array,
    plan: Plan,
    facets: IntArray,
    points: Array,
    boxes: Array,
    limits: Array,
    work: Array,
    xi: Array,
) -> int:
    """The facet that holds a point (2,), -1 where none does; its (ξ, η) go to xi."""
    if not (limits[0] <= xy[0] <= limits[2] and limits[1] <= xy[1] <= limits[3]):
        return -1
    facet = _lowest_holding(xy, _proposed(plan, xy), facets, points, boxes, work, xi)
    if facet < 0:
        facet = _lowest_holding(xy, np.arange(len(facets)), facets, points, boxes, work, xi)
    return facet


@njit
def _proposed(plan: Plan, xy: Array) -> IntArray:
    """Facets whose boxes touch the rectangle of a point, or the nearest one."""
    column = min(max(int((xy[0] - plan.corner[0]) / plan.size[0]), 0), plan.counts[0] - 1)
    row = min(max(int((xy[1] - plan.corner[1]) / plan.size[1]), 0), plan.counts[1] - 1)
    k = row * plan.counts[0] + column
    return plan.facets[plan.first[k] : plan.first[k + 1]]


@njit
def _lowest_holding(
    xy: Array, tried: IntArray, facets: IntArray, points: Array, boxes: Array, work: Array, xi: Array
) -> int:
    """The lowest-numbered facet among the tried ones that holds the point, else −1; its (ξ, η) go to xi."""
    best, x, y = -1, xy[0], xy[1]
    for f in tried:
        out_of_x, out_of_y = not boxes[f, 0] <= x <= boxes[f, 2], not boxes[f, 1] <= y <= boxes[f, 3]
        if out_of_x or out_of_y or (best >= 0 and f > best):
            continue
        converged, s, t = invert(xy, points, facets[f], work)
        if converged and inside(facets.shape[1], s, t, RIM):
            best = f
            xi[0], xi[1] = s, t
    return best


@njit
def invert(xy: Array, points: Array, nodes: IntArray, work: Array) -> tuple[bool, float, float]:
    """Solve Σ N_a(ξ, η) p_a = xy for (ξ, η) by Newton's method from the facet's middle.

    nodes (nv,): the facet. work (nv, 3): scratch. The first value is whether it has converged.
    """
    N, dN = work[:, 0], work[:, 1:]
    s, t = centre(len(nodes))
    for _ in range(MAX_ITERATIONS):
        fill_shape(s, t, N, dN)
        ds, dt = _newton_step(xy, points, nodes, N, dN)
        s, t = s + ds, t + dt
        if abs(ds) + abs(dt) < CONVERGED:
            return True, s, t
        if not abs(s) + abs(t) < DIVERGED:
            return False, s, t
    return False, s, t


@njit
def _newton_step(xy: Array, points: Array, nodes: IntArray, N: Array, dN: Array) -> tuple[float, float]:
    """Step in (ξ, η); infinite where the map is singular."""
    rx, ry = xy[0], xy[1]
    a = b = c = d = 0.0
    for i in range(len(nodes)):
        x, y = points[nodes[i], 0], points[nodes[i], 1]
        rx, ry = rx - N[i] * x, ry - N[i] * y
        a, b = a + dN[i, 0] * x, b + dN[i, 1] * x
        c, d = c + dN[i, 0] * y, d + dN[i, 1] * y
    det = a * d - b * c
    if det == 0.0:
        return np.inf, np.inf
    return (d * rx - b * ry) / det, (a * ry - c * rx) / det


@njit
def facet_below(cover: Cover, x: float, y: float, previous: int) -> int:
    """A facet below a horizontal position [m]: that of last time, `previous`, where it still is one, else the one that
    `FacetSearch.locate` finds; -1 where none is.
    """
    if previous >= 0 and _within_corners(cover.points, cover.facets[previous], x, y):
        return previous
    cover.xy[0], cover.xy[1] = x, y
    surface = cover.plan, cover.facets, cover.points, cover.boxes, cover.limits
    return _holding(cover.xy, *surface, cover.work, cover.xi)


@njit
def _within_corners(points: Array, nodes: IntArray, x: float, y: float) -> bool:
    """Whether a position lies within a facet with straight sides, seen from above."""
    if nodes.size != len(QUAD):
        return False
    for a in range(nodes.size):
        p, r = nodes[a], nodes[(a + 1) % nodes.size]
        along_x, along_y = points[r, 0] - points[p, 0], points[r, 1] - points[p, 1]
        across = along_x * (y - points[p, 1]) - along_y * (x - points[p, 0])
        if not across >= -ON_SIDE * (along_x * along_x + along_y * along_y):
            return False
    return True
