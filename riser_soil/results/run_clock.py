"""Time that a run takes: seconds by part, and processor time."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np

from riser_soil.core.compiled import seconds_of_work
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import Timer

_PROCESSOR = "processor"


@dataclass
class RunClock(Timer):
    """Clock of a run. began: processor time of the process as the run began, less what was spent before a restart."""

    seconds: defaultdict[str, float] = field(default_factory=lambda: defaultdict(float))
    began: float = field(default_factory=seconds_of_work)

    @property
    def processor_seconds(self) -> float:
        """Processor time of the run so far on this rank [s], without compilation of kernels."""
        return seconds_of_work() - self.began

    def state(self) -> Saved:
        return super().state() | {_PROCESSOR: np.array(self.processor_seconds)}

    def restore(self, saved: Saved) -> None:
        """Count the time that was spent before, too."""
        parts = dict(saved)
        self.began -= float(parts.pop(_PROCESSOR, 0.0))
        super().restore(parts)
