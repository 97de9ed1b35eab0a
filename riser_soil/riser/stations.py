"""Quadrature along the line's elements: values at Gauss points (stations), residuals and tangent blocks.

Arrays follow `hermite`: q (ne, 4, d). A field has values (ne, ng, d) at the ng stations of each element, three Gauss
points unless another rule is given.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.rows import add_pulled_back, add_shares, add_weighed, combined, numbers_at, times
from riser_soil.riser.hermite import Size, put_rows, shapes, slopes

POINTS = 0.5 + np.sqrt(0.6) * np.array([-0.5, 0.0, 0.5])
FOUR = fixed(4)
GAUSS = np.array([5.0, 8.0, 5.0]) / 18.0


class QuadratureRule(NamedTuple):
    """Quadrature over an element: places xi in 0..1 and weights that sum to one, each (ng,)."""

    points: Array
    weights: Array


THREE_POINTS = QuadratureRule(POINTS, GAUSS)
ENDS = QuadratureRule(np.array([0.0, 1.0]), np.array([0.5, 0.5]))


def gauss(n: int) -> QuadratureRule:
    """Gauss and Legendre's rule of n points."""
    x, w = np.polynomial.legendre.leggauss(n)
    return QuadratureRule(0.5 + 0.5 * x, 0.5 * w)


class Stations(NamedTuple):
    """Shape functions N, their derivatives dN by arc length, N times quadrature weight; each (ne, ng, 4)."""

    N: Array
    dN: Array
    weighted: Array

    def of(self, elements: IntArray) -> Stations:
        """Those of some elements."""
        return Stations(*(values[elements] for values in self))


def stations(L: Array, rule: QuadratureRule = THREE_POINTS) -> Stations:
    """Stations on elements of unstressed lengths L (ne,)."""
    N = np.stack([shapes(np.full(L.size, p), L) for p in rule.points], axis=1)
    dN = np.stack([slopes(np.full(L.size, p), L) for p in rule.points], axis=1)
    return Stations(N, dN, rule.weights[:, None] * L[:, None, None] * N)


def points(L: Array, xi: Array) -> Stations:
    """One station each, of weight 1, at xi (m,) of elements of lengths L (m,): what acts there is a force."""
    N = shapes(xi, L)[:, None, :]
    return Stations(N, slopes(xi, L)[:, None, :], N)


def interpolate(at: Stations, q: Array) -> Array:
    """Values (ne, ng, d) of q, q' or q''."""
    values: Array = _interpolate(at.N, q, fixed(q.shape[2]))
    return values


@njit
def _interpolate(N: Array, q: Array, D: Size) -> Array:
    ne, ng, d = N.shape[0], N.shape[1], len(D)
    out = np.empty((ne, ng, d))
    for e in range(ne):
        for g in range(ng):
            put_value(N[e, g], q[e], out[e, g], D)
    return out


@njit
def put_value(N: Array, q: Array, out: Array, D: Size) -> None:
    """Write the value (d,) at one station, N (4,), of an element's q (4, d)."""
    for i in range(len(D)):
        total = 0.0
        for a in range(4):
            total += N[a] * q[a, i]
        out[i] = total


def unit_tangents(at: Stations, chord: Array, ends: Array) -> tuple[Array, Array]:
    """Unit tangents (ne, ng, d) and stretch |x'| (ne, ng); chord (ne, d), ends: end tangents (ne, 2, d)."""
    tau, stretch = _unit_tangents(at.dN, chord, ends, fixed(chord.shape[1]))
    return tau, stretch


@njit
def _unit_tangents(dN: Array, chord: Array, ends: Array, D: Size) -> tuple[Array, Array]:
    ne, ng, d = dN.shape[0], dN.shape[1], len(D)
    tau, stretch = np.empty((ne, ng, d)), np.empty((ne, ng))
    for e in range(ne):
        for g in range(ng):
            stretch[e, g] = put_unit_tangent(dN[e, g], chord[e], ends[e], tau[e, g], D)
    return tau, stretch


@njit
def value_at(N: Array, p: int, q: Array, e: int, D: Size) -> tuple[float, ...]:
    """Value (d,) at station p of all, N (ne, ng, 4), which lies in element e, of q (ne, 4, d)."""
    (N1, N2, N3, N4), d, at = numbers_at(N, 4 * p, FOUR), len(D), 4 * len(D) * e
    found: tuple[float, ...] = combined(((N1, q, at), (N2, q, at + d), (N3, q, at + 2 * d), (N4, q, at + 3 * d)), D)
    return found


@njit
def unit_tangent_at(
    dN: Array, p: int, chord: Array, ends: Array, e: int, D: Size
) -> tuple[tuple[float, ...], float]:
    """Unit tangent (d,) at station p of all, dN (ne, ng, 4), which lies in element e, and the stretch |x'| there; chord
    (ne, d), ends: end tangents (ne, 2, d).
    """
    (_, by_first, by_chord, by_second), d, square = numbers_at(dN, 4 * p, FOUR), len(D), 0.0
    slope = combined(((by_chord, chord, d * e), (by_first, ends, 2 * d * e), (by_second, ends, 2 * d * e + d)), D)
    for i in range(len(D)):
        square += slope[i] * slope[i]
    stretch = math.sqrt(square)
    return times(1.0 / stretch, slope), stretch


@njit
def put_unit_tangent(dN: Array, chord: Array, ends: Array, tau: Array, D: Size) -> float:
    """Write the unit tangent (d,) at one station, dN (4,), of an element with end tangents (2, d); its stretch |x'|."""
    square = 0.0
    for i in range(len(D)):
        x = dN[2] * chord[i] + dN[1] * ends[0, i] + dN[3] * ends[1, i]
        tau[i] = x
        square += x * x
    stretch = math.sqrt(square)
    for i in range(len(D)):
        tau[i] /= stretch
    return stretch


def integrate(at: Stations, f: Array) -> Array:
    """Residual conjugate to q (ne, 4, d) of a force per length f (ne, ng, d)."""
    F: Array = _integrate(at.weighted, f, fixed(f.shape[2]))
    return F


@njit
def _integrate(weighted: Array, f: Array, D: Size) -> Array:
    ne, ng, d = f.shape[0], f.shape[1], len(D)
    out = np.zeros((ne, 4, d))
    for e in range(ne):
        for g in range(ng):
            add_integrand(weighted[e, g], f[e, g], out[e], D)
    return out


@njit
def add_integrand(weighted: Array, f: Array, F: Array, D: Size) -> None:
    """Add to F (4, d) of an element what the force per length f (d,) at one station, weighted (4,), has in it."""
    for a in range(4):
        for i in range(len(D)):
            F[a, i] += weighted[a] * f[i]


@njit
def add_integrand_at(weighted: Array, p: int, f: tuple[float, ...], F: Array, e: int, D: Size) -> None:
    """The same of station p of all, weighted (ne, ng, 4), which lies in element e, with F (ne, 4, d)."""
    add_shares(F, 4 * len(D) * e, weighted, 4 * p, f, D)


@njit
def element_workspace(n: int, D: Size) -> Array:
    """Workspace for how what is conjugate to q of an element follows its n dofs (4, d, n)."""
    return np.empty((4, len(D), n))


def add_stiffness(out: Array, at: Stations, elements: IntArray, by_position: Array, P: Array) -> None:
    """Add to out (ne, n, n), for some elements (m,), the derivative by the dofs of the residual of a force per length
    that depends on the position alone, by_position (m, ng, d, d); P = dt/dTheta (ne, 2, d, r) held.
    """
    _add_stiffness(out, at.N, at.weighted, elements, by_position, P, fixed(P.shape[2]), fixed(P.shape[3]))


@njit
def _add_stiffness(
    out: Array, N: Array, weighted: Array, elements: IntArray, by_position: Array, P: Array, D: Size, R: Size
) -> None:
    workspace, rows = element_workspace(out.shape[1], D), np.empty((len(D), out.shape[1]))
    for m in range(elements.size):
        e = elements[m]
        put_rows(P[e], 1.0, rows, D, R)
        workspace[:] = 0.0
        for g in range(by_position.shape[1]):
            add_weighed(workspace, weighted[e, g], ((N[e, g], by_position[m, g], rows),), D, R)
        add_pulled_back(out[e], P[e], workspace, D, R)
