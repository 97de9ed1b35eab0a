"""Counter of the Newton iterations of a stage."""

from __future__ import annotations

from dataclasses import dataclass

from riser_soil.solve.dynamic_relaxation import RelaxationResult
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import StatelessObserver


@dataclass
class IterationCounter(StatelessObserver):
    """Newton iterations of all steps of a stage."""

    iterations: int = 0

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        self.iterations += step.solution.iterations

    def relaxed(self, relaxed: RelaxationResult) -> None:
        self.iterations += relaxed.iterations
