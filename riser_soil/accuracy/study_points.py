"""Points of a study: runs of a scene with settings varied, and the key results and processor time of each."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from riser_soil.errors import MeshError, SolveError
from riser_soil.results.folder import SCENE, SUMMARY
from riser_soil.scene.scene import Scene
from riser_soil.variants import pool
from riser_soil.variants.key_results import KeyResult, key_results
from riser_soil.variants.one_run import Task, known, task
from riser_soil.variants.pool import Workers
from riser_soil.variants.runs_folder import Outcome, prepare_attempts
from riser_soil.variants.variant import variant_of

POINTS = "points"  # folder of the points' runs
FINAL = (MeshError.exit_status, SolveError.exit_status)  # of failed runs that would fail again
KEPT = (SUMMARY, SCENE)  # of a run's results; series and pictures go
_PLACE = re.compile(rf"^.*/{re.escape(SCENE)}(:\d+)?: ")  # of a mistake, in the point's own scene file
LETTERS = 12  # of a point's key, which make its name

Factors = tuple[float, ...]
"""How many times as fine as the scene a point is, setting by setting."""


@dataclass(frozen=True)
class PointOutcome:
    """How a point's run ended, and its results.

    status: exit status; reason: why it failed. cpu: processor time [s], nan where it is not known. alone: whether no
    other point ran beside it. steps: number of time and load steps.
    """

    factors: Factors
    status: int
    reason: str
    cpu: float
    alone: bool
    steps: int = 0
    key_results: Mapping[str, KeyResult] = field(default_factory=dict)

    @property
    def done(self) -> bool:
        """Whether it has results."""
        return self.status == 0


@dataclass(frozen=True, eq=False)
class StudyPoint:
    """A run of the study, and its scene."""

    factors: Factors
    scene: Scene

    def task(self, runs: Path, alone: bool) -> Task:
        """The run to be computed. Fields beside the positions are not recorded, and error bars are not estimated."""
        output = self.scene.output.model_copy(update={"fields": ()})
        variant = variant_of(self.scene.model_copy(update={"output": output, "error_bars": False}))
        return task(variant.key[:LETTERS], variant, runs.absolute(), keep=KEPT, final=FINAL, alone=alone)

    def outcome(self, runs: Path, ended: Outcome) -> PointOutcome:
        """Outcome of the point, whose run has ended."""
        try:
            summary = json.loads((runs / ended.name / SUMMARY).read_text(encoding="utf-8"))
        except (OSError, ValueError):  # of a run that failed before its first step
            summary = {"stages": [], "processor_seconds": None}
        steps = sum(stage["steps"] for stage in summary["stages"])
        found = key_results(summary) if ended.done else {}
        cpu = math.nan if summary["processor_seconds"] is None else summary["processor_seconds"]
        reason = _PLACE.sub("", ended.reason)
        return PointOutcome(self.factors, ended.status, reason, cpu, ended.alone, steps, found)


OnEnd = Callable[[PointOutcome, bool], None]
"""Called as each point ends, with its outcome and whether that was known before."""


def compute(points: Sequence[StudyPoint], runs: Path, jobs: int, on_end: OnEnd) -> list[PointOutcome]:
    """Outcomes of points, as they end. runs: folder of all points; jobs: how many run at a time."""
    found: list[PointOutcome] = []
    todo: dict[str, list[StudyPoint]] = {}  # by the names of their runs: counts that are rounded make some equal
    tasks: dict[str, Task] = {}

    def end(point: StudyPoint, ended: Outcome, before: bool) -> None:
        found.append(point.outcome(runs, ended))
        on_end(found[-1], before)

    for point in points:
        each = point.task(runs, alone=jobs == 1)
        if (earlier := known(each)) is not None:
            end(point, earlier, True)
        else:
            tasks[each["name"]] = each
            todo.setdefault(each["name"], []).append(point)

    def on_run(ended: Outcome) -> None:
        for point in todo[ended.name]:
            end(point, ended, False)

    if tasks:
        pool.compute([*tasks.values()], Workers(jobs), on_run, lambda: prepare_attempts(runs))
    return found
