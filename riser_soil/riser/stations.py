"""Quadrature stations along the line's elements: from q to values there, and back to residuals and their
blocks.

Arrays follow `hermite`: q (ne, 4, d). A field has values (ne, ng, d) at the ng = 3 Gauss stations of each
element.
"""

import math
from typing import NamedTuple

import numpy as np

from riser_soil.arrays import Array
from riser_soil.compiled import njit
from riser_soil.riser.hermite import shapes, slopes

POINTS = 0.5 + np.sqrt(0.6) * np.array([-0.5, 0.0, 0.5])
GAUSS = np.array([5.0, 8.0, 5.0]) / 18.0


class Stations(NamedTuple):
    """Shape functions N, their derivatives dN by arc length, N times quadrature weight; each (ne, ng, 4)."""

    N: Array
    dN: Array
    weighted: Array


def stations(L: Array) -> Stations:
    """Three Gauss stations on elements of unstressed lengths L (ne,)."""
    N = np.stack([shapes(np.full(L.size, p), L) for p in POINTS], axis=1)
    dN = np.stack([slopes(np.full(L.size, p), L) for p in POINTS], axis=1)
    return Stations(N, dN, GAUSS[:, None] * L[:, None, None] * N)


@njit
def interpolate(at: Stations, q: Array) -> Array:
    """Values (ne, ng, d) of q, q' or q''."""
    ne, ng, d = q.shape[0], at.N.shape[1], q.shape[2]
    out = np.zeros((ne, ng, d))
    for e in range(ne):
        for g in range(ng):
            for a in range(4):
                for i in range(d):
                    out[e, g, i] += at.N[e, g, a] * q[e, a, i]
    return out


@njit
def unit_tangents(at: Stations, chord: Array, ends: Array) -> tuple[Array, Array]:
    """Unit tangents (ne, ng, d) and stretch |x'| (ne, ng); chord (ne, d), ends: end tangents (ne, 2, d)."""
    ne, ng, d = chord.shape[0], at.N.shape[1], chord.shape[1]
    tau, stretch = np.empty((ne, ng, d)), np.empty((ne, ng))
    for e in range(ne):
        for g in range(ng):
            square = 0.0
            for i in range(d):
                x = (
                    at.dN[e, g, 2] * chord[e, i]
                    + at.dN[e, g, 1] * ends[e, 0, i]
                    + at.dN[e, g, 3] * ends[e, 1, i]
                )
                tau[e, g, i] = x
                square += x * x
            stretch[e, g] = math.sqrt(square)
            for i in range(d):
                tau[e, g, i] /= stretch[e, g]
    return tau, stretch


@njit
def integrate(at: Stations, f: Array) -> Array:
    """Residual conjugate to q (ne, 4, d) of a force per length f (ne, ng, d)."""
    ne, ng, d = f.shape
    out = np.zeros((ne, 4, d))
    for e in range(ne):
        for g in range(ng):
            for a in range(4):
                for i in range(d):
                    out[e, a, i] += at.weighted[e, g, a] * f[e, g, i]
    return out


@njit
def follow_slope(A: Array, tau: Array, stretch: Array) -> Array:
    """Derivative by x' from that by tau, A (ne, ng, d, d): tau follows x' by (I - tau tau)/|x'|."""
    ne, ng, d = tau.shape
    out = np.empty_like(A)
    for e in range(ne):
        for g in range(ng):
            for i in range(d):
                along = 0.0
                for j in range(d):
                    along += A[e, g, i, j] * tau[e, g, j]
                for j in range(d):
                    out[e, g, i, j] = (A[e, g, i, j] - along * tau[e, g, j]) / stretch[e, g]
    return out


@njit
def add_tangent(
    out: Array, scale: float, P: Array, columns: Array, shift: float, weighted: Array, trial: Array, A: Array
) -> None:
    """Add to out (ne, n, n) scale times the derivative by the dofs of the residual of a force per length.

    A: derivative (ne, ng, d, d) of the force by the field that the functions `trial` (N or dN) make of q, q'
    or q''.
    columns, shift: derivatives of tangents (ne, 2, d, r) and positions in that q by the dofs; P: dt/dTheta.
    """
    ne, ng, d, r = A.shape[0], A.shape[1], A.shape[2], P.shape[3]
    n = d + r
    S = np.empty((d, 2 * n))
    for e in range(ne):
        for g in range(ng):
            for i in range(d):
                for side in range(2):
                    position, turn = shift * trial[e, g, 2 * side], trial[e, g, 2 * side + 1]
                    for k in range(d):
                        S[i, side * n + k] = position * A[e, g, i, k]
                    for k in range(r):
                        total = 0.0
                        for j in range(d):
                            total += A[e, g, i, j] * columns[e, side, j, k]
                        S[i, side * n + d + k] = turn * total
            for side in range(2):
                position, turn = scale * weighted[e, g, 2 * side], scale * weighted[e, g, 2 * side + 1]
                for i in range(d):
                    for c in range(2 * n):
                        out[e, side * n + i, c] += position * S[i, c]
                    for m in range(r):
                        lever = turn * P[e, side, i, m]
                        for c in range(2 * n):
                            out[e, side * n + d + m, c] += lever * S[i, c]
