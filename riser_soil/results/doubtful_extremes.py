"""Extremes that the time step leaves in doubt: their errors from how sharply figures turn, limits, warnings.

What is judged is the largest tension at both ends, the least along the riser and the largest moment. A riser that was
in compression may get taut long after, and with another force in finer steps: the largest tension's own course does
not show that, the least one's does.

Estimate of the time step's error in the extremes of figures, from how sharply the figures turn between steps.

A scheme of second order misses about dt^2 q''/n of a figure q(t), and dt^2 q'' is its second difference

    D = q(n+1) - 2 q(n) + q(n-1).

The estimate of a peak's error is SHARE times the largest |D| of the steps around it. That of an extreme is its own, or
how far another peak goes beyond it with an error of its own: a sharp peak nearly as large as the extreme may be larger
in truth. It costs no solve and knows nothing of what the figure is. It is an estimate of size, not a bound: an error
that has grown elsewhere, as one of phase, is not seen; a corner that the motion itself has counts like one that the
steps have cut.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.saved_state import Saved
from riser_soil.results.figures import places_of

JUDGED = (
    "start.effective_tension",
    "end.effective_tension",
    "min_effective_tension",
    "max_bending_moment",
    "touchdown_arc",
)
NEAR = 0.15  # of its error, by which another peak may be less than the extreme


"""Figures whose extremes have an estimated error; the last one's has no warning."""
START, END, LEAST, MOMENT, _ = range(len(JUDGED))
AT = np.array([places_of(name).start for name in JUDGED])
# Share of the largest tension, or moment, from which an estimated error is a warning, and the share of it to aim at.
LARGE_ERROR, FINE = 0.03, 1.0 / 3.0
# The least effective tension is told from this share of its own size, or where the riser is compressed from half of it,
# as the force with which it gets taut again errs by several times as much; within NEAR_SLACK and LARGE_ERROR of the
# largest.
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
        found = self.resolution
        return DoubtfulExtreme(name, unit, float(found.of_most[at]), scale, float(found.steps[1, at]))

    def _of_least(self, scale: float) -> DoubtfulExtreme:
        found = self.resolution
        least, error, dt = (float(each[LEAST]) for each in (found.least, found.of_least, found.steps[0]))
        own, then = (COMPRESSED_ERROR, _TAUT_AGAIN) if least < 0.0 else (LEAST_ERROR, "")
        size = own * abs(least) / scale if scale > 0.0 else LARGE_ERROR
        allowed = min(max(size, NEAR_SLACK), LARGE_ERROR)
        return DoubtfulExtreme("least effective tension", "N", error, scale, dt, allowed, then)


class TimeResolution:
    """Estimates of the time step's error in the extremes of n figures."""

    def __init__(self, n: int) -> None:
        from riser_soil.results.course import Course, follow  # compiled code is imported where there are stages

        none, unknown = np.zeros((2, n)), np.full((2, n), -np.inf)
        course = Course(
            values=np.full(n, np.nan),
            slope=np.full(n, np.nan),
            past=np.zeros(n),
            times=np.full(2, np.nan),
            extreme=unknown.copy(),
            error=none.copy(),
            steps=none.copy(),
            peak=unknown.copy(),
            leads=np.zeros((2, n), dtype=bool),
            around=none.copy(),
            longest=none.copy(),
            since=none.copy(),
            rival=unknown.copy(),
            rival_error=none.copy(),
            rival_steps=none.copy(),
        )
        self._follow, self._course = follow, course

    def update(self, t: Array | float, values: Array) -> None:
        """t: s; values (n,) after a step, or times (nt,) and values (nt, n) after steps in turn. nan does not count."""
        self._follow(self._course, np.atleast_1d(t), np.atleast_2d(values))

    @property
    def _less(self) -> Array:
        """How much less than the extreme the other peak is (2, n)."""
        extreme, rival = self._course.extreme, self._course.rival
        return np.subtract(extreme, rival, out=np.full_like(extreme, np.inf), where=np.isfinite(rival))

    @property
    def _rivalled(self) -> BoolArray:
        beyond = self._course.rival_error - self._less > self._course.error
        return beyond & (self._less <= NEAR * self._course.rival_error)

    @property
    def _errors(self) -> Array:
        return np.where(self._rivalled, self._course.rival_error - self._less, self._course.error)

    @property
    def least(self) -> Array:
        """Least values (n,) yet; inf without any."""
        return -self._course.extreme[0]

    @property
    def steps(self) -> Array:
        """Longest steps [s] around the peaks that the errors of the least and the largest values (2, n) come from."""
        return np.where(self._rivalled, self._course.rival_steps, self._course.steps)

    @property
    def of_least(self) -> Array:
        """Estimated error (n,) of the least values."""
        return self._errors[0]

    @property
    def of_most(self) -> Array:
        """Estimated error (n,) of the largest values."""
        return self._errors[1]

    def state(self) -> Saved:
        return {name: values.copy() for name, values in self._course._asdict().items()}

    def restore(self, saved: Saved) -> None:
        for name, values in self._course._asdict().items():
            values[...] = saved[name]
