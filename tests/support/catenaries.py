"""Elastic catenaries by themselves: closed forms, and the pulls of one between two points."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import root

from riser_soil.core.arrays import Array


def spans(H: float, V: float, w: float, EA: float, L: float) -> tuple[float, float]:
    """Horizontal and vertical distance [m] from the lower to the upper end of an elastic catenary that hangs on H, V.

    Irvine, Cable Structures, 1981, equations 2.24 and 2.25.
    """
    low = V - w * L
    x = H * L / EA + H / w * (math.asinh(V / H) - math.asinh(low / H))
    z = w * L / EA * (V / w - 0.5 * L) + H / w * (math.hypot(1.0, V / H) - math.hypot(1.0, low / H))
    return x, z


def pulls(a: Array, b: Array, w: float, EA: float, L: float) -> tuple[Array, Array]:
    """Forces (2,) [N] of an elastic catenary from a up to b, (2,) [m] along x and z, on what holds it at a and at b."""
    dx, dz = b - a
    chord = float(np.hypot(dx, dz))
    weight, taut = abs(w) * L, EA * max(chord / L - 1.0, 0.0)
    scale, steep = weight + taut, (max(abs(dx), 1e-3 * chord) / chord, dz / chord)

    def force(u: Array) -> tuple[float, float]:
        return scale * math.exp(u[0]), scale * u[1]

    def off(u: Array) -> Array:
        x, z = spans(*force(u), w, EA, L)
        return np.array([x - abs(dx), z - dz])

    slack = np.array([math.log(0.5), 0.7])
    start = np.array([math.log(taut * steep[0] / scale), (taut * steep[1] + 0.5 * weight) / scale]) if taut else slack
    solution = root(off, start, tol=1e-13).x  # as near as round-off lets it, of which it complains
    assert np.abs(off(solution)).max() < 1e-9, "m"
    H, V = force(solution)
    ahead = float(np.sign(dx)) * H
    return np.array([ahead, V - w * L]), np.array([-ahead, -V])
