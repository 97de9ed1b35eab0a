"""Harmonic prescribed motion with a smooth ramp."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.motion.ramped import ramped
from riser_soil.riser.ends import Kinematics


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
        w = 2.0 * math.pi / self.period
        sine, cosine = self.amplitude * np.sin(w * t + self.phase), self.amplitude * np.cos(w * t + self.phase)
        x, v, a = ramped(t, self.ramp, sine, w * cosine, -w * w * sine)
        return self.origin + x, v, a
