"""Morison's formula for a slender pipe: drag and added mass per length.

With the pipe's velocity v through the water, acceleration a, unit tangent tau, v_t = v.tau and v_n = v - v_t tau, the
pipe feels

    drag        -(D/2) rho Cdn |v_n| v_n - (pi D/2) rho Cdt |v_t| v_t tau
    added mass  -rho (pi D^2/4) [Can (a - (a.tau) tau) + Cat (a.tau) tau]

The functions write the resistance, that is the negative of these forces (N/m), and its derivatives (d, d) by v, a and
the slope x' of the axis, whose direction is tau and whose size is the stretch, at one point: v, a, tau (d,); c, m:
coefficients (2,), normal and tangential. With tau = 0 they are those of
a body alike in all directions, by the normal coefficients. tau follows x' by (I - tau tau)/|x'|.
Source: Morison et al., Petroleum Transactions 189 (1950); tangential drag on the wetted perimeter as in DNV-RP-C205.
"""

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.rows import Vector, as_tuple
from riser_soil.riser.hermite import Size

STILL = 1e-150  # m/s, whose square is as good as zero; to ask whether a speed is zero keeps loops off vectors


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
def write_drag(v: Vector, tau: Vector, c: Vector, f: Array, D: Size) -> None:
    """Write the resistance to the rate at one point, f (d,)."""
    v, tau = as_tuple(v, D), as_tuple(tau, D)
    along, speed = _split(v, tau, D)
    across, lengthwise = c[0] * speed, c[1] * abs(along) * along
    for i in range(len(D)):
        f[i] = across * (v[i] - along * tau[i]) + lengthwise * tau[i]


@njit
def write_added(a: Vector, tau: Vector, m: Vector, f: Array, D: Size) -> None:
    """Write the resistance to the acceleration at one point, f (d,)."""
    a, tau = as_tuple(a, D), as_tuple(tau, D)
    along, _ = _split(a, tau, D)
    for i in range(len(D)):
        f[i] = m[0] * a[i] + (m[1] - m[0]) * along * tau[i]


@njit
def write_drag_derivatives(
    v: Vector, tau: Vector, stretch: float, c: Vector, weight: float, by_v: Array, by_slope: Array, D: Size
) -> None:
    """Write d drag/dv and d drag/dx' at one point, each (d, d), times a weight; at rest both are zero."""
    v, tau = as_tuple(v, D), as_tuple(tau, D)
    along, speed = _split(v, tau, D)
    normal, tangential = weight * c[0] * speed, weight * 2.0 * c[1] * abs(along)
    bend = weight * c[0] / max(speed, STILL)
    excess, turned, shorter = tangential - normal, (0.5 * tangential - normal) * along, 1.0 / stretch
    for i in range(len(D)):
        across_i = v[i] - along * tau[i]
        for j in range(len(D)):
            across_j = v[j] - along * tau[j]
            one, both, dyad = 1.0 if i == j else 0.0, tau[i] * tau[j], bend * across_i * across_j
            by_v[i, j] = normal * one + excess * both + dyad
            by_slope[i, j] = (excess * tau[i] * across_j + turned * (one - both) - along * dyad) * shorter


@njit
def write_added_derivatives(
    a: Vector, tau: Vector, stretch: float, m: Vector, weight: float, by_a: Array, by_slope: Array, D: Size
) -> None:
    """Write d added/da at one point (d, d), times a weight, and add d added/dx' to by_slope (d, d)."""
    a, tau = as_tuple(a, D), as_tuple(tau, D)
    normal, excess = weight * m[0], weight * (m[1] - m[0])
    along, _ = _split(a, tau, D)
    shorter = excess / stretch
    for i in range(len(D)):
        for j in range(len(D)):
            one, both = 1.0 if i == j else 0.0, tau[i] * tau[j]
            by_a[i, j] = normal * one + excess * both
            by_slope[i, j] += shorter * (tau[i] * (a[j] - along * tau[j]) + along * (one - both))
