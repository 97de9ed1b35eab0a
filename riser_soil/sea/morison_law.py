"""Morison's formula for a slender pipe in still water: what the water resists with, per length.

With the pipe's rate v, acceleration a, unit tangent tau, v_t = v.tau and v_n = v - v_t tau, the pipe feels

    drag        -(D/2) rho Cdn |v_n| v_n - (pi D/2) rho Cdt |v_t| v_t tau
    added mass  -rho (pi D^2/4) [Can (a - (a.tau) tau) + Cat (a.tau) tau]

The functions return the resistance, that is the negative of these forces (N/m), and its derivatives, tau
being varied freely. v, a, tau: (..., d); c: coefficient (..., 2), normal and tangential.
Source: Morison et al., Petroleum Transactions 189 (1950); tangential drag on the wetted perimeter as in DNV-
RP-C205.
"""

import numpy as np

from riser_soil.arrays import Array


def drag_coefficients(rho: float, diameter: Array, normal: Array, tangential: Array) -> Array:
    """Factors (ne, 2) of |v_n| v_n and |v_t| v_t, kg/m2, from Cdn and Cdt."""
    return 0.5 * rho * np.stack([normal * diameter, tangential * np.pi * diameter], axis=-1)


def added_masses(rho: float, diameter: Array, normal: Array, tangential: Array) -> Array:
    """Added mass (ne, 2), kg/m, across and along the pipe, from Can and Cat."""
    return rho * (0.25 * np.pi * diameter**2)[:, None] * np.stack([normal, tangential], axis=-1)


def drag(v: Array, tau: Array, c: Array) -> Array:
    """Resistance to the rate (..., d)."""
    along, across, speed = _split(v, tau)
    return np.asarray(c[..., :1] * speed * across + c[..., 1:] * np.abs(along) * along * tau)


def drag_derivatives(v: Array, tau: Array, c: Array) -> tuple[Array, Array]:
    """d drag/dv and d drag/dtau (..., d, d); at rest both are zero."""
    along, across, speed = _split(v, tau)
    unit = np.divide(across, speed, out=np.zeros_like(across), where=speed > 0.0)
    normal, tangential = c[..., :1, None], 2.0 * c[..., 1:, None] * np.abs(along)[..., None]
    eye, speed, along = np.eye(v.shape[-1]), speed[..., None], along[..., None]
    bend = _outer(across, unit)
    by_v = normal * (speed * (eye - _outer(tau, tau)) + bend) + tangential * _outer(tau, tau)
    turned = _outer(tau, v)
    by_tau = tangential * (turned + 0.5 * along * eye) - normal * (
        speed * (turned + along * eye) + along * bend
    )
    return by_v, by_tau


def added(a: Array, tau: Array, m: Array) -> Array:
    """Resistance to the acceleration (..., d)."""
    along = np.sum(a * tau, axis=-1, keepdims=True)
    return np.asarray(m[..., :1] * a + (m[..., 1:] - m[..., :1]) * along * tau)


def added_derivatives(a: Array, tau: Array, m: Array) -> tuple[Array, Array]:
    """d added/da and d added/dtau (..., d, d)."""
    across, excess = m[..., :1, None], (m[..., 1:] - m[..., :1])[..., None]
    along, eye = np.sum(a * tau, axis=-1)[..., None, None], np.eye(a.shape[-1])
    return across * eye + excess * _outer(tau, tau), excess * (_outer(tau, a) + along * eye)


def _split(v: Array, tau: Array) -> tuple[Array, Array, Array]:
    """Speed along tau, velocity across it and that velocity's magnitude."""
    along = np.sum(v * tau, axis=-1, keepdims=True)
    across = v - along * tau
    return along, across, np.linalg.norm(across, axis=-1, keepdims=True)


def _outer(a: Array, b: Array) -> Array:
    return np.asarray(a[..., :, None] * b[..., None, :])
