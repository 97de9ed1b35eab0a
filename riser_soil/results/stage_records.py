"""Records of one stage of a run, by its name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import ResultsError
from riser_soil.results.read import Run


@dataclass(frozen=True, eq=False)
class StageRecords:
    """A stage and its records (nr,) in results.nc; of one along t with the state that it begins with."""

    run: Run
    number: int
    records: IntArray

    @property
    def told(self) -> dict[str, Any]:
        """What the summary tells of the stage."""
        stage: dict[str, Any] = self.run.summary["stages"][self.number]
        return stage

    @property
    def name(self) -> str:
        return str(self.told["name"])

    @property
    def timed(self) -> bool:
        """Whether it goes along t, as quasi-static and dynamic stages do."""
        return bool(self.told["kind"] != "static")

    @property
    def time(self) -> Array:
        """(nr,) s, total simulated time."""
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
        raise ResultsError(f"{run.folder}: nothing was recorded, so there is nothing to draw")
    if name is None:
        timed = [n for n in recorded if stages[n]["kind"] != "static"]
        return _of(run, (timed or recorded)[-1], of_record)
    named = [n for n in recorded if stages[n]["name"] == name]
    if not named:
        known = ", ".join(stages[n]["name"] for n in recorded)
        raise ResultsError(f'{run.folder}: "{name}" is no stage of the run with records; it has {known}')
    return _of(run, named[-1], of_record)


def all_stages(run: Run) -> list[StageRecords]:
    """Every stage of which something was recorded, in turn."""
    of_record = _stage_of_records(run)
    return [_of(run, n, of_record) for n in range(len(run.summary["stages"])) if (of_record == n).any()]


def _stage_of_records(run: Run) -> IntArray:
    """Number of the stage of each record, (nt,)."""
    return run["stage"].astype(int)


def _of(run: Run, number: int, of_record: IntArray) -> StageRecords:
    own = np.flatnonzero(of_record == number)
    timed = run.summary["stages"][number]["kind"] != "static"
    before = np.flatnonzero(of_record < number)[-1:] if timed else own[:0]
    return StageRecords(run, number, np.concatenate([before, own]))
