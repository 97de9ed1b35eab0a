"""The first guess of a step's increments: the motion of the steps before it continued."""

from __future__ import annotations

import numpy as np

from riser_soil.arrays import Array


class Extrapolation:
    """Mean rate of the last step, at its middle, and its change since the step before [1/s, 1/s2 of the increments].

    smooth: whether the change goes on, so that the motion follows a parabola in time. An impact ends what went before:
    with contact the last rate alone is the better guess.
    """

    def __init__(self, size: int, smooth: bool) -> None:
        self._smooth = smooth
        self._rate, self._slope = np.zeros(size), np.zeros(size)
        self._dt = 0.0

    def increments(self, dt: float) -> Array:
        """The increments of a step of dt to come; nothing moves before a first step was accepted."""
        return dt * (self._rate + 0.5 * (self._dt + dt) * self._slope)

    def accept(self, increments: Array, dt: float) -> None:
        """Continue from a step of dt that has been taken."""
        rate = increments / dt
        if self._smooth and self._dt > 0.0:
            self._slope = (rate - self._rate) / (0.5 * (self._dt + dt))
        self._rate, self._dt = rate, dt
