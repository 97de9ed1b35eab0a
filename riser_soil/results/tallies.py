"""Tallies of a run: the summary of its stages, counted on the way, line by line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved, Stateful, gathered, restore_all
from riser_soil.core.snapshot import Records, RunFacts, StepRecord
from riser_soil.results.code_tally import CodeTally
from riser_soil.results.figures import pack
from riser_soil.results.hung_figures import HungExtremes
from riser_soil.results.indicators import StageIndicators
from riser_soil.results.schedule import DueOutputs, SimulatedTime
from riser_soil.results.summary import StageTally, Summary


class Tallies:
    """Counts what the summary tells, of accepted steps in turn. lines: their names, "" of the only one.

    now: time of the run at the last step [s]; in a static stage its load factor.
    """

    def __init__(self, facts: RunFacts, lines: Sequence[str]) -> None:
        self.summary, self.now = Summary(facts), 0.0
        self._scales = facts.diameter, facts.weight, facts.contact_period
        self._lines, self._on_soil, self._code_checks = lines, facts.on_soil, facts.code_checks
        self._hung, self._time = HungExtremes(), SimulatedTime()
        self._latest: dict[str, Array] = {}

    @property
    def stage(self) -> StageTally:
        """The present one."""
        return self.summary.stages[-1]

    @property
    def over_soil(self) -> StageTally:
        """That of the line that lies on the soil."""
        return self.stage.of(self._on_soil)

    def begin_stage(self, name: str, kind: str, automatic: bool) -> None:
        """Begin a stage: a tally of it for the whole and for each line. automatic: whether its time steps are."""
        self._time.begin_stage(kind)
        stage = self._new(name, kind, automatic, "")
        stage.lines = {line: self._new(name, kind, automatic, line) for line in self._lines if line}
        self.summary.stages.append(stage)
        self._hung = HungExtremes()
        if kind != "static":
            self._begin_from_latest()

    def _new(self, name: str, kind: str, automatic: bool, line: str) -> StageTally:
        indicators = StageIndicators(*self._scales, automatic=automatic)
        return StageTally(name, kind, indicators=indicators, code=CodeTally(self._code_checks.get(line, ())))

    def _begin_from_latest(self) -> None:
        """Count the state that the stage begins with."""
        for line, latest in self._latest.items():
            tally = self.stage.of(line)
            tally.extremes.update(self._time.now, latest)
            tally.indicators.begin(self._time.now, latest)

    def begin_at(self, records: Records) -> float:
        """Count the state that the run begins with; when it is recorded [s]."""
        self._latest = {line: pack(record)[0] for line, record in records.items()}
        self._begin_from_latest()
        return self.stamp()

    def accept(
        self, steps: Sequence[StepRecord], due: Sequence[DueOutputs], records: Records, hung: Mapping[str, Array]
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
        self.now = float(at[-1])
        stage.count([step.health for step in steps])
        stage.time = self._time.stage_time
        stage.balance(times, [step.ledger for step in steps])
        if stage.kind == "dynamic":
            stage.indicators.follow_steps(at, steps)
        self._count_lines(at, records)
        if hung:
            self._hung.update(at, hung)
            stage.hung = self._hung.nested
        return times, stamps

    def _count_lines(self, at: Array, records: Records) -> None:
        for line, record in records.items():
            tally, rows = self.stage.of(line), pack(record)
            self._latest[line] = rows[-1]
            tally.extremes.update(at, rows)
            if self.stage.kind == "dynamic":
                tally.indicators.follow(at, rows)
            tally.last_instant = record.at(-1)
            tally.bend(at, record)
            tally.pull(at, record)
            tally.code.update(at, record)

    def stamp(self) -> float:
        """Time of a record made now [s], later than that of every record before."""
        return self._time.stamp()

    def time_at(self, t: float) -> float:
        """Time of the run [s] at a time of the present stage; in a static stage its load factor."""
        return t if self.stage.kind == "static" else self._time.of_stage(t)

    def state(self) -> Saved:
        latest = {f"latest/{line}" if line else "latest": values for line, values in self._latest.items()}
        return gathered(self._owners) | latest | {"now": np.array(self.now)}

    def restore(self, saved: Saved) -> None:
        restore_all(self._owners, saved)
        self.now = float(saved["now"])
        keys = {line: f"latest/{line}" if line else "latest" for line in self._lines}
        self._latest = {line: saved[key] for line, key in keys.items() if key in saved}

    @property
    def _owners(self) -> dict[str, Stateful]:
        return {"summary": self.summary, "time": self._time, "hung": self._hung}
