"""How far runs are from the reference: single figures relative, curves by their largest and their RMS difference."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, nan

import numpy as np

from benchmarks.soil_precision.ladders import LADDERS
from benchmarks.soil_precision.measure import Measured
from demos.page import csv_table

HEAD = ("scene", "method", "cells to a diameter", "processor s", "figure", "norm", "value", "error")


@dataclass(frozen=True)
class Row:
    """A figure of a run, its error by one norm; value: of single figures [SI], nan of curves."""

    scene: str
    method: str
    n: int
    seconds: float
    figure: str
    norm: str
    value: float
    error: float

    @property
    def cells(self) -> list[str]:
        value = "" if np.isnan(self.value) else f"{self.value:.6g}"
        row = [self.figure, self.norm, value, f"{self.error:.6f}"]
        return [self.scene, self.method, str(self.n), f"{self.seconds:.2f}", *row]


def relative(value: float, reference: float) -> float:
    return abs(value - reference) / abs(reference)


def largest(values: Sequence[float], reference: Sequence[float]) -> float:
    """Largest difference over the reference's largest value; places that are nan in either don't count."""
    return float(np.nanmax(np.abs(np.subtract(values, reference))) / np.nanmax(np.abs(reference)))


def rms(values: Sequence[float], reference: Sequence[float]) -> float:
    """Root mean square of the difference over that of the reference."""
    return float(np.sqrt(np.nanmean(np.subtract(values, reference) ** 2) / np.nanmean(np.square(reference))))


def judged(runs: Sequence[Measured]) -> list[Row]:
    """Rows of all runs but the references themselves; errors of those that failed are infinite."""
    known = {(run.scene, run.method, run.n): run for run in runs}
    references = {scene: known[scene, ladder.best, ladder.reference[0]] for scene, ladder in LADDERS.items()}
    return [row for run in runs if run is not references[run.scene] for row in _rows(run, references[run.scene])]


def _rows(run: Measured, reference: Measured) -> list[Row]:
    def row(figure: str, norm: str, value: float, error: float) -> Row:
        return Row(run.scene, run.method, run.n, run.seconds, figure, norm, value, inf if run.reason else error)

    rows = []
    for name, true in reference.figures.items():
        value = run.figures.get(name, nan)
        rows.append(row(name, "relative", value, relative(value, true)))
    for name, along in reference.curves.items():
        values = run.curves.get(name, along)
        rows.append(row(name, "largest", nan, largest(values, along)))
        rows.append(row(name, "RMS", nan, rms(values, along)))
    return rows


def uncertainty(rows: Sequence[Row], scene: str, figure: str, norm: str) -> float:
    """Difference of the reference to the next coarser one."""
    asked = (scene, LADDERS[scene].best, LADDERS[scene].reference[1], figure, norm)
    return next(row.error for row in rows if (row.scene, row.method, row.n, row.figure, row.norm) == asked)


def series(rows: Sequence[Row], scene: str, figure: str, norm: str) -> dict[str, list[Row]]:
    """Methods' rows of one figure, by n; without those that are for the reference alone."""
    groups: dict[str, list[Row]] = {}
    methods = LADDERS[scene].methods
    for row in sorted(rows, key=lambda each: each.n):
        if (row.scene, row.figure, row.norm) == (scene, figure, norm) and row.n in methods[row.method][1]:
            groups.setdefault(row.method, []).append(row)
    return groups


def cheapest(rows: Sequence[Row], error: float) -> Row | None:
    """The cheapest of a figure's rows that has at most that error, as have all finer ones of its method."""
    kept = [row for row in rows if all(r.error <= error for r in rows if r.method == row.method and r.n >= row.n)]
    return min(kept, key=lambda row: row.seconds, default=None)


def csv_of(rows: Sequence[Row]) -> str:
    return csv_table(HEAD, [row.cells for row in rows])


def rows_of(text: str) -> list[Row]:
    """Rows from the text that `csv_of` writes."""
    return [
        Row(scene, method, int(n), float(seconds), figure, norm, float(value or "nan"), float(error))
        for scene, method, n, seconds, figure, norm, value, error in list(csv.reader(io.StringIO(text)))[1:]
    ]
