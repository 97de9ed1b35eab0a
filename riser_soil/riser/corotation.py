"""Corotational frame of a two-node beam element in space, and nodal forces from forces in that frame.

e1 lies along the chord; e2 is the second section axis of the first end, brought over by the shortest
rotation of its tangent to e1. The strains of `strain3d` do not depend on how the frame is turned about
e1, so that no moment about it is left over, and its spin about e1 may be taken as zero:

    omega = (0, -u_3/l, u_2/l)

by components along (e1, e2, e3), as all vectors here; u is the displacement of node 2 less that of node
1. Virtual work then gives the nodal forces from the chord force N and the moments m_i conjugate to w_i -
omega, w_i being the spins of the ends. Frames that are tied to the mean of both ends, as in Battini &
Pacoste, Comput. Methods Appl. Mech. Engng 191 (2002), need further terms.
"""

import math
from typing import NamedTuple

from riser_soil.core.compiled import njit
from riser_soil.riser.vectors import Mat, Vec, add, cross, dot, matmul, scale, sub


class SpatialCorotated(NamedTuple):
    """An element's frame, chord and ends."""

    axes: Mat  # rows e1, e2, e3
    length: float  # chord, m
    A1: Mat  # section frames of the ends seen from the element's frame
    A2: Mat


class SpatialNodalForces(NamedTuple):
    """Force on node 2 (node 1 gets its opposite) and moments on both nodes, conjugate to u, w_1 and w_2."""

    force: Vec
    moment1: Vec
    moment2: Vec


@njit
def corotate(chord: Vec, T1: Mat, T2: Mat) -> SpatialCorotated:
    """The element's frame from its chord and the section frames of its ends."""
    length = math.sqrt(dot(chord, chord))
    e1 = scale(1.0 / length, chord)
    tangent, second = (T1[0][0], T1[1][0], T1[2][0]), (T1[0][1], T1[1][1], T1[2][1])
    e2 = sub(second, scale(dot(second, e1) / (1.0 + dot(tangent, e1)), add(tangent, e1)))
    axes = (e1, e2, cross(e1, e2))
    return SpatialCorotated(axes, length, matmul(axes, T1), matmul(axes, T2))


@njit
def frame_spin(length: float, u: Vec) -> Vec:
    """omega, the spin of the frame when the nodes move apart by u."""
    return (0.0, -u[2] / length, u[1] / length)


@njit
def nodal_forces(length: float, N: float, m1: Vec, m2: Vec) -> SpatialNodalForces:
    """Nodal forces from the chord force N and the moments m_i conjugate to w_i - omega."""
    return SpatialNodalForces((N, -(m1[2] + m2[2]) / length, (m1[1] + m2[1]) / length), m1, m2)


@njit
def lengthen(length: float, forces: SpatialNodalForces, stretch: float) -> Vec:
    """Change of the force on node 2, at fixed N and m_i, when the chord lengthens by `stretch`."""
    return (0.0, -stretch / length * forces.force[1], -stretch / length * forces.force[2])


@njit
def turn(forces: SpatialNodalForces, spin: Vec) -> SpatialNodalForces:
    """Change of the forces when the frame in which they are fixed spins."""
    return SpatialNodalForces(cross(spin, forces.force), cross(spin, forces.moment1), cross(spin, forces.moment2))


@njit
def plus(a: SpatialNodalForces, b: SpatialNodalForces) -> SpatialNodalForces:
    """Sum of two sets of forces."""
    return SpatialNodalForces(add(a.force, b.force), add(a.moment1, b.moment1), add(a.moment2, b.moment2))
