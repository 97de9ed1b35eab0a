"""Uniform load per length on elements, in a plane and in space: potential, residual, tangent.

An element bows from its chord by a cubic with the angles theta_i from the chord to the tangents of its ends, by which
`beam2d` measures its bending, too; with w.n, the load across the chord, and w per unstressed length L, the potential is

    V = -w.(x1 + x2) L/2 - (theta_1 - theta_2) w.n L^2/12

theta_1 - theta_2 does not change as the chord turns, so V depends on the chord by its direction alone. In space
In space it is the same. Forces (N) and moments (N m) are ordered as in `beam2d`.

Uniform load per length on elements in space, seen from the element's frame: what it does to their bow.

An element bows from its chord by a cubic with the swings (y_i, z_i) of its ends, see `corotation`. So a load w per
unstressed length L, of components (w_1, w_2, w_3) along the frame, has the potential

    V = -w.(x1 + x2) L/2 - [w_2 (z_1 - z_2) - w_3 (y_1 - y_2)] L^2/12.

Its first part is a constant force on each node. The second is here; it changes with the swings, and as the frame turns
under the load. Swings are the angles by which `strain3d` measures bending: the cubic through the unit tangents would
cost accuracy on coarse meshes. In a plane it is the same.
"""

from __future__ import annotations

from typing import NamedTuple

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.beam2d import PlanarCorotated
from riser_soil.riser.vectors import Mat, Vec, cross, matvec


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


class BowLoad(NamedTuple):
    """A load on an element, seen from its frame."""

    twelfth: float  # L^2/12, m2
    w: Vec  # per length, N/m


NO_LOAD = BowLoad(0.0, (0.0, 0.0, 0.0))


@njit
def bow_load(axes: Mat, L: float, w: Vec) -> BowLoad:
    """That of w [N/m], in global axes, on an element of arc length L whose frame has these axes."""
    return BowLoad(L * L / 12.0, matvec(axes, w))


@njit
def turned(load: BowLoad, spin: Vec) -> BowLoad:
    """How a load that is fixed in space changes as the frame spins."""
    return BowLoad(load.twelfth, cross(load.w, spin))


@njit
def bow_potential(load: BowLoad, a: Vec, b: Vec) -> float:
    """Second part of V [J], for the angles a and b (tau, y, z) of the ends."""
    return -load.twelfth * (load.w[1] * (a[2] - b[2]) - load.w[2] * (a[1] - b[1]))


@njit
def end_moment(load: BowLoad) -> Vec:
    """Fixed-end moment: conjugate to the angles of the first end [N m]; that of the second is its opposite."""
    return (0.0, load.twelfth * load.w[2], -load.twelfth * load.w[1])


@njit
def chord_force(load: BowLoad, length: float, a: Vec, b: Vec) -> Vec:
    """Force on node 2 [N], as the frame of a chord of this length turns under the load; linear in the angles."""
    along = load.twelfth * load.w[0] / length
    return (0.0, along * (a[2] - b[2]), -along * (a[1] - b[1]))
