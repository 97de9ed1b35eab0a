"""What a run is worth: the quantities in which programs are compared, and how far a run is from their consensus."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median

import numpy as np
from scipy.interpolate import CubicSpline

from benchmarks.peers.case import Case, Record
from riser_soil.core.arrays import Array
from riser_soil.results.stage_records import peak

TENSIONS = ("top min", "top max", "bottom min", "bottom max")
MOMENT, RANGE = "largest moment", "touchdown range"
BETWEEN = 2001  # arcs at which the height is looked at


@dataclass(frozen=True)
class Judged:
    """A run's largest error of all quantities, and what it cost: processor seconds per simulated second."""

    elements: int
    time_step: float
    seconds: float
    error: float

    def refines(self, other: Judged) -> bool:
        """Whether it has at least as many elements and at most as long steps; each run refines itself."""
        return self.elements >= other.elements and self.time_step <= other.time_step


def quantities(case: Case, record: Record) -> dict[str, float]:
    """Extremes from `case.since` on, between records and stations; over a floor how far the touchdown point travels."""
    window = record.time >= case.since - 1e-9
    t = record.time[window]
    values: dict[str, float] = {}
    for name, tension in (("top", record.moved[window]), ("bottom", record.held[window])):
        values |= {f"{name} min": -float(peak(t, -tension)), f"{name} max": float(peak(t, tension))}
    values[MOMENT] = float(peak(t, peak(record.arc, record.moment[window])))
    if case.floor is not None:
        arc = lift_off(case, record.position[window, :, 1])
        values[RANGE] = float(peak(t, arc) + peak(t, -arc))
    return values


def lift_off(case: Case, height: Array) -> Array:
    """Arc (nt,) [m] of the last point that is lower than the clearance, of node heights (nt, nn) [m] at equal arcs."""
    arcs = np.linspace(0.0, case.length, BETWEEN)
    above = CubicSpline(np.linspace(0.0, case.length, height.shape[1]), height, axis=1)(arcs) - case.clearance
    last = BETWEEN - 1 - np.argmax(above[:, ::-1] < 0.0, axis=1)
    low, high = (above[np.arange(len(above)), last + k] for k in (0, 1))
    return np.asarray(arcs[last] + (arcs[1] - arcs[0]) * low / (low - high))


def consensus(finest: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """The median of each quantity over the programs' finest runs."""
    return {name: median(each[name] for each in finest) for name in finest[0]}


def apart(finest: Sequence[Mapping[str, float]]) -> float:
    """How far the finest runs are from each other, as errors are reported: a smaller error of any run means nothing."""
    agreed = consensus(finest)
    differences = ((a[name] - b[name]) / _scale(name, agreed) for name in agreed for a in finest for b in finest)
    return max(differences)


def errors(values: Mapping[str, float], agreed: Mapping[str, float]) -> dict[str, float]:
    """Relative: of tensions to the greatest at that end, of all else to itself."""
    return {name: abs(values[name] - agreed[name]) / _scale(name, agreed) for name in agreed}


def _scale(name: str, agreed: Mapping[str, float]) -> float:
    return agreed[f"{name.split()[0]} max"] if name in TENSIONS else agreed[name]


def kept_error(run: Judged, runs: Sequence[Judged]) -> float:
    """The largest error of a run and of all those that refine it: a run that is right by luck is none the better."""
    return max(each.error for each in runs if each.refines(run))


def cheapest(runs: Sequence[Judged], target: float) -> Judged | None:
    """The cheapest run that has an accuracy, and all whose refinements have it."""
    reached = [run for run in runs if kept_error(run, runs) <= target]
    return min(reached, key=lambda run: run.seconds, default=None)


def front(runs: Sequence[Judged]) -> list[tuple[float, float]]:
    """Seconds and kept errors of the runs that no cheaper one beats, from cheap to dear."""
    points: list[tuple[float, float]] = []
    for run in sorted(runs, key=lambda run: run.seconds):
        kept = kept_error(run, runs)
        if not points or kept < points[-1][1]:
            points.append((run.seconds, kept))
    return points
