"""Predictor: first guess of a step's increments, extrapolated from the steps before it."""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved

STEPS = 4  # that a smooth motion is continued from, at most
PARABOLA = 2
FALL = 0.5  # at most, of each term beyond the parabola to the one before


class Extrapolation:
    """Polynomial extrapolation through the ends of the last steps, by Newton's divided differences of the increments'
    sums.

    The first difference is the mean rate of the last step [1/s], the second half its change [1/s2]. Beyond them only
    terms that fall fast are taken: those of what is rough, such as short waves in the riser or a gust, don't.

    smooth: whether changes go on at all. An impact ends what went before: with contact the last rate alone is the
    better guess.
    """

    def __init__(self, size: int, smooth: bool) -> None:
        self._size, self._most = size, STEPS if smooth else 1
        self._differences: list[Array] = []
        self._steps: list[float] = []

    def increments(self, dt: float) -> Array:
        """The increments of a step of dt to come; nothing moves before a first step was accepted."""
        total, largest = np.zeros(self._size), math.inf
        factor = span = dt
        for order, (difference, step) in enumerate(zip(self._differences, self._steps, strict=True), start=1):
            term = factor * difference
            size = float(np.abs(term).max())
            if order > PARABOLA and size > FALL * largest:
                break
            total += term
            largest, span = size, span + step
            factor *= span
        return total

    def accept(self, increments: Array, dt: float) -> None:
        """Continue from a step of dt that has been taken."""
        found, span, kept = [increments / dt], dt, self._most - 1
        for before, step in zip(self._differences[:kept], self._steps, strict=False):
            span += step
            found.append((found[-1] - before) / span)
        self._differences, self._steps = found, [dt, *self._steps[:kept]]

    def state(self) -> Saved:
        return {"differences": np.array(self._differences), "steps": np.array(self._steps)}

    def restore(self, saved: Saved) -> None:
        self._differences, self._steps = list(saved["differences"]), [float(dt) for dt in saved["steps"]]
