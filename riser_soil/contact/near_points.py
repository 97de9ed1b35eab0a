"""Search for the points of the soil's surface near the pipe, which is a cylinder around its curved axis.

The axis is the cubic c(s) = Σ N_a(s) q_a of a beam element. A point that has come through to above the axis is taken to
lie below it: the pipe pushes it down all the same. What lies beyond an element's reach is passed over, facet by facet
and row by row.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.contact.facets import QUAD, fill_shape
from riser_soil.contact.integration_points import area, place
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser.hermite import Four, bend, slope
from riser_soil.riser.hermite import shape as axis_shape

MAX_ITERATIONS = 30
CONVERGED = 1e-9  # step along an element, as a part of its length, after which one more would be below round-off
THROUGH = 0.5  # radii beside the axis within which a point above it has come through
ROUND_OFF = 1e-6  # by which a reach is widened, and below which a row lies along an element
THINNEST = 1e-3  # radii: nearer to the axis the direction from it means nothing


class Axis(NamedTuple):
    """The riser's axis in global axes: q (ne, 4, 3), see `hermite`, lengths and radii (ne,) [m]."""

    q: Array
    length: Array
    radius: Array


class Surface(NamedTuple):
    """facets (nf, nv); their divisions (nf, 2) and the numbers (nf,) of their first integration points; undeformed and
    deformed points (np, 3) [m].
    """

    facets: IntArray
    parts: IntArray
    first: IntArray
    at_first: Array
    deformed: Array


class NearPoints(NamedTuple):
    """Integration points near the pipe (n,): element, facet and number; place on the element's axis, 0 to 1; (xi, eta)
    (n, 2) on the facet; area [m2] and gap [m].
    """

    element: IntArray
    facet: IntArray
    number: IntArray
    along: Array
    xi: Array
    area: Array
    gap: Array

    def of(self, chosen: BoolArray) -> NearPoints:
        """Those points that are marked (n,)."""
        c = chosen
        whose = self.element[c], self.facet[c], self.number[c]
        return NearPoints(*whose, self.along[c], self.xi[c], self.area[c], self.gap[c])


@njit
def boxes(axis: Axis, above: float, around: float) -> tuple[Array, Array]:
    """Boxes, low and high (ne, 3), around the pipe's elements, as Bézier curves between their handles, wider by a reach
    above the ground and around the pipe [m].
    """
    low, high = np.empty((len(axis.length), 3)), np.empty((len(axis.length), 3))
    for e in range(len(low)):
        q, third = axis.q[e], axis.length[e] / 3.0
        for i in range(3):
            wide, a, b = axis.radius[e] + (above if i == 2 else around), q[0, i], q[2, i]
            c, d = a + q[1, i] * third, b - q[3, i] * third
            low[e, i], high[e, i] = min(a, b, c, d) - wide, max(a, b, c, d) + wide
    return low, high


def near_points(axis: Axis, surface: Surface, elements: IntArray, facets: IntArray, within: float) -> NearPoints:
    """Points of candidate pairs (m,) of an element and a facet whose gap is less than `within` [m]."""
    return NearPoints(*_near_points(axis, surface, *_by_facet(elements, facets, len(surface.facets)), within))


@njit
def _by_facet(elements: IntArray, facets: IntArray, count: int) -> tuple[IntArray, IntArray, IntArray]:
    """The m pairs, facet by facet of those that are in any: their elements (m,), in the order given; the facets (k,);
    where the elements of each begin (k + 1,).
    """
    counts = np.zeros(count + 1, np.int64)
    for f in facets:
        counts[f + 1] += 1
    paired = np.flatnonzero(counts[1:])
    begin = np.cumsum(counts)
    first, order, at = np.append(begin[paired], len(facets)), np.empty_like(elements), begin[:-1].copy()
    for k, f in enumerate(facets):
        order[at[f]] = elements[k]
        at[f] += 1
    return order, paired, first


@njit
def _near_points(
    axis: Axis, surface: Surface, elements: IntArray, facets: IntArray, begin: IntArray, within: float
) -> tuple[IntArray, IntArray, IntArray, Array, Array, Array, Array]:
    bow = _bow(axis)
    room = 0
    for f in facets:
        room += surface.parts[f, 0] * surface.parts[f, 1]
    element, facet, number = np.empty(room, np.int64), np.empty(room, np.int64), np.empty(room, np.int64)
    numbers, n, nv = np.empty((room, 5)), 0, surface.facets.shape[1]
    N, dN, kept = np.empty(nv), np.empty((nv, 2)), np.empty_like(elements)
    for i, f in enumerate(facets):
        nodes = surface.facets[f]
        near = elements[begin[i] : begin[i + 1]]
        rows, columns, even = 1, surface.parts[f, 0] * surface.parts[f, 1], nv == len(QUAD)
        if even:
            rows, columns = surface.parts[f, 0], surface.parts[f, 1]
            near = _not_beyond(axis, bow, near, surface.deformed, nodes, within)
        for row in range(rows if near.size > 0 else 0):
            beside, a, b = near, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
            first, last, clear_of, clearance = 0, columns, a, -np.inf
            if even:
                xi = -1.0 + (2 * row + 1) / rows
                a = point_on(surface.deformed, nodes, xi, -1.0, N, dN)
                b = point_on(surface.deformed, nodes, xi, 1.0, N, dN)
                first, last, count = _in_row(axis, bow, near, a, b, columns, within, kept)
                beside = kept[:count]
            for column in range(first, last):
                k = row * columns + column
                if even:
                    p = _between(a, b, (column + 0.5) / columns)
                else:
                    xi, eta, _ = place(nv, surface.parts[f], k)
                    p = point_on(surface.deformed, nodes, xi, eta, N, dN)
                if _distance(p, clear_of) <= clearance - within:
                    continue
                e, along, gap, clearance = _nearest(axis, bow, beside, p, within)
                clear_of = p
                if gap < within:
                    xi, eta, share = place(nv, surface.parts[f], k)
                    fill_shape(xi, eta, N, dN)
                    element[n], facet[n], number[n] = e, f, surface.first[f] + k
                    numbers[n, 0], numbers[n, 1], numbers[n, 2], numbers[n, 3] = along, gap, xi, eta
                    numbers[n, 4] = share * area(surface.at_first, nodes, dN)
                    n += 1
    values = numbers[:n]
    whose = element[:n], facet[:n], number[:n]
    return *whose, values[:, 0].copy(), values[:, 2:4].copy(), values[:, 4].copy(), values[:, 1].copy()


@njit
def _not_beyond(
    axis: Axis, bow: Array, elements: IntArray, points: Array, nodes: IntArray, within: float
) -> IntArray:
    """Those elements to which a point between a facet's corners may have a gap less than `within` [m]: seen from the
    line through the element's ends towards the corners' middle, some corner is no farther than that.
    """
    kept, n = np.empty(len(elements), np.int64), 0
    for e in elements:
        least = _least_beside(axis.q[e], points, nodes)
        if least < (axis.radius[e] + within + bow[e]) * (1.0 + ROUND_OFF):
            kept[n] = e
            n += 1
    return kept[:n]


@njit
def _least_beside(q: Array, points: Array, nodes: IntArray) -> float:
    """Least distance [m] of some points from the line through an element's ends in the direction, square to that line,
    of the points' mean; no point between them is nearer to the line.
    """
    chord = (q[2, 0] - q[0, 0], q[2, 1] - q[0, 1], q[2, 2] - q[0, 2])
    x = y = z = 0.0
    for a in nodes:
        x, y, z = x + points[a, 0] - q[0, 0], y + points[a, 1] - q[0, 1], z + points[a, 2] - q[0, 2]
    square = chord[0] ** 2 + chord[1] ** 2 + chord[2] ** 2
    share = (x * chord[0] + y * chord[1] + z * chord[2]) / square if square > 0.0 else 0.0
    x, y, z = x - share * chord[0], y - share * chord[1], z - share * chord[2]
    size, least = math.sqrt(x * x + y * y + z * z), np.inf
    if not size > 0.0:
        return 0.0
    for a in nodes:
        beside = x * (points[a, 0] - q[0, 0]) + y * (points[a, 1] - q[0, 1]) + z * (points[a, 2] - q[0, 2])
        least = min(least, beside / size)
    return least


@njit
def _in_row(
    axis: Axis,
    bow: Array,
    elements: IntArray,
    a: tuple[float, float, float],
    b: tuple[float, float, float],
    count: int,
    within: float,
    kept: IntArray,
) -> tuple[int, int, int]:
    """First and behind the last of `count` points, evenly spaced on the straight row from a to b, that may have a gap
    less than `within` [m] to some of the elements: those nearer to the lines through the elements' ends than that. Such
    elements, whose ends the row does not lie farther beyond either, are written to `kept`; last their number.
    """
    low, high, n = 1.0, 0.0, 0
    for e in elements:
        q = axis.q[e]
        reach = (axis.radius[e] + within + bow[e]) * (1.0 + ROUND_OFF)
        cc = cw = cd = ww = wd = dd = 0.0
        for i in range(3):
            c, w, d = q[2, i] - q[0, i], a[i] - q[0, i], b[i] - a[i]
            cc, cw, cd = cc + c * c, cw + c * w, cd + c * d
            ww, wd, dd = ww + w * w, wd + w * d, dd + d * d
        ahead = max(-max(cw, cw + cd), min(cw, cw + cd) - cc)
        if ahead > reach * math.sqrt(cc):
            continue
        kept[n] = e
        inverse = 1.0 / cc if cc > 0.0 else 0.0
        square, tilt, at_a = dd - cd * cd * inverse, wd - cw * cd * inverse, ww - cw * cw * inverse - reach * reach
        root = tilt * tilt - square * at_a
        if square <= ROUND_OFF * dd or not root < np.inf:  # along the element, or nowhere
            low, high, n = 0.0, 1.0, n + 1
        elif root >= 0.0:
            low = min(low, (-tilt - math.sqrt(root)) / square)
            high, n = max(high, (-tilt + math.sqrt(root)) / square), n + 1
    first, last = max(math.floor(low * count - 0.5), 0), min(math.ceil(high * count - 0.5) + 1, count)
    return int(min(first, count)), int(max(last, 0)), n


@njit
def _between(a: tuple[float, float, float], b: tuple[float, float, float], share: float) -> tuple[float, float, float]:
    """The point at a share of the way from a to b."""
    return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])


@njit
def point_on(
    points: Array, nodes: IntArray, xi: float, eta: float, N: Array, dN: Array
) -> tuple[float, float, float]:
    """Place of a point on a facet [m]; writes the shape functions there to N and dN, see `fill_shape`."""
    fill_shape(xi, eta, N, dN)
    x = y = z = 0.0
    for a in range(len(nodes)):
        x += N[a] * points[nodes[a], 0]
        y += N[a] * points[nodes[a], 1]
        z += N[a] * points[nodes[a], 2]
    return x, y, z


@njit
def _nearest(
    axis: Axis, bow: Array, elements: IntArray, p: tuple[float, float, float], within: float
) -> tuple[int, float, float, float]:
    """Of some elements the one whose axis comes nearest to a point, the place on it, and the gap [m]; the first where
    two come as near. -1 where none can come within that gap. Last the clearance [m]: no gap is less.
    """
    nearest, place_on, gap, distance, clearance = -1, 0.0, np.inf, np.inf, np.inf
    for e in elements:
        beside = _from_chord(axis.q[e], p) - bow[e]
        clearance = min(clearance, beside - axis.radius[e])
        if beside - axis.radius[e] >= within or beside >= distance:
            continue
        along = _closest(axis.q[e], axis.length[e], p)
        c = combined(axis.q[e], axis_shape(along, axis.length[e]))
        rho = signed_distance(c, p, axis.radius[e])
        if abs(rho) < distance:
            nearest, place_on, gap, distance = e, along, rho - axis.radius[e], abs(rho)
    return nearest, place_on, gap, clearance


@njit
def _distance(p: tuple[float, float, float], r: tuple[float, float, float]) -> float:
    return math.sqrt((p[0] - r[0]) ** 2 + (p[1] - r[1]) ** 2 + (p[2] - r[2]) ** 2)


@njit
def _from_chord(q: Array, p: tuple[float, float, float]) -> float:
    """Distance of a point from the straight line between an element's ends [m]."""
    share, beside = _along_chord(q, p), 0.0
    for i in range(3):
        beside += (p[i] - q[0, i] - share * (q[2, i] - q[0, i])) ** 2
    return math.sqrt(beside)


@njit
def _along_chord(q: Array, p: tuple[float, float, float]) -> float:
    """Place, 0 to 1, on the straight line between an element's ends that is closest to a point."""
    along = square = 0.0
    for i in range(3):
        chord = q[2, i] - q[0, i]
        along += (p[i] - q[0, i]) * chord
        square += chord * chord
    return min(max(along / square, 0.0), 1.0) if square > 0.0 else 0.0


@njit
def _bow(axis: Axis) -> Array:
    """How far (ne,) the axis leaves the chord at most [m], stretched as it may be: being a Bézier curve, no farther
    than 3/4 of what its handles do, whose weights sum to that at most.
    """
    out = np.empty(len(axis.length))
    for e in range(len(out)):
        q, third = axis.q[e], axis.length[e] / 3.0
        first, last = combined(q, (1.0, third, 0.0, 0.0)), combined(q, (1.0, 0.0, 0.0, third))
        out[e] = 0.75 * max(_from_chord(q, first), _from_chord(q, last))
    return out


@njit
def signed_distance(c: tuple[float, float, float], p: tuple[float, float, float], radius: float) -> float:
    """Distance of p from the axis at c [m], < 0 where it has come through to above."""
    x, y, z = p[0] - c[0], p[1] - c[1], p[2] - c[2]
    beside = math.sqrt(x * x + y * y)
    rho = max(math.sqrt(beside * beside + z * z), THINNEST * radius)
    return -rho if z > 0.0 and beside < THROUGH * radius else rho


@njit
def _closest(q: Array, L: float, p: tuple[float, float, float]) -> float:
    """Place xi in 0..1 on an element's axis that is closest to a point."""
    xi = _along_chord(q, p)
    for _ in range(MAX_ITERATIONS):
        c, c1 = combined(q, axis_shape(xi, L)), combined(q, slope(xi, L))
        c2 = combined(q, bend(xi, L))
        against = ahead = turning = 0.0
        for i in range(3):
            against += (p[i] - c[i]) * c1[i]
            ahead += c1[i] * c1[i]
            turning += (p[i] - c[i]) * c2[i]
        rate = ahead - turning
        if rate <= 0.1 * ahead:  # far from the axis, beyond its centre of curvature
            rate = ahead
        new = min(max(xi + against / (rate * L), 0.0), 1.0)
        step, xi = abs(new - xi), new
        if step < CONVERGED:
            break
    return xi


@njit
def combined(q: Array, N: Four) -> tuple[float, float, float]:
    """Sum of the q (4, 3) of an element by their shape functions."""
    x = N[0] * q[0, 0] + N[1] * q[1, 0] + N[2] * q[2, 0] + N[3] * q[3, 0]
    y = N[0] * q[0, 1] + N[1] * q[1, 1] + N[2] * q[2, 1] + N[3] * q[3, 1]
    z = N[0] * q[0, 2] + N[1] * q[1, 2] + N[2] * q[2, 2] + N[3] * q[3, 2]
    return x, y, z
