"""Quadrature at the waterline: lost buoyancy of partly submerged elements, with its tangent.

Per element: z its heights (ne, 4), those of `hermite`'s q; h (ne, ng) the immersion at its Gauss stations; L length, b
width of the wet section (ne,). At a fine point xi, of quadrature weight w, the height of the surface is interpolated
quadratically from the stations' surface h + z, with the weights `lag` (n, ng).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.riser.hermite import Size, add_rows, shape
from riser_soil.riser.stations import POINTS
from riser_soil.sea.wet_section import dry_height, wet_share, wet_slope


class FinePoints(NamedTuple):
    """Gauss-Legendre points xi (n,) within 0..1, their weights w (n,), and lag (n, ng)."""

    xi: Array
    w: Array
    lag: Array


def fine_points(n: int) -> FinePoints:
    """n of them; the interpolation runs through the three Gauss stations."""
    x, w = np.polynomial.legendre.leggauss(n)
    xi = 0.5 * (x + 1.0)
    lag = [np.prod([(xi - p) / (q - p) for p in POINTS if p != q], axis=0) for q in POINTS]
    return FinePoints(xi, 0.5 * w, np.stack(lag, axis=-1))


@njit
def _immersion(xi: float, lag: Array, z: Array, h: Array, at_stations: Array, L: float) -> float:
    """Immersion of one point; at_stations: heights of the element's stations (ng,)."""
    N = shape(xi, L)
    found = 0.0
    for g in range(lag.size):
        found += lag[g] * (h[g] + at_stations[g])
    for a in range(4):
        found -= N[a] * z[a]
    return found


@njit
def _submerged(h: Array, L: float, b: float) -> bool:
    """Whether an element lies too deep to reach the surface, by the length that it has."""
    return h.min() > L + 0.5 * b


@njit
def dry_lengths(xi: Array, w: Array, lag: Array, z: Array, h: Array, stations: Array, L: Array, b: Array) -> Array:
    """Integrals of (1 - S) N_a over the elements (ne, 4)."""
    out = np.zeros((L.size, 4))
    for e in range(L.size):
        if _submerged(h[e], L[e], b[e]):
            continue
        for i in range(xi.size):
            dry = 1.0 - wet_share(_immersion(xi[i], lag[i], z[e], h[e], stations[e], L[e]), b[e])
            N = shape(xi[i], L[e])
            for a in range(4):
                out[e, a] += w[i] * L[e] * dry * N[a]
    return out


@njit
def dry_potentials(xi: Array, w: Array, lag: Array, z: Array, h: Array, stations: Array, L: Array, b: Array) -> Array:
    """Integrals of `dry_height` over the elements (ne,) [m2]."""
    out = np.zeros(L.size)
    for e in range(L.size):
        if _submerged(h[e], L[e], b[e]):
            continue
        for i in range(xi.size):
            immersion = _immersion(xi[i], lag[i], z[e], h[e], stations[e], L[e])
            out[e] += w[i] * L[e] * dry_height(immersion, b[e])
    return out


@njit
def slopes(
    xi: Array, w: Array, lag: Array, z: Array, h: Array, stations: Array, L: Array, b: Array
) -> tuple[Array, Array]:
    """Derivatives of `dry_lengths` by the elements' heights (ne, 4, 4), and by the surface's at the stations (ne, 4,
    ng).
    """
    by_height, by_surface = np.zeros((L.size, 4, 4)), np.zeros((L.size, 4, h.shape[1]))
    for e in range(L.size):
        if _submerged(h[e], L[e], b[e]):
            continue
        for i in range(xi.size):
            slope = w[i] * L[e] * wet_slope(_immersion(xi[i], lag[i], z[e], h[e], stations[e], L[e]), b[e])
            if slope == 0.0:
                continue
            N = shape(xi[i], L[e])
            for a in range(4):
                for c in range(4):
                    by_height[e, a, c] += slope * N[a] * N[c]
                for g in range(lag.shape[1]):
                    by_surface[e, a, g] -= slope * N[a] * lag[i, g]
    return by_height, by_surface


def add_tangent(out: Array, by_q: Array, P: Array) -> None:
    """Add to out (ne, n, n) the derivative by the dofs of loads along z with derivatives by_q (ne, 4, 4, d)."""
    _add_tangent(out, by_q, P, fixed(P.shape[2]), fixed(P.shape[3]))


@njit
def _add_tangent(out: Array, by_q: Array, P: Array, D: Size, R: Size) -> None:
    d, half = len(D), len(D) + len(R)
    S = np.zeros((4, d, 2 * half))
    for e in range(P.shape[0]):
        for a in range(4):
            for side in range(2):
                for j in range(d):
                    S[a, d - 1, side * half + j] = by_q[e, a, 2 * side, j]
                for k in range(len(R)):
                    total = 0.0
                    for j in range(d):
                        total += by_q[e, a, 2 * side + 1, j] * P[e, side, j, k]
                    S[a, d - 1, side * half + d + k] = total
        add_rows(out[e], P[e], S, D, R)
