"""Harmonic prescribed motion with a smooth ramp."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

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
