"""Histories of outputs as CSV: time in the first column, names without blanks or commas in the first row.

qats (github.com/dnvgl/qats) and pandas read such files with their defaults.
"""

from __future__ import annotations

import csv
from collections.abc import Sequence
from typing import TextIO

import numpy as np

from riser_soil.statistics.records import Records


def write_histories(histories: Sequence[Records], file: TextIO) -> None:
    """Write histories of one run and stage as CSV; time counts from the stage's begin."""
    first = histories[0]
    time = first.begin + first.step * np.arange(len(first.values[0]))
    table = np.column_stack([time, *(each.values[0] for each in histories)])
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["time_s", *(name for each in histories for name in _names(each))])
    writer.writerows([repr(float(value)) for value in row] for row in table)


def _names(history: Records) -> list[str]:
    """Names of an output's columns, one a place, with its unit: effective_tension_at_150m_N."""
    places = ["" if np.isnan(arc) else f"_at_{arc:.10g}m" for arc in history.arc]
    unit = "_" + history.units.replace(" ", "") if history.units not in ("", "1") else ""
    return [f"{history.name}{place}{unit}" for place in places]
