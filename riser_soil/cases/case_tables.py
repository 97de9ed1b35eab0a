"""Tables of all cases: cases.csv, a row for each; extremes.csv, a row for each quantity; cases.nc; cases.png."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from riser_soil.cases.case_folder import Outcome, place
from riser_soil.cases.case_values import CaseValue, case_values
from riser_soil.cases.expansion import Case
from riser_soil.core.arrays import Array
from riser_soil.results.whole_file import written_together

TABLE, EXTREMES, DATA, PLOT = "cases.csv", "extremes.csv", "cases.nc", "cases.png"
FILES = (TABLE, EXTREMES, DATA, PLOT)


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


def write_tables(table: CaseTable, folder: Path) -> None:
    """All files together."""
    from riser_soil.cases.case_dataset import dataset
    from riser_soil.cases.case_panels import panels
    from riser_soil.plots.load_cases import draw_load_cases

    with written_together(folder, FILES) as made:
        _write(made / TABLE, _rows(table))
        _write(made / EXTREMES, _extremes(table))
        dataset(table).to_netcdf(made / DATA, engine="h5netcdf")
        draw_load_cases(made / PLOT, table.title, panels(table))


def _write(file: Path, rows: Iterator[list[str]]) -> None:
    with file.open("w", newline="", encoding="utf-8") as opened:
        csv.writer(opened).writerows(rows)


def _rows(table: CaseTable) -> Iterator[list[str]]:
    """Head and cases."""
    names = [f"{key} [{value.unit}]" for key, value in table.quantities.items()]
    yield ["case", *table.paths, "status", "reason", "seconds [s]", "machine", *names]
    columns = [table.column(key) for key in table.quantities]
    for n, case in enumerate(table.cases):
        outcome = table.outcomes[case.name]
        given = [_given(case.values[path]) if path in case.values else "" for path in table.paths]
        told = [str(outcome.status), outcome.reason, f"{outcome.seconds:.3g}", outcome.machine]
        yield [case.name, *given, *told, *(_number(column[n]) for column in columns)]


def _extremes(table: CaseTable) -> Iterator[list[str]]:
    """Head and quantities: extremes with their cases, mean and standard deviation over the cases that have them."""
    yield ["quantity", "unit", "largest", "in case", "least", "in case", "mean", "standard deviation", "cases"]
    for key, value in table.quantities.items():
        column = table.column(key)
        most, least, known = int(np.nanargmax(column)), int(np.nanargmin(column)), column[np.isfinite(column)]
        ends = [cell for n in (most, least) for cell in (_number(column[n]), table.cases[n].name)]
        yield [key, value.unit, *ends, _number(known.mean()), _number(known.std()), str(known.size)]


def _given(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _number(value: float) -> str:
    return f"{value:.8g}" if math.isfinite(value) else ""
