"""Files of all cases: cases.csv, a row for each; extremes.csv, a row for each quantity; cases.nc; cases.png."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from riser_soil.cases.case_dataset import dataset
from riser_soil.cases.case_folder import DATA, EXTREMES, FILES, PLOT, TABLE
from riser_soil.cases.case_table import CaseTable
from riser_soil.plots.load_cases import Panel, draw_load_cases
from riser_soil.results.whole_file import written_together


def write_files(table: CaseTable, folder: Path) -> None:
    """All files together."""
    with written_together(folder, FILES) as made:
        _write(made / TABLE, _rows(table))
        _write(made / EXTREMES, _extremes(table))
        dataset(table).to_netcdf(made / DATA, engine="h5netcdf")
        _draw(table, made / PLOT)


def _draw(table: CaseTable, png: Path) -> None:
    """The headline quantities of the last stage that the table tells of."""
    names = [case.name for case in table.cases]
    stage = next((value.stage for value in reversed(table.quantities.values())), "no stage")
    shown = {key: each for key, each in table.quantities.items() if each.stage == stage and not each.in_time}
    panels = [Panel(names, each.name, each.unit, table.column(key)) for key, each in shown.items()]
    draw_load_cases(png, f"{table.title}: {stage}; × failed, or none", panels)


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
