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
from riser_soil.riser.hermite import Size, add_rows, shapes, slopes

POINTS = 0.5 + np.sqrt(0.6) * np.array([-0.5, 0.0, 0.5])
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
            for i in range(d):
                total = 0.0
                for a in range(4):
                    total += N[e, g, a] * q[e, a, i]
                out[e, g, i] = total
    return out


def motion(
    at: Stations, rate: Array, acceleration: Array, chord: Array, ends: Array
) -> tuple[Array, Array, Array, Array]:
    """Velocities, accelerations and unit tangents (ne, ng, d), and the stretch |x'| (ne, ng).

    rate, acceleration: q' and q''; chord (ne, d); ends: end tangents (ne, 2, d).
    """
    D = fixed(chord.shape[1])
    found: tuple[Array, Array, Array, Array] = _motion(at.N, at.dN, rate, acceleration, chord, ends, D)
    return found


@njit
def _motion(
    N: Array, dN: Array, rate: Array, acceleration: Array, chord: Array, ends: Array, D: Size
) -> tuple[Array, Array, Array, Array]:
    tau, stretch = _unit_tangents(dN, chord, ends, D)
    return _interpolate(N, rate, D), _interpolate(N, acceleration, D), tau, stretch


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
            square = 0.0
            for i in range(d):
                x = dN[e, g, 2] * chord[e, i] + dN[e, g, 1] * ends[e, 0, i] + dN[e, g, 3] * ends[e, 1, i]
                tau[e, g, i] = x
                square += x * x
            stretch[e, g] = math.sqrt(square)
            for i in range(d):
                tau[e, g, i] /= stretch[e, g]
    return tau, stretch


def integrate(at: Stations, f: Array) -> Array:
    """Residual conjugate to q (ne, 4, d) of a force per length f (ne, ng, d)."""
    F: Array = _integrate(at.weighted, f, fixed(f.shape[2]))
    return F


@njit
def _integrate(weighted: Array, f: Array, D: Size) -> Array:
    ne, ng, d = f.shape[0], f.shape[1], len(D)
    out = np.empty((ne, 4, d))
    for e in range(ne):
        for a in range(4):
            for i in range(d):
                total = 0.0
                for g in range(ng):
                    total += weighted[e, g, a] * f[e, g, i]
                out[e, a, i] = total
    return out


def inner(share: Array, f: Array, g: Array) -> float:
    """Sum over the stations of f . g, each (ne, ng, d), times their shares (ne, ng)."""
    total: float = _inner(share, f, g)
    return total


@njit
def _inner(share: Array, f: Array, g: Array) -> float:
    total = 0.0
    for e in range(f.shape[0]):
        for k in range(f.shape[1]):
            for i in range(f.shape[2]):
                total += share[e, k] * f[e, k, i] * g[e, k, i]
    return total


def follow_slope(A: Array, tau: Array, stretch: Array) -> Array:
    """Derivative by x' from that by tau, A (ne, ng, d, d): tau follows x' by (I - tau tau)/|x'|."""
    by_slope: Array = _follow_slope(A, tau, stretch, fixed(tau.shape[2]))
    return by_slope


@njit
def _follow_slope(A: Array, tau: Array, stretch: Array, D: Size) -> Array:
    out = np.empty_like(A)
    for e in range(tau.shape[0]):
        for g in range(tau.shape[1]):
            for i in range(len(D)):
                along = 0.0
                for j in range(len(D)):
                    along += A[e, g, i, j] * tau[e, g, j]
                for j in range(len(D)):
                    out[e, g, i, j] = (A[e, g, i, j] - along * tau[e, g, j]) / stretch[e, g]
    return out


class DofDerivatives(NamedTuple):
    """Derivatives by the dofs: of tangents in q, q' and q'' (ne, 2, d, r), of positions in q' and q'' the shifts."""

    q: Array
    rate: Array
    acceleration: Array
    shift_v: float
    shift_a: float


Place = tuple[int, int, int]  # element, station, end of the element


class Derivatives(NamedTuple):
    """Derivatives (ne, ng, d, d) of a force per length by x, by x', and by the rate and acceleration of x."""

    position: Array
    slope: Array
    rate: Array
    acceleration: Array


class _Room(NamedTuple):
    """Room for one element: how the forces at its stations follow its dofs (ng, d, n), how what is conjugate to q does
    (4, d, n), and both as matrices (ng, d n) and (4, d n), whose long rows fill vector registers.
    """

    change: Array
    S: Array
    changes: Array
    rows: Array


@njit
def _room(ng: int, n: int, D: Size) -> _Room:
    change, S = np.empty((ng, len(D), n)), np.empty((4, len(D), n))
    return _Room(change, S, change.reshape(ng, len(D) * n), S.reshape(4, len(D) * n))


@njit
def _add_block(out: Array, room: _Room, weighted: Array, P: Array, D: Size, R: Size) -> None:
    """Add to out (n, n) of an element the integral of what is in the room; weighted (ng, 4), P (2, d, r)."""
    room.rows[:] = 0.0
    for g in range(room.changes.shape[0]):
        for a in range(4):
            for c in range(room.changes.shape[1]):
                room.rows[a, c] += weighted[g, a] * room.changes[g, c]
    add_rows(out, P, room.S, D, R)


def add_tangent(out: Array, at: Stations, by: Derivatives, columns: DofDerivatives) -> None:
    """Add to out (ne, n, n) the derivative by the dofs of the residual of a force per length, P = dt/dTheta held."""
    D, R = fixed(by.slope.shape[2]), fixed(columns.q.shape[3])
    _add_tangent(out, tuple(at), tuple(by), tuple(columns), D, R)


@njit
def _add_tangent(out: Array, at: tuple, by: tuple, columns: tuple, D: Size, R: Size) -> None:
    """Takes plain tuples: numba reads named ones half a microsecond slower."""
    at, by, columns = Stations(*at), Derivatives(*by), DofDerivatives(*columns)
    room = _room(by.slope.shape[1], out.shape[1], D)
    for e in range(by.slope.shape[0]):
        for g in range(by.slope.shape[1]):
            for side in range(2):
                _put_change(room.change[g], (e, g, side), at, by, columns, D, R)
        _add_block(out[e], room, at.weighted[e], columns.q[e], D, R)


@njit
def _put_change(
    change: Array, place: Place, at: Stations, by: Derivatives, columns: DofDerivatives, D: Size, R: Size
) -> None:
    """Write how the force at a station of an element follows the dofs of one of its ends to change (d, n)."""
    e, g, side = place
    d, first = len(D), side * (len(D) + len(R))
    position, tangent = at.N[e, g, 2 * side], at.N[e, g, 2 * side + 1]
    by_chord, by_end = at.dN[e, g, 2 * side], at.dN[e, g, 2 * side + 1]
    for i in range(d):
        for j in range(d):
            moving = by.position[e, g, i, j] + columns.shift_v * by.rate[e, g, i, j]
            moving += columns.shift_a * by.acceleration[e, g, i, j]
            change[i, first + j] = by_chord * by.slope[e, g, i, j] + position * moving
        for k in range(len(R)):
            sloping, turning = 0.0, 0.0
            for j in range(d):
                sloping += by.slope[e, g, i, j] * columns.q[e, side, j, k]
                turning += by.position[e, g, i, j] * columns.q[e, side, j, k]
                turning += by.rate[e, g, i, j] * columns.rate[e, side, j, k]
                turning += by.acceleration[e, g, i, j] * columns.acceleration[e, side, j, k]
            change[i, first + d + k] = by_end * sloping + tangent * turning


def add_stiffness(out: Array, at: Stations, elements: IntArray, by_position: Array, P: Array) -> None:
    """Add to out (ne, n, n), for some elements (m,), the derivative by the dofs of the residual of a force per length
    that depends on the position alone, by_position (m, ng, d, d); P = dt/dTheta (ne, 2, d, r) held.
    """
    _add_stiffness(out, at.N, at.weighted, elements, by_position, P, fixed(P.shape[2]), fixed(P.shape[3]))


@njit
def _add_stiffness(
    out: Array, N: Array, weighted: Array, elements: IntArray, by_position: Array, P: Array, D: Size, R: Size
) -> None:
    room = _room(by_position.shape[1], out.shape[1], D)
    for m in range(elements.size):
        e = elements[m]
        for g in range(by_position.shape[1]):
            for side in range(2):
                _put_stiffness(room.change[g], (e, g, side), N, by_position[m], P, D, R)
        _add_block(out[e], room, weighted[e], P[e], D, R)


@njit
def _put_stiffness(change: Array, place: Place, N: Array, by_position: Array, P: Array, D: Size, R: Size) -> None:
    """Write as `_put_change` does, for a force that depends on the position alone: by_position (ng, d, d)."""
    e, g, side = place
    d, first, position, tangent = len(D), side * (len(D) + len(R)), N[e, g, 2 * side], N[e, g, 2 * side + 1]
    for i in range(d):
        for j in range(d):
            change[i, first + j] = position * by_position[g, i, j]
        for k in range(len(R)):
            turning = 0.0
            for j in range(d):
                turning += by_position[g, i, j] * P[e, side, j, k]
            change[i, first + d + k] = tangent * turning
