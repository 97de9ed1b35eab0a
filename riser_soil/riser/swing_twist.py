"""Swing-twist decomposition of a rotation: A = exp[(0, y, z)] exp[(tau, 0, 0)].

The swing turns e1 into t = A e1 by the shortest way; t alone fixes it:

    (y, z) = f (-t_z, t_y),   f = alpha/sin(alpha),   cos(alpha) = t_x.

When A spins by w, t changes by w x t and the twist by dtau = w.(e1 + t)/(1 + t_x). Neither is defined at
t = -e1. A `mu` is the generalised moment conjugate to (tau, y, z), m the moment conjugate to w.
"""

import math
from typing import NamedTuple

from riser_soil.core.compiled import njit
from riser_soil.riser.angle_over_sine import angle_over_sine
from riser_soil.riser.vectors import Mat, Vec, add, cross, dot, scale


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
