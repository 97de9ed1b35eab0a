"""Files of all cases: cases.csv, a row a case; extremes.csv, a row a quantity; cases.nc; cases.png.

characteristic.csv has a row for each quantity of each group of cases that differ in their seeds alone.
"""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from riser_soil import __version__
from riser_soil.cases.case_table import CaseTable
from riser_soil.cases.characteristic import CharacteristicExtreme, row_of
from riser_soil.plots.load_cases import Panel, draw_load_cases
from riser_soil.results.whole_file import written_together

TABLE, EXTREMES, CHARACTERISTIC, DATA, PLOT = "cases.csv", "extremes.csv", "characteristic.csv", "cases.nc", "cases.png"
FILES = (TABLE, EXTREMES, CHARACTERISTIC, DATA, PLOT)

def write_files(table: CaseTable, extremes: Sequence[CharacteristicExtreme], folder: Path) -> None:
    """Write all files, together or none."""
    with written_together(folder, FILES) as made:
        _write(made / TABLE, _rows(table))
        _write(made / EXTREMES, _extremes(table))
        _write(made / CHARACTERISTIC, _characteristic(table, extremes))
        dataset(table).to_netcdf(made / DATA, engine="h5netcdf")
        _draw(table, made / PLOT)


def _draw(table: CaseTable, png: Path) -> None:
    """Draw the key results of the last stage in the table."""
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
    yield ["case", *table.axes, *table.paths, "status", "reason", "seconds [s]", "machine", *names]
    columns = [table.column(key) for key in table.quantities]
    for n, case in enumerate(table.cases):
        outcome = table.outcomes[case.name]
        given = [_given(case.values[path]) if path in case.values else "" for path in table.paths]
        ending = [str(outcome.status), outcome.reason, f"{outcome.seconds:.3g}", outcome.machine]
        labels = [case.labels.get(axis, "") for axis in table.axes]
        yield [case.name, *labels, *given, *ending, *(_number(column[n]) for column in columns)]


def _extremes(table: CaseTable) -> Iterator[list[str]]:
    """Head and quantities: extremes with their cases, mean and standard deviation over the cases that have them."""
    yield ["quantity", "unit", "largest", "in case", "least", "in case", "mean", "standard deviation", "cases"]
    for key, value in table.quantities.items():
        column = table.column(key)
        most, least, known = int(np.nanargmax(column)), int(np.nanargmin(column)), column[np.isfinite(column)]
        ends = [cell for n in (most, least) for cell in (_number(column[n]), table.cases[n].name)]
        yield [key, value.unit, *ends, _number(known.mean()), _number(known.std()), str(known.size)]


def _characteristic(table: CaseTable, extremes: Sequence[CharacteristicExtreme]) -> Iterator[list[str]]:
    """Head, and a row for each group of seeds and each of its quantities."""
    axes = list(dict.fromkeys(axis for each in extremes for axis in each.group.labels))
    rows = [row_of(each, axes) for each in extremes]
    yield list(rows[0]) if rows else ["group"]
    for row in rows:
        yield [_number(value) if isinstance(value, float) else str(value) for value in row.values()]


def _given(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _number(value: float) -> str:
    return f"{value:.8g}" if math.isfinite(value) else ""


def dataset(table: CaseTable) -> xarray.Dataset:
    """Dataset of all cases by the dimension `case`, their name.

    `set_…`: values that differ from the base scene. status, reason, seconds. A variable a quantity, nan where a case
    failed.
    """
    names = [case.name for case in table.cases]
    outcomes = [table.outcomes[name] for name in names]
    variables: dict[str, Any] = {
        "status": ("case", np.array([o.status for o in outcomes], "i4"), {"long_name": "exit status; 0 is done"}),
        "reason": ("case", _texts([o.reason for o in outcomes]), {"long_name": "why a case failed"}),
        "seconds": ("case", [o.seconds for o in outcomes], {"units": "s", "long_name": "from its start to its end"}),
    }
    for axis in table.axes:
        labels = _texts([case.labels.get(axis, "") for case in table.cases])
        variables[_identifier(f"axis_{axis}")] = ("case", labels, {"long_name": axis})
    for path in table.paths:
        given = _given_values([case.values.get(path) for case in table.cases])
        variables[_identifier(f"set_{path}")] = ("case", given, {"long_name": path})
    for key, value in table.quantities.items():
        attributes = {"units": value.unit.replace(".", " "), "long_name": value.name, "stage": value.stage}
        attributes |= {"sign_convention": value.sign} if value.sign else {}
        variables[_identifier(key)] = ("case", table.column(key), attributes)
    about = {"title": table.title, "source": f"riser_soil {__version__}", "Conventions": "CF-1.11"}
    return xarray.Dataset(variables, {"case": ("case", _texts(names), {"long_name": "name of the case"})}, about)


def _given_values(values: Sequence[Any]) -> Any:
    """Values of one path: numbers, nan where it is the base scene's; as text if not all are numbers."""
    if all(value is None or (isinstance(value, int | float) and not isinstance(value, bool)) for value in values):
        return np.array([np.nan if value is None else value for value in values], "f8")
    return _texts(["" if v is None else v if isinstance(v, str) else json.dumps(v, ensure_ascii=False) for v in values])


def _texts(values: Sequence[str]) -> Any:
    return np.array(values, dtype=object)


def _identifier(text: str) -> str:
    """Name of a variable: `heave_top_tension_mean`."""
    return re.sub(r"\W+", "_", text).strip("_")
