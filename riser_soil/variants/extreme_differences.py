"""Extremes of key results over a stage and in windows of its time, and the difference of two runs in them.

Two runs may agree in one extreme by chance, where their difference changes its sign. So the difference is the root of
the mean square of those in the extreme itself and in the windows in which the quantity comes near it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.results.peaks import RunPeaks, StagePeaks
from riser_soil.variants.key_results import KeyResult, key_results

NEAR = 0.2  # distance from the extreme, over the quantity's range in the windows, of a window that counts


class Extreme(NamedTuple):
    """Extreme of a stage, between nodes and steps.

    windows (W,): extremes in windows of a dynamic stage's time, nan where unknown; empty for a static stage. least:
    whether it is the least value, not the largest.
    """

    value: float
    windows: Array
    least: bool = False


Extremes = Mapping[str, Extreme]  # extremes of key results by their keys, in their units


def extremes_of(peaks: RunPeaks) -> dict[str, Extreme]:
    """Extremes of a run's key results by their keys."""
    stages = {(own.name, line): own for of_lines in peaks.stages for line, own in of_lines.items()}
    return {
        key: without_windows(each.value) if not each.figure else _with_windows(each, stages[each.stage, each.of])
        for key, each in key_results(peaks.as_summary("peaks")).items()
    }


def _with_windows(each: KeyResult, stage: StagePeaks) -> Extreme:
    return Extreme(each.value, stage.in_windows(each.figure, each.which), each.which == "min")


def without_windows(value: float) -> Extreme:
    """Extreme of a quantity whose course in time is not known."""
    return Extreme(value, np.empty(0))


def difference(run: Extreme, other: Extreme) -> float:
    """Size of the difference of two runs, in the quantity's unit. The windows near the extreme of `run` count."""
    off = run.value - other.value
    if run.windows.size == 0 or other.windows.size == 0:
        return abs(off)
    between = (run.windows - other.windows)[_near(run)]
    known = between[np.isfinite(between)]
    return math.sqrt(0.5 * (off**2 + float(np.mean(known**2)))) if known.size else abs(off)


def _near(run: Extreme) -> Array:
    """Whether each window (W,) comes near the extreme; an unknown one does not."""
    height = -run.windows if run.least else run.windows
    top, bottom = np.nanmax(height), np.nanmin(height)
    return np.asarray(height >= top - NEAR * (top - bottom))
