"""Output schedule, which accepted steps are written to which file, and simulated time over all stages."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from riser_soil.core.saved_state import Saved, gathered, restore_all

# Share of an interval by which a step may end early and still count: time is a sum of steps.
_SLACK = 1e-6
# Equilibria of static stages take no time; those that would share an instant are set this far apart [s],
# because readers of time series want time to grow.
TICK = 1e-6


@dataclass(frozen=True)
class DueOutputs:
    """Files that a step is written to."""

    series: bool  # results.nc
    pictures: bool  # files for ParaView


class _OutputInterval:
    """Multiples of one interval [s]; none means every step."""

    def __init__(self, interval: float | None) -> None:
        self._interval = interval
        self._count = 1

    def restart(self) -> None:
        self._count = 1

    def reached(self, t: float) -> bool:
        if self._interval is None:
            return True
        passed = math.floor(t / self._interval + _SLACK)
        if passed < self._count:
            return False
        self._count = passed + 1
        return True

    def state(self) -> Saved:
        return {"count": np.array(self._count)}

    def restore(self, saved: Saved) -> None:
        self._count = int(saved["count"])


class Schedule:
    """Says after each accepted step what is to be written.

    A quasi-static or dynamic stage is written at the first accepted step at or after each multiple of the interval
    since the stage began, and at its last step; a static stage only at its last step. Pictures imply the series.

    interval: s between records of results.nc; None for every accepted step.
    picture_interval: s between frames of the XDMF files; None for the same as `interval`.
    """

    def __init__(self, interval: float | None = None, picture_interval: float | None = None) -> None:
        self._series = _OutputInterval(interval)
        self._pictures = _OutputInterval(interval if picture_interval is None else picture_interval)
        self._static = True

    def begin_stage(self, kind: str) -> None:
        """kind: `static`, `quasi-static` or `dynamic`."""
        self._static = kind == "static"
        self._series.restart()
        self._pictures.restart()

    def due(self, t: float, last: bool) -> DueOutputs:
        """What the step that ends at t [s since the stage began] is written to. Call once per accepted step.

        last: whether it is the stage's last step.
        """
        if self._static:
            return DueOutputs(last, last)
        pictures = self._pictures.reached(t) or last
        series = self._series.reached(t) or pictures
        return DueOutputs(series, pictures)

    def state(self) -> Saved:
        return gathered({"series": self._series, "pictures": self._pictures}) | {"static": np.array(self._static)}

    def restore(self, saved: Saved) -> None:
        restore_all({"series": self._series, "pictures": self._pictures}, saved)
        self._static = bool(saved["static"])


class SimulatedTime:
    """Total simulated time: quasi-static and dynamic stages add up, static stages take none."""

    def __init__(self) -> None:
        self._start = 0.0
        self._now = 0.0
        self._last_record = -TICK
        self._static = True

    @property
    def stage_time(self) -> float:
        """s simulated in the current stage."""
        return self._now - self._start

    @property
    def now(self) -> float:
        return self._now

    def of_stage(self, t: float) -> float:
        """The time at t of the present stage [s]."""
        return self._start + t

    def begin_stage(self, kind: str) -> None:
        self._static = kind == "static"
        self._start = self._now

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
        times = {"begun": self._start, "now": self._now, "last_record": self._last_record, "static": self._static}
        return {name: np.array(value) for name, value in times.items()}

    def restore(self, saved: Saved) -> None:
        self._start, self._now = float(saved["begun"]), float(saved["now"])
        self._last_record, self._static = float(saved["last_record"]), bool(saved["static"])
