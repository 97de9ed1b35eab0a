"""Uniform load per length on elements in a plane: its potential, residual and tangent.

An element bows from its chord by a cubic with the angles theta_i from the chord to the tangents of its ends, by which
`beam2d` measures its bending, too; with w.n, the load across the chord, and w per unstressed length L, the potential is

    V = -w.(x1 + x2) L/2 - (theta_1 - theta_2) w.n L^2/12

theta_1 - theta_2 does not change as the chord turns, so V depends on the chord by its direction alone. In space
`spatial_load` is the same. Forces (N) and moments (N m) are ordered as in `beam2d`.
"""

from __future__ import annotations

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.beam2d import PlanarCorotated


@njit
def _split(at: PlanarCorotated, w: Array) -> tuple[float, float]:
    """The load along the chord and across it."""
    c, s = at.axis
    return c * w[0] + s * w[1], c * w[1] - s * w[0]


@njit
def element_potential(at: PlanarCorotated, L: float, w: Array, middle_p: float, middle_z: float) -> float:
    """V [J] of one element, its middle (x1 + x2)/2 at (p, z) [m]."""
    _, across = _split(at, w)
    return -L * (w[0] * middle_p + w[1] * middle_z) - L * L / 12.0 * (at.theta1 - at.theta2) * across


@njit
def add_element_forces(at: PlanarCorotated, L: float, w: Array, f: Array) -> None:
    """Add the residual of one element to f (6,)."""
    along, across = _split(at, w)
    twelfth = L * L / 12.0
    spun = twelfth * (at.theta1 - at.theta2) * along / at.length  # by the chord's turning, over its length
    p, z = -spun * at.axis[1], spun * at.axis[0]
    f[0] -= 0.5 * L * w[0] + p
    f[1] -= 0.5 * L * w[1] + z
    f[2] -= twelfth * across
    f[3] -= 0.5 * L * w[0] - p
    f[4] -= 0.5 * L * w[1] - z
    f[5] += twelfth * across


@njit
def add_element_tangent(at: PlanarCorotated, L: float, w: Array, K: Array) -> None:
    """Add the derivative of the residual of one element to K (6, 6)."""
    along, across = _split(at, w)
    c, s = at.axis
    twelfth, spread = L * L / 12.0, at.theta1 - at.theta2
    bend = twelfth * spread / (at.length * at.length)
    even, odd = bend * across, bend * along  # by n n and by (e n + n e) of the chord's unit vector e and its normal n
    pp = even * s * s + 2.0 * odd * c * s
    zz = even * c * c - 2.0 * odd * c * s
    pz = -even * c * s - odd * (c * c - s * s)
    turned = twelfth * along / at.length
    for end in range(2):
        sign = 2 * end - 1.0
        for other in range(2):
            both, i, j = sign * (2 * other - 1.0), 3 * end, 3 * other
            K[i, j] += both * pp
            K[i, j + 1] += both * pz
            K[i + 1, j] += both * pz
            K[i + 1, j + 1] += both * zz
            mixed = -both * turned
            K[i, j + 2] += mixed * -s
            K[i + 1, j + 2] += mixed * c
            K[j + 2, i] += mixed * -s
            K[j + 2, i + 1] += mixed * c
