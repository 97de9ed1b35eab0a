"""Search for the points of the soil's surface near the pipe, which is a cylinder around its curved axis.

What lies beyond an element's reach is passed over, facet by facet and row by row.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.contact.closest_point import Axis, bow_of, nearest
from riser_soil.contact.facets import QUAD, fill_shape
from riser_soil.contact.integration_points import Place, area, between, row_of
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser.vectors import Vec, add, norm, scale, sub

ROUND_OFF = 1e-6  # by which a reach is widened, and below which a row lies along an element
FEW = 4096  # points for which there is room at first


class Surface(NamedTuple):
    """facets (nf, nv); their `divisions` (nf, 5) and the numbers (nf,) of their first integration points; points
    (np, 3) [m] where areas are measured, and at a state.
    """

    facets: IntArray
    parts: IntArray
    first: IntArray
    measured: Array
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


class PairsByFacet(NamedTuple):
    """Pairs of an element and a facet: those of facets[i] are elements[begin[i] : begin[i + 1]]; facets without any are
    left out.
    """

    elements: IntArray
    facets: IntArray
    begin: IntArray


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
    pairs, capacity = by_facet(elements, facets, len(surface.facets)), FEW
    while True:
        points = points_workspace(capacity)
        count = fill_near(axis, surface, pairs, within, points)
        if count <= capacity:
            return first_of(points, count)
        capacity = count


def points_workspace(count: int) -> NearPoints:
    """Workspace for so many points."""
    element, facet, number = (np.empty(count, dtype=np.int64) for _ in range(3))
    along, share, gap = (np.empty(count) for _ in range(3))
    return NearPoints(element, facet, number, along, np.empty((count, 2)), share, gap)


@njit
def first_of(points: NearPoints, n: int) -> NearPoints:
    """The first n points."""
    return NearPoints(
        points.element[:n],
        points.facet[:n],
        points.number[:n],
        points.along[:n],
        points.xi[:n],
        points.area[:n],
        points.gap[:n],
    )


@njit
def by_facet(elements: IntArray, facets: IntArray, count: int) -> PairsByFacet:
    """Pairs (m,) of an element and a facet, facet by facet of `count`."""
    counts = np.zeros(count + 1, np.int64)
    for f in facets:
        counts[f + 1] += 1
    paired = np.flatnonzero(counts[1:])
    begin = np.cumsum(counts)
    first, order, at = np.append(begin[paired], len(facets)), np.empty_like(elements), begin[:-1].copy()
    for k, f in enumerate(facets):
        order[at[f]] = elements[k]
        at[f] += 1
    return PairsByFacet(order, paired, first)


@njit
def fill_near(axis: Axis, surface: Surface, pairs: PairsByFacet, within: float, out: NearPoints) -> int:
    """Write points of some pairs whose gap is less than `within` [m], as far as there is room; how many there are."""
    bow = bow_of(axis)
    capacity, n, nv = len(out.gap), 0, surface.facets.shape[1]
    N, dN, hull, in_reach = np.empty(nv), np.empty((nv, 2)), np.empty((nv, 3)), np.empty_like(pairs.elements)
    for i, f in enumerate(pairs.facets):
        nodes, cut = surface.facets[f], surface.parts[f]
        rows, columns = cut[0], cut[1]
        _write_hull(surface.deformed, nodes, hull)
        near = _not_beyond(axis, bow, pairs.elements[pairs.begin[i] : pairs.begin[i + 1]], hull, within)
        for row in range(rows if near.size > 0 else 0):
            first, last, share = row_of(nv, cut, row)
            a, b, bends = _curve(surface.deformed, nodes, first, last, N, dN)
            aside = max(norm(bends[0]), norm(bends[1]))
            column, behind, count = _in_row(axis, bow, near, a, b, columns, within + 0.75 * aside, in_reach)
            beside, apart = in_reach[:count], (norm(sub(b, a)) + 3.0 * aside) / columns
            while column < behind:
                part = (column + 0.5) / columns
                p = _on_curve(a, b, bends, part)
                e, along, gap, clearance = nearest(axis, bow, beside, p, within)
                if gap < within:
                    if n < capacity:
                        xi, eta = first[0] + part * (last[0] - first[0]), first[1] + part * (last[1] - first[1])
                        fill_shape(xi, eta, N, dN)
                        out.element[n], out.facet[n] = e, f
                        out.number[n] = surface.first[f] + row * columns + column
                        out.along[n], out.xi[n, 0], out.xi[n, 1], out.gap[n] = along, xi, eta, gap
                        out.area[n] = share * area(surface.measured, nodes, dN)
                    n += 1
                column += 1 + _clear_points(clearance - within, apart, columns)
    return n


@njit
def _curve(
    points: Array, nodes: IntArray, first: Place, last: Place, N: Array, dN: Array
) -> tuple[Vec, Vec, tuple[Vec, Vec]]:
    """A row on a facet: its ends [m], and by how much the two handles of its Bézier curve between them, a cubic one at
    most, lie off the thirds of the straight line; from its points at the thirds.
    """
    a, b = point_on(points, nodes, *first, N, dN), point_on(points, nodes, *last, N, dN)
    if len(nodes) == len(QUAD):
        return a, b, ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    third, two = between(first, last, 1.0 / 3.0), between(first, last, 2.0 / 3.0)
    c = sub(point_on(points, nodes, *third, N, dN), add(scale(2.0 / 3.0, a), scale(1.0 / 3.0, b)))
    d = sub(point_on(points, nodes, *two, N, dN), add(scale(1.0 / 3.0, a), scale(2.0 / 3.0, b)))
    return a, b, (sub(scale(3.0, c), scale(1.5, d)), sub(scale(3.0, d), scale(1.5, c)))


@njit
def _on_curve(a: Vec, b: Vec, bends: tuple[Vec, Vec], share: float) -> Vec:
    """The point at a share of the way along a row, see `_curve`: no farther off the straight line than 3/4 of a bend,
    and faster along than that by three times a bend at most.
    """
    rest = 1.0 - share
    bend = 3.0 * share * rest
    straight = add(scale(rest, a), scale(share, b))
    return add(straight, add(scale(bend * rest, bends[0]), scale(bend * share, bends[1])))


@njit
def _clear_points(clear: float, apart: float, most: int) -> int:
    """How many points of a row, no farther apart than that [m], lie within a distance that is clear [m]."""
    if not clear > 0.0:
        return 0
    return int(clear / apart) if clear < most * apart else most


@njit
def _write_hull(points: Array, nodes: IntArray, hull: Array) -> None:
    """Write points (nv, 3) between which all of a facet lies: its corners, and the Bézier points of tri6's sides and of
    those of strip8 that run across.
    """
    nv = len(nodes)
    for a in range(nv):
        for j in range(3):
            x = points[nodes[a], j]
            if nv == 6 and a > 2:
                x = 2.0 * x - 0.5 * (points[nodes[a - 3], j] + points[nodes[(a - 2) % 3], j])
            elif nv == 8 and a > 3:
                x = points[nodes[a - 4], j] + (points[nodes[7 - a], j] - x) / 6.0
            hull[a, j] = x


@njit
def _not_beyond(axis: Axis, bow: Array, elements: IntArray, hull: Array, within: float) -> IntArray:
    """Those elements to which a point between some (nv, 3) may have a gap less than `within` [m]: seen from the line
    through the element's ends towards their middle, some of them is no farther than that.
    """
    near, n = np.empty(len(elements), np.int64), 0
    for e in elements:
        least = _least_beside(axis.q[e], hull)
        if least < (axis.radius[e] + within + bow[e]) * (1.0 + ROUND_OFF):
            near[n] = e
            n += 1
    return near[:n]


@njit
def _least_beside(q: Array, points: Array) -> float:
    """Least distance [m] of points (n, 3) from the line through an element's ends in the direction, square to that
    line, of the points' mean; no point between them is nearer to the line.
    """
    chord = (q[2, 0] - q[0, 0], q[2, 1] - q[0, 1], q[2, 2] - q[0, 2])
    x = y = z = 0.0
    for a in range(len(points)):
        x, y, z = x + points[a, 0] - q[0, 0], y + points[a, 1] - q[0, 1], z + points[a, 2] - q[0, 2]
    square = chord[0] ** 2 + chord[1] ** 2 + chord[2] ** 2
    share = (x * chord[0] + y * chord[1] + z * chord[2]) / square if square > 0.0 else 0.0
    x, y, z = x - share * chord[0], y - share * chord[1], z - share * chord[2]
    size, least = math.sqrt(x * x + y * y + z * z), np.inf
    if not size > 0.0:
        return 0.0
    for a in range(len(points)):
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
    in_reach: IntArray,
) -> tuple[int, int, int]:
    """First and behind the last of `count` points, evenly spaced on the straight row from a to b, that may have a gap
    less than `within` [m] to some of the elements: those nearer to the lines through the elements' ends than that. Such
    elements, whose ends the row does not lie farther beyond either, are written to `in_reach`; last their number.
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
        in_reach[n] = e
        inverse = 1.0 / cc if cc > 0.0 else 0.0
        square, tilt, at_a = dd - cd * cd * inverse, wd - cw * cd * inverse, ww - cw * cw * inverse - reach * reach
        root = tilt * tilt - square * at_a
        if square <= ROUND_OFF * dd or not root < np.inf:  # along the element, or nowhere
            if not min(at_a, at_a + 2.0 * tilt + square) > 0.25 * square:
                low, high, n = 0.0, 1.0, n + 1
        elif root >= 0.0:
            low = min(low, (-tilt - math.sqrt(root)) / square)
            high, n = max(high, (-tilt + math.sqrt(root)) / square), n + 1
    first, last = max(math.floor(low * count - 0.5), 0), min(math.ceil(high * count - 0.5) + 1, count)
    return int(min(first, count)), int(max(last, 0)), n


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


def points_of(first: Surface, second: Surface, chosen: IntArray) -> tuple[IntArray, Array, Array]:
    """Numbers (n,) of the integration points of some facets, and their places (n, 3) on two surfaces of these."""
    counts = first.parts[chosen, :2].prod(axis=1)
    numbers = np.concatenate([np.arange(n) + first.first[f] for f, n in zip(chosen, counts, strict=True)] or [chosen])
    places = np.empty((2, len(numbers), 3))
    for surface, out in zip((first, second), places, strict=True):
        _write_places(surface, np.repeat(chosen, counts), numbers, out)
    return numbers, places[0], places[1]


@njit
def _write_places(surface: Surface, facets: IntArray, numbers: IntArray, out: Array) -> None:
    nv = surface.facets.shape[1]
    N, dN = np.empty(nv), np.empty((nv, 2))
    for i, f in enumerate(facets):
        row, column = divmod(numbers[i] - surface.first[f], surface.parts[f, 1])
        first, last, _ = row_of(nv, surface.parts[f], row)
        at = between(first, last, (column + 0.5) / surface.parts[f, 1])
        out[i, 0], out[i, 1], out[i, 2] = point_on(surface.deformed, surface.facets[f], *at, N, dN)
