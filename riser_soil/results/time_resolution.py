"""Estimate of the time step's error in the extremes of figures, from how sharply the figures turn between steps.

A scheme of second order misses about dt^2 q''/n of a figure q(t), and dt^2 q'' is its second difference

    D = q(n+1) - 2 q(n) + q(n-1).

The estimate of a peak's error is SHARE times the largest |D| of the steps around it. That of an extreme is its own, or
how far another peak goes beyond it with an error of its own: a sharp peak nearly as large as the extreme may be larger
in truth. It costs no solve and knows nothing of what the figure is. It is an estimate of size, not a bound: an error
that has grown elsewhere, as one of phase, goes unnoticed; a corner that the motion itself has counts like one that the
steps have cut.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.saved_state import Saved

NEAR = 0.15  # of its error, by which another peak may be less than the extreme


class TimeResolution:
    """Estimates of the time step's error in the extremes of n figures."""

    def __init__(self, n: int) -> None:
        from riser_soil.results.course import Course, follow  # compiled code is imported where there are stages

        none, unknown = np.zeros((2, n)), np.full((2, n), -np.inf)
        course = Course(
            values=np.full(n, np.nan),
            slope=np.full(n, np.nan),
            past=np.zeros(n),
            times=np.full(2, np.nan),
            extreme=unknown.copy(),
            error=none.copy(),
            steps=none.copy(),
            peak=unknown.copy(),
            leads=np.zeros((2, n), dtype=bool),
            around=none.copy(),
            longest=none.copy(),
            since=none.copy(),
            rival=unknown.copy(),
            rival_error=none.copy(),
            rival_steps=none.copy(),
        )
        self._follow, self._course = follow, course

    def update(self, t: Array | float, values: Array) -> None:
        """t: s; values (n,) after a step, or times (nt,) and values (nt, n) after steps in turn. nan does not count."""
        self._follow(self._course, np.atleast_1d(t), np.ascontiguousarray(np.atleast_2d(values)))

    @property
    def _less(self) -> Array:
        """Extreme less the other peak (2, n), by size."""
        extreme, rival = self._course.extreme, self._course.rival
        return np.subtract(extreme, rival, out=np.full_like(extreme, np.inf), where=np.isfinite(rival))

    @property
    def _rivalled(self) -> BoolArray:
        beyond = self._course.rival_error - self._less > self._course.error
        return beyond & (self._less <= NEAR * self._course.rival_error)

    @property
    def _errors(self) -> Array:
        return np.where(self._rivalled, self._course.rival_error - self._less, self._course.error)

    @property
    def least(self) -> Array:
        """Least values (n,) yet; inf without any."""
        return -self._course.extreme[0]

    @property
    def steps(self) -> Array:
        """Longest steps [s] around the peaks that the errors of the least and the largest values (2, n) come from."""
        return np.where(self._rivalled, self._course.rival_steps, self._course.steps)

    @property
    def of_least(self) -> Array:
        """Estimated error (n,) of the least values."""
        return self._errors[0]

    @property
    def of_most(self) -> Array:
        """Estimated error (n,) of the largest values."""
        return self._errors[1]

    def state(self) -> Saved:
        return {name: values.copy() for name, values in self._course._asdict().items()}

    def restore(self, saved: Saved) -> None:
        for name, values in self._course._asdict().items():
            values[...] = saved[name]
