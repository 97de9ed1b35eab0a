"""Morison's formula for a slender pipe: drag and added mass per length.

With the pipe's velocity v through the water, acceleration a, unit tangent tau, v_t = v.tau and v_n = v - v_t tau, the
pipe feels

    drag        -(D/2) rho Cdn |v_n| v_n - (pi D/2) rho Cdt |v_t| v_t tau
    added mass  -rho (pi D^2/4) [Can (a - (a.tau) tau) + Cat (a.tau) tau]

The functions return the resistance, that is the negative of these forces (N/m), and its derivatives (..., d, d), tau
being varied freely, at ng points of each element: v, a, tau (ne, ng, d); c, m: coefficients (ne, 2), normal and
tangential. With tau = 0 they are those of a body alike in all directions, by the normal coefficients.
Source: Morison et al., Petroleum Transactions 189 (1950); tangential drag on the wetted perimeter as in DNV-RP-C205.
"""

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.riser.hermite import Size


def drag_coefficients(rho: float, diameter: Array, normal: Array, tangential: Array) -> Array:
    """Factors (ne, 2) of |v_n| v_n and |v_t| v_t, kg/m2, from Cdn and Cdt."""
    return 0.5 * rho * np.stack([normal * diameter, tangential * np.pi * diameter], axis=-1)


def added_masses(rho: float, diameter: Array, normal: Array, tangential: Array) -> Array:
    """Added mass (ne, 2), kg/m, across and along the pipe, from Can and Cat."""
    return rho * (0.25 * np.pi * diameter**2)[:, None] * np.stack([normal, tangential], axis=-1)


@njit
def _split(v: Array, tau: Array, D: Size) -> tuple[float, float]:
    """Speed along tau and speed across it of a vector (d,)."""
    along, square = 0.0, 0.0
    for i in range(len(D)):
        along += v[i] * tau[i]
    for i in range(len(D)):
        square += (v[i] - along * tau[i]) ** 2
    return along, math.sqrt(square)


@njit
def put_drag(v: Array, tau: Array, c: Array, f: Array, D: Size) -> None:
    """Write the resistance to the rate at one point, f (d,)."""
    along, speed = _split(v, tau, D)
    across, lengthwise = c[0] * speed, c[1] * abs(along) * along
    for i in range(len(D)):
        f[i] = across * (v[i] - along * tau[i]) + lengthwise * tau[i]


@njit
def put_added(a: Array, tau: Array, m: Array, f: Array, D: Size) -> None:
    """Write the resistance to the acceleration at one point, f (d,)."""
    along, _ = _split(a, tau, D)
    for i in range(len(D)):
        f[i] = m[0] * a[i] + (m[1] - m[0]) * along * tau[i]


@njit
def put_drag_derivatives(v: Array, tau: Array, c: Array, by_v: Array, by_tau: Array, D: Size) -> None:
    """Write d drag/dv and d drag/dtau at one point, each (d, d); at rest both are zero."""
    along, speed = _split(v, tau, D)
    normal, tangential = c[0] * speed, 2.0 * c[1] * abs(along)
    bend = c[0] / speed if speed > 0.0 else 0.0
    for i in range(len(D)):
        across_i = v[i] - along * tau[i]
        for j in range(len(D)):
            dyad = bend * across_i * (v[j] - along * tau[j])
            one = 1.0 if i == j else 0.0
            both = tau[i] * tau[j]
            turned = tau[i] * v[j]
            by_v[i, j] = normal * (one - both) + dyad + tangential * both
            by_tau[i, j] = tangential * (turned + 0.5 * along * one)
            by_tau[i, j] -= normal * (turned + along * one) + along * dyad


@njit
def put_added_derivatives(a: Array, tau: Array, m: Array, by_a: Array, by_tau: Array, D: Size) -> None:
    """Write d added/da and d added/dtau at one point, each (d, d)."""
    excess = m[1] - m[0]
    along, _ = _split(a, tau, D)
    for i in range(len(D)):
        for j in range(len(D)):
            one = 1.0 if i == j else 0.0
            by_a[i, j] = m[0] * one + excess * tau[i] * tau[j]
            by_tau[i, j] = excess * (tau[i] * a[j] + along * one)


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


def resistance_derivatives(v: Array, a: Array, tau: Array, c: Array, m: Array) -> tuple[Array, Array, Array]:
    """Derivatives of the sum of `resistance` by v, a and tau."""
    found: tuple[Array, Array, Array] = _resistance_derivatives(v, a, tau, c, m, fixed(v.shape[2]))
    return found


@njit
def _resistance_derivatives(
    v: Array, a: Array, tau: Array, c: Array, m: Array, D: Size
) -> tuple[Array, Array, Array]:
    ne, ng, d = v.shape[0], v.shape[1], len(D)
    by_v, by_tau = np.empty((ne, ng, d, d)), np.empty((ne, ng, d, d))
    for e in range(ne):
        for g in range(ng):
            put_drag_derivatives(v[e, g], tau[e, g], c[e], by_v[e, g], by_tau[e, g], D)
    by_a, added_by_tau = _added_derivatives(a, tau, m, D)
    return by_v, by_a, by_tau + added_by_tau


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


def added_derivatives(a: Array, tau: Array, m: Array) -> tuple[Array, Array]:
    """d added/da and d added/dtau."""
    found: tuple[Array, Array] = _added_derivatives(a, tau, m, fixed(a.shape[2]))
    return found


@njit
def _added_derivatives(a: Array, tau: Array, m: Array, D: Size) -> tuple[Array, Array]:
    ne, ng, d = a.shape[0], a.shape[1], len(D)
    by_a, by_tau = np.empty((ne, ng, d, d)), np.empty((ne, ng, d, d))
    for e in range(ne):
        for g in range(ng):
            put_added_derivatives(a[e, g], tau[e, g], m[e], by_a[e, g], by_tau[e, g], D)
    return by_a, by_tau
