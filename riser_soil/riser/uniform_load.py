"""A constant load per length on shallow-arch elements: its potential, residual and stiffness.

The element bows from its chord by a cubic with the end angles theta_i between chord and tangents, so a load w
per unstressed length L has the potential

    V = -w.(x1 + x2) L/2 - (psi1 - psi2) L^2/12,    psi_i = g(c_i) (w.t_i - c_i w.e),    c_i = e.t_i,

e being the chord's unit vector and g = theta/sin(theta), so that psi is theta times the load across the
chord. Taking t_i - c_i e itself (g = 1), or the cubic through the unit tangents, costs accuracy on coarse
meshes: the elements measure their bending by the angle. Arrays follow `hermite`: residual F = dV/dq (ne, 4,
d), stiffness (ne, 4, 4, d, d).
"""

import math

import numpy as np
from numba import njit

from riser_soil.arrays import Array

SERIES_BELOW = 0.05  # 1 - cos(theta) under which closed forms lose digits and the series has converged
SERIES: Array = np.cumprod([1.0] + [2.0 * n / (2.0 * n + 1.0) for n in range(1, 13)])[::-1].copy()


@njit(cache=True)
def angle_over_sine(c: float) -> tuple[float, float, float]:
    """g = theta/sin(theta) and its first two derivatives by c = cos(theta), for theta below pi."""
    g, slope, bend = 0.0, 0.0, 0.0
    if 1.0 - c < SERIES_BELOW:
        x = 0.5 * (1.0 - c)  # sin^2(theta/2)
        for coefficient in SERIES:
            bend = bend * x + 2.0 * slope
            slope = slope * x + g
            g = g * x + coefficient
        return g, -0.5 * slope, 0.25 * bend
    sine2 = 1.0 - c * c
    g = math.acos(c) / math.sqrt(sine2)
    slope = (c * g - 1.0) / sine2
    return g, slope, (g + 3.0 * c * slope) / sine2


@njit(cache=True)
def _dot(a: Array, b: Array) -> float:
    total = 0.0
    for i in range(a.size):
        total += a[i] * b[i]
    return total


@njit(cache=True)
def _axis(chord: Array, e: Array) -> float:
    """Unit vector of the chord into e; returns its length."""
    l = math.sqrt(_dot(chord, chord))
    for i in range(e.size):
        e[i] = chord[i] / l
    return l


@njit(cache=True)
def _psi_slopes(e: Array, t: Array, w: Array, by_t: Array, by_e: Array) -> None:
    """Gradient of psi with respect to t and e, both varied freely."""
    c, along = _dot(e, t), _dot(w, e)
    g, g1, _ = angle_over_sine(c)
    P = g1 * (_dot(w, t) - c * along) - g * along
    for i in range(e.size):
        by_t[i] = P * e[i] + g * w[i]
        by_e[i] = P * t[i] - g * c * w[i]


@njit(cache=True)
def _psi_bends(e: Array, t: Array, w: Array, tt: Array, te: Array, ee: Array) -> None:
    """Second derivatives of psi with respect to t and e (te: rows t, columns e)."""
    c, along = _dot(e, t), _dot(w, e)
    g, g1, g2 = angle_over_sine(c)
    across = _dot(w, t) - c * along
    P, Q, S = g1 * across - g * along, g2 * across - 2.0 * g1 * along, g1 * c + g
    for i in range(e.size):
        for j in range(e.size):
            tt[i, j] = Q * e[i] * e[j] + g1 * (e[i] * w[j] + w[i] * e[j])
            ee[i, j] = Q * t[i] * t[j] - S * (t[i] * w[j] + w[i] * t[j])
            te[i, j] = Q * e[i] * t[j] - S * e[i] * w[j] + g1 * w[i] * t[j] + (P if i == j else 0.0)


@njit(cache=True)
def potential(chord: Array, middle: Array, tangent: Array, L: Array, w: Array) -> Array:
    """V (ne,) J. chord, middle = (x1 + x2)/2 and w: (ne, d); tangent: (ne, 2, d) at the elements' ends; L:
    (ne,).
    """
    ne, d = chord.shape
    V, e = np.empty(ne), np.empty(d)
    for k in range(ne):
        _axis(chord[k], e)
        V[k] = -L[k] * _dot(w[k], middle[k])
        for end in range(2):
            t = tangent[k, end]
            c = _dot(e, t)
            psi = angle_over_sine(c)[0] * (_dot(w[k], t) - c * _dot(w[k], e))
            V[k] -= (1 - 2 * end) * L[k] * L[k] / 12.0 * psi
    return V


@njit(cache=True)
def residual(chord: Array, tangent: Array, L: Array, w: Array) -> Array:
    """F = dV/dq (ne, 4, d); arguments as in `potential`."""
    ne, d = chord.shape
    F, e, by_t, by_e = np.empty((ne, 4, d)), np.empty(d), np.empty(d), np.empty(d)
    for k in range(ne):
        l = _axis(chord[k], e)
        for i in range(d):
            F[k, 0, i] = F[k, 2, i] = -0.5 * L[k] * w[k, i]
        for end in range(2):
            factor = (2 * end - 1) * L[k] * L[k] / 12.0
            _psi_slopes(e, tangent[k, end], w[k], by_t, by_e)
            along = _dot(e, by_e)
            for i in range(d):
                F[k, 2 * end + 1, i] = factor * by_t[i]
                F[k, 2, i] += factor * (by_e[i] - e[i] * along) / l
                F[k, 0, i] -= factor * (by_e[i] - e[i] * along) / l
    return F


@njit(cache=True)
def _project(A: Array, e: Array, l: float, out: Array) -> None:
    """A (I - e e)/l, row by row."""
    for i in range(A.shape[0]):
        along = _dot(A[i], e)
        for j in range(e.size):
            out[i, j] = (A[i, j] - along * e[j]) / l


@njit(cache=True)
def _add_chord_block(out: Array, factor: float, ee: Array, by_e: Array, e: Array, l: float) -> None:
    """Add to the blocks of x1, x2 the second derivative by the chord: (I - e e) ee (I - e e)/l^2 and the turn
    of e.
    """
    d = e.size
    half, whole = np.empty((d, d)), np.empty((d, d))
    _project(ee, e, l, half)
    _project(half.T.copy(), e, l, whole)
    along = _dot(e, by_e)
    for i in range(d):
        for j in range(d):
            one = 1.0 if i == j else 0.0
            turn = 3.0 * along * e[i] * e[j] - along * one - by_e[i] * e[j] - e[i] * by_e[j]
            value = factor * (whole[i, j] + turn / (l * l))
            out[0, 0, i, j] += value
            out[2, 2, i, j] += value
            out[0, 2, i, j] -= value
            out[2, 0, i, j] -= value


@njit(cache=True)
def stiffness(chord: Array, tangent: Array, L: Array, w: Array) -> Array:
    """Second derivatives of V in blocks (ne, 4, 4, d, d); arguments as in `potential`."""
    ne, d = chord.shape
    K, e, by_t, by_e = np.zeros((ne, 4, 4, d, d)), np.empty(d), np.empty(d), np.empty(d)
    tt, te, ee, td = np.empty((d, d)), np.empty((d, d)), np.empty((d, d)), np.empty((d, d))
    for k in range(ne):
        l = _axis(chord[k], e)
        for end in range(2):
            factor, a = (2 * end - 1) * L[k] * L[k] / 12.0, 2 * end + 1
            _psi_slopes(e, tangent[k, end], w[k], by_t, by_e)
            _psi_bends(e, tangent[k, end], w[k], tt, te, ee)
            _project(te, e, l, td)
            _add_chord_block(K[k], factor, ee, by_e, e, l)
            for i in range(d):
                for j in range(d):
                    K[k, a, a, i, j] = factor * tt[i, j]
                    K[k, a, 2, i, j] = factor * td[i, j]
                    K[k, a, 0, i, j] = -factor * td[i, j]
                    K[k, 2, a, j, i] = factor * td[i, j]
                    K[k, 0, a, j, i] = -factor * td[i, j]
    return K
