"""Records of one stage of a run by its name, and what follows from them: reactions, peaks between samples."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import ResultsError
from riser_soil.results.peaks import parabola
from riser_soil.results.read import Run


@dataclass(frozen=True, eq=False)
class StageRecords:
    """A stage and its records (nr,) in results.nc; of one along t with the state that it begins with."""

    run: Run
    number: int
    records: IntArray

    @property
    def summary(self) -> dict[str, Any]:
        """The stage in summary.json."""
        stage: dict[str, Any] = self.run.summary["stages"][self.number]
        return stage

    @property
    def name(self) -> str:
        return str(self.summary["name"])

    @property
    def timed(self) -> bool:
        """Whether the stage goes along t, as quasi-static and dynamic stages do."""
        return bool(self.summary["kind"] != "static")

    @property
    def time(self) -> Array:
        """Total simulated time (nr,) [s] of the records."""
        return self.run.time[self.records]

    @property
    def moves(self) -> bool:
        """Whether there is more than one instant."""
        return self.timed and len(self.records) > 1

    def __getitem__(self, name: str) -> Array:
        """A variable of results.nc at the stage's records, (nr, ...)."""
        return self.run[name][self.records]


def stage_records(run: Run, name: str | None = None) -> StageRecords:
    """A stage by its name; by default the last along t of which something was recorded, else the last of all.

    Raises ResultsError where there is no such stage, or nothing was recorded of it.
    """
    stages, of_record = run.summary["stages"], _stage_of_records(run)
    recorded = [n for n in range(len(stages)) if (of_record == n).any()]
    if not recorded:
        raise ResultsError(f"{run.place}: nothing was recorded, so there is nothing to draw")
    if name is None:
        timed = [n for n in recorded if stages[n]["kind"] != "static"]
        return _of(run, (timed or recorded)[-1], of_record)
    named = [n for n in recorded if stages[n]["name"] == name]
    if not named:
        known = ", ".join(stages[n]["name"] for n in recorded)
        raise ResultsError(f'{run.place}: "{name}" is no stage of the run with records; it has {known}')
    return _of(run, named[-1], of_record)


def _stage_of_records(run: Run) -> IntArray:
    """Number of the stage of each record, (nt,)."""
    return run["stage"].astype(int)


def _of(run: Run, number: int, of_record: IntArray) -> StageRecords:
    own = np.flatnonzero(of_record == number)
    timed = run.summary["stages"][number]["kind"] != "static"
    before = np.flatnonzero(of_record < number)[-1:] if timed else own[:0]
    return StageRecords(run, number, np.concatenate([before, own]))


@dataclass(frozen=True, eq=False)
class Reactions:
    """Forces of the supports on the riser (nt,) [N] at its start (1) and end (2).

    V is positive upwards. H lies along the horizontal from start to end and is positive where it pulls the riser
    taut: a riser at rest without current or friction has H1 = H2.
    """

    H1: Array
    V1: Array
    H2: Array
    V2: Array


def along(position: Array) -> Array:
    """Horizontal unit vector (3,) from start to end of an axis (nn, 3) [m]; x where they lie above each other."""
    chord = (position[-1] - position[0]) * [1.0, 1.0, 0.0]
    length = float(np.linalg.norm(chord))
    return chord / length if length > 0.0 else np.array([1.0, 0.0, 0.0])


def reactions(run: Run) -> Reactions:
    """Reactions at all recorded times, in the vertical plane in which start and end lie at the first of them."""
    start, end, direction = run["start_force"], run["end_force"], along(run["position"][0])
    return Reactions(-start @ direction, start[:, 2], end @ direction, end[:, 2])


def peak(x: Array, q: Array) -> Array:
    """Largest value of q (..., n) along its last axis, sampled at growing x (n,), n at least 3.

    Taken between the samples, from the parabola through the largest one and its two neighbours: third order in their
    distance where q is smooth. The sample itself where it is the first or the last.
    """
    largest = q.argmax(axis=-1)
    i = np.clip(largest, 1, q.shape[-1] - 2)
    three = np.stack([np.take_along_axis(q, (i + k)[..., None], axis=-1)[..., 0] for k in (-1, 0, 1)])
    slope, bend = parabola(np.stack([x[i + k] for k in (-1, 0, 1)]), three)
    vertex = (i == largest) & (bend < 0.0)
    return np.where(vertex, three[1] - slope**2 / np.where(vertex, 4.0 * bend, 1.0), q.max(axis=-1))
