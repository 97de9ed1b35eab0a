"""Tallies of a run: the summary of its stages, counted on the way, line by line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved, Stateful, gathered, restore_all
from riser_soil.core.snapshot import Records, RunFacts, SoilMesh, SoilSnapshot, StepRecord
from riser_soil.results.figures import pack
from riser_soil.results.schedule import DueOutputs, SimulatedTime
from riser_soil.results.soil_extremes import places
from riser_soil.results.stage_tally import StageTally
from riser_soil.results.summary import Summary


class Tallies:
    """Counts what the summary has of accepted steps in turn. lines: their names, "" of the only one. mesh: of the soil,
    None without.
    """

    def __init__(self, facts: RunFacts, lines: Sequence[str], mesh: SoilMesh | None = None) -> None:
        self.summary = Summary(facts, lines)
        self._on_soil, self._places = facts.on_soil, None if mesh is None else places(mesh)
        self._time, self._now = SimulatedTime(), 0.0

    @property
    def stage(self) -> StageTally:
        """Tally of the present stage."""
        return self.summary.stages[-1]

    def begin_stage(self, name: str, kind: str, automatic: bool) -> None:
        """Begin a stage; one along t with the figures that the stage before ended with. automatic: whether its time
        steps are.
        """
        self._time.begin_stage(kind)
        self.summary.begin_stage(name, kind, automatic)
        if kind != "static" and len(self.summary.stages) > 1:
            before = self.summary.stages[-2].lines
            self._begin_from({line: tally.extremes.latest for line, tally in before.items()})

    def _begin_from(self, figures: Mapping[str, Array]) -> None:
        """Count the packed figures of each line that the stage begins with."""
        for line, vector in figures.items():
            self.stage.lines[line].begin(self._time.now, vector)

    def begin_at(self, records: Records) -> float:
        """Count the state that the run begins with; when it is recorded [s]."""
        self._begin_from({line: pack(record)[0] for line, record in records.items()})
        return self.stamp()

    def accept(
        self,
        steps: Sequence[StepRecord],
        due: Sequence[DueOutputs],
        records: Records,
        bodies_and_joints: Mapping[str, Array],
    ) -> tuple[list[float], list[float]]:
        """Count steps; their times in the run [s], and when those are recorded whose series is due."""
        times, stamps = list[float](), list[float]()
        for step, wanted in zip(steps, due, strict=True):
            self._time.advance(step.t)
            times.append(self._time.now)
            if wanted.series:
                stamps.append(self.stamp())
        stage = self.stage
        at = np.array([step.t for step in steps] if stage.kind == "static" else times)
        self._now = float(at[-1])
        stage.time = self._time.stage_time
        stage.count(times, steps)
        stage.bodies_and_joints.update(at, bodies_and_joints)
        for line, record in records.items():
            stage.lines[line].update(at, record)
        return times, stamps

    def picture(self, soil: SoilSnapshot | None) -> None:
        """Count the soil at the last step."""
        if soil is not None and self._places is not None and self.summary.stages:
            self.stage.lines[self._on_soil].soil.update(self._now, soil, self._places)

    def stamp(self) -> float:
        """Time of a record made now [s], later than that of every record before."""
        return self._time.stamp()

    def time_at(self, t: float) -> float:
        """Time of the run [s] at a time of the present stage; in a static stage its load factor."""
        return t if self.stage.kind == "static" else self._time.of_stage(t)

    def state(self) -> Saved:
        return gathered(self._owners) | {"now": np.array(self._now)}

    def restore(self, saved: Saved) -> None:
        restore_all(self._owners, saved)
        self._now = float(saved["now"])

    @property
    def _owners(self) -> dict[str, Stateful]:
        return {"summary": self.summary, "time": self._time}
