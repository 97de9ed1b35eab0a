"""Points of a study: runs of a scene with settings varied, and the key results and processor time of each."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from riser_soil.errors import MeshError, SolveError
from riser_soil.results.folder import SCENE, SUMMARY
from riser_soil.scene.scene import Scene
from riser_soil.variants import pool
from riser_soil.variants.key_results import KeyResult, key_results
from riser_soil.variants.one_run import Task, task
from riser_soil.variants.pool import Workers
from riser_soil.variants.runs_folder import Outcome
from riser_soil.variants.variant import variant_of

POINTS = "points"  # folder of the points' runs
FINAL = (MeshError.exit_status, SolveError.exit_status)  # exit statuses of failed runs that would fail again
KEPT = (SUMMARY, SCENE)  # files of a run that are kept; series and pictures are deleted
_PLACE = re.compile(rf"^.*/{re.escape(SCENE)}(:\d+)?: ")  # place of a mistake in the point's own scene file
LETTERS = 12  # letters of a point's key that make its name

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


OnEnd = Callable[[PointOutcome, bool], None]
"""Called as each point ends, with its outcome and whether that was known before."""


def compute(scenes: Mapping[Factors, Scene], runs: Path, jobs: int, on_end: OnEnd) -> list[PointOutcome]:
    """Outcomes of points with these scenes, as they end. runs: folder of all points; jobs: how many run at a time."""
    tasks = {factors: point_task(scene, runs, alone=jobs == 1) for factors, scene in scenes.items()}
    outcomes: list[PointOutcome] = []

    def end(ended: Outcome, before: bool = False) -> None:
        """Counts that are rounded may give several points the same scene, and one run."""
        for factors in (each for each in tasks if tasks[each]["name"] == ended.name):
            outcomes.append(point_outcome(factors, ended, runs))
            on_end(outcomes[-1], before)

    earlier, todo = pool.divided([*tasks.values()])
    for each in earlier.values():
        end(each, before=True)
    pool.compute(todo, Workers(jobs), end)
    return outcomes


def point_task(scene: Scene, runs: Path, alone: bool) -> Task:
    """Run of a point. Fields beside the positions are not recorded, and error bars are not estimated."""
    output = scene.output.model_copy(update={"fields": ()})
    variant = variant_of(scene.model_copy(update={"output": output, "error_bars": False}))
    return task(variant.key[:LETTERS], variant, runs.absolute(), keep=KEPT, final=FINAL, alone=alone)


def point_outcome(factors: Factors, ended: Outcome, runs: Path) -> PointOutcome:
    """Outcome of a point whose run has ended."""
    try:
        summary = json.loads((runs / ended.name / SUMMARY).read_text(encoding="utf-8"))
    except (OSError, ValueError):  # the run failed before its first step
        summary = {"stages": [], "processor_seconds": None}
    steps = sum(stage["steps"] for stage in summary["stages"])
    cpu = math.nan if summary["processor_seconds"] is None else summary["processor_seconds"]
    results = key_results(summary) if ended.done else {}
    return PointOutcome(factors, ended.status, _PLACE.sub("", ended.reason), cpu, ended.alone, steps, results)
