"""Simulated time of a run over all its stages: the time axis of the results."""

from __future__ import annotations

import numpy as np

from riser_soil.core.saved_state import Saved

# Equilibria of static stages take no time; those that would share an instant are set this far apart [s],
# because readers of time series want time to grow.
TICK = 1e-6


class SimulatedTime:
    """Total simulated time: quasi-static and dynamic stages add up, static stages take none."""

    def __init__(self) -> None:
        self._begun = 0.0
        self._now = 0.0
        self._last_record = -TICK
        self._static = True

    @property
    def stage_time(self) -> float:
        """s simulated in the current stage."""
        return self._now - self._begun

    @property
    def now(self) -> float:
        return self._now

    def of_stage(self, t: float) -> float:
        """The time at t of the present stage [s]."""
        return self._begun + t

    def begin_stage(self, kind: str) -> None:
        self._static = kind == "static"
        self._begun = self._now

    def advance(self, t: float) -> None:
        """t: s since the stage began; in a static stage the load factor, which is no time."""
        if not self._static:
            self._now = self.of_stage(t)

    def stamp(self) -> float:
        """Time of a record made now [s], later than that of every record before."""
        after = self._last_record + TICK
        self._last_record = self._now if self._now > self._last_record else after
        return self._last_record

    def state(self) -> Saved:
        times = {"begun": self._begun, "now": self._now, "last_record": self._last_record, "static": self._static}
        return {name: np.array(value) for name, value in times.items()}

    def restore(self, saved: Saved) -> None:
        self._begun, self._now = float(saved["begun"]), float(saved["now"])
        self._last_record, self._static = float(saved["last_record"]), bool(saved["static"])
