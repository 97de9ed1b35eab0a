"""Prescribed motions of an end: harmonic, swinging on an arc about a hub, by a table, or without rates; smooth ramp."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.smooth_step import smooth_step
from riser_soil.riser.line_ends import Kinematics, Motion, SupportRotation

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

Value = TypeVar("Value", float, Array)


@dataclass(frozen=True, eq=False)
class HarmonicMotion:
    """position = origin + r(t/ramp) amplitude sin(2 pi t/period + phase); r is twice continuously differentiable.

    origin, amplitude: (3,) [m]. period, ramp [s]; ramp 0 is the full motion at once. phase [rad]: one for all
    components, or (3,).
    """

    origin: Array
    amplitude: Array
    period: float
    ramp: float = 0.0
    phase: float | Array = 0.0

    def __call__(self, t: float) -> Kinematics:
        """Position [m], velocity [m/s] and acceleration [m/s2] at t [s]."""
        x, v, a = np.zeros(3), np.zeros(3), np.zeros(3)
        for i, amplitude, phase in self._components:
            x[i], v[i], a[i] = self._component(t, amplitude, phase)
        return self.origin + x, v, a

    @cached_property
    def _components(self) -> list[tuple[int, float, float]]:
        """Number, amplitude and phase of each that moves: for three plain arithmetic is faster than that of arrays."""
        phases = np.broadcast_to(self.phase, self.amplitude.shape)
        each = zip(self.amplitude, phases, strict=True)
        return [(i, float(size), float(phase)) for i, (size, phase) in enumerate(each) if size != 0.0]

    def _component(self, t: float, amplitude: float, phase: float) -> tuple[float, float, float]:
        w = 2.0 * math.pi / self.period
        sine, cosine = amplitude * math.sin(w * t + phase), amplitude * math.cos(w * t + phase)
        return ramped(t, self.ramp, sine, w * cosine, -w * w * sine)


def ramped(t: float, ramp: float, x: Value, v: Value, a: Value) -> tuple[Value, Value, Value]:
    """The product of x and a smooth step of t/ramp, with its first two derivatives in t; v, a: those of x."""
    if t >= ramp:
        return x, v, a
    r, r1, r2 = smooth_step(t, ramp)
    return r * x, r1 * x + r * v, r2 * x + 2.0 * r1 * v + r * a


@dataclass(frozen=True)
class AngleOscillation:
    """phi = r(t/ramp) amplitude sin(2 pi t/period + phase), in rad; r as in `smooth_step`; period, ramp [s]."""

    amplitude: float
    period: float
    ramp: float = 0.0
    phase: float = 0.0

    def __call__(self, t: float) -> tuple[float, float, float]:
        """phi [rad] and its first two derivatives at t [s]."""
        w = 2.0 * math.pi / self.period
        sine, cosine = self.amplitude * math.sin(w * t + self.phase), self.amplitude * math.cos(w * t + self.phase)
        return ramped(t, self.ramp, sine, w * cosine, -w * w * sine)


@dataclass(frozen=True, eq=False)
class SwingingEnd:
    """`origin` turned about the line through `hub` along the unit vector `axis` by the swing's angle, right-handed.

    origin, hub, axis: (3,), [m].
    """

    origin: Array
    hub: Array
    axis: Array
    swing: AngleOscillation

    def __call__(self, t: float) -> Kinematics:
        """Position [m], velocity [m/s] and acceleration [m/s2] at t [s]."""
        phi, rate, acceleration = self.swing(t)
        middle, arms = self._circle
        turned, ahead = (math.cos(phi), math.sin(phi)), (-math.sin(phi), math.cos(phi))
        change = [acceleration * along - rate * rate * out for along, out in zip(ahead, turned, strict=True)]
        x, v, a = np.array([turned, [rate * along for along in ahead], change]) @ arms
        return middle + x, v, a

    @cached_property
    def _circle(self) -> tuple[Array, Array]:
        """A circle's middle (3,) [m]; the arm to the origin, and the arm a quarter turn on (2, 3) [m]."""
        arm = self.origin - self.hub
        along = float(arm @ self.axis) * self.axis
        return self.hub + along, np.stack([arm - along, np.cross(self.axis, arm)])


@dataclass(frozen=True, eq=False)
class RockingSupport:
    """A support that turns about a unit vector `axis` (3,) by the swing's angle, right-handed."""

    axis: Array
    swing: AngleOscillation

    def __call__(self, t: float) -> SupportRotation:
        """Turning at t [s]."""
        phi, rate, acceleration = self.swing(t)
        return SupportRotation(phi * self.axis, rate * self.axis, acceleration * self.axis)


class TabulatedMotion:
    """Cubic splines through rows, twice continuously differentiable, times a smooth step of t/ramp.

    time: (n,) increasing [s]. values: (n, 6) displacement [m] and rotation vector [rad]. Not-a-knot at both ends, which
    keeps the splines' fourth order there. straight: lines from row to row instead.
    """

    def __init__(self, time: Array, values: Array, ramp: float = 0.0, straight: bool = False) -> None:
        from scipy.interpolate import CubicSpline  # takes time

        self._spline = _lines(time, values) if straight else CubicSpline(time, values, bc_type="not-a-knot")
        self._ramp = ramp

    def __call__(self, t: float) -> Kinematics:
        """Displacement and rotation vector (6,) at t [s], and their derivatives."""
        x, v, a = (self._spline(t, order) for order in range(3))
        return ramped(t, self._ramp, x, v, a)


def _lines(time: Array, values: Array) -> PPoly:
    from scipy.interpolate import PPoly

    slopes = np.diff(values, axis=0) / np.diff(time)[:, None]
    return PPoly(np.stack([slopes, values[:-1]]), time)


@dataclass(frozen=True, eq=False)
class SlowMotion:
    """The places of a motion."""

    motion: Motion

    def __call__(self, t: float) -> Kinematics:
        """Position [m] at t; nothing has a velocity."""
        return self.motion(t)[0], np.zeros(3), np.zeros(3)


@dataclass(frozen=True, eq=False)
class SlowTurning:
    """The rotations of a support."""

    turning: Callable[[float], SupportRotation]

    def __call__(self, t: float) -> SupportRotation:
        """Turning at t; nothing has an angular velocity."""
        return SupportRotation(self.turning(t).rotation, np.zeros(3), np.zeros(3))


@dataclass(frozen=True, eq=False)
class SmoothMove:
    """Straight from `origin` to `target` (3,) [m] as the load factor grows from 0 to 1."""

    origin: Array
    target: Array

    def __call__(self, t: float) -> tuple[Array, Array, Array]:
        """Position [m] at the load factor t; there are no rates in statics."""
        return self.origin + t * (self.target - self.origin), np.zeros(3), np.zeros(3)
