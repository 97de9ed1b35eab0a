"""The frame that follows a two-node beam element in space, and how it hands forces on to the nodes.

e1 lies along the chord, e2 in the plane of e1 and the mean of the second section axes of both ends.
Vectors here are given by their components along (e1, e2, e3); u is the displacement of node 2 less that
of node 1, w_i are the spins of the ends. With q_i, the second axis of an end over the component of the
mean along e2, with eta = (q_1 + q_2).e1 / 2 and the levers p_i = q_i x e3 / 2, the frame spins by

    omega = (eta omega_2 + p_1.w_1 + p_2.w_2, -u_3/l, u_2/l),

and virtual work gives the nodal forces from the chord force N and the moments m_i conjugate to w_i -
omega.
Source: Battini & Pacoste, Co-rotational beam elements with warping effects in instability problems,
Comput. Methods Appl. Mech. Engng 191 (2002), section 2; here with the variation of every term.
"""

import math
from typing import NamedTuple

from numba import njit

from riser_soil.riser.rotations import log
from riser_soil.riser.vectors import Mat, Vec, add, cross, dot, matmul, matvec, scale, sub


class Corotated(NamedTuple):
    """Configuration of one element seen from its own frame."""

    axes: Mat  # rows e1, e2, e3
    length: float  # chord, m
    theta1: Vec  # rotation vectors from the element's frame to the section frames of the ends, rad
    theta2: Vec
    q1: Vec  # second section axes of the ends over the component of their mean along e2
    q2: Vec


class NodalForces(NamedTuple):
    """Force on node 2 (node 1 gets its opposite) and moments on both nodes, conjugate to u, w_1 and w_2."""

    force: Vec
    moment1: Vec
    moment2: Vec


@njit(cache=True)
def corotate(chord: Vec, T1: Mat, T2: Mat) -> Corotated:
    """The element's frame and local configuration from its chord and the section frames of its ends."""
    length = math.sqrt(dot(chord, chord))
    e1 = scale(1.0 / length, chord)
    axis1 = (T1[0][1], T1[1][1], T1[2][1])
    axis2 = (T2[0][1], T2[1][1], T2[2][1])
    mean = scale(0.5, add(axis1, axis2))
    normal = cross(e1, mean)
    e3 = scale(1.0 / math.sqrt(dot(normal, normal)), normal)
    axes = (e1, cross(e3, e1), e3)
    per_mean = 1.0 / dot(axes[1], mean)
    q1 = scale(per_mean, matvec(axes, axis1))
    q2 = scale(per_mean, matvec(axes, axis2))
    return Corotated(axes, length, log(matmul(axes, T1)), log(matmul(axes, T2)), q1, q2)


@njit(cache=True)
def lever(q: Vec) -> Vec:
    """p_i, the share of an end's spin that turns the frame about its chord."""
    return (0.5 * q[1], -0.5 * q[0], 0.0)


@njit(cache=True)
def obliquity(q1: Vec, q2: Vec) -> float:
    """eta, the slope of the mean second section axis against the plane normal to the chord."""
    return 0.5 * (q1[0] + q2[0])


@njit(cache=True)
def frame_spin(at: Corotated, u: Vec, w1: Vec, w2: Vec) -> Vec:
    """omega, the spin of the frame when the nodes move by u, w_1 and w_2."""
    across = -u[2] / at.length
    along = obliquity(at.q1, at.q2) * across + dot(lever(at.q1), w1) + dot(lever(at.q2), w2)
    return (along, across, u[1] / at.length)


@njit(cache=True)
def axis_variation(at: Corotated, relative1: Vec, relative2: Vec) -> tuple[Vec, Vec]:
    """Variation of q_1 and q_2 when the ends spin by relative_i = w_i - omega against the frame."""
    dq1 = cross(relative1, at.q1)
    dq2 = cross(relative2, at.q2)
    mean = 0.5 * (dq1[1] + dq2[1])
    return sub(dq1, scale(mean, at.q1)), sub(dq2, scale(mean, at.q2))


@njit(cache=True)
def nodal_forces(at: Corotated, N: float, m1: Vec, m2: Vec) -> NodalForces:
    """Nodal forces from the chord force N and the moments m_i conjugate to w_i - omega."""
    M = add(m1, m2)
    force = (N, -M[2] / at.length, (M[1] + obliquity(at.q1, at.q2) * M[0]) / at.length)
    return NodalForces(force, sub(m1, scale(M[0], lever(at.q1))), sub(m2, scale(M[0], lever(at.q2))))


@njit(cache=True)
def configuration_variation(
    at: Corotated, twisting: float, force: Vec, stretch: float, dq1: Vec, dq2: Vec
) -> NodalForces:
    """Variation of `nodal_forces` at fixed N and m_i: the chord lengthens by `stretch`, q_i vary by dq_i.

    `twisting` is the moment of m_1 + m_2 about the chord, `force` the force on node 2.
    """
    shorter = -stretch / at.length
    transverse = (0.0, shorter * force[1], shorter * force[2] + obliquity(dq1, dq2) * twisting / at.length)
    return NodalForces(transverse, scale(-twisting, lever(dq1)), scale(-twisting, lever(dq2)))


@njit(cache=True)
def turn(forces: NodalForces, spin: Vec) -> NodalForces:
    """Change of the forces when the frame in which they are fixed spins."""
    return NodalForces(cross(spin, forces.force), cross(spin, forces.moment1), cross(spin, forces.moment2))


@njit(cache=True)
def plus(a: NodalForces, b: NodalForces) -> NodalForces:
    """Sum of two sets of forces."""
    return NodalForces(add(a.force, b.force), add(a.moment1, b.moment1), add(a.moment2, b.moment2))
