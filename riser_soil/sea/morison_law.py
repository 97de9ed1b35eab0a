"""Morison's formula for a slender pipe: drag and added mass per length.

With the pipe's velocity v through the water, acceleration a, unit tangent tau, v_t = v.tau and v_n = v - v_t tau, the
pipe feels

    drag        -(D/2) rho Cdn |v_n| v_n - (pi D/2) rho Cdt |v_t| v_t tau
    added mass  -rho (pi D^2/4) [Can (a - (a.tau) tau) + Cat (a.tau) tau]

The functions return the resistance, that is the negative of these forces (N/m), and its derivatives (..., d, d) by v,
a and the slope x' of the axis, whose direction is tau and whose size is the stretch, at ng points of each element: v,
a, tau (ne, ng, d); stretch (ne, ng); c, m: coefficients (ne, 2), normal and tangential. With tau = 0 they are those of
a body alike in all directions, by the normal coefficients. tau follows x' by (I - tau tau)/|x'|.
Source: Morison et al., Petroleum Transactions 189 (1950); tangential drag on the wetted perimeter as in DNV-RP-C205.
"""

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.rows import Vector, held
from riser_soil.riser.hermite import Size


def drag_coefficients(rho: float, diameter: Array, normal: Array, tangential: Array) -> Array:
    """Factors (ne, 2) of |v_n| v_n and |v_t| v_t, kg/m2, from Cdn and Cdt."""
    return 0.5 * rho * np.stack([normal * diameter, tangential * np.pi * diameter], axis=-1)


def added_masses(rho: float, diameter: Array, normal: Array, tangential: Array) -> Array:
    """Added mass (ne, 2), kg/m, across and along the pipe, from Can and Cat."""
    return rho * (0.25 * np.pi * diameter**2)[:, None] * np.stack([normal, tangential], axis=-1)


@njit
def _split(v: Vector, tau: Vector, D: Size) -> tuple[float, float]:
    """Speed along tau and speed across it of a vector (d,)."""
    along, square = 0.0, 0.0
    for i in range(len(D)):
        along += v[i] * tau[i]
    for i in range(len(D)):
        square += (v[i] - along * tau[i]) ** 2
    return along, math.sqrt(square)


@njit
def put_drag(v: Vector, tau: Vector, c: Vector, f: Array, D: Size) -> None:
    """Write the resistance to the rate at one point, f (d,)."""
    v, tau = held(v, D), held(tau, D)
    along, speed = _split(v, tau, D)
    across, lengthwise = c[0] * speed, c[1] * abs(along) * along
    for i in range(len(D)):
        f[i] = across * (v[i] - along * tau[i]) + lengthwise * tau[i]


@njit
def put_added(a: Vector, tau: Vector, m: Vector, f: Array, D: Size) -> None:
    """Write the resistance to the acceleration at one point, f (d,)."""
    a, tau = held(a, D), held(tau, D)
    along, _ = _split(a, tau, D)
    for i in range(len(D)):
        f[i] = m[0] * a[i] + (m[1] - m[0]) * along * tau[i]


@njit
def put_drag_derivatives(
    v: Vector, tau: Vector, stretch: float, c: Vector, weight: float, by_v: Array, by_slope: Array, D: Size
) -> None:
    """Write d drag/dv and d drag/dx' at one point, each (d, d), times a weight; at rest both are zero."""
    v, tau = held(v, D), held(tau, D)
    along, speed = _split(v, tau, D)
    normal, tangential = weight * c[0] * speed, weight * 2.0 * c[1] * abs(along)
    bend = weight * c[0] / speed if speed > 0.0 else 0.0
    excess, turned, shorter = tangential - normal, (0.5 * tangential - normal) * along, 1.0 / stretch
    for i in range(len(D)):
        across_i = v[i] - along * tau[i]
        for j in range(len(D)):
            across_j = v[j] - along * tau[j]
            one, both, dyad = 1.0 if i == j else 0.0, tau[i] * tau[j], bend * across_i * across_j
            by_v[i, j] = normal * one + excess * both + dyad
            by_slope[i, j] = (excess * tau[i] * across_j + turned * (one - both) - along * dyad) * shorter


@njit
def put_added_derivatives(
    a: Vector, tau: Vector, stretch: float, m: Vector, weight: float, by_a: Array, by_slope: Array, D: Size
) -> None:
    """Write d added/da at one point (d, d), times a weight, and add d added/dx' to by_slope (d, d)."""
    a, tau = held(a, D), held(tau, D)
    normal, excess = weight * m[0], weight * (m[1] - m[0])
    along, _ = _split(a, tau, D)
    shorter = excess / stretch
    for i in range(len(D)):
        for j in range(len(D)):
            one, both = 1.0 if i == j else 0.0, tau[i] * tau[j]
            by_a[i, j] = normal * one + excess * both
            by_slope[i, j] += shorter * (tau[i] * (a[j] - along * tau[j]) + along * (one - both))


def resistance(v: Array, a: Array, tau: Array, c: Array, m: Array) -> tuple[Array, Array]:
    """Resistance to the acceleration and to the rate, each (ne, ng, d)."""
    found: tuple[Array, Array] = _resistance(v, a, tau, c, m, fixed(v.shape[2]))
    return found


@njit
def _resistance(v: Array, a: Array, tau: Array, c: Array, m: Array, D: Size) -> tuple[Array, Array]:
    drag = np.empty_like(v)
    for e in range(v.shape[0]):
        for g in range(v.shape[1]):
            put_drag(v[e, g], tau[e, g], c[e], drag[e, g], D)
    return _added(a, tau, m, D), drag


def resistance_derivatives(
    v: Array, a: Array, tau: Array, stretch: Array, c: Array, m: Array
) -> tuple[Array, Array, Array]:
    """Derivatives of the sum of `resistance` by v, a and x'."""
    found: tuple[Array, Array, Array] = _resistance_derivatives(v, a, tau, stretch, c, m, fixed(v.shape[2]))
    return found


@njit
def _resistance_derivatives(
    v: Array, a: Array, tau: Array, stretch: Array, c: Array, m: Array, D: Size
) -> tuple[Array, Array, Array]:
    ne, ng, d = v.shape[0], v.shape[1], len(D)
    by_v, by_a, by_slope = np.empty((ne, ng, d, d)), np.empty((ne, ng, d, d)), np.empty((ne, ng, d, d))
    for e in range(ne):
        for g in range(ng):
            axis = tau[e, g], stretch[e, g]
            put_drag_derivatives(v[e, g], *axis, c[e], 1.0, by_v[e, g], by_slope[e, g], D)
            put_added_derivatives(a[e, g], *axis, m[e], 1.0, by_a[e, g], by_slope[e, g], D)
    return by_v, by_a, by_slope


def added(a: Array, tau: Array, m: Array) -> Array:
    """Resistance to the acceleration (ne, ng, d)."""
    found: Array = _added(a, tau, m, fixed(a.shape[2]))
    return found


@njit
def _added(a: Array, tau: Array, m: Array, D: Size) -> Array:
    f = np.empty_like(a)
    for e in range(a.shape[0]):
        for g in range(a.shape[1]):
            put_added(a[e, g], tau[e, g], m[e], f[e, g], D)
    return f


def added_derivatives(a: Array, tau: Array, stretch: Array, m: Array) -> tuple[Array, Array]:
    """Derivatives of `added` by a and x'."""
    found: tuple[Array, Array] = _added_derivatives(a, tau, stretch, m, fixed(a.shape[2]))
    return found


@njit
def _added_derivatives(a: Array, tau: Array, stretch: Array, m: Array, D: Size) -> tuple[Array, Array]:
    ne, ng, d = a.shape[0], a.shape[1], len(D)
    by_a, by_slope = np.empty((ne, ng, d, d)), np.zeros((ne, ng, d, d))
    for e in range(ne):
        for g in range(ng):
            put_added_derivatives(a[e, g], tau[e, g], stretch[e, g], m[e], 1.0, by_a[e, g], by_slope[e, g], D)
    return by_a, by_slope
