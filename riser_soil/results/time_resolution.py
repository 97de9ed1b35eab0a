"""Estimate of the time step's error in the extremes of figures, from how sharply the figures turn between steps.

A scheme of second order misses about dt^2 q''/n of a figure q(t), and dt^2 q'' is its second difference

    D = q(n+1) - 2 q(n) + q(n-1).

The estimate of a peak's error is SHARE times the largest |D| of the steps around it. That of an extreme is its own, or
how far another peak goes beyond it with an error of its own: a sharp peak nearly as large as the extreme may be larger
in truth. It costs no solve and knows nothing of what the figure is. It is an estimate of size, not a bound: an error
that has grown elsewhere, as one of phase, is not seen; a corner that the motion itself has counts like one that the
steps have cut.
"""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.saved_state import Saved, values_of

# Of the largest second difference around an extreme, from the calibration in `tests/verification/test_indicators.py`.
SHARE = 0.3
_SIGNS = np.array([[-1.0], [1.0]])
AFTER = 2  # steps after a peak that still belong to it
NEAR = 0.15  # of its error, by which another peak may be less than the extreme


class TimeResolution:
    """Estimates of the time step's error in the extremes of n figures.

    Arrays (2, n) are of the least values, negative, and of the largest.
    """

    def __init__(self, n: int) -> None:
        self._values: Array = np.full(n, np.nan)
        self._slope: Array = np.full(n, np.nan)
        self._t, self._dt = math.nan, math.nan
        self._past: Array = np.zeros(n)  # |D| of the step before
        self._extreme: Array = np.full((2, n), -np.inf)
        self._error: Array = np.zeros((2, n))  # its own
        self._steps: Array = np.zeros((2, n))  # s, the longest around it
        # The latest peak, or the value while it rises: whether it is the extreme, the largest |D| and the longest step
        # [s] around it, updates since.
        self._peak: Array = np.full((2, n), -np.inf)
        self._leads: BoolArray = np.zeros((2, n), dtype=bool)
        self._around: Array = np.zeros((2, n))
        self._longest: Array = np.zeros((2, n))
        self._since: Array = np.zeros((2, n))
        # Of the peaks yet, the one that goes farthest with its error, and the longest step [s] around it.
        self._rival: Array = np.full((2, n), -np.inf)
        self._rival_error: Array = np.zeros((2, n))
        self._rival_steps: Array = np.zeros((2, n))

    def update(self, t: float, values: Array) -> None:
        """t: s; values (n,) after a step. nan does not count."""
        dt = t - self._t
        slope = (values - self._values) / dt
        longer = max(dt, self._dt)
        bend = (2.0 * longer**2 / (dt + self._dt)) * np.abs(slope - self._slope)
        bend = np.where(bend >= 0.0, bend, 0.0)
        signed, last = _SIGNS * values, _SIGNS * self._values
        falls = np.asarray(signed <= last)
        self._look_back(bend, longer)
        self._end_peaks(falls | (self._since > 0.0))
        self._follow(signed, ~np.isnan(signed) & ~falls, bend, longer)
        self._values, self._slope, self._t, self._dt, self._past = values.copy(), slope, t, dt, bend

    def _look_back(self, bend: Array, step: float) -> None:
        """What a step tells of the peaks before it."""
        near = self._since < AFTER
        self._around = np.where(near, np.maximum(self._around, bend), self._around)
        self._longest = np.where(near, np.fmax(self._longest, step), self._longest)
        self._keep()

    def _end_peaks(self, turned: BoolArray) -> None:
        error = SHARE * self._around
        beyond = turned & (self._peak + error > self._rival + self._rival_error)
        self._rival = np.where(beyond, self._peak, self._rival)
        self._rival_error = np.where(beyond, error, self._rival_error)
        self._rival_steps = np.where(beyond, self._longest, self._rival_steps)

    def _follow(self, signed: Array, rises: BoolArray, bend: Array, step: float) -> None:
        self._leads = np.where(rises, signed > self._extreme, self._leads)
        self._extreme = np.fmax(self._extreme, signed)
        self._peak = np.where(rises, signed, self._peak)
        self._around = np.where(rises, np.maximum(self._past, bend), self._around)
        self._longest = np.where(rises, step, self._longest)
        self._since = np.where(rises, 0.0, self._since + 1.0)
        self._keep()

    def _keep(self) -> None:
        """What is known of the extreme, where it is followed."""
        self._error = np.where(self._leads, SHARE * self._around, self._error)
        self._steps = np.where(self._leads, self._longest, self._steps)

    @property
    def _less(self) -> Array:
        """How much less than the extreme the other peak is (2, n)."""
        known = np.isfinite(self._rival)
        return np.subtract(self._extreme, self._rival, out=np.full_like(self._extreme, np.inf), where=known)

    @property
    def _rivalled(self) -> BoolArray:
        beyond = self._rival_error - self._less > self._error
        return beyond & (self._less <= NEAR * self._rival_error)

    @property
    def _errors(self) -> Array:
        return np.where(self._rivalled, self._rival_error - self._less, self._error)

    @property
    def least(self) -> Array:
        """Least values (n,) yet; inf without any."""
        return -self._extreme[0]

    @property
    def steps(self) -> Array:
        """Longest steps [s] around the peaks that the errors of the least and the largest values (2, n) come from."""
        return np.where(self._rivalled, self._rival_steps, self._steps)

    @property
    def of_least(self) -> Array:
        """Estimated error (n,) of the least values."""
        return self._errors[0]

    @property
    def of_most(self) -> Array:
        """Estimated error (n,) of the largest values."""
        return self._errors[1]

    def state(self) -> Saved:
        return values_of(self)

    def restore(self, saved: Saved) -> None:
        vars(self).update({name: value.copy() if value.ndim else float(value) for name, value in saved.items()})
