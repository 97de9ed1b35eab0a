"""Linear waves: surface, velocity and acceleration of the water, with all derivatives, for a sum of components.

With theta = k (x cos d + y sin d) - w t + phase, each component has

    surface   a cos theta
    velocity  a w C cos theta along (cos d, sin d), a w S sin theta upwards

with C = cosh k(z + h)/sinh kh and S = sinh k(z + h)/sinh kh, z being the height above the mean surface and h the depth,
which may be inf. The acceleration is the local one, dv/dt at a fixed point: linear theory drops the convective part.
Where z is stretched, both the formula of v and that of a are taken at z', as is the practice: a is dv/dt at a fixed z'.
The gradients are the exact derivatives of v and a as returned. `wave_series` takes the sums.
Source: Airy (1845), as in Dean and Dalrymple, Water Wave Mechanics for Engineers and Scientists (1984), chapter 3.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.smooth_step import smooth_step
from riser_soil.sea import wave_series as series
from riser_soil.sea.components import Components
from riser_soil.sea.flows import WaterMotion, add_flow
from riser_soil.sea.wave_series import WaveSeries, WaveTrain, train, turn

Vector = tuple[float, float, float]
_ramped = njit(smooth_step)
Stretching = Literal["wheeler", "vertical"]


class Heights(NamedTuple):
    """Points at which linear theory is evaluated: height z (n,) from the mean surface [m], its gradient (n, 3) at the
    points.
    """

    z: Array
    gradient: Array


class WaveField(NamedTuple):
    """Linear waves of a stage that grow smoothly, with surface, velocity and acceleration ramped alike.

    The acceleration is the rate of the ramped velocity, the ramp's own share included.
    level: z of the mean surface [m]; wheeler: whether z is stretched Wheeler's way. clock: what the waves' clock, which
    their phases are counted on, shows when the stage begins [s]. ramp [s] is counted from the waves' beginning; since:
    how long they have acted when the stage begins [s]. now: (3,) time of the stage that they have been brought to [s],
    or nan, and the ramp's factor then with its rate [1/s].
    """

    train: WaveTrain
    series: WaveSeries
    level: float
    wheeler: bool
    ramp: float
    clock: float
    since: float
    now: Array


def linear_waves(
    components: Components,
    depth: float,
    surface_level: float,
    stretching: Stretching = "wheeler",
    ramp: float = 0.0,
    clock: float = 0.0,
    since: float | None = None,
) -> WaveField:
    """Waves in water of a depth [m], which may be inf, brought to no time yet; since: by default what the clock shows.
    """
    prepared, times = train(components, depth), (ramp, clock, clock if since is None else since)
    of_train = prepared, series.wave_series(prepared)
    return WaveField(*of_train, surface_level, stretching == "wheeler", *times, np.full(3, np.nan))


@add_flow.of(WaveField)
def _add_waves(sea: WaveField, motion: WaterMotion, t: Array, x: Array) -> None:
    _update(sea, t[0])
    rise, slope = _surface(sea, x)
    z = _heights(x, sea.level)
    at = wheeler(z, rise, slope, sea.train.depth) if sea.wheeler else vertical(z, sea.train.depth)
    for p in range(len(x)):
        motion.immersion[p] += rise[p]
        motion.immersion_gradient[p, 0] += slope[p, 0]
        motion.immersion_gradient[p, 1] += slope[p, 1]
    for g in range(len(sea.train.toward)):
        _add_direction(motion, sea, g, x, at)


@njit
def _update(sea: WaveField, t: float) -> None:
    """Bring the waves to a time, unless they are there."""
    if sea.now[0] != t:
        turn(sea.train, sea.clock + t)
        sea.now[1], sea.now[2], _ = _ramped(sea.since + t, sea.ramp)
        sea.now[0] = t


@njit
def _heights(x: Array, level: float) -> Array:
    """Heights of points above a level [m]."""
    z = np.empty(len(x))
    for p in range(len(x)):
        z[p] = x[p, 2] - level
    return z


@njit
def _along(x: Array, cx: float, cy: float) -> Array:
    """Places of points along a horizontal direction [m]."""
    s = np.empty(len(x))
    for p in range(len(x)):
        s[p] = cx * x[p, 0] + cy * x[p, 1]
    return s


@njit
def _surface(sea: WaveField, x: Array) -> tuple[Array, Array]:
    """Rise of the surface above its mean at points (n,), and its slope along x and y (n, 2)."""
    rise, slope = np.zeros(len(x)), np.zeros((len(x), 2))
    t, factor, _ = sea.now
    for g in range(len(sea.train.toward)):
        cx, cy = sea.train.toward[g]
        eta, along = series.surface(sea.series, sea.train, t, g, _along(x, cx, cy))
        for p in range(len(x)):
            rise[p] += factor * eta[p]
            slope[p, 0] += factor * along[p] * cx
            slope[p, 1] += factor * along[p] * cy
    return rise, slope


@njit
def wheeler(z: Array, eta: Array, slope: Array, h: float) -> Heights:
    """Wheeler's stretching: z' = (z - eta) h/(h + eta), at the surface 0 and at the bottom -h.

    Source: Wheeler, Journal of Petroleum Technology 22 (1970) 359-367.
    """
    at = Heights(np.empty(z.size), np.empty((z.size, 3)))
    for p in range(z.size):
        shrink = 1.0 / (1.0 + eta[p] / h)
        stretched = (z[p] - eta[p]) * shrink
        by_slope = -shrink * (1.0 + stretched / h)
        _place(at, p, stretched, (by_slope * slope[p, 0], by_slope * slope[p, 1], shrink), h)
    return at


@njit
def vertical(z: Array, h: float) -> Heights:
    """Vertical stretching: above the mean surface the water moves as it does there."""
    at = Heights(np.empty(z.size), np.empty((z.size, 3)))
    for p in range(z.size):
        _place(at, p, z[p], (0.0, 0.0, 1.0), h)
    return at


@njit
def _place(at: Heights, p: int, z: float, gradient: Vector, h: float) -> None:
    """Above the surface and below the bottom the water moves as it does there."""
    at.z[p] = min(max(z, -h), 0.0)
    for i in range(3):
        at.gradient[p, i] = gradient[i] if at.z[p] == z else 0.0


@njit
def _add_direction(motion: WaterMotion, sea: WaveField, g: int, x: Array, at: Heights) -> None:
    """Add the flow of the waves of one direction."""
    t, factor, rate = sea.now
    cx, cy = sea.train.toward[g]
    v, a = series.flow(sea.series, sea.train, t, g, _along(x, cx, cy), at.z)
    for p in range(len(x)):
        value, by_z = factor * a.value[p] + rate * v.value[p], factor * a.by_z[p] + rate * v.by_z[p]
        _add(motion.velocity, motion.velocity_gradient, p, factor * v.value[p], factor * v.by_z[p], cx, cy, at.gradient)
        _add(motion.acceleration, motion.acceleration_gradient, p, value, by_z, cx, cy, at.gradient)


@njit
def _add(v: Array, dv: Array, p: int, value: complex, by_z: complex, cx: float, cy: float, gradient: Array) -> None:
    """Add a flow without divergence and curl in (x, y, z'), whose z' has a gradient in (x, y, z)."""
    by_s, across = -by_z.imag, by_z.real
    components = value.real * cx, value.real * cy, value.imag
    rows = (
        (by_s * cx * cx, by_s * cx * cy, across * cx),
        (by_s * cx * cy, by_s * cy * cy, across * cy),
        (across * cx, across * cy, -by_s * cx * cx - by_s * cy * cy),
    )
    for i in range(3):
        v[p, i] += components[i]
        dv[p, i, 0] += rows[i][0] + rows[i][2] * gradient[p, 0]
        dv[p, i, 1] += rows[i][1] + rows[i][2] * gradient[p, 1]
        dv[p, i, 2] += rows[i][2] * gradient[p, 2]
