"""Gap between the pipe's cylinder and rows of points across it, as between the gaps at the ends of each row.

A row of a facet of four nodes runs from eta = -1 to +1, across the riser. Flat facets cut off the round groove that
the pipe has pressed into soil that moves with it: a point of the chord between two nodes on the pipe would seem to
penetrate by h^2/(4 D), more than contact gives. With g_a and g_b the gaps at the ends of the row

    g = (1 - eta)/2 g_a + (1 + eta)/2 g_b,

which is exact where the ground follows the pipe. Its derivatives are those of g_a and g_b, see `cylinder_gap`: seven
linear forms, that of g and three of each end. Both ends look at the element that is nearest to the row's middle.
"""

from __future__ import annotations

import numpy as np

from riser_soil.contact.closest_point import Axis, bow_of, closest, combined, nearest, signed_distance
from riser_soil.contact.cylinder_gap import FORMS, away_from_axis, fill_axis, fill_nodes, frame
from riser_soil.contact.facets import fill_shape
from riser_soil.contact.integration_points import area, place
from riser_soil.contact.near_points import NearPoints, PairsByFacet, Surface, point_on
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser.hermite import shape as axis_shape

ROW_FORMS = 2 * FORMS - 1


@njit
def fill_near_rows(axis: Axis, surface: Surface, pairs: PairsByFacet, within: float, out: NearPoints) -> int:
    """Write points of some pairs whose gap is less than `within` [m], as far as there is room; how many there are."""
    bow, n, nv = bow_of(axis), 0, surface.facets.shape[1]
    N, dN = np.empty(nv), np.empty((nv, 2))
    for i, f in enumerate(pairs.facets):
        nodes, near = surface.facets[f], pairs.elements[pairs.begin[i] : pairs.begin[i + 1]]
        rows, columns = surface.parts[f, 0], surface.parts[f, 1]
        for row in range(rows):
            xi = -1.0 + (2 * row + 1) / rows
            middle = point_on(surface.deformed, nodes, xi, 0.0, N, dN)
            e = nearest(axis, bow, near, middle, np.inf)[0]
            first, gap0 = _end(axis, e, surface.deformed, nodes, xi, -1.0, N, dN)
            last, gap1 = _end(axis, e, surface.deformed, nodes, xi, 1.0, N, dN)
            if not min(gap0, gap1) < within:
                continue
            for column in range(columns):
                share = (column + 0.5) / columns
                gap = gap0 + share * (gap1 - gap0)
                if not gap < within:
                    continue
                if n < len(out.gap):
                    k = row * columns + column
                    xi, eta, part = place(nv, surface.parts[f], k)
                    fill_shape(xi, eta, N, dN)
                    out.element[n], out.facet[n], out.number[n] = e, f, surface.first[f] + k
                    out.xi[n, 0], out.xi[n, 1], out.gap[n] = xi, eta, gap
                    out.along[n] = first + share * (last - first)
                    out.area[n] = part * area(surface.measured, nodes, dN)
                n += 1
    return n


@njit
def _end(
    axis: Axis, e: int, points: Array, nodes: Array, xi: float, eta: float, N: Array, dN: Array
) -> tuple[float, float]:
    """Place on an element's axis that is closest to an end of a row, and the gap there [m]."""
    p = point_on(points, nodes, xi, eta, N, dN)
    along = closest(axis.q[e], axis.length[e], p)
    c = combined(axis.q[e], axis_shape(along, axis.length[e]))
    return along, signed_distance(c, p, axis.radius[e]) - axis.radius[e]


def row_forms(axis: Axis, surface: Surface, near: NearPoints, basis: Array) -> tuple[Array, Array, Array]:
    """Linear forms (n, 7, 4 d + 3 nv) of the gap at some points, symmetric matrices C (n, 7, 7) with which
    d2g = forms.C.forms, and the form (n, 4 d + 3 nv) of the place on the axis; the first form is dg. Columns as of
    `gap_forms`.
    """
    n, columns = len(near.gap), 4 * basis.shape[1] + 3 * surface.facets.shape[1]
    forms, C, by_place = np.zeros((n, ROW_FORMS, columns)), np.zeros((n, ROW_FORMS, ROW_FORMS)), np.zeros((n, columns))
    _put_row_forms(axis, surface, near, basis, forms, C, by_place)
    return forms, C, by_place


@njit
def _put_row_forms(
    axis: Axis, surface: Surface, near: NearPoints, basis: Array, forms: Array, C: Array, by_place: Array
) -> None:
    nv = surface.facets.shape[1]
    N, dN, vectors = np.empty(nv), np.empty((nv, 2)), np.empty((FORMS, 2, 3))
    one, curved = np.empty((FORMS, forms.shape[2])), np.zeros((FORMS, FORMS))
    for i in range(len(near.gap)):
        e, nodes, xi = near.element[i], surface.facets[near.facet[i]], near.xi[i, 0]
        for end in range(2):
            eta = 2.0 * end - 1.0
            share = 0.5 * (1.0 + eta * near.xi[i, 1])
            p = point_on(surface.deformed, nodes, xi, eta, N, dN)
            along = closest(axis.q[e], axis.length[e], p)
            curved[...] = 0.0
            frame(axis.q[e], axis.length[e], axis.radius[e], along, p, vectors, curved)
            fill_axis(vectors, basis, along, axis.length[e], one)
            fill_nodes(vectors, N, one[:, 4 * basis.shape[1] :])
            first = 1 + (FORMS - 1) * end
            for c in range(forms.shape[2]):
                forms[i, 0, c] += share * one[0, c]
                by_place[i, c] += share * one[FORMS - 1, c]
                for k in range(1, FORMS):
                    forms[i, first + k - 1, c] = one[k, c]
            for a in range(1, FORMS):
                for b in range(1, FORMS):
                    C[i, first + a - 1, first + b - 1] = share * curved[a, b]


@njit
def gaps_of(axis: Axis, points: Array) -> tuple[Array, Array]:
    """Gaps (n,) [m] between the pipe and points (n, 3), and unit vectors (n, 3) away from its axis."""
    bow, elements = bow_of(axis), np.arange(len(axis.length))
    gaps, away = np.empty(len(points)), np.empty((len(points), 3))
    for i in range(len(points)):
        p = (points[i, 0], points[i, 1], points[i, 2])
        e, along, gaps[i], _ = nearest(axis, bow, elements, p, np.inf)
        n = away_from_axis(axis.q[e], axis.length[e], axis.radius[e], along, p)[1]
        away[i, 0], away[i, 1], away[i, 2] = n
    return gaps, away


def points_of(first: Surface, second: Surface, chosen: IntArray) -> tuple[IntArray, Array, Array]:
    """Numbers (n,) of the integration points of some facets, and their places (n, 3) on two surfaces of these."""
    counts = first.parts[chosen].prod(axis=1)
    numbers = np.concatenate([np.arange(n) + first.first[f] for f, n in zip(chosen, counts, strict=True)] or [chosen])
    places = np.empty((2, len(numbers), 3))
    for surface, out in zip((first, second), places, strict=True):
        _put_places(surface, np.repeat(chosen, counts), numbers, out)
    return numbers, places[0], places[1]


@njit
def _put_places(surface: Surface, facets: IntArray, numbers: IntArray, out: Array) -> None:
    nv = surface.facets.shape[1]
    N, dN = np.empty(nv), np.empty((nv, 2))
    for i, f in enumerate(facets):
        xi, eta, _ = place(nv, surface.parts[f], numbers[i] - surface.first[f])
        out[i, 0], out[i, 1], out[i, 2] = point_on(surface.deformed, surface.facets[f], xi, eta, N, dN)
