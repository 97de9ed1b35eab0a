"""Wetting: the submerged share of a lying circular pipe, and lost buoyancy of partly submerged elements.

At immersion h, the height of the surface above the pipe's axis, the wet share of a section of diameter b is

    S(h) = 1/2 + (eta sqrt(1 - eta^2) + asin(eta))/pi,    eta = 2 h/b within -1..1,

0 above and 1 below: Archimedes' law for a level surface. S is continuous with its slope.

At a fine point xi of an element, of quadrature weight w, the height of the surface is interpolated quadratically from
that above the element's stations, with the weights `lag` (n, ng).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.rows import add_pulled_back
from riser_soil.riser.hermite import Size, shape
from riser_soil.riser.stations import POINTS


@njit
def wet_share(h: float, b: float) -> float:
    """S, from 0 to 1."""
    if abs(2.0 * h) >= b:
        return 1.0 if h > 0.0 else 0.0
    eta = 2.0 * h / b
    return 0.5 + (eta * math.sqrt(1.0 - eta * eta) + math.asin(eta)) / math.pi


@njit
def wet_slope(h: float, b: float) -> float:
    """dS/dh [1/m]."""
    if abs(2.0 * h) >= b:
        return 0.0
    eta = 2.0 * h / b
    return 4.0 / math.pi * math.sqrt(1.0 - eta * eta) / b


@njit
def dry_height(h: float, b: float) -> float:
    """Integral of 1 - S from h up to full immersion [m]; -h above the water."""
    if abs(2.0 * h) >= b:
        return max(-h, 0.0)
    eta = 2.0 * h / b
    across = math.sqrt(1.0 - eta * eta)
    return 0.5 * b * ((eta * math.asin(eta) + across - across**3 / 3.0) / math.pi - 0.5 * eta)


class FinePoints(NamedTuple):
    """Gauss-Legendre points xi (n,) within 0..1, their weights w (n,), and lag (n, ng)."""

    xi: Array
    w: Array
    lag: Array


class WetElement(NamedTuple):
    """An element: z its heights (4,), those of `hermite`'s q; h (ng,) the immersion at its stations, whose own heights
    are stations (ng,); L length, b width of the wet section.
    """

    z: Array
    h: Array
    stations: Array
    L: float
    b: float


class TangentWorkspace(NamedTuple):
    """Workspace for the tangent of one element: see `write_slopes`, `write_by_q`, `write_by_dofs`; S but for its last
    rows is zero.
    """

    by_height: Array
    by_surface: Array
    by_q: Array
    S: Array


def fine_points(n: int) -> FinePoints:
    """n of them; the interpolation runs through the three Gauss stations."""
    x, w = np.polynomial.legendre.leggauss(n)
    xi = 0.5 * (x + 1.0)
    lag = [np.prod([(xi - p) / (q - p) for p in POINTS if p != q], axis=0) for q in POINTS]
    return FinePoints(xi, 0.5 * w, np.stack(lag, axis=-1))


@njit
def _immersion(xi: float, lag: Array, at: WetElement) -> float:
    """Immersion of one point."""
    N = shape(xi, at.L)
    immersion = 0.0
    for g in range(lag.size):
        immersion += lag[g] * (at.h[g] + at.stations[g])
    for a in range(4):
        immersion -= N[a] * at.z[a]
    return immersion


@njit
def submerged(at: WetElement) -> bool:
    """Whether an element lies too deep to reach the surface, by the length that it has."""
    deep: bool = at.h.min() > at.L + 0.5 * at.b
    return deep


@njit
def write_dry_lengths(points: FinePoints, at: WetElement, out: Array) -> None:
    """Write the integrals of (1 - S) N_a over an element to out (4,)."""
    out[:] = 0.0
    if submerged(at):
        return
    for i in range(points.xi.size):
        dry = 1.0 - wet_share(_immersion(points.xi[i], points.lag[i], at), at.b)
        N = shape(points.xi[i], at.L)
        for a in range(4):
            out[a] += points.w[i] * at.L * dry * N[a]


@njit
def dry_potential(points: FinePoints, at: WetElement) -> float:
    """Integral of `dry_height` over an element [m2]."""
    total = 0.0
    if submerged(at):
        return total
    for i in range(points.xi.size):
        total += points.w[i] * at.L * dry_height(_immersion(points.xi[i], points.lag[i], at), at.b)
    return total


@njit
def write_slopes(points: FinePoints, at: WetElement, by_height: Array, by_surface: Array) -> None:
    """Write the derivatives of `write_dry_lengths` by the element's heights (4, 4), and by the surface's at its
    stations (4, ng).
    """
    by_height[:] = 0.0
    by_surface[:] = 0.0
    if submerged(at):
        return
    for i in range(points.xi.size):
        slope = points.w[i] * at.L * wet_slope(_immersion(points.xi[i], points.lag[i], at), at.b)
        if slope == 0.0:
            continue
        N = shape(points.xi[i], at.L)
        for a in range(4):
            for c in range(4):
                by_height[a, c] += slope * N[a] * N[c]
            for g in range(points.lag.shape[1]):
                by_surface[a, g] -= slope * N[a] * points.lag[i, g]


@njit
def write_by_q(by_height: Array, by_surface: Array, N: Array, gradient: Array, by_q: Array, D: Size) -> None:
    """Write the derivatives of an element's dry lengths by its q (4, 4, d): as the pipe moves, and as the surface above
    it changes. N (ng, 4) of its stations; gradient (ng, d) of their immersion.
    """
    up = len(D) - 1
    for a in range(4):
        for c in range(4):
            for j in range(len(D)):
                total = by_height[a, c] if j == up else 0.0
                for g in range(N.shape[0]):
                    total += by_surface[a, g] * N[g, c] * (gradient[g, j] + (1.0 if j == up else 0.0))
                by_q[a, c, j] = total


@njit
def write_by_dofs(by_q: Array, P: Array, scale: float, S: Array, D: Size, R: Size) -> None:
    """Write how loads along z on an element, with scaled derivatives by_q (4, 4, d), follow the dofs to the last rows
    of S (4, d, n).
    """
    d, half = len(D), len(D) + len(R)
    for a in range(4):
        for side in range(2):
            for j in range(d):
                S[a, d - 1, side * half + j] = scale * by_q[a, 2 * side, j]
            for k in range(len(R)):
                total = 0.0
                for j in range(d):
                    total += by_q[a, 2 * side + 1, j] * P[side, j, k]
                S[a, d - 1, side * half + d + k] = scale * total


def tangent_workspace(ng: int, n: int, D: Size) -> TangentWorkspace:
    """Workspace for an element of n dofs with ng stations."""
    d = len(D)
    return TangentWorkspace(np.zeros((4, 4)), np.zeros((4, ng)), np.zeros((4, 4, d)), np.zeros((4, d, n)))


@njit
def add_element_tangent(
    out: Array,
    points: FinePoints,
    at: WetElement,
    N: Array,
    gradient: Array,
    weight: float,
    P: Array,
    workspace: TangentWorkspace,
    D: Size,
    R: Size,
) -> None:
    """Add to out (n, n) the derivative by the dofs of a load, weight times the dry lengths along z, on an element that
    reaches the surface; N (ng, 4) of its stations, gradient (ng, d) of their immersion, P = dt/dTheta (2, d, r) fixed.
    """
    if submerged(at):
        return
    write_slopes(points, at, workspace.by_height, workspace.by_surface)
    write_by_q(workspace.by_height, workspace.by_surface, N, gradient, workspace.by_q, D)
    write_by_dofs(workspace.by_q, P, weight, workspace.S, D, R)
    add_pulled_back(out, P, workspace.S, D, R)
