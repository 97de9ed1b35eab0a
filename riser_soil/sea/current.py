"""Current by height, steady or changing in time.

A changing one has profiles by height at given times, and a cubic spline in time through them. The spline is level at
the first time and at the last one, and goes on so: the rate, which is the water's acceleration, has no jumps. As the
current is level and the same all along a height, it carries nothing with it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.sea.flows import WaterMotion, add_flow


@njit
def at_heights(z: Array, level: Array, velocity: Array) -> tuple[Array, Array]:
    """Horizontal velocity [m/s] and its derivative by z [1/s], each (n, 2), at heights z (n,).

    level (m,) [m] increases; velocity (m, 2) holds there. Linear between the levels, constant beyond them; at a level,
    the derivative is that of the layer above it.
    """
    values, slopes = np.empty((z.size, 2)), np.zeros((z.size, 2))
    for p in range(z.size):
        above = np.searchsorted(level, z[p], side="right")
        below = max(above - 1, 0)
        for i in range(2):
            if 0 < above < level.size:
                slopes[p, i] = (velocity[above, i] - velocity[below, i]) / (level[above] - level[below])
            values[p, i] = velocity[below, i] + slopes[p, i] * (z[p] - level[below])
    return values, slopes


class SteadyCurrent(NamedTuple):
    """A current by height.

    level (m,) [m], increasing; velocity (m, 2) [m/s] towards x and y. grows: with the stage's time, the load factor of
    statics, by which it is multiplied then; that accelerates nothing.
    """

    level: Array
    velocity: Array
    grows: bool = False


@add_flow.of(SteadyCurrent)
def _add_current(current: SteadyCurrent, motion: WaterMotion, t: Array, x: Array) -> None:
    values, slopes = at_heights(x[:, 2], current.level, current.velocity)
    factor = t[0] if current.grows else 1.0
    for p in range(x.shape[0]):
        for i in range(2):
            motion.velocity[p, i] += factor * values[p, i]
            motion.velocity_gradient[p, i, 2] += factor * slopes[p, i]


class ChangingCurrent(NamedTuple):
    """A current by height and time, constant before the first time and after the last.

    level (m,) [m] and time (k,) [s], increasing; velocity (k, m, 2) [m/s] towards x and y; rate (k, m, 2) [m/s2]: of
    its spline at these times. clock: what the time is counted on shows when the stage begins [s]; runs: whether it goes
    on through the stage, which then is a dynamic one; grows: as of `SteadyCurrent`.
    """

    level: Array
    time: Array
    velocity: Array
    rate: Array
    clock: float
    runs: bool
    grows: bool


def changing_current(
    level: Array, time: Array, velocity: Array, clock: float = 0.0, runs: bool = True, grows: bool = False
) -> ChangingCurrent:
    """A `ChangingCurrent` through velocities at given times."""
    return ChangingCurrent(level, time, velocity, spline_rates(time, velocity), clock, runs, grows)


def spline_rates(time: Array, value: Array) -> Array:
    """Rates (k, ...) at increasing times (k,) of the cubic spline through values (k, ...), level at both ends.

    Its second derivatives agree at the times within: s_(i-1)/h_i + 2 s_i (1/h_i + 1/h_(i+1)) + s_(i+1)/h_(i+1) =
    3 (d_i/h_i + d_(i+1)/h_(i+1)), with h the spans between the times and d the differences of the values over them.
    """
    inverse = 1.0 / np.diff(time)
    steep = (np.diff(value, axis=0).T * inverse**2).T
    left, right = inverse[:-1], inverse[1:]
    matrix = np.diag(2.0 * (left + right)) + np.diag(right[:-1], 1) + np.diag(right[:-1], -1)
    rates = np.zeros(value.shape)
    within = 3.0 * (steep[:-1] + steep[1:])
    rates[1:-1] = np.linalg.solve(matrix, within.reshape(len(within), value[0].size)).reshape(within.shape)
    return rates


@add_flow.of(ChangingCurrent)
def _add_changing(current: ChangingCurrent, motion: WaterMotion, t: Array, x: Array) -> None:
    velocity, rate = _at_time(current, current.clock + t[0] if current.runs else current.clock)
    u, shear = at_heights(x[:, 2], current.level, velocity)
    du, shear_rate = at_heights(x[:, 2], current.level, rate)
    factor, moves = t[0] if current.grows else 1.0, 1.0 if current.runs else 0.0
    for p in range(x.shape[0]):
        for i in range(2):
            motion.velocity[p, i] += factor * u[p, i]
            motion.velocity_gradient[p, i, 2] += factor * shear[p, i]
            motion.acceleration[p, i] += moves * du[p, i]
            motion.acceleration_gradient[p, i, 2] += moves * shear_rate[p, i]


@njit
def _at_time(current: ChangingCurrent, t: float) -> tuple[Array, Array]:
    """Velocity (m, 2) and its rate [m/s2] at the levels."""
    time = current.time
    b = min(max(int(np.searchsorted(time, t, side="right")), 1), time.size - 1)
    a, h = b - 1, time[b] - time[b - 1]
    s = min(max((t - time[a]) / h, 0.0), 1.0)
    velocity, rate = np.empty(current.velocity.shape[1:]), np.empty(current.velocity.shape[1:])
    for m in range(len(velocity)):
        for i in range(2):
            rise = current.velocity[b, m, i] - current.velocity[a, m, i]
            first, last = h * current.rate[a, m, i], h * current.rate[b, m, i]
            bow, turn = 3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise
            velocity[m, i] = current.velocity[a, m, i] + s * (first + s * (bow + s * turn))
            rate[m, i] = (first + s * (2.0 * bow + 3.0 * s * turn)) / h
    return velocity, rate
