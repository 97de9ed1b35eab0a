"""Corotational frame of a two-node beam element in space: swing and twist of its ends, nodal forces, uniform load.

e1 lies along the chord; e2 is the second section axis of the first end, brought over by the shortest
rotation of its tangent to e1. The strains of `strain3d` do not depend on how the frame is turned about
e1, so that no moment about it is left over, and its spin about e1 may be taken as zero:

    omega = (0, -u_3/l, u_2/l)

by components along (e1, e2, e3), as all vectors here; u is the displacement of node 2 less that of node
1. Virtual work then gives the nodal forces from the chord force N and the moments m_i conjugate to w_i -
omega, w_i being the spins of the ends. Frames that are tied to the mean of both ends, as in Battini &
Pacoste, Comput. Methods Appl. Mech. Engng 191 (2002), need further terms.

The rotation of an end from the frame is split into swing and twist: A = exp[(0, y, z)] exp[(tau, 0, 0)]. The swing
turns e1 into t = A e1 by the shortest way; t alone fixes it:

    (y, z) = f (-t_z, t_y),   f = alpha/sin(alpha),   cos(alpha) = t_x.

When A spins by w, t changes by w x t and the twist by dtau = w.(e1 + t)/(1 + t_x). Neither is defined at
t = -e1. A `mu` is the generalised moment conjugate to (tau, y, z), m the moment conjugate to w.

Angles follow from their sines by g = theta/sin(theta), which is differentiated by c = cos(theta). Near theta = 0 its
closed form loses digits; there g is the sum of (2 n)!!/(2 n + 1)!! x^n, x = sin^2(theta/2).

A uniform load acts on the bow of an element. It bows from its chord by a cubic with the swings (y_i, z_i) of its ends.
So a load w per unstressed length L, of components (w_1, w_2, w_3) along the frame, has the potential

    V = -w.(x1 + x2) L/2 - [w_2 (z_1 - z_2) - w_3 (y_1 - y_2)] L^2/12.

Its first part is a constant force on each node. The second is here; it changes with the swings, and as the frame turns
under the load. Swings are the angles by which `strain3d` measures bending: the cubic through the unit tangents would
cost accuracy on coarse meshes. In a plane it is the same.
"""

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.vectors import Mat, Vec, add, cross, dot, matmul, matvec, scale, sub

SERIES_BELOW = 0.05  # 1 - cos(theta) under which closed forms lose digits and the series has converged
SERIES: Array = np.cumprod([1.0] + [2.0 * n / (2.0 * n + 1.0) for n in range(1, 13)])[::-1].copy()


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


class SwingTwist(NamedTuple):
    """A rotation split into twist and swing."""

    angles: Vec  # (tau, y, z), rad
    t: Vec  # A e1
    f: float
    df: float  # by t_x
    ddf: float


@njit
def split(A: Mat) -> SwingTwist:
    """Twist and swing of the rotation matrix A."""
    t = (A[0][0], A[1][0], A[2][0])
    f, df, ddf = angle_over_sine(t[0], math.sqrt(t[1] * t[1] + t[2] * t[2]))
    tau = math.atan2(A[2][1] - A[1][2], A[1][1] + A[2][2])
    return SwingTwist((tau, -f * t[2], f * t[1]), t, f, df, ddf)


@njit
def rate(at: SwingTwist, w: Vec) -> Vec:
    """Change of (tau, y, z) for the spin w."""
    dt = cross(w, at.t)
    df = at.df * dt[0]
    dtau = (w[0] + dot(w, at.t)) / (1.0 + at.t[0])
    return (dtau, -at.f * dt[2] - df * at.t[2], at.f * dt[1] + df * at.t[1])


@njit
def rate_variation(at: SwingTwist, w: Vec, spin: Vec) -> Vec:
    """Change of `rate` at fixed w when A spins by `spin`."""
    t, dt, et, edt = at.t, cross(w, at.t), cross(spin, at.t), cross(w, cross(spin, at.t))
    df, ef = at.df * dt[0], at.df * et[0]
    edf = at.ddf * et[0] * dt[0] + at.df * edt[0]
    dtau = (w[0] + dot(w, t)) / (1.0 + t[0])
    return (
        (dot(w, et) - dtau * et[0]) / (1.0 + t[0]),
        -(ef * dt[2] + at.f * edt[2] + edf * t[2] + df * et[2]),
        ef * dt[1] + at.f * edt[1] + edf * t[1] + df * et[1],
    )


@njit
def _twist_direction(at: SwingTwist) -> Vec:
    """(e1 + t)/(1 + t_x)."""
    per = 1.0 / (1.0 + at.t[0])
    return (1.0, per * at.t[1], per * at.t[2])


@njit
def _swing_force(at: SwingTwist, mu: Vec) -> Vec:
    """Gradient of mu_y y + mu_z z by t."""
    return (at.df * (mu[2] * at.t[1] - mu[1] * at.t[2]), at.f * mu[2], -at.f * mu[1])


@njit
def moment(at: SwingTwist, mu: Vec) -> Vec:
    """m = the transpose of `rate` times mu."""
    return add(scale(mu[0], _twist_direction(at)), cross(at.t, _swing_force(at, mu)))


@njit
def moment_variation(at: SwingTwist, mu: Vec, w: Vec) -> Vec:
    """Change of m at fixed mu for the spin w."""
    dt = cross(w, at.t)
    per = mu[0] / (1.0 + at.t[0])
    falling = dt[0] / (1.0 + at.t[0])
    twisting = (0.0, per * (dt[1] - falling * at.t[1]), per * (dt[2] - falling * at.t[2]))
    lever, dlever = mu[2] * at.t[1] - mu[1] * at.t[2], mu[2] * dt[1] - mu[1] * dt[2]
    df = at.df * dt[0]
    change = (at.ddf * dt[0] * lever + at.df * dlever, df * mu[2], -df * mu[1])
    return add(twisting, add(cross(dt, _swing_force(at, mu)), cross(at.t, change)))


@njit
def angle_over_sine(cosine: float, sine: float) -> tuple[float, float, float]:
    """g and its first two derivatives by the cosine, for theta below pi; sine: not negative."""
    g, slope, bend = 0.0, 0.0, 0.0
    if 1.0 - cosine < SERIES_BELOW:
        x = 0.5 * (1.0 - cosine)
        for coefficient in SERIES:
            bend = bend * x + 2.0 * slope
            slope = slope * x + g
            g = g * x + coefficient
        return g, -0.5 * slope, 0.25 * bend
    g = math.atan2(sine, cosine) / sine
    slope = (cosine * g - 1.0) / (sine * sine)
    return g, slope, (g + 3.0 * cosine * slope) / (sine * sine)


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
    """Change of a load that is fixed in space, in axes that spin."""
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
