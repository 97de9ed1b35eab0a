"""Damage of a riser's wall in a year: rainflow cycles, Miner's sum over load cases with their shares."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import fatpack
import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.fatigue.sn_curve import SNCurve
from riser_soil.fatigue.stress_history import StressHistory

YEAR = 365.25 * 24.0 * 3600.0  # s


@dataclass(frozen=True)
class StressRanges:
    """How ranges are counted: points around the section, surface, load classes, factor on ranges (SCF); thickness [m]
    for the curve's correction, None for the wall's own.
    """

    curve: SNCurve
    points: int = 16
    surface: str = "outer"
    load_classes: int = 4096
    stress_concentration: float = 1.0
    thickness: float | None = None

    @property
    def angles(self) -> Array:
        """(np,) rad, from the section's y axis towards its z axis."""
        return 2.0 * np.pi / self.points * np.arange(self.points)

    def factor(self, wall_thickness: float) -> float:
        """Factor on stress ranges in a wall of this thickness [m]."""
        thickness = wall_thickness if self.thickness is None else self.thickness
        return self.stress_concentration * self.curve.thickness_factor(thickness)


def damage_rates(history: StressHistory, how: StressRanges, sections: Sequence[int]) -> Array:
    """Damage per second (n, np) of sections at the points around them."""
    rates = np.empty((len(sections), how.points))
    thickness = history.sections.wall.thickness
    for row, section in enumerate(sections):
        scale = 1e-6 * how.factor(float(thickness[section]))  # Pa to MPa
        stress = history.at(section, how.angles, how.surface)
        for point in range(how.points):
            ranges = rainflow_ranges(stress[:, point], how.load_classes)
            rates[row, point] = how.curve.damage(scale * ranges) / history.duration
    return rates


def standard_error(history: StressHistory, how: StressRanges, section: int, point: int) -> float:
    """Relative standard error of the damage at a point, by that of four parts of the history; 0 without damage."""
    stress = history.at(section, how.angles[[point]], how.surface)[:, 0]
    scale = 1e-6 * how.factor(float(history.sections.wall.thickness[section]))
    parts = [how.curve.damage(scale * rainflow_ranges(part, how.load_classes)) for part in np.array_split(stress, 4)]
    mean = float(np.mean(parts))
    return float(np.std(parts, ddof=1)) / (2.0 * mean) if mean > 0.0 else 0.0


def records_per_period(history: StressHistory, how: StressRanges, section: int, point: int) -> tuple[float, float]:
    """Mean period of the stress [s] between upward crossings of its mean, and how many records it has."""
    period = mean_period(history.time, history.at(section, how.angles[[point]], how.surface)[:, 0])
    return period, period * (history.time.size - 1) / history.duration


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
    ranges = _counted(history, load_classes)
    if ranges.max(initial=0.0) < whole * (1.0 - 0.5 / load_classes):
        ranges = _counted(np.append(np.roll(history, -int(history.argmax())), history.max()), load_classes)
    return ranges


def _counted(history: Array, load_classes: int) -> Array:
    """Ranges of rainflow cycles, as fatpack counts them; none where the history has fewer turns than it can count."""
    try:
        return np.asarray(fatpack.find_rainflow_ranges(history, k=load_classes))
    except (IndexError, ValueError):
        return np.empty(0)


def mean_period(time: Array, history: Array) -> float:
    """Mean time between upward crossings of the mean [s]; inf with fewer than two of them."""
    above = history > history.mean()
    up = time[1:][above[1:] & ~above[:-1]]
    return float((up[-1] - up[0]) / (up.size - 1)) if up.size > 1 else np.inf
