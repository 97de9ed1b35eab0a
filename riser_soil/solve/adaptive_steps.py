"""Adaptive time steps: step sizes from the local error that each step makes.

The step size that meets the error tolerance follows from the order of the error. An integral controller (in the
logarithm) goes part of the way there, quickly downwards, slowly upwards: a change of step size excites the stiff modes
of a riser, which persist at small steps. With sizes that follow the error as closely upwards as downwards, the error
of the tension of a hose that sweeps a floor was twice as large at the same cost.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from riser_soil.core.saved_state import Saved

ORDER = 3  # of the local error in the step size
AIM = 0.3  # of the tolerance: the local error that steps are chosen for
DOWN, UP = 0.5, 0.1  # of the way to the size that would have fitted, by one step
AHEAD = 4.0  # times the last step: the longest that can be foreseen from it
LEAST_CUT, MOST_CUT = 0.9, 0.2  # of a step that is tried again for its error
LONGEST, FIRST = 0.05, 0.01  # of the stage, where nothing else limits a step
NEAR = 1e-9


class AutoSteps:
    """Adaptive steps from 0 to `end` [s] whose local error stays within `tolerance` [m]; see the module's text.

    smallest [s]: steps are not cut below it. first [s]: size to begin with. stops [s]: times to be hit, in any order;
    up to the next one all steps are equal unless the error changes.
    """

    judges_error = True

    def __init__(
        self, end: float, tolerance: float, smallest: float, first: float, stops: Iterable[float] = ()
    ) -> None:
        self.end, self.tolerance = end, tolerance
        self._smallest = smallest
        self._stops = from_last_to_first(end, stops)
        self._now = 0.0
        self._size = max(smallest, min(first, FIRST * end))
        self._error = 0.0
        self._failed = False

    @property
    def finished(self) -> bool:
        return not self._stops

    @property
    def target(self) -> float:
        """Time at the end of the step to be tried."""
        stop = self._stops[-1]
        steps = math.ceil((stop - self._now) / self._size - NEAR)
        return stop if steps <= 1 else self._now + (stop - self._now) / steps

    @property
    def dt(self) -> float:
        return self.target - self._now

    def rejection(self, error: float) -> str:
        """Why a step of this local error [m] is not accepted; empty for a good one. The size follows from it."""
        self._error = error
        if error <= self.tolerance:
            return ""
        return f"the step's local error of {error:.3g} m exceeds the tolerance of {self.tolerance:.3g} m"

    def accept(self, easy: bool) -> None:
        """Move on; a step that was hard, or failed at first, is not followed by a longer one."""
        fit = self._fit() if easy and not self._failed else min(self._fit(), self._size)
        size = self._size * (fit / self._size) ** (UP if fit > self._size else DOWN)
        self._now = self.target
        if self._now == self._stops[-1]:
            self._stops.pop()
        self._size = max(self._smallest, min(size, LONGEST * self.end))
        self._error, self._failed = 0.0, False

    def cut(self) -> bool:
        """Shorten the step: as its error asks, else to its half; False when it can't be shortened any more."""
        dt = self.dt
        if dt <= (1.0 + NEAR) * self._smallest:
            return False
        wrong = self._error > self.tolerance
        self._size = max(self._smallest, min(LEAST_CUT * dt, max(MOST_CUT * dt, self._fit())) if wrong else 0.5 * dt)
        self._error, self._failed = 0.0, True
        return True

    def state(self) -> Saved:
        """Stops: those to come, the next one last."""
        return {"now": np.array(self._now), "size": np.array(self._size), "stops": np.array(self._stops)}

    def restore(self, saved: Saved) -> None:
        self._now, self._size = float(saved["now"]), float(saved["size"])
        self._stops = [float(t) for t in saved["stops"]]
        self._error, self._failed = 0.0, False

    def _fit(self) -> float:
        """Size that would have made the error aimed at."""
        aim = AIM * self.tolerance
        return float(self.dt * (aim / max(self._error, aim / AHEAD**ORDER)) ** (1.0 / ORDER))


def from_last_to_first(end: float, stops: Iterable[float]) -> list[float]:
    """The end and all stops before it, without those that all but meet one after them."""
    spaced = [end]
    for stop in sorted(stops, reverse=True):
        if NEAR * end < stop < spaced[-1] - NEAR * end:
            spaced.append(stop)
    return spaced
