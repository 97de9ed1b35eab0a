"""Rainflow cycles of a stress history, counted by fatpack's four-point method (Amzallag et al. 1994, ISO 12110-2)."""

from __future__ import annotations

import fatpack
import numpy as np

from riser_soil.core.arrays import Array


def rainflow_ranges(history: Array, load_classes: int) -> Array:
    """Ranges of all cycles (n,), in the unit of the history (nt,).

    What is left open, the residue, is closed by itself once more behind it, as if the history went on as it began
    (fatpack.find_rainflow_ranges). Turns are sorted into `load_classes` equal classes from the least to the largest.
    fatpack's seam may lose the first or the last turn of the history. Where that is its largest or least value, so that
    no cycle has the whole range, the same repeating history is counted from its largest value on.
    """
    whole = float(np.ptp(history))
    if whole == 0.0:
        return np.empty(0)
    found = _counted(history, load_classes)
    if found.max(initial=0.0) < whole * (1.0 - 0.5 / load_classes):
        found = _counted(np.append(np.roll(history, -int(history.argmax())), history.max()), load_classes)
    return found


def _counted(history: Array, load_classes: int) -> Array:
    """As fatpack counts; none where the history has fewer turns than it can take."""
    try:
        return np.asarray(fatpack.find_rainflow_ranges(history, k=load_classes))
    except (IndexError, ValueError):
        return np.empty(0)


def mean_period(time: Array, history: Array) -> float:
    """Mean time between upward crossings of the mean [s]; inf with fewer than two of them."""
    above = history > history.mean()
    up = time[1:][above[1:] & ~above[:-1]]
    return float((up[-1] - up[0]) / (up.size - 1)) if up.size > 1 else np.inf
