"""Measured resistance by penetration of a pipe segment, read from a CSV table."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pydantic_core import PydanticCustomError

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.columns import LENGTH, Units, read_columns

FORCE_PER_LENGTH: Units = {"N/m": 1.0, "kN/m": 1e3, "lbf/ft": 14.593902937}
LEAST_ROWS = 4


@dataclass(frozen=True, eq=False)
class MeasuredResistance:
    """What was measured, in the order of time: penetration w (n,) [m] of the pipe's underside below the seabed, and
    vertical resistance V (n,) per length of pipe [N/m], > 0 where the soil pushes the pipe up."""

    w: Array
    V: Array


def read_resistance(file: Path) -> MeasuredResistance:
    """The columns w and V of a file; SceneError of one line for what is wrong."""
    if not file.is_file():
        raise SceneError(f"{file}: there is no such file; give a CSV file with the columns w [m], V [N/m]")
    try:
        columns = read_columns(file, {"w": LENGTH, "v": FORCE_PER_LENGTH}, required=("w", "v"))
    except PydanticCustomError as err:
        raise SceneError(err.message()) from err
    if columns.rows < LEAST_ROWS:
        raise SceneError(f"{file}: {columns.rows} rows; a curve needs at least {LEAST_ROWS}; add measurements")
    measured = MeasuredResistance(np.array(columns.values["w"]), np.array(columns.values["v"]))
    if np.ptp(measured.w) == 0.0:
        raise SceneError(f"{file}: w is {measured.w[0]:g} m in every row; the pipe must move")
    if not np.any(measured.V > 0.0):
        raise SceneError(f"{file}: V is nowhere above 0, where the soil pushes the pipe up; check the sign of V")
    return measured
