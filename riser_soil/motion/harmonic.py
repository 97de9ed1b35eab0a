"""Harmonic motion that starts smoothly."""

from __future__ import annotations

import math
from dataclasses import dataclass

from riser_soil.arrays import Array
from riser_soil.smooth_step import smooth_step

Kinematics = tuple[Array, Array, Array]


@dataclass(frozen=True, eq=False)
class Harmonic:
    """position = origin + r(t/ramp) amplitude sin(2 pi t/period + phase); r is twice continuously differentiable.

    origin, amplitude: (3,) [m]. period, ramp [s]; ramp 0 is the full motion at once. phase [rad].
    """

    origin: Array
    amplitude: Array
    period: float
    ramp: float = 0.0
    phase: float = 0.0

    def __call__(self, t: float) -> Kinematics:
        """Position [m], velocity [m/s] and acceleration [m/s2] at t [s]."""
        w = 2.0 * math.pi / self.period
        s, c = math.sin(w * t + self.phase), math.cos(w * t + self.phase)
        r, r1, r2 = smooth_step(t, self.ramp)
        return (
            self.origin + self.amplitude * (r * s),
            self.amplitude * (r1 * s + r * w * c),
            self.amplitude * (r2 * s + 2.0 * r1 * w * c - r * w * w * s),
        )
