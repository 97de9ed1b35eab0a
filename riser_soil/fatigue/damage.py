"""Damage of a riser's wall in a year: Miner's sum over load cases with their shares."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.fatigue.rainflow import mean_period, rainflow_ranges
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
        """On stress ranges in a wall of this thickness [m]."""
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
