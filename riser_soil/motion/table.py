"""Time history of a prescribed motion: cubic splines, or straight lines, through the rows of a table."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from riser_soil.core.arrays import Array
from riser_soil.motion.harmonic import ramped
from riser_soil.riser.ends import Kinematics


class TabulatedMotion:
    """Cubic splines through rows, twice continuously differentiable, times a smooth step of t/ramp.

    time: (n,) increasing [s]. values: (n, 6) displacement [m] and rotation vector [rad]. Not-a-knot at both ends, which
    keeps the splines' fourth order there. straight: lines from row to row instead.
    """

    def __init__(self, time: Array, values: Array, ramp: float = 0.0, straight: bool = False) -> None:
        self._spline = _lines(time, values) if straight else CubicSpline(time, values, bc_type="not-a-knot")
        self._ramp = ramp

    def __call__(self, t: float) -> Kinematics:
        """Displacement and rotation vector (6,) at t [s], and their derivatives."""
        x, v, a = (self._spline(t, order) for order in range(3))
        return ramped(t, self._ramp, x, v, a)


def _lines(time: Array, values: Array) -> PPoly:
    slopes = np.diff(values, axis=0) / np.diff(time)[:, None]
    return PPoly(np.stack([slopes, values[:-1]]), time)
