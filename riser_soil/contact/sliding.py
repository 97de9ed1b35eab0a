"""Sliding of the riser over points of the soil's surface in a step, with exact derivatives.

The axis c(s) of a beam element lies nearest to the soil's point p at the place s. With c0, p0 those of the start of the
step and e the slide of the riser over the soil,

    e  = (c - c0) - (p - p0),                      de = N δq - δp + (c' - c0') δs,

and the directions along the pipe's surface are those of the start of the step at the same place s,

    a = c0'/|c0'|,   l = a x r/|a x r|,  r = p0 - c0,      both functions of s alone.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.contact.closest_point import THINNEST, Axis, combined
from riser_soil.contact.facets import fill_shape
from riser_soil.contact.near_points import NearPoints, Surface
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser import hermite
from riser_soil.riser.hermite import Four
from riser_soil.riser.vectors import Vec, add, cross, dot, norm, scale, sub, vector


class Slide(NamedTuple):
    """Slide e of n points (n, 3) [m] and its derivative by s (n, 3) at fixed q and p; directions (n, 2, 3), axial and
    lateral, and their derivatives by s (n, 2, 3) [1/m]; de/dz at fixed s (n, 3, nz); d²e/ds dz (n, 3, nz) [1/m].
    """

    moved: Array
    moved_by_s: Array
    along: Array
    along_by_s: Array
    by_z: Array
    by_s_z: Array


def slide(near: NearPoints, start: tuple[Axis, Surface], end: tuple[Axis, Surface], basis: Array) -> Slide:
    """Slide of points from the start to the end of a step; z: q of the element in axes basis (3, d), then the facet."""
    n, nz = len(near.gap), 4 * basis.shape[1] + 3 * end[1].facets.shape[1]
    found = Slide(
        np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 2, 3)), np.empty((n, 2, 3)),
        np.zeros((n, 3, nz)), np.zeros((n, 3, nz)),
    )  # fmt: skip
    _slide(near, start[0], start[1], end[0], end[1], basis, found)
    return found


@njit
def _slide(
    near: NearPoints, axis0: Axis, ground0: Surface, axis: Axis, ground: Surface, basis: Array, out: Slide
) -> None:
    nv = ground.facets.shape[1]
    N, dN = np.empty(nv), np.empty((nv, 2))
    for i in range(len(near.gap)):
        e, xi, nodes = near.element[i], near.along[i], ground.facets[near.facet[i]]
        L, q0 = axis.length[e], axis0.q[e]
        fill_shape(near.xi[i, 0], near.xi[i, 1], N, dN)
        shape, slope = hermite.shape(xi, L), hermite.slope(xi, L)
        _move(q0, axis.q[e], shape, slope, out.moved[i], out.moved_by_s[i])
        _move_ground(ground0.deformed, ground.deformed, nodes, N, out.moved[i])
        c1, c2, r = combined(q0, slope), combined(q0, hermite.bend(xi, L)), _from_axis(q0, shape, ground0, nodes, N)
        _directions(c1, c2, r, axis.radius[e], out.along[i], out.along_by_s[i])
        _columns(shape, slope, N, basis, out.by_z[i], out.by_s_z[i])


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
def _from_axis(q: Array, shape: Four, ground: Surface, nodes: IntArray, N: Array) -> Vec:
    """From the axis to a point of a facet [m]."""
    r = scale(-1.0, combined(q, shape))
    for a in range(len(nodes)):
        r = add(r, scale(N[a], vector(ground.deformed[nodes[a]])))
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
