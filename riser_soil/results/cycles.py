"""Cycles of a run's periodic stage: its period and the records of each cycle."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from riser_soil.core.arrays import IntArray
from riser_soil.errors import ResultsError
from riser_soil.results.read import Run

SLACK = 1e-6  # of the period: time is a sum of steps


@dataclass(frozen=True, eq=False)
class Cycle:
    """A whole cycle: its end [s of the run] and the records (n,) of results.nc from its beginning to its end."""

    end: float
    records: IntArray


def stage_of_kind(run: Run, name: str | None, *kinds: str) -> int:
    """Number of a stage of one of these kinds by its name; the last one by default."""
    found = {stage["name"]: n for n, stage in enumerate(run.summary["stages"]) if stage["kind"] in kinds}
    chosen = name if name is not None else next(reversed(found), "")
    if chosen not in found:
        words = " or ".join(kinds)
        known = f"its {words} stages: {', '.join(found)}" if found else f"it has no {words} stage"
        raise ResultsError(f'{run.folder}: "{chosen}" is no {words} stage of the run; {known}')
    return found[chosen]


def dynamic_stage(run: Run, name: str | None) -> int:
    """Number of a dynamic stage by its name; the last one by default."""
    return stage_of_kind(run, name, "dynamic")


def timed_stage(run: Run, name: str | None) -> int:
    """Number of a stage along t by its name; the last one by default."""
    return stage_of_kind(run, name, "quasi-static", "dynamic")


def beginning(run: Run, stage: int) -> float:
    """Total simulated time [s] at which a stage begins."""
    return float(sum(before["time"] for before in run.summary["stages"][:stage]))


def period_of(run: Run, stage: int) -> float:
    """Period [s] of a stage's motion, or of regular waves where the ends stay."""
    stages = run.scene.get("stages") or []
    found = {*_periods(stages[stage : stage + 1])} or {*_periods((run.scene.get("water") or {}).get("waves"))}
    if len(found) != 1:
        told = f"has the periods {', '.join(f'{T:g}' for T in sorted(found))} s" if found else "has no one period"
        raise ResultsError(f'{run.folder}: stage "{run.stage_names[stage]}" {told}; give the length of a cycle, period')
    return found.pop()


def _periods(piece: Any) -> Iterator[float]:
    """All that goes by the name period in a piece of a scene."""
    if isinstance(piece, list):
        for item in piece:
            yield from _periods(item)
    if isinstance(piece, dict):
        for key, value in piece.items():
            if key == "period" and isinstance(value, int | float):
                yield float(value)
            else:
                yield from _periods(value)


def cycles(run: Run, stage: int, period: float) -> list[Cycle]:
    """The whole cycles of a stage, from its beginning on; ResultsError where there is none."""
    since, of_stage = beginning(run, stage), run["stage"] == stage
    at_first = np.flatnonzero(run["stage"] < stage)[-1:]
    records = np.concatenate([at_first, np.flatnonzero(of_stage)])
    passed = (run.time[records] - since) / period
    whole = int(np.floor(passed.max(initial=0.0) + SLACK))
    if whole < 1:
        raise ResultsError(f'{run.folder}: stage "{run.stage_names[stage]}" has no whole cycle of {period:g} s')
    return [
        Cycle(since + (n + 1) * period, records[(passed > n - SLACK) & (passed < n + 1 + SLACK)]) for n in range(whole)
    ]
