"""Extremes of headline quantities over a stage and in windows of its time, and how far two runs are apart in them.

Two runs may agree in one extreme by chance, where their difference changes its sign. So what counts is the mean square
of the differences in the extreme itself and in the windows in which the quantity comes near it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from riser_soil.accuracy.headlines import headlines
from riser_soil.core.arrays import Array
from riser_soil.results.peaks import RunPeaks

NEAR = 0.2  # of a quantity's range over the windows, from its extreme


class Extreme(NamedTuple):
    """Of a stage, between nodes and steps. windows (W,): of windows of a dynamic stage's time, nan where unknown; none
    of a static one. least: whether it is the least value, not the largest.
    """

    value: float
    windows: Array
    least: bool = False


Extremes = Mapping[str, Extreme]  # of headline quantities by their keys, in their units


def extremes_of(peaks: RunPeaks) -> dict[str, Extreme]:
    stages = {stage.name: stage for stage in peaks.stages}
    return {
        key: Extreme(each.value, stages[each.stage].in_windows(each.figure, each.which), each.which == "min")
        for key, each in headlines(peaks.told("peaks")).items()
    }


def alone(value: float) -> Extreme:
    """Of a quantity that was not followed in time."""
    return Extreme(value, np.empty(0))


def apart(run: Extreme, other: Extreme) -> float:
    """How far two runs are apart, in the quantity's unit. run: the one that tells which windows count."""
    off = run.value - other.value
    if run.windows.size == 0 or other.windows.size == 0:
        return abs(off)
    between = (run.windows - other.windows)[_near(run)]
    known = between[np.isfinite(between)]
    return math.sqrt(0.5 * (off**2 + float(np.mean(known**2)))) if known.size else abs(off)


def _near(run: Extreme) -> Array:
    """Whether a window (W,) comes near the extreme; one that is unknown does not."""
    height = -run.windows if run.least else run.windows
    top, bottom = np.nanmax(height), np.nanmin(height)
    return np.asarray(height >= top - NEAR * (top - bottom))
