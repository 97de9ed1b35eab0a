"""Hang-off: ends' places, or segments' lengths, with which lines at rest have the angles or tensions asked for.

The cable without bending stiffness tells where to begin. The scene itself is then taken through its first static stage,
with bending, ends, joints and ground as in any run, and the secant method, of several ends Powell's hybrid method,
closes the rest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from riser_soil.assembly import Assembly, build, sized
from riser_soil.assembly.hang_off import HungEnd, by_cable, first_value, hung_ends, in_words, settled, with_values
from riser_soil.assembly.packages import communicator_of
from riser_soil.core.arrays import Array, as_list
from riser_soil.core.communicator import Communicator
from riser_soil.errors import SceneError, SolveError
from riser_soil.results.riser_snapshot import riser_snapshot
from riser_soil.scene.scene import Scene
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import StatelessObserver, solve_stages

ANGLE, TENSION = 0.002, 2e-5  # deg; of the tension asked for: a fifth of what is promised
MOST = 12  # static solves by end
DIFFERENCE = 1e-3  # of a value, by which slopes are found where there are several
LONGEST_STEP = 0.1  # of all values, of the first step from where the slopes are found


@dataclass(frozen=True)
class FoundEnd:
    """What was asked for at an end, the value [m] found, and what the riser has there."""

    hung: HungEnd
    value: float
    reached: float

    @property
    def in_words(self) -> str:
        """The request and what was reached, in words."""
        return f"{in_words(self.hung, self.value)} gives {self.reached:.7g} {self.hung.asked.unit}"

    @property
    def summary(self) -> dict[str, Any]:
        """This end in block `hang_off` of summary.json."""
        asked = self.hung.asked
        quantity = {"angle_deg": asked.angle} if asked.angle is not None else {"tension": asked.tension}
        known = {"end": self.hung.name, "asked": quantity, "reached": self.reached}
        return known | {"by": asked.by, "value": self.value}


@dataclass(frozen=True)
class HungScene:
    """The scene in numbers; what was found at its ends, and the static solves that it took."""

    scene: Scene
    ends: tuple[FoundEnd, ...]
    solves: int

    @property
    def in_words(self) -> str:
        """What was found for each end, a line each."""
        return "\n".join(f"{each.in_words} ({self.solves} static solves)" for each in self.ends)

    @property
    def summary(self) -> dict[str, Any]:
        """Block `hang_off` of summary.json, of several lines by name."""
        found = {each.hung.line: each.summary | {"static_solves": self.solves} for each in self.ends}
        return found if self.scene.lines else found[""]


def hung(scene: Scene) -> HungScene | None:
    """The scene with what its hang-offs ask for solved; None where none is asked for; collective.

    Raises SceneError where no values give it, SolveError where none were found.
    """
    ends = hung_ends(scene)
    if not ends:
        return None
    return _HangOffSearch(ends, communicator_of(scene)).found()


class _HangOffSearch:
    """The search for values (ends,) [m] by Powell's hybrid method, from those of cables, then from those of cables
    whose aims are shifted by what the lines miss, if that is nearer.
    """

    def __init__(self, ends: Sequence[HungEnd], comm: Communicator) -> None:
        self._ends, self._comm = ends, comm
        self._asked = np.array([each.asked.asked for each in ends])
        self._close = np.array([ANGLE if each.asked.angle is not None else TENSION * each.asked.asked for each in ends])
        self._low, self._high = np.transpose([each.bounds for each in ends])
        self._tried: list[tuple[Array, Array]] = []  # values and what they miss, over what may be missed

    def found(self) -> HungScene:
        """What is close enough, or SolveError."""
        from scipy.optimize import root

        values = np.array([first_value(each) for each in self._ends])
        if (off := self._off(values)).any():
            values = min(self._shifted(values, off), key=lambda each: float(np.linalg.norm(self._off(each))))
        if self._off(values).any():
            root(self._off, values, jac=self._slopes, options={"factor": LONGEST_STEP, "xtol": 0.0})
        values, off = self._nearest
        if self._missed(off).any():
            raise self._failure()
        ends = zip(self._ends, as_list(values), as_list(self._asked + off * self._close), strict=True)
        scene = settled(self._ends, as_list(values))
        return HungScene(scene, tuple(FoundEnd(*each) for each in ends), len(self._tried))

    def _shifted(self, values: Array, off: Array) -> list[Array]:
        """The values, and those of cables with shifted aims, where there are such cables."""
        try:
            return [values, self._by_cables(self._asked - off * self._close)]
        except SceneError:
            return [values]

    def _by_cables(self, asked: Array) -> Array:
        return np.array([by_cable(*each) for each in zip(self._ends, asked, strict=True)])

    def _off(self, values: Array) -> Array:
        """What lines at rest have beyond what was asked for, over what may be missed (ends,); 0 where all is close."""
        values = np.clip(values, self._low, self._high)
        for known, off in self._tried:
            if np.array_equal(known, values):
                return self._missed(off)
        if len(self._tried) == MOST * len(self._ends):
            raise self._failure()
        reached = _reached(self._ends, with_values(self._ends, as_list(values)), self._comm)
        self._tried.append((values, (reached - self._asked) / self._close))
        return self._missed(self._tried[-1][1])

    def _missed(self, off: Array) -> Array:
        return off.copy() if np.any(np.abs(off) > 1.0) else np.zeros_like(off)

    @property
    def _nearest(self) -> tuple[Array, Array]:
        return min(self._tried, key=lambda each: float(np.abs(each[1]).max()))

    def _slopes(self, values: Array) -> Array:
        """Derivative of the ends' errors by the values that are solved for [1/m] (ends, ends): of one end from the last
        two values tried, of several ends by one solve for each.
        """
        off = self._off(values)
        others = self._tried[:-3:-1] if len(values) == 1 else []
        for other, seen in others:
            if other != values:
                return (seen - off)[:, None] / (other - values)
        step = DIFFERENCE * values
        return np.transpose([(self._off(values + step * unit) - off) / (step @ unit) for unit in np.eye(len(values))])

    def _failure(self) -> SolveError:
        values, off = self._nearest
        worst = int(np.argmax(np.abs(off)))
        missing, missed = self._ends[worst], off[worst] * self._close[worst]
        return SolveError(
            f"{missing.path}: {missing.request} was not reached in {len(self._tried)} static solves: with "
            f"{values[worst]:.6g} m it is off by {missed:.3g} {missing.asked.unit}; take finer elements or a stiffer "
            "solver.tolerance"
        )


def _reached(ends: Sequence[HungEnd], scene: Scene, comm: Communicator) -> Array:
    """The lines' own angles [deg] or tensions [N] (ends,) at the end of the first stage, the vessel at no offset;
    collective.
    """
    assembly = build(sized(scene.model_copy(update={"vessel": None})), comm)
    last = _LastStep(assembly, ends)
    solve_stages(assembly, last, assembly.scene.stages[:1])
    return np.array(comm.bcast(last.seen))


class _LastStep(StatelessObserver):
    """Sees the angles or tensions at the last step of a stage; on rank 0."""

    def __init__(self, assembly: Assembly, ends: Sequence[HungEnd]) -> None:
        self._assembly, self._ends, self.seen = assembly, ends, list[float]()

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        if last and self._assembly.comm.rank == 0:
            self.seen = [self._seen(hung, stepper) for hung in self._ends]

    def _seen(self, hung: HungEnd, stepper: TimeStepper) -> float:
        riser, at_end = riser_snapshot(self._assembly.lines[hung.line], stepper), hung.name == "end"
        if hung.asked.angle is None:
            return float(riser.effective_tension[-1 if at_end else 0])
        return from_vertical(riser.end_tangent if at_end else -riser.start_tangent)


def from_vertical(upwards: Array) -> float:
    """Angle [deg] of a unit tangent (3,) that points out of the riser, from the upward vertical."""
    return math.degrees(math.atan2(math.hypot(upwards[0], upwards[1]), upwards[2]))
