"""Gap and sliding between points of the soil and the pipe's cylinder, with exact derivatives.

The axis is the cubic c(s) = Σ N_a(s) q_a of a beam element. With s the closest place to the point p, d = p - c,
rho = |d|, n = d/rho, tau = c'/|c'|, b = tau x n and kappa = n·c'', the gap g = rho - R to the radius R has

    δg   = n·(δp - N δq)
    δs   = (c'·(δp - N δq) + rho n·N'δq)/(c'² - rho kappa)
    δ²g  = (b·(δp - N δq))²/rho + rho (ε + kappa δs)²/c'² - 2 ε δs - kappa δs²,    ε = n·N'δq

so four linear forms hold everything. At an end of the element s stays, and δ²g is that of the distance from a point:
the sum over two directions square to n. A point that has come through to above the axis counts as lying below it, with
rho < 0: the pipe pushes it down all the same.

For friction the slide in a step is needed. The axis c(s) of a beam element lies nearest to the soil's point p at the
place s. With c0, p0 those of the start of the step and e the slide of the riser over the soil,

    e  = (c - c0) - (p - p0),                      de = N δq - δp + (c' - c0') δs,

and the directions along the pipe's surface are those of the start of the step at the same place s,

    a = c0'/|c0'|,   l = a x r/|a x r|,  r = p0 - c0,      both functions of s alone.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.contact.closest_point import THINNEST, Axis, bow_of, combined, nearest, signed_distance
from riser_soil.contact.facets import fill_shape
from riser_soil.contact.near_points import NearPoints, Surface, point_on
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser import hermite
from riser_soil.riser.hermite import Four, bend, slope
from riser_soil.riser.hermite import shape as axis_shape
from riser_soil.riser.vectors import Vec, add, cross, dot, norm, scale, sub, vector

FORMS = 4
PARALLEL = 1e-12  # sine of the angle below which two directions are one


@njit
def gap_forms(axis: Axis, surface: Surface, near: NearPoints, basis: Array) -> tuple[Array, Array]:
    """Linear forms (n, 4, 4 d + 3 nv) of the gap at some points, and the symmetric matrices C (n, 4, 4) with which
    δ²g = forms·C·forms; the first is δg, the last δs.

    Columns: q of the element in axes basis (3, d), then the facet's nodes.
    """
    n, columns = len(near.gap), 4 * basis.shape[1] + 3 * surface.facets.shape[1]
    forms, C = np.empty((n, FORMS, columns)), np.zeros((n, FORMS, FORMS))
    nv = surface.facets.shape[1]
    N, dN, vectors = np.empty(nv), np.empty((nv, 2)), np.empty((FORMS, 2, 3))
    for i in range(len(near.gap)):
        e, nodes, xi = near.element[i], surface.facets[near.facet[i]], near.along[i]
        p = point_on(surface.deformed, nodes, near.xi[i, 0], near.xi[i, 1], N, dN)
        frame(axis.q[e], axis.length[e], axis.radius[e], xi, p, vectors, C[i])
        fill_axis(vectors, basis, xi, axis.length[e], forms[i])
        fill_nodes(vectors, N, forms[i, :, 4 * basis.shape[1] :])
    return forms, C


@njit
def fill_nodes(vectors: Array, N: Array, forms: Array) -> None:
    """Write the facet's columns (4, 3 nv) of the forms of a point with the shape functions N (nv,)."""
    for k in range(FORMS):
        for a in range(len(N)):
            for j in range(3):
                forms[k, 3 * a + j] = N[a] * vectors[k, 0, j]


@njit
def fill_axis(vectors: Array, basis: Array, xi: float, L: float, forms: Array) -> None:
    """Write the columns of q of the forms: -N times their vectors by δp - N δq, and N' times those by N'δq."""
    d, N, dN = basis.shape[1], axis_shape(xi, L), slope(xi, L)
    for k in range(FORMS):
        for j in range(d):
            moved = sloped = 0.0
            for i in range(3):
                moved += basis[i, j] * vectors[k, 0, i]
                sloped += basis[i, j] * vectors[k, 1, i]
            for a in range(4):
                forms[k, a * d + j] = dN[a] * sloped - N[a] * moved


@njit
def frame(
    q: Array, L: float, radius: float, xi: float, p: tuple[float, float, float], vectors: Array, C: Array
) -> None:
    """Write vectors (4, 2, 3) of the forms δg, b·(…), ε and δs, by δp - N δq and by N'δq; C (4, 4), see `gap_forms`.

    At an end of the element the third form is along the other direction square to n.
    """
    c1, c2 = combined(q, slope(xi, L)), combined(q, bend(xi, L))
    rho, n = away_from_axis(q, L, radius, xi, p)
    vectors[...] = 0.0
    ahead = c1[0] * c1[0] + c1[1] * c1[1] + c1[2] * c1[2]
    kappa = n[0] * c2[0] + n[1] * c2[1] + n[2] * c2[2]
    b = _square_to(c1, n)
    free = 0.0 < xi < 1.0
    third = n if free else _square_to(b, n)
    for i in range(3):
        vectors[0, 0, i], vectors[1, 0, i] = n[i], b[i]
        vectors[2, int(free), i] = third[i]
    C[1, 1] = 1.0 / rho
    if not free:
        C[2, 2] = 1.0 / rho
        return
    for i in range(3):
        vectors[3, 0, i] = c1[i] / (ahead - rho * kappa)
        vectors[3, 1, i] = rho * n[i] / (ahead - rho * kappa)
    C[2, 2] = rho / ahead
    C[2, 3] = C[3, 2] = rho * kappa / ahead - 1.0
    C[3, 3] = rho * kappa * kappa / ahead - kappa


@njit
def away_from_axis(
    q: Array, L: float, radius: float, xi: float, p: tuple[float, float, float]
) -> tuple[float, tuple[float, float, float]]:
    """rho [m] and n of a point p whose closest place on an element is xi, see the module's text."""
    c = combined(q, axis_shape(xi, L))
    rho = signed_distance(c, p, radius)
    return rho, ((p[0] - c[0]) / rho, (p[1] - c[1]) / rho, (p[2] - c[2]) / rho)


@njit
def _square_to(t: tuple[float, float, float], n: tuple[float, float, float]) -> tuple[float, float, float]:
    """Unit vector along t x n; where they are parallel, one that is square to n."""
    x, y, z = t[1] * n[2] - t[2] * n[1], t[2] * n[0] - t[0] * n[2], t[0] * n[1] - t[1] * n[0]
    size = math.sqrt(x * x + y * y + z * z)
    if size < PARALLEL * math.sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]):
        x, y, z = (-n[1], n[0], 0.0) if abs(n[2]) < 0.5 else (0.0, -n[2], n[1])
        size = math.sqrt(x * x + y * y + z * z)
    return x / size, y / size, z / size


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


class Slide(NamedTuple):
    """How the pipe slides over a point. z: q of the element in axes basis (3, d), then the facet's nodes.

    The way e (3,) [m] and its derivative by s (3,) at fixed q and p; axial and lateral direction (2, 3), and their
    derivatives by s (2, 3) [1/m]; de/dz at fixed s (3, nz); d²e/ds dz (3, nz) [1/m]; workspace.
    """

    moved: Array
    moved_by_s: Array
    along: Array
    along_by_s: Array
    by_z: Array
    by_s_z: Array
    N: Array
    dN: Array


@njit
def slide_workspace(nv: int, d: int) -> Slide:
    """Workspace for the slide over a point of facets with nv nodes, of a pipe in d dimensions."""
    by_z, by_s_z = np.zeros((3, 4 * d + 3 * nv)), np.zeros((3, 4 * d + 3 * nv))
    ways, ahead = (np.empty(3), np.empty(3)), (np.empty((2, 3)), np.empty((2, 3)))
    return Slide(ways[0], ways[1], ahead[0], ahead[1], by_z, by_s_z, np.empty(nv), np.empty((nv, 2)))


@njit
def write_slide(
    near: NearPoints, i: int, start: tuple[Array, Array], axis: Axis, ground: Surface, out: Slide
) -> None:
    """Write a point's slide and its directions. start: q (ne, 4, 3) and the soil's points (np, 3) [m] where the step
    starts.
    """
    e, xi, nodes = near.element[i], near.along[i], ground.facets[near.facet[i]]
    L, q0 = axis.length[e], start[0][e]
    fill_shape(near.xi[i, 0], near.xi[i, 1], out.N, out.dN)
    shape, slope = hermite.shape(xi, L), hermite.slope(xi, L)
    _move(q0, axis.q[e], shape, slope, out.moved, out.moved_by_s)
    _move_ground(start[1], ground.deformed, nodes, out.N, out.moved)
    c1, c2, r = combined(q0, slope), combined(q0, hermite.bend(xi, L)), _from_axis(q0, shape, start[1], nodes, out.N)
    _directions(c1, c2, r, axis.radius[e], out.along, out.along_by_s)


@njit
def write_slide_columns(near: NearPoints, i: int, axis: Axis, basis: Array, out: Slide) -> None:
    """Write the derivatives by z of a point's slide, which has been written."""
    L = axis.length[near.element[i]]
    shape, slope = hermite.shape(near.along[i], L), hermite.slope(near.along[i], L)
    _columns(shape, slope, out.N, basis, out.by_z, out.by_s_z)


@njit
def _move(q0: Array, q: Array, shape: Four, slope: Four, moved: Array, by_s: Array) -> None:
    for j in range(3):
        moved[j] = by_s[j] = 0.0
        for a in range(4):
            moved[j] += shape[a] * (q[a, j] - q0[a, j])
            by_s[j] += slope[a] * (q[a, j] - q0[a, j])


@njit
def _move_ground(before: Array, now: Array, nodes: IntArray, N: Array, moved: Array) -> None:
    for a in range(len(nodes)):
        for j in range(3):
            moved[j] -= N[a] * (now[nodes[a], j] - before[nodes[a], j])


@njit
def _columns(shape: Four, slope: Four, N: Array, basis: Array, by_z: Array, by_s_z: Array) -> None:
    d = basis.shape[1]
    for j in range(3):
        for a in range(4):
            for k in range(d):
                by_z[j, a * d + k] = shape[a] * basis[j, k]
                by_s_z[j, a * d + k] = slope[a] * basis[j, k]
        for a in range(len(N)):
            by_z[j, 4 * d + 3 * a + j] = -N[a]


@njit
def _from_axis(q: Array, shape: Four, points: Array, nodes: IntArray, N: Array) -> Vec:
    """Vector from the axis to a point of a facet of points (np, 3) [m]."""
    r = scale(-1.0, combined(q, shape))
    for a in range(len(nodes)):
        r = add(r, scale(N[a], vector(points[nodes[a]])))
    return r


@njit
def _directions(c1: Vec, c2: Vec, r: Vec, radius: float, along: Array, by_s: Array) -> None:
    """Unit vectors along the pipe and across it, and how they turn with s."""
    a, da = _unit(c1, c2)
    across = cross(a, r)
    lateral = dl = (0.0, 0.0, 0.0)
    if norm(across) > THINNEST * radius:
        lateral, dl = _unit(across, cross(da, r))  # r' = -c' is along a
    for j in range(3):
        along[0, j], along[1, j] = a[j], lateral[j]
        by_s[0, j], by_s[1, j] = da[j], dl[j]


@njit
def _unit(v: Vec, dv: Vec) -> tuple[Vec, Vec]:
    """A vector over its size, and the derivative of that."""
    size = norm(v)
    u = scale(1.0 / size, v)
    return u, scale(1.0 / size, sub(dv, scale(dot(u, dv), u)))
