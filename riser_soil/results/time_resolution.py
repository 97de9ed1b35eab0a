"""Estimate of the time step's error in the extremes of figures, from how sharply the figures turn between steps.

A scheme of second order misses about dt^2 q''/n of a figure q(t), and dt^2 q'' is its second difference

    D = q(n+1) - 2 q(n) + q(n-1).

The estimate of an extreme's error is SHARE times the largest |D| of the steps around it. It costs no solve and knows
nothing of what the figure is. It is an estimate of size, not a bound: an error that has grown elsewhere, as one of
phase, is not seen; a corner that the motion itself has counts like one that the steps have cut.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved, values_of

# Of the largest second difference around an extreme, from the calibration in `tests/verification/test_indicators.py`.
SHARE = 0.3
AFTER = 2  # steps after an extreme that still belong to it


class TimeResolution:
    """Estimates of the time step's error in the extremes of n figures."""

    def __init__(self, n: int) -> None:
        self._values, self._t = np.full((3, n), np.nan), np.full(3, np.nan)
        self._bend, self._past = np.zeros(n), np.zeros(n)  # |D| of the last two steps
        self._least, self._most = np.full(n, np.inf), np.full(n, -np.inf)
        self._of_least, self._of_most = np.zeros(n), np.zeros(n)
        self._since_least, self._since_most = np.full(n, np.inf), np.full(n, np.inf)

    def update(self, t: float, values: Array) -> None:
        """t: s; values (n,) after a step. nan does not count."""
        self._values, self._t = np.vstack([self._values[1:], values]), np.append(self._t[1:], t)
        self._past, self._bend = self._bend, self._second_difference()
        near = np.maximum(self._past, self._bend)
        for side, sign in (("least", -1.0), ("most", 1.0)):
            self._follow(side, sign, values, near)

    def _follow(self, side: str, sign: float, values: Array, near: Array) -> None:
        extreme, error, since = (getattr(self, f"_{name}{side}") for name in ("", "of_", "since_"))
        new = sign * values > sign * extreme
        extreme[new], error[new], since[new] = values[new], near[new], 0.0
        after = ~new & (since < AFTER)
        since[~new] += 1.0
        error[after] = np.maximum(error[after], self._bend[after])

    def _second_difference(self) -> Array:
        """|D| over the last two steps, of the longer one where they differ; 0 where it is not known."""
        first, second = np.diff(self._t)
        slopes = np.diff(self._values, axis=0) / np.array([[first], [second]])
        found = 2.0 * max(first, second) ** 2 / (first + second) * np.abs(slopes[1] - slopes[0])
        return np.nan_to_num(found, nan=0.0, posinf=0.0)

    @property
    def of_least(self) -> Array:
        """Estimated error (n,) of the least values."""
        return SHARE * self._of_least

    @property
    def of_most(self) -> Array:
        """Estimated error (n,) of the largest values."""
        return SHARE * self._of_most

    def state(self) -> Saved:
        return values_of(self)

    def restore(self, saved: Saved) -> None:
        vars(self).update({name: value.copy() for name, value in saved.items()})
