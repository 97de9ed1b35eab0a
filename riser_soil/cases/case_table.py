"""Table of all cases: what became of each, and its values, key results and statistics of the last dynamic stage."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from riser_soil.accuracy.key_results import key_results
from riser_soil.cases.case_folder import Outcome, place
from riser_soil.cases.expansion import Case
from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError
from riser_soil.results.read import Run

MEAN, DEVIATION = ", mean", ", standard deviation"
_SIGNS = {"tension": "positive in tension", "contact force": "positive where the ground pushes"}


@dataclass(frozen=True, eq=False)
class CaseTable:
    """All cases in their order, what became of them, and the values of those that are done."""

    title: str
    cases: Sequence[Case]
    outcomes: Mapping[str, Outcome]
    values: Mapping[str, Mapping[str, CaseValue]]

    @cached_property
    def paths(self) -> list[str]:
        """Of all values in which cases differ from the base scene."""
        return list(dict.fromkeys(path for case in self.cases for path in case.values))

    @cached_property
    def quantities(self) -> dict[str, CaseValue]:
        """Of all cases by their keys, each as the first case has it."""
        found: dict[str, CaseValue] = {}
        for values in self.values.values():
            for key, value in values.items():
                found.setdefault(key, value)
        return found

    @property
    def failed(self) -> list[Outcome]:
        return [self.outcomes[case.name] for case in self.cases if not self.outcomes[case.name].done]

    def column(self, key: str) -> Array:
        """A quantity's values (n,), nan in cases that failed or have none."""
        return np.array([self._value(case.name, key) for case in self.cases])

    def _value(self, name: str, key: str) -> float:
        value = self.values.get(name, {}).get(key)
        return math.nan if value is None else value.value


def case_table(
    title: str, folder: Path, cases: Sequence[Case], outcomes: Mapping[str, Outcome], since: float
) -> CaseTable:
    """From the results in the cases' folders. since: s, of the statistics."""
    done = [case.name for case in cases if outcomes[case.name].done]
    values = {name: {value.key: value for value in case_values(place(folder, name), since)} for name in done}
    return CaseTable(title, cases, outcomes, values)


@dataclass(frozen=True)
class CaseValue:
    """stage and name of a quantity, its unit (SI), and its value in one case."""

    stage: str
    name: str
    unit: str
    value: float

    @property
    def key(self) -> str:
        return f"{self.stage}: {self.name}"

    @property
    def in_time(self) -> bool:
        """Whether it is of the statistics in time, and no extreme."""
        return self.name.endswith((MEAN, DEVIATION))

    @property
    def sign(self) -> str:
        """What its sign means; of a standard deviation or a magnitude nothing."""
        if self.name.endswith(DEVIATION):
            return ""
        return next((sign for word, sign in _SIGNS.items() if word in self.name), "")


def case_values(folder: Path, since: float) -> list[CaseValue]:
    """Of a run's folder, those of several lines and bodies behind their names. since: time of the last dynamic stage
    [s] from which on its records count in statistics.
    """
    run = Run(folder)
    found = [CaseValue(each.stage, each.label, each.unit, each.value) for each in key_results(run.summary).values()]
    each = ((line, value) for line, own in run.of_lines.items() for value in _statistics(own, since))
    return [*found, *(replace(value, name=f"{line} {value.name}".strip()) for line, value in each)]


def _statistics(run: Run, since: float) -> Iterator[CaseValue]:
    """Mean and standard deviation of what is recorded; nan, where nothing touches, doesn't count."""
    stages = run.summary["stages"]
    number = max((n for n, stage in enumerate(stages) if stage["kind"] == "dynamic"), default=None)
    if number is None:
        return
    start = sum(stage["time"] for stage in stages[:number])
    seen = (run["stage"] == number) & (run.time >= start + since)
    for name, unit, series in _series(run):
        values = series[seen]
        values = values[np.isfinite(values)]
        if values.size:
            yield CaseValue(stages[number]["name"], name + MEAN, unit, float(values.mean()))
            yield CaseValue(stages[number]["name"], name + DEVIATION, unit, float(values.std()))


def _series(run: Run) -> Iterator[tuple[str, str, Array]]:
    """Name, unit and records (nt,) of what a run may have recorded; moments are those at nodes."""
    height = run["position"][-1][:, 2]
    upper = 0 if height[0] > height[-1] else -1
    for name, unit, variable, of in (
        ("top tension", "N", "effective_tension", lambda T: T[:, upper]),
        ("least effective tension", "N", "effective_tension", lambda T: T.min(axis=1)),
        ("largest bending moment at nodes", "N.m", "bending_moment", lambda M: M.max(axis=1)),
        ("touchdown arc", "m", "touchdown_arc", lambda arc: arc),
        ("contact force", "N", "contact_force_sum", lambda F: F[:, 2]),
    ):
        try:
            values = run[variable]
        except ResultsError:  # not recorded
            continue
        yield name, unit, of(values)
