"""Buffer of accepted steps: their results are computed and written for many of them together, see `instants`."""

from __future__ import annotations

from typing import NamedTuple

from riser_soil.core.arrays import Array
from riser_soil.core.snapshot import SoilSnapshot, StepRecord
from riser_soil.results.instants import StateCopy
from riser_soil.results.schedule import DueOutputs
from riser_soil.results.soil_plausibility import PressedSoil

MOST_STEPS, MOST_NUMBERS = 64, 1 << 20  # in a buffer that is full


class BufferedStep(NamedTuple):
    """An accepted step as it waits in the buffer: its record, what is due to be written of it, and its state.

    lines: state of each line, by name; bodies_and_joints: their values, by path; pressed: the soil under the riser, if
    any, where the step is recorded; soil: its fields where these are due.
    """

    record: StepRecord
    due: DueOutputs
    lines: dict[str, StateCopy]
    bodies_and_joints: dict[str, Array]
    pressed: PressedSoil | None
    soil: SoilSnapshot | None


class StepBuffer:
    """Accepted steps that are not yet written. A step with fields of the soil fills it, as these are large."""

    def __init__(self) -> None:
        self._steps: list[BufferedStep] = []

    def add(self, step: BufferedStep) -> None:
        """Put a step behind the others."""
        self._steps.append(step)

    @property
    def full(self) -> bool:
        """Whether it has as many steps as are written together."""
        last = self._steps[-1]
        numbers = sum(line.inside.size for line in last.lines.values())
        return last.soil is not None or len(self._steps) >= min(MOST_STEPS, MOST_NUMBERS // numbers)

    def emptied(self) -> list[BufferedStep]:
        """All its steps, in their order; it has none afterwards."""
        steps, self._steps = self._steps, []
        return steps
