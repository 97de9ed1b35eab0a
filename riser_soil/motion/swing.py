"""Harmonic rotation: ends that swing on an arc about a hub, and supports that rock about an axis."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.motion.ramped import ramped
from riser_soil.riser.ends import Kinematics, SupportRotation


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
        middle, arm, across = self._circle
        turned: Array = arm * math.cos(phi) + across * math.sin(phi)
        ahead = across * math.cos(phi) - arm * math.sin(phi)
        return middle + turned, rate * ahead, acceleration * ahead - rate * rate * turned

    @cached_property
    def _circle(self) -> tuple[Array, Array, Array]:
        """Its middle (3,) [m], the arm to the origin, and the arm a quarter turn on."""
        arm = self.origin - self.hub
        along = float(arm @ self.axis) * self.axis
        return self.hub + along, arm - along, np.asarray(np.cross(self.axis, arm), dtype=float)


@dataclass(frozen=True, eq=False)
class RockingSupport:
    """A support that turns about a unit vector `axis` (3,) by the swing's angle, right-handed."""

    axis: Array
    swing: AngleOscillation

    def __call__(self, t: float) -> SupportRotation:
        """Turning at t [s]."""
        phi, rate, acceleration = self.swing(t)
        return SupportRotation(phi * self.axis, rate * self.axis, acceleration * self.axis)
