"""Estimate of the time step's error in the extremes of figures, from how sharply the figures turn between steps.

A scheme of second order misses about dt^2 q''/n of a figure q(t), and dt^2 q'' is its second difference

    D = q(n+1) - 2 q(n) + q(n-1).

The estimate of an extreme's error is SHARE times the largest |D| of the steps around it. It costs no solve and knows
nothing of what the figure is. It is an estimate of size, not a bound: an error that has grown elsewhere, as one of
phase, is not seen; a corner that the motion itself has counts like one that the steps have cut.
"""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved, values_of

# Of the largest second difference around an extreme, from the calibration in `tests/verification/test_indicators.py`.
SHARE = 0.3
_SIGNS = np.array([[-1.0], [1.0]])
AFTER = 2  # steps after an extreme that still belong to it


class TimeResolution:
    """Estimates of the time step's error in the extremes of n figures."""

    def __init__(self, n: int) -> None:
        self._values: Array = np.full(n, np.nan)
        self._slope: Array = np.full(n, np.nan)
        self._t, self._dt = math.nan, math.nan
        self._past: Array = np.zeros(n)  # |D| of the step before
        # Of the least values, negative, and of the largest: the value, the largest |D| around it, updates since.
        self._extreme: Array = np.full((2, n), -np.inf)
        self._around: Array = np.zeros((2, n))
        self._since: Array = np.full((2, n), np.inf)
        self._steps: Array = np.zeros((2, n))  # s, the longest of those around it

    def update(self, t: float, values: Array) -> None:
        """t: s; values (n,) after a step. nan does not count."""
        dt = t - self._t
        slope = (values - self._values) / dt
        longer = max(dt, self._dt)
        bend = (2.0 * longer**2 / (dt + self._dt)) * np.abs(slope - self._slope)
        bend = np.where(bend >= 0.0, bend, 0.0)
        self._values, self._slope, self._t, self._dt = values.copy(), slope, t, dt
        signed = _SIGNS * values
        new = signed > self._extreme
        self._since = np.where(new, 0.0, self._since + 1.0)
        self._extreme = np.where(new, signed, self._extreme)
        near = self._since <= AFTER
        kept = np.where(near, np.maximum(self._around, bend), self._around)
        self._around = np.where(new, np.maximum(self._past, bend), kept)
        self._steps = np.where(new, longer, np.where(near, np.fmax(self._steps, longer), self._steps))
        self._past = bend

    @property
    def least(self) -> Array:
        """Least values (n,) yet; inf without any."""
        return -self._extreme[0]

    @property
    def steps(self) -> Array:
        """Longest steps [s] around the least and the largest values (2, n)."""
        return self._steps

    @property
    def of_least(self) -> Array:
        """Estimated error (n,) of the least values."""
        return SHARE * self._around[0]

    @property
    def of_most(self) -> Array:
        """Estimated error (n,) of the largest values."""
        return SHARE * self._around[1]

    def state(self) -> Saved:
        return values_of(self)

    def restore(self, saved: Saved) -> None:
        vars(self).update({name: value.copy() if value.ndim else float(value) for name, value in saved.items()})
