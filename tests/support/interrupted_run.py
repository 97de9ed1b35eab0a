"""A run that is left after some of its steps and goes on elsewhere, beside the same run left alone."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from mpi4py import MPI

from riser_soil.assembly import Assembly, build
from riser_soil.core.part import State
from riser_soil.core.saved_state import AnyArray, Saved
from riser_soil.results.observer import Observer
from riser_soil.results.run_clock import RunClock
from riser_soil.scene.scene import Scene
from riser_soil.stages import lay, resume_stage, run_stage
from tests.support.equal_runs import datasets

TIMES = ("clock/", "observer/recorder/summary/seconds")  # what it took differs from run to run


@dataclass
class Kept:
    """States of a run: after the steps that are wanted, by their number from 1, and after the last one."""

    wanted: tuple[int, ...] = ()
    states: dict[int, Saved] = field(default_factory=dict)
    steps: int = 0
    last: Saved = field(default_factory=dict)
    gather: Callable[[], Saved] | None = None

    def keep(self, gather: Callable[[], Saved], last: bool, leaving: bool) -> None:
        self.steps, self.gather = self.steps + 1, gather
        if self.steps in self.wanted:
            self.states[self.steps] = gather()

    def end(self) -> None:
        assert self.gather is not None
        self.last = self.gather()


def whole(scene: Scene, folder: Path, after: tuple[int, ...]) -> Kept:
    """A run from its beginning, its states kept after some steps."""
    kept, assembly, clock = Kept(after), build(scene, MPI.COMM_SELF), RunClock()
    with Observer.open(assembly, clock, folder, force=False) as observer:
        before, laid = lay(assembly, clock)
        if laid is not None:
            observer.laid(assembly.slackest.slack, laid.steps, laid.relaxations)
        _go_on(assembly, 0, before, observer, clock, kept)
    return kept


def resumed(scene: Scene, folder: Path, saved: Saved) -> Kept:
    """The rest of a run, all things built anew."""
    kept, assembly, clock = Kept(), build(scene, MPI.COMM_SELF), RunClock()
    with Observer.open(assembly, clock, folder, force=False) as observer:
        stage, before = resume_stage(assembly, saved, observer, clock, kept.keep)
        _go_on(assembly, scene.stages.index(stage) + 1, before, observer, clock, kept)
    return kept


def _go_on(assembly: Assembly, first: int, before: State, observer: Observer, clock: RunClock, kept: Kept) -> None:
    for stage in assembly.scene.stages[first:]:
        before = run_stage(assembly, stage, before, observer, clock, kept.keep)
    kept.end()
    observer.finish()


def differing(one: Saved, other: Saved) -> list[str]:
    """Names of what is not the same to the last bit, times of the computer left out."""
    names = [name for name in one.keys() | other.keys() if not name.startswith(TIMES)]
    return sorted(n for n in names if n not in one or n not in other or not _same(one[n], other[n]))


def _same(one: AnyArray, other: AnyArray) -> bool:
    return np.array_equal(one, other, equal_nan=one.dtype.kind == "f")


def differing_rows(one: Path, other: Path) -> list[str]:
    """Variables of results.nc whose last rows, as many as the shorter file has, are not the same to the last bit."""
    with h5py.File(one / "results.nc") as a, h5py.File(other / "results.nc") as b:
        return [name for name, rows in datasets(a) if not _same(*_last_rows(rows, b[name]))]


def _last_rows(one: h5py.Dataset, other: h5py.Dataset) -> tuple[AnyArray, AnyArray]:
    """Of series that grow with time, as many rows as the other has; else all."""
    rows = len(other) if other.maxshape[:1] == (None,) else 0
    return (one[-rows:], other[-rows:]) if rows else (one[()], other[()])


def summary(folder: Path) -> dict[str, Any]:
    """Less what it took in seconds, and the versions of what was imported by then."""
    data: dict[str, Any] = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    return {name: value for name, value in data.items() if name not in ("seconds", "processor_seconds", "versions")}
