"""Measured resistance by penetration from a CSV table, and the path of penetration through its points."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from pydantic_core import PydanticCustomError

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import SceneError
from riser_soil.scene.columns import LENGTH, Units, read_columns

FIRST, GROWTH = 0.1, 1.6  # first step after a turn over the largest step; a step over the one before it
TURN = 0.5  # way back that makes a turn, over the largest step: less is scatter of the measurement
FORCE_PER_LENGTH: Units = {"N/m": 1.0, "kN/m": 1e3, "lbf/ft": 14.593902937}
LEAST_ROWS = 4


@dataclass(frozen=True, eq=False)
class PenetrationPath:
    """Penetrations w (m,) [m] to step through, from the start on, and the place (n,) of each measured point along it,
    in steps: 2.5 is midway between w[2] and w[3]."""

    w: Array
    place: Array

    def at_points(self, values: Array) -> Array:
        """Values (m,) at the steps, as they are at the measured points (n,)."""
        return np.interp(self.place, np.arange(len(self.w)), values)


def path_through(measured: Array, start: float, step: float) -> PenetrationPath:
    """The path from a start [m] to the first measured penetration (n,) [m] and on through its turns, in steps of at
    most `step` [m], short ones after each turn."""
    corners = turns(measured, TURN * step)
    ends = np.concatenate(([start], measured[corners]))
    w, place = [start], np.zeros(len(measured))
    branch = np.searchsorted(corners, np.arange(len(measured)))
    for n, (a, b) in enumerate(pairwise(ends)):
        reached = len(w) - 1
        if a != b:
            stops = a + (b - a) * steps(abs(b - a), step)
            w.extend(stops[1:])
            along, mine = (stops - a) / (b - a), branch == n
            part = np.clip((measured[mine] - a) / (b - a), 0.0, 1.0)
            place[mine] = reached + np.interp(part, along, np.arange(len(stops)))
        else:
            place[branch == n] = reached
    return PenetrationPath(np.array(w), place)


def steps(length: float, largest: float) -> Array:
    """Parts 0..1 of a length [m] whose steps grow to `largest` [m]."""
    sizes = list[float]()
    size = FIRST * largest
    while sum(sizes) < length:
        sizes.append(size)
        size = min(GROWTH * size, largest)
    ends = np.cumsum([0.0, *sizes])
    return np.asarray(ends / ends[-1])


def turns(w: Array, least: float) -> IntArray:
    """Indexes into w (n,) at which it turns back by at least `least`; the first point and the last are among them."""
    corners, extreme, way = [0], 0, 0.0
    for n, value in enumerate(w):
        if way == 0.0:
            way = float(np.sign(value - w[0])) if abs(value - w[0]) >= least else 0.0
            extreme = n if way else 0
        elif way * (value - w[extreme]) > 0.0:
            extreme = n
        elif way * (w[extreme] - value) >= least:
            corners.append(extreme)
            way, extreme = -way, n
    return np.unique([*corners, extreme, len(w) - 1])


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
