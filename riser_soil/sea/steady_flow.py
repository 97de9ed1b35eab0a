"""Flow of a regular wave of finite height: surface, velocity and acceleration of the water, with all derivatives.

With zeta = s + i z the velocity u along s and w upwards is u - i w = f(zeta), f being analytic: u_s = Re f', u_z = w_s
= -Im f', w_z = -Re f'. The water's acceleration, rate and advection, is a_s - i a_z = -c f' + f' conj f. The
formulas hold up to the surface; above it the water moves as at the surface below. `steady_wave` has the coefficients.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.smooth_step import smooth_step
from riser_soil.sea.flows import WaterMotion, add_flow
from riser_soil.sea.steady_wave import SteadyWave

_ramped = njit(smooth_step)


class SteadyFlow(NamedTuple):
    """A wave that grows smoothly in a stage. speed, rise (m,), k, w, depth: as of `SteadyWave`; toward: unit vector;
    phase [rad]; level: z of the mean surface [m]; ramp, clock, since: as of `WaveField`.
    """

    speed: Array
    rise: Array
    k: float
    w: float
    depth: float
    toward: tuple[float, float]
    phase: float
    level: float
    ramp: float
    clock: float
    since: float


def steady_flow(
    wave: SteadyWave, direction: float, phase: float, level: float, ramp: float, clock: float, since: float
) -> SteadyFlow:
    """The flow of a wave. direction, phase [rad]: of the crest at x = y = 0 and clock 0."""
    of_wave = wave.speed, wave.rise, wave.k, wave.w, wave.depth
    return SteadyFlow(*of_wave, (math.cos(direction), math.sin(direction)), phase, level, ramp, clock, since)


@add_flow.of(SteadyFlow)
def _add_steady(wave: SteadyFlow, motion: WaterMotion, t: Array, x: Array) -> None:
    cx, cy = wave.toward
    factor, rate, _ = _ramped(wave.since + t[0], wave.ramp)
    turned = wave.phase - np.remainder(wave.w * (wave.clock + t[0]), 2.0 * np.pi)
    for p in range(x.shape[0]):
        theta = wave.k * (cx * x[p, 0] + cy * x[p, 1]) + turned
        around = complex(math.cos(theta), math.sin(theta))
        eta, slope = _surface(wave, around)
        rise, steep = factor * eta, factor * slope
        motion.immersion[p] += rise
        motion.immersion_gradient[p, 0] += steep * cx
        motion.immersion_gradient[p, 1] += steep * cy
        z, by_s, by_z = _height(x[p, 2] - wave.level, rise, steep, wave.depth)
        _add_water(motion, wave, p, _potential(wave, around, z), (factor, rate), (by_s, by_z))


@njit
def _surface(wave: SteadyFlow, around: complex) -> tuple[float, float]:
    """Rise of the surface [m] and its slope where the wave has the phase around = exp(i theta)."""
    eta, slope, turn = 0.0, 0.0, complex(1.0, 0.0)
    for n in range(wave.rise.size):
        turn *= around
        eta += wave.rise[n] * turn.real
        slope -= (n + 1.0) * wave.k * wave.rise[n] * turn.imag
    return eta, slope


@njit
def _height(z: float, rise: float, slope: float, h: float) -> tuple[float, float, float]:
    """Height within the water at which a point's motion is taken, with its derivatives by s and z."""
    if z > rise:
        return rise, slope, 0.0
    if z < -h:
        return -h, 0.0, 0.0
    return z, 0.0, 1.0


@njit
def _potential(wave: SteadyFlow, around: complex, z: float) -> tuple[complex, complex, complex]:
    """f, f' and f'' at a height above the mean surface."""
    f, f1, f2 = complex(0.0, 0.0), complex(0.0, 0.0), complex(0.0, 0.0)
    falling = math.exp(wave.k * z) * around.conjugate()
    rising = math.exp(-wave.k * (z + 2.0 * wave.depth)) * around
    down, up = complex(1.0, 0.0), complex(1.0, 0.0)
    for n in range(wave.speed.size):
        down *= falling
        up *= rising
        k, D = (n + 1.0) * wave.k, wave.speed[n]
        f += D * (down + up)
        f1 += D * k * complex(0.0, 1.0) * (up - down)
        f2 -= D * k * k * (down + up)
    return f, f1, f2


@njit
def _add_water(
    motion: WaterMotion,
    wave: SteadyFlow,
    p: int,
    potential: tuple[complex, complex, complex],
    ramp: tuple[float, float],
    height: tuple[float, float],
) -> None:
    """Add velocity and acceleration at a point. ramp: factor and its rate; height: that within the water by s and z."""
    (f, f1, f2), (r, rate), c = potential, ramp, wave.w / wave.k
    carried = f2 * f.conjugate()
    a = -r * c * f1 + r * r * f1 * f.conjugate() + rate * f
    along = -r * c * f2 + r * r * (carried + f1 * f1.conjugate()) + rate * f1
    up = complex(0.0, 1.0) * (-r * c * f2 + r * r * (carried - f1 * f1.conjugate()) + rate * f1)
    _add(motion.velocity, motion.velocity_gradient, p, (r * f, r * f1, r * complex(0.0, 1.0) * f1), wave.toward, height)
    _add(motion.acceleration, motion.acceleration_gradient, p, (a, along, up), wave.toward, height)


@njit
def _add(
    v: Array,
    dv: Array,
    p: int,
    field: tuple[complex, complex, complex],
    toward: tuple[float, float],
    height: tuple[float, float],
) -> None:
    """Add a vector along s and, as the imaginary part's opposite, upwards, with its derivatives by s and the height."""
    value, by_s, by_height = field
    along, up = by_s + by_height * height[0], by_height * height[1]
    parts = (
        (value.real * toward[0], along.real * toward[0], up.real * toward[0]),
        (value.real * toward[1], along.real * toward[1], up.real * toward[1]),
        (-value.imag, -along.imag, -up.imag),
    )
    for i in range(3):
        v[p, i] += parts[i][0]
        dv[p, i, 0] += parts[i][1] * toward[0]
        dv[p, i, 1] += parts[i][1] * toward[1]
        dv[p, i, 2] += parts[i][2]
