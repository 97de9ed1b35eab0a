"""Harmonic motion that starts smoothly."""

from __future__ import annotations

import math
from dataclasses import dataclass

from riser_soil.arrays import Array

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
        r, r1, r2 = _smooth_step(t, self.ramp)
        return (
            self.origin + self.amplitude * (r * s),
            self.amplitude * (r1 * s + r * w * c),
            self.amplitude * (r2 * s + 2.0 * r1 * w * c - r * w * w * s),
        )


def _smooth_step(t: float, ramp: float) -> tuple[float, float, float]:
    """10 x^3 - 15 x^4 + 6 x^5 of x = t/ramp, 0 before and 1 after, with its first two derivatives in t."""
    if t >= ramp:
        return 1.0, 0.0, 0.0
    x = max(t / ramp, 0.0)
    value = x**3 * (10.0 - 15.0 * x + 6.0 * x * x)
    slope = 30.0 * x * x * (1.0 - x) ** 2 / ramp
    return value, slope, 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / ramp**2
