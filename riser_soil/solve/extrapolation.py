"""Predictor of a step's increments: polynomial extrapolation of the steps before."""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.saved_state import Saved

SMOOTH, GRADUAL, ROUGH = 4, 3, 1  # steps that a motion is continued from, at most
PARABOLA = 2
FALL = 0.5  # at most, of each term beyond the parabola to the one before


class Extrapolation:
    """Polynomial extrapolation through the ends of the last steps, by Newton's divided differences of the increments'
    sums.

    The first difference is the mean rate of the last step [1/s], the second half its change [1/s2]. Beyond them only
    terms that fall fast are used: those of what is rough, such as short waves in the riser or a gust, don't.

    most: steps that it continues, which is SMOOTH without contact and GRADUAL on clay. An impact ends what went before:
    with a penalty's contact the last rate alone is the better guess, ROUGH.
    """

    def __init__(self, size: int, most: int) -> None:
        self._most = most
        self._differences: Array = np.zeros((0, size))
        self._steps: Array = np.zeros(0)

    def increments(self, dt: float) -> Array:
        """The increments of a step of dt to come; nothing moves before a first step was accepted."""
        increments: Array = _extrapolated(self._differences, self._steps, dt)
        return increments

    def accept(self, increments: Array, dt: float) -> None:
        """Continue from an accepted step of dt."""
        self._differences, self._steps = _accepted(self._differences, self._steps, increments, dt, self._most)

    def state(self) -> Saved:
        return {"differences": self._differences, "steps": self._steps}

    def restore(self, saved: Saved) -> None:
        self._differences, self._steps = saved["differences"], saved["steps"]


@njit
def _extrapolated(differences: Array, steps: Array, dt: float) -> Array:
    total, largest = np.zeros(differences.shape[1]), math.inf
    factor = span = dt
    for order in range(differences.shape[0]):
        size = 0.0
        for i in range(total.size):
            size = max(size, abs(factor * differences[order, i]))
        if order >= PARABOLA and size > FALL * largest:
            break
        for i in range(total.size):
            total[i] += factor * differences[order, i]
        largest, span = size, span + steps[order]
        factor *= span
    return total


@njit
def _accepted(differences: Array, steps: Array, increments: Array, dt: float, most: int) -> tuple[Array, Array]:
    """Differences (k, n) and sizes of the steps (k,) with a further one, at most so many."""
    orders = min(differences.shape[0] + 1, most)
    divided, sizes = np.empty((orders, increments.size)), np.empty(orders)
    sizes[0], span = dt, dt
    for i in range(increments.size):
        divided[0, i] = increments[i] / dt
    for order in range(1, orders):
        span += steps[order - 1]
        sizes[order] = steps[order - 1]
        for i in range(increments.size):
            divided[order, i] = (divided[order - 1, i] - differences[order - 1, i]) / span
    return divided, sizes
