"""Table of all cases: how each ended, and its values, key results and statistics of the last dynamic stage."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from riser_soil.cases.case_values import CaseValue, case_values
from riser_soil.cases.expansion import Case
from riser_soil.core.arrays import Array
from riser_soil.variants.runs_folder import Outcome


@dataclass(frozen=True, eq=False)
class CaseTable:
    """All cases in their order, how they ended, and the values of those that are done."""

    title: str
    cases: Sequence[Case]
    outcomes: Mapping[str, Outcome]
    values: Mapping[str, Mapping[str, CaseValue]]

    @cached_property
    def paths(self) -> list[str]:
        """Paths of all values that cases set."""
        return list(dict.fromkeys(path for case in self.cases for path in case.values))

    @cached_property
    def axes(self) -> list[str]:
        """Names of axes that are no path of the scene."""
        known = dict.fromkeys(axis for case in self.cases for axis in case.labels)
        return [axis for axis in known if axis not in self.paths]

    @cached_property
    def quantities(self) -> dict[str, CaseValue]:
        """Quantities of all cases by their keys, each as the first case that has it."""
        first: dict[str, CaseValue] = {}
        for values in self.values.values():
            first = {**first, **values, **first}
        return first

    @property
    def failed(self) -> list[Outcome]:
        """Outcomes of cases that failed."""
        return [self.outcomes[case.name] for case in self.cases if not self.outcomes[case.name].done]

    def column(self, key: str) -> Array:
        """A quantity's values (n,), nan in cases that failed or have none."""
        return np.array([self._value(case.name, key) for case in self.cases])

    def _value(self, name: str, key: str) -> float:
        value = self.values.get(name, {}).get(key)
        return math.nan if value is None else value.value


def case_table(
    title: str, runs: Path, cases: Sequence[Case], outcomes: Mapping[str, Outcome], since: float
) -> CaseTable:
    """Table from the results in the cases' folders. runs: folder of these. since: s, of the statistics."""
    done = [case.name for case in cases if outcomes[case.name].done]
    values = {name: {value.key: value for value in case_values(runs / name, since)} for name in done}
    return CaseTable(title, cases, outcomes, values)
