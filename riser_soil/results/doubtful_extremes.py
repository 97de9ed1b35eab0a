"""Extremes that the time step leaves in doubt: their errors from how sharply figures turn, limits, warnings.

What is judged is the largest tension at both ends, the least along the riser and the largest moment. A riser that was
in compression may get taut long after, and with another force in finer steps: the largest tension's own course does
not show that, the least one's does.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.results.figures import places_of
from riser_soil.results.time_resolution import TimeResolution

JUDGED = (  # figures whose extremes have an estimated error; the last one's has no warning
    "start.effective_tension",
    "end.effective_tension",
    "min_effective_tension",
    "max_bending_moment",
    "touchdown_arc",
)
START, END, LEAST, MOMENT, _ = range(len(JUDGED))
AT = np.array([places_of(name).start for name in JUDGED])
# Share of the largest tension, or moment, from which an estimated error is a warning, and the share of it to aim at.
LARGE_ERROR, FINE = 0.03, 1.0 / 3.0
# An error of the least effective tension is a warning from this share of its own size, or where the riser is compressed
# from half of it, as the force with which it gets taut again errs by several times as much; within NEAR_SLACK and
# LARGE_ERROR of the largest.
LEAST_ERROR, COMPRESSED_ERROR, NEAR_SLACK = 0.1, 0.05, 0.01
NEGLIGIBLE = 1e-2  # of the riser's weight: a tension too small to judge; times a diameter, a moment
_TAUT_AGAIN = "; where the riser is compressed, the force with which it gets taut again may be off by more"


@dataclass(frozen=True)
class DoubtfulExtreme:
    """An extreme's estimated error beside a scale, in `unit`, and the share of it from which it is a warning.

    dt: the longest step around it [s]. then: what else its error means.
    """

    name: str
    unit: str
    error: float
    scale: float
    dt: float
    allowed: float = LARGE_ERROR
    then: str = ""

    @property
    def share(self) -> float:
        """Estimated error over the scale."""
        return self.error / self.scale if self.scale > 0.0 else 0.0

    @property
    def excess(self) -> float:
        """The share over the allowed one; above 1 it is a warning."""
        return self.share / self.allowed

    def warning(self, automatic: bool) -> str:
        """automatic: whether the steps are; their local error goes with their third power."""
        shorter = math.sqrt(FINE / self.excess)
        fixed, auto = f"time_step of {self.dt * shorter:.2g} s, or auto", f"tolerance of {shorter**3:.2g} of this one"
        return (
            f"the {self.name} may be off by some {self.error:.3g} {self.unit}, {self.share:.2g} of {self.scale:.4g} "
            f"{self.unit} (limit {self.allowed:.2g}): that sharply it turns between steps of {self.dt:.3g} s"
            f"{self.then}; take a {auto if automatic else fixed}"
        )


@dataclass(frozen=True, eq=False)
class JudgedExtremes:
    """The extremes of a stage. largest: sizes (5,) of the figures; diameter, weight: of the riser [m], [N]."""

    resolution: TimeResolution
    largest: Array
    diameter: float
    weight: float

    def warnings(self, automatic: bool) -> Iterator[str]:
        """Warnings of the tension that is most in doubt, and of the bending moment."""
        for worst in (max(self._tensions(), key=lambda each: each.excess), self._moment()):
            if worst.excess > 1.0:
                yield worst.warning(automatic)

    def _tensions(self) -> Iterator[DoubtfulExtreme]:
        scale = max(float(self.largest[:LEAST].max()), NEGLIGIBLE * self.weight)
        yield self._of_largest("largest tension at the start", "N", START, scale)
        yield self._of_largest("largest tension at the end", "N", END, scale)
        yield self._of_least(scale)

    def _moment(self) -> DoubtfulExtreme:
        scale = max(float(self.largest[MOMENT]), NEGLIGIBLE * self.weight * self.diameter)
        return self._of_largest("largest bending moment", "N.m", MOMENT, scale)

    def _of_largest(self, name: str, unit: str, at: int, scale: float) -> DoubtfulExtreme:
        error, dt = self.resolution.of_most[at], self.resolution.steps[1, at]
        return DoubtfulExtreme(name, unit, float(error), scale, float(dt))

    def _of_least(self, scale: float) -> DoubtfulExtreme:
        judged = self.resolution
        least, error, dt = (float(each[LEAST]) for each in (judged.least, judged.of_least, judged.steps[0]))
        own, then = (COMPRESSED_ERROR, _TAUT_AGAIN) if least < 0.0 else (LEAST_ERROR, "")
        size = own * abs(least) / scale if scale > 0.0 else LARGE_ERROR
        allowed = min(max(size, NEAR_SLACK), LARGE_ERROR)
        return DoubtfulExtreme("least effective tension", "N", error, scale, dt, allowed, then)
