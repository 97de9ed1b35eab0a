"""Hang-off: ends' places, or segments' lengths, with which lines at rest have the angles or tensions asked for.

The first guess is that of a cable without bending stiffness. Each evaluation of the residual solves the scene's first
static stage, with bending, ends, joints and ground as in any run. The root is found by the secant method for one end,
by Powell's hybrid method for several.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from riser_soil.assembly import Assembly, build, sized
from riser_soil.assembly.hang_off import (
    HangOffEnd,
    by_cable,
    first_value,
    hang_off_ends,
    in_words,
    settled,
    with_values,
)
from riser_soil.assembly.packages import communicator_of
from riser_soil.core.arrays import Array, as_list
from riser_soil.core.communicator import Communicator
from riser_soil.errors import SceneError, SolveError
from riser_soil.results.riser_record import riser_record
from riser_soil.scene.scene import Scene
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import StatelessObserver, solve_stages

ANGLE, TENSION = 0.002, 2e-5  # tolerances: in degrees, and relative; a fifth of those in the documentation
MOST_SOLVES = 12  # largest number of static solves for each end
DIFFERENCE = 1e-3  # relative, of a value, for derivatives with several ends
FIRST_STEP = 0.1  # largest relative length of the first step


@dataclass(frozen=True)
class SolvedEnd:
    """Solved end. value: its coordinate or length [m]. reached: angle [deg] or tension [N] of the riser there."""

    end: HangOffEnd
    value: float
    reached: float

    @property
    def in_words(self) -> str:
        """The request and what was reached, in words."""
        return f"{in_words(self.end, self.value)} gives {self.reached:.7g} {self.end.asked.unit}"

    @property
    def summary(self) -> dict[str, Any]:
        """This end in block `hang_off` of summary.json."""
        asked = self.end.asked
        quantity = {"angle_deg": asked.angle} if asked.angle is not None else {"tension": asked.tension}
        known = {"end": self.end.name, "asked": quantity, "reached": self.reached}
        return known | {"by": asked.by, "value": self.value}


@dataclass(frozen=True)
class SolvedHangOffs:
    """The scene with solved hang-offs. solves: number of static solves."""

    scene: Scene
    ends: tuple[SolvedEnd, ...]
    solves: int

    @property
    def in_words(self) -> str:
        """The solution in words, a line for each end."""
        return "\n".join(f"{each.in_words} ({self.solves} static solves)" for each in self.ends)

    @property
    def summary(self) -> dict[str, Any]:
        """Block `hang_off` of summary.json, of several lines by name."""
        summaries = {each.end.line: each.summary | {"static_solves": self.solves} for each in self.ends}
        return summaries if self.scene.lines else summaries[""]


def with_hang_offs_solved(scene: Scene) -> SolvedHangOffs | None:
    """The scene with its hang-offs solved, None where it has none; collective.

    Raises SceneError where there is no solution, SolveError where none was found.
    """
    ends = hang_off_ends(scene)
    if not ends:
        return None
    return _HangOffSearch(ends, communicator_of(scene)).solve()


class _HangOffSearch:
    """Root of the residual of values (ends,) [m].

    The search begins with the values of cables, or of cables whose aims are shifted by the residual, if that is nearer.
    """

    def __init__(self, ends: Sequence[HangOffEnd], comm: Communicator) -> None:
        self._ends, self._comm = ends, comm
        self._asked = np.array([each.asked.asked for each in ends])
        angles = np.array([each.asked.angle is not None for each in ends])
        self._tolerance = np.where(angles, ANGLE, TENSION * self._asked)
        self._low, self._high = np.transpose([each.bounds for each in ends])
        self._evaluated: list[tuple[Array, Array]] = []  # values and their residuals

    def solve(self) -> SolvedHangOffs:
        """The scene with the values of the root, or SolveError."""
        from scipy.optimize import root

        values = np.array([first_value(each) for each in self._ends])
        if (residual := self._residual(values)).any():
            guesses = self._shifted(values, residual)
            values = min(guesses, key=lambda each: float(np.linalg.norm(self._residual(each))))
        if self._residual(values).any():
            root(self._residual, values, jac=self._jacobian, options={"factor": FIRST_STEP, "xtol": 0.0})
        values, residual = self._nearest
        if _beyond_tolerance(residual).any():
            raise self._failure()
        ends = zip(self._ends, as_list(values), as_list(self._asked + residual * self._tolerance), strict=True)
        scene = settled(self._ends, as_list(values))
        return SolvedHangOffs(scene, tuple(SolvedEnd(*each) for each in ends), len(self._evaluated))

    def _shifted(self, values: Array, residual: Array) -> list[Array]:
        """The values, and those of cables with shifted aims, where there are such cables."""
        try:
            return [values, self._by_cables(self._asked - residual * self._tolerance)]
        except SceneError:
            return [values]

    def _by_cables(self, asked: Array) -> Array:
        return np.array([by_cable(*each) for each in zip(self._ends, asked, strict=True)])

    def _residual(self, values: Array) -> Array:
        """Angles or tensions at rest less those asked for, over the tolerance (ends,); 0 if all are within it."""
        values = np.clip(values, self._low, self._high)
        for known, residual in self._evaluated:
            if np.array_equal(known, values):
                return _beyond_tolerance(residual)
        if len(self._evaluated) == MOST_SOLVES * len(self._ends):
            raise self._failure()
        reached = _reached(self._ends, with_values(self._ends, as_list(values)), self._comm)
        self._evaluated.append((values, (reached - self._asked) / self._tolerance))
        return _beyond_tolerance(self._evaluated[-1][1])

    @property
    def _nearest(self) -> tuple[Array, Array]:
        return min(self._evaluated, key=lambda each: float(np.abs(each[1]).max()))

    def _jacobian(self, values: Array) -> Array:
        """Derivative of the residual by the values [1/m] (ends, ends): for one end by the last two evaluations, for
        several by one evaluation each.
        """
        residual = self._residual(values)
        others = self._evaluated[:-3:-1] if len(values) == 1 else []
        for other, of_other in others:
            if other != values:
                return (of_other - residual)[:, None] / (other - values)
        step = DIFFERENCE * values
        columns = [(self._residual(values + step * unit) - residual) / (step @ unit) for unit in np.eye(len(values))]
        return np.transpose(columns)

    def _failure(self) -> SolveError:
        values, residual = self._nearest
        worst = int(np.argmax(np.abs(residual)))
        missing, missed = self._ends[worst], residual[worst] * self._tolerance[worst]
        return SolveError(
            f"{missing.path}: {missing.request} was not reached in {len(self._evaluated)} static solves: with "
            f"{values[worst]:.6g} m it is off by {missed:.3g} {missing.asked.unit}; take finer elements or a stiffer "
            "solver.tolerance"
        )


def _beyond_tolerance(residual: Array) -> Array:
    """The residual, or zero where all of it is within the tolerance."""
    return residual.copy() if np.any(np.abs(residual) > 1.0) else np.zeros_like(residual)


def _reached(ends: Sequence[HangOffEnd], scene: Scene, comm: Communicator) -> Array:
    """Angles [deg] or tensions [N] of lines (ends,) at the end of the first stage, without the vessel's offset;
    collective.
    """
    assembly = build(sized(scene.model_copy(update={"vessel": None})), comm)
    last = _LastStep(assembly, ends)
    solve_stages(assembly, last, assembly.scene.stages[:1])
    return np.array(comm.bcast(last.values))


class _LastStep(StatelessObserver):
    """Observer of angles [deg] or tensions [N] at the last step of a stage, on rank 0."""

    def __init__(self, assembly: Assembly, ends: Sequence[HangOffEnd]) -> None:
        self._assembly, self._ends, self.values = assembly, ends, list[float]()

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        if last and self._assembly.comm.rank == 0:
            self.values = [self._value(end, stepper) for end in self._ends]

    def _value(self, end: HangOffEnd, stepper: TimeStepper) -> float:
        riser, at_end = riser_record(self._assembly.lines[end.line], stepper), end.name == "end"
        if end.asked.angle is None:
            return float(riser.effective_tension[-1 if at_end else 0])
        return from_vertical(riser.end_tangent if at_end else -riser.start_tangent)


def from_vertical(upwards: Array) -> float:
    """Angle [deg] of a unit tangent (3,) that points out of the riser, from the upward vertical."""
    return math.degrees(math.atan2(math.hypot(upwards[0], upwards[1]), upwards[2]))
