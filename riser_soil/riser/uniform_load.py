"""Uniform load per length on shallow-arch elements: its potential, residual and tangent.

The element bows from its chord by a cubic with the end angles theta_i between chord and tangents, so a load w
per unstressed length L has the potential

    V = -w.(x1 + x2) L/2 - (psi1 - psi2) L^2/12,    psi_i = g(c_i) (w.t_i - c_i w.e),    c_i = e.t_i,

e being the chord's unit vector and g = theta/sin(theta), so that psi is theta times the load across the
chord. Taking t_i - c_i e itself (g = 1), or the cubic through the unit tangents, costs accuracy on coarse
meshes: the elements measure their bending by the angle. Arrays follow `hermite`: residual F = dV/dq (ne, 4, d). In a
plane `planar_load` is the same at less cost.
"""

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.riser.angle_over_sine import angle_over_sine
from riser_soil.riser.hermite import Size

Three = tuple[float, float, float]


@njit
def _dot(D: Size, a: Array, b: Array) -> float:
    total = 0.0
    for i in range(len(D)):
        total += a[i] * b[i]
    return total


@njit
def _axis(D: Size, chord: Array, e: Array) -> float:
    """Unit vector of the chord into e; returns its length."""
    l = math.sqrt(_dot(D, chord, chord))
    for i in range(len(D)):
        e[i] = chord[i] / l
    return l


@njit
def _factor(c: float) -> Three:
    """g and its derivatives by c."""
    return angle_over_sine(c, math.sqrt(max(1.0 - c * c, 0.0)))


@njit
def _psi_slopes(D: Size, e: Array, t: Array, w: Array, g: Three, by_t: Array, by_e: Array) -> None:
    """Gradient of psi with respect to t and e, both varied freely; g from `_factor`."""
    c, along = _dot(D, e, t), _dot(D, w, e)
    P = g[1] * (_dot(D, w, t) - c * along) - g[0] * along
    for i in range(len(D)):
        by_t[i] = P * e[i] + g[0] * w[i]
        by_e[i] = P * t[i] - g[0] * c * w[i]


@njit
def _psi_bends(D: Size, e: Array, t: Array, w: Array, g: Three, tt: Array, te: Array, ee: Array) -> None:
    """Second derivatives of psi with respect to t and e (te: rows t, columns e)."""
    c, along = _dot(D, e, t), _dot(D, w, e)
    across = _dot(D, w, t) - c * along
    P, Q, S = g[1] * across - g[0] * along, g[2] * across - 2.0 * g[1] * along, g[1] * c + g[0]
    for i in range(len(D)):
        for j in range(len(D)):
            tt[i, j] = Q * e[i] * e[j] + g[1] * (e[i] * w[j] + w[i] * e[j])
            ee[i, j] = Q * t[i] * t[j] - S * (t[i] * w[j] + w[i] * t[j])
            te[i, j] = Q * e[i] * t[j] - S * e[i] * w[j] + g[1] * w[i] * t[j] + (P if i == j else 0.0)


def potential(chord: Array, middle: Array, tangent: Array, L: Array, w: Array) -> Array:
    """V (ne,) J. chord, middle = (x1 + x2)/2 and w: (ne, d); tangent: (ne, 2, d) at the elements' ends; L:
    (ne,).
    """
    found: Array = _potential(fixed(chord.shape[1]), chord, middle, tangent, L, w)
    return found


@njit
def _potential(D: Size, chord: Array, middle: Array, tangent: Array, L: Array, w: Array) -> Array:
    V, e = np.empty(chord.shape[0]), np.empty(len(D))
    for k in range(chord.shape[0]):
        V[k] = element_potential(D, chord[k], middle[k], tangent[k], L[k], w[k], e)
    return V


@njit
def element_potential(D: Size, chord: Array, middle: Array, tangent: Array, L: float, w: Array, e: Array) -> float:
    """That of one element; e (d,): room."""
    _axis(D, chord, e)
    V = -L * _dot(D, w, middle)
    for end in range(2):
        t = tangent[end]
        c = _dot(D, e, t)
        psi = _factor(c)[0] * (_dot(D, w, t) - c * _dot(D, w, e))
        V -= (1 - 2 * end) * L * L / 12.0 * psi
    return V


def residual(chord: Array, tangent: Array, L: Array, w: Array) -> Array:
    """F = dV/dq (ne, 4, d); arguments as in `potential`."""
    F = np.zeros((chord.shape[0], 4, chord.shape[1]))
    add_residual(fixed(chord.shape[1]), chord, tangent, L, w, F)
    return F


@njit
def add_residual(D: Size, chord: Array, tangent: Array, L: Array, w: Array, F: Array) -> None:
    """Add what `residual` returns to F (ne, 4, d)."""
    d = len(D)
    e, t, by_t, by_e = np.empty(d), np.empty(d), np.empty(d), np.empty(d)
    for k in range(chord.shape[0]):
        l, load = _axis(D, chord[k], e), w[k]
        for i in range(d):
            F[k, 0, i] -= 0.5 * L[k] * w[k, i]
            F[k, 2, i] -= 0.5 * L[k] * w[k, i]
        for end in range(2):
            factor = (2 * end - 1) * L[k] * L[k] / 12.0
            for i in range(d):
                t[i] = tangent[k, end, i]
            _psi_slopes(D, e, t, load, _factor(_dot(D, e, t)), by_t, by_e)
            along = _dot(D, e, by_e)
            for i in range(d):
                F[k, 2 * end + 1, i] += factor * by_t[i]
                F[k, 2, i] += factor * (by_e[i] - e[i] * along) / l
                F[k, 0, i] -= factor * (by_e[i] - e[i] * along) / l


@njit
def _chord_bend(D: Size, ee: Array, by_e: Array, e: Array, l: float, row: Array, out: Array) -> None:
    """Second derivative of psi by the chord, out (d, d): (I - e e) ee (I - e e)/l^2 and the turn of e; ee symmetric.

    row: room for d numbers.
    """
    along, twice = _dot(D, e, by_e), 0.0
    for i in range(len(D)):
        row[i] = _dot(D, ee[i], e)
        twice += e[i] * row[i]
    for i in range(len(D)):
        for j in range(len(D)):
            inner = ee[i, j] - row[i] * e[j] - e[i] * row[j] + (twice + 3.0 * along) * e[i] * e[j]
            inner -= by_e[i] * e[j] + e[i] * by_e[j]
            out[i, j] = (inner - (along if i == j else 0.0)) / (l * l)


@njit
def _project(D: Size, A: Array, e: Array, l: float) -> None:
    """A becomes A (I - e e)/l: derivatives by e become those by the chord."""
    for i in range(len(D)):
        along = 0.0
        for j in range(len(D)):
            along += A[i, j] * e[j]
        for j in range(len(D)):
            A[i, j] = (A[i, j] - along * e[j]) / l


def add_tangent(out: Array, weight: float, P: Array, chord: Array, tangent: Array, L: Array, w: Array) -> None:
    """Add weight times the derivative of the residual by the dofs to out (ne, n, n), P = dt/dTheta (ne, 2, d, r) held;
    other arguments as in `potential`.
    """
    add_tangent_to(fixed(P.shape[2]), fixed(P.shape[3]), out, weight, P, chord, tangent, L, w)


@njit
def _add_chord_block(D: Size, out: Array, n: int, dd: Array, factor: float) -> None:
    """Add to both ends' positions what the chord's change does."""
    for i in range(len(D)):
        for j in range(len(D)):
            change = factor * dd[i, j]
            out[i, j] += change
            out[n + i, n + j] += change
            out[i, n + j] -= change
            out[n + i, j] -= change


@njit
def _add_turning_block(
    D: Size, R: Size, out: Array, n: int, end: int, P: Array, tt: Array, te: Array, factor: float
) -> None:
    """Add what an end's tangent does to itself and, with the chord, to the positions."""
    at = end * n + len(D)
    for m in range(len(R)):
        for j in range(len(D)):
            change = 0.0
            for i in range(len(D)):
                change += factor * P[i, m] * te[i, j]
            out[at + m, j] -= change
            out[j, at + m] -= change
            out[at + m, n + j] += change
            out[n + j, at + m] += change
        for j in range(len(D)):
            turned = 0.0
            for i in range(len(D)):
                turned += factor * P[i, m] * tt[i, j]
            for k in range(len(R)):
                out[at + m, at + k] += turned * P[j, k]


@njit
def add_tangent_to(
    D: Size, R: Size, out: Array, weight: float, P: Array, chord: Array, tangent: Array, L: Array, w: Array
) -> None:
    """What `add_tangent` does, for compiled code."""
    d, n = len(D), len(D) + len(R)
    e, t, by_t, by_e, row = np.empty(d), np.empty(d), np.empty(d), np.empty(d), np.empty(d)
    tt, te, ee, dd = np.empty((d, d)), np.empty((d, d)), np.empty((d, d)), np.empty((d, d))
    for k in range(chord.shape[0]):
        l, load = _axis(D, chord[k], e), w[k]
        for end in range(2):
            factor = weight * (2 * end - 1) * L[k] * L[k] / 12.0
            for i in range(d):
                t[i] = tangent[k, end, i]
            g = _factor(_dot(D, e, t))
            _psi_slopes(D, e, t, load, g, by_t, by_e)
            _psi_bends(D, e, t, load, g, tt, te, ee)
            _project(D, te, e, l)
            _chord_bend(D, ee, by_e, e, l, row, dd)
            _add_turning_block(D, R, out[k], n, end, P[k, end], tt, te, factor)
            _add_chord_block(D, out[k], n, dd, factor)
