"""Force of shed vortices across the flow and in line with it, and how the phase of their shedding follows the pipe.

With the velocity u of the water past the pipe, across it u_n = u - (u.tau) tau, diameter D and the vortices' phase phi,
the pipe feels per length

    (1/2) rho D Cv cos(phi) |u_n| (tau x u_n),

at right angles to pipe and flow, and in line with the flow, with a coefficient, a phase and frequencies of its own,

    (1/2) rho D C cos(phi) |u_n| u_n,

the part of the drag that the vortices make vary. Each phase turns at the rate

    dphi/dt = 2 pi |u_n|/D [f0 + df sin(theta)],    theta = phase of the pipe's velocity along the force - phi,

so that shedding locks to an oscillation of the frequency f |u_n|/D with f within f0 - df to f0 + df, the force ahead of
or behind the velocity by sin(theta) = (f - f0)/df. Where it locks with theta about 0 it puts energy in.
Sources: Thorsen, Saevik & Larsen, J. Fluids Struct. 51 (2014) and 61 (2016), across the flow, in relative velocity as
in the manual of MoorDyn v2; Ulveseter, Saevik & Larsen, J. Fluids Struct. 68 (2017), in line, who have two ranges of
frequencies and a damping fitted to experiments; here it is one range, and damping is that of the drag. From memory.

Of the pipe's velocity and acceleration along the force, y' and y'', an oscillation at the angular frequency w has the
phase atan2(-y'', w y'). For w the rate of shedding itself is taken: where it is locked that is the oscillation's, so
that no extremes of the past are needed. A motion of less than LEAST_MOTION diameters does not lead the wake: sin(theta)
then fades out, so that nothing hangs on the round-off of a pipe at rest.

Vectors are (3,). The functions return the resistance, that is the negative of the force, as in `morison_law`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit

LEAST_MOTION = 1e-3  # diameters


class Shedding(NamedTuple):
    """Properties per element (ne,): half rho D Cv [kg/m2]; diameter [m]; middle and half width of the range of
    frequencies that it locks to, f0 and df [-].
    """

    lift: Array
    diameter: Array
    middle: Array
    width: Array


class Wake(NamedTuple):
    """The vortices behind the stations of a pipe, each (ne, ng): phase [rad], its rate [1/s] and the rate's growth
    [1/s2], since the time (1,) of the last step accepted.
    """

    time: Array
    phase: Array
    rate: Array
    growth: Array


def phases_at(wake: Wake, t: float) -> Array:
    """Phases (ne, ng) at a time [s] of the step under way: known before it, by Adams and Bashforth's rule of the second
    order.
    """
    since = t - wake.time[0]
    return np.asarray(wake.phase + since * (wake.rate + 0.5 * since * wake.growth))


@njit
def _cross(a: Array, b: Array) -> tuple[float, float, float]:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit
def _dot(a: Array, b: Array | tuple[float, float, float]) -> float:
    total = 0.0
    for i in range(3):
        total += a[i] * b[i]
    return total


@njit
def _speed(v: Array, tau: Array) -> float:
    """Speed across the pipe."""
    along, square = _dot(v, tau), 0.0
    for i in range(3):
        square += (v[i] - along * tau[i]) ** 2
    return math.sqrt(square)


@njit
def write_resistance(v: Array, tau: Array, k: float, f: Array) -> None:
    """Write the resistance f across the flow at one station, of velocity v through the water; k: half rho D Cv
    cos(phi). In line it is that of a drag.
    """
    across, speed = _cross(tau, v), _speed(v, tau)
    for i in range(3):
        f[i] = k * speed * across[i]


@njit
def write_derivatives(v: Array, tau: Array, stretch: float, k: float, by_v: Array, by_slope: Array) -> None:
    """Write its derivatives (3, 3) by v and by the slope x' of the axis, of size stretch."""
    across, speed, along = _cross(tau, v), _speed(v, tau), _dot(v, tau)
    bend = k / speed if speed > 0.0 else 0.0
    for j in range(3):
        v_j, next_j, last_j = v[j] - along * tau[j], (j + 1) % 3, (j + 2) % 3
        for i in range(3):
            lean = bend * across[i] * v_j
            by_v[i, j] = lean
            by_slope[i, j] = -along / stretch * lean
        by_v[next_j, j] += k * speed * tau[last_j]
        by_v[last_j, j] -= k * speed * tau[next_j]
        # dtau x v of dtau = (e_j - tau_j tau)/stretch
        share = k * speed / stretch
        for i in range(3):
            by_slope[i, j] -= share * tau[j] * across[i]
        by_slope[next_j, j] -= share * v[last_j]
        by_slope[last_j, j] += share * v[next_j]


@njit
def _force_direction(v: Array, tau: Array, speed: float, in_line: bool) -> tuple[float, float, float]:
    """Unit vector of the force at phase 0, of velocity v through the water and speed across the pipe."""
    along, across = _dot(v, tau), _cross(v, tau)
    if in_line:
        x, y, z = along * tau[0] - v[0], along * tau[1] - v[1], along * tau[2] - v[2]
        return x / speed, y / speed, z / speed
    return across[0] / speed, across[1] / speed, across[2] / speed


@njit
def shedding_rate(
    v: Array,
    own: Array,
    a: Array,
    tau: Array,
    phase: float,
    rate: float,
    diameter: float,
    middle: float,
    width: float,
    in_line: bool,
) -> float:
    """Rate of the phase [1/s] at one station. v: velocity through the water, own: the pipe's, a: its acceleration;
    rate: as it is foreseen.
    """
    speed = _speed(v, tau)
    if speed == 0.0:
        return 0.0
    toward = _force_direction(v, tau, speed, in_line)
    cosine, sine = rate * _dot(own, toward), -_dot(a, toward)
    size, least = math.hypot(cosine, sine), rate * rate * LEAST_MOTION * diameter
    ahead = sine * math.cos(phase) - cosine * math.sin(phase)
    square = size * size + least * least
    followed = ahead * size / square if square > 0.0 else 0.0
    return 2.0 * math.pi * speed / diameter * (middle + width * followed)


@njit
def advance(
    wake: Wake,
    shed: Shedding,
    in_line: bool,
    t: float,
    phase: float,
    e: int,
    g: int,
    v: Array,
    own: Array,
    a: Array,
    tau: Array,
) -> None:
    """Keep phase and rate of one station at the end t of an accepted step; the time is the caller's to keep."""
    of_pipe, since = (shed.diameter[e], shed.middle[e], shed.width[e]), t - wake.time[0]
    foreseen = max(wake.rate[e, g] + since * wake.growth[e, g], 0.0)
    rate = shedding_rate(v, own, a, tau, phase, foreseen, *of_pipe, in_line)
    wake.growth[e, g] = (rate - wake.rate[e, g]) / since if since > 0.0 else 0.0
    wake.phase[e, g], wake.rate[e, g] = phase % (2.0 * math.pi), rate
