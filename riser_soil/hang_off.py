"""Hang-off: an end's place, or a segment's length, with which the riser at rest has the angle or tension asked for.

The cable without bending stiffness tells where to begin. The riser itself is then taken through its first static stage,
with its bending, ends and ground as in any run, and the secant method closes the rest.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from riser_soil.assembly import Assembly, build, sized
from riser_soil.assembly.hang_off import HungEnd, by_cable, hung_end, reported, settled, with_value
from riser_soil.assembly.packages import communicator_of
from riser_soil.core.arrays import Array
from riser_soil.core.communicator import Communicator
from riser_soil.core.system import Timer
from riser_soil.errors import SolveError
from riser_soil.interruption import agreeing
from riser_soil.results.riser_snapshot import riser_snapshot
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import StatelessObserver, lay, run_stage

ANGLE, TENSION = 0.002, 2e-5  # deg; of the tension asked for: a fifth of what is promised
MOST = 12  # static solves


@dataclass(frozen=True)
class HungScene:
    """The scene in numbers; what was asked for in it, the value [m] found, what the riser has there, static solves."""

    scene: Scene
    hung: HungEnd
    value: float
    reached: float
    solves: int

    @property
    def reported(self) -> str:
        """In words."""
        gives = f"gives {self.reached:.7g} {self.hung.asked.unit}"
        return f"{reported(self.hung, self.value)} {gives} ({self.solves} static solves)"

    @property
    def summary(self) -> dict[str, Any]:
        """Block `hang_off` of summary.json."""
        asked = self.hung.asked
        quantity = {"angle_deg": asked.angle} if asked.angle is not None else {"tension": asked.tension}
        return {"end": self.hung.name, "asked": quantity, "reached": self.reached, "by": asked.by} | {
            "value": self.value,
            "static_solves": self.solves,
        }


def hung(scene: Scene) -> HungScene | None:
    """The scene with what its hang-off asks for solved; None where none is asked for; collective.

    Raises SceneError where no value gives it, SolveError where none was found.
    """
    wanted, comm = hung_end(scene), communicator_of(scene)
    if wanted is None:
        return None
    asked, (low, high) = wanted.asked.asked, wanted.limits
    close = ANGLE if wanted.asked.angle is not None else TENSION * asked
    value, before = by_cable(wanted, asked), (math.nan, math.nan)
    for solves in range(1, MOST + 1):
        found = with_value(wanted, value)
        off = _reached(wanted, found, comm) - asked
        if abs(off) <= close:
            return HungScene(settled(wanted, value), wanted, value, asked + off, solves)
        before, value = (value, off), min(max(_next(wanted, before, (value, off)), low), high)
    raise SolveError(
        f"{wanted.path}: {wanted.reported} was not reached in {MOST} static solves: with {before[0]:.6g} m it is off "
        "by "
        f"{before[1]:.3g} {wanted.asked.unit}; take finer elements or a stiffer solver.tolerance"
    )


def _next(wanted: HungEnd, before: tuple[float, float], now: tuple[float, float]) -> float:
    """The secant's zero; at first that of a cable whose aim is shifted by what the riser misses."""
    (value, off), (earlier, earlier_off) = now, before
    if math.isnan(earlier):
        return by_cable(wanted, wanted.asked.asked - off)
    return value - off * (value - earlier) / (off - earlier_off) if off != earlier_off else value


def _reached(wanted: HungEnd, scene: Scene, comm: Communicator) -> float:
    """The riser's own angle [deg] or tension [N] at the end of the first stage; collective."""
    assembly, clock = build(sized(scene), comm), Timer.new()
    last = _LastStep(assembly, wanted)
    with agreeing(comm):
        before, _ = lay(assembly, clock)
        run_stage(assembly, assembly.scene.stages[0], before, last, clock)
    return float(comm.bcast(last.seen))


class _LastStep(StatelessObserver):
    """Sees the angle or tension at the last step of a stage; on rank 0."""

    def __init__(self, assembly: Assembly, wanted: HungEnd) -> None:
        self._assembly, self._wanted, self.seen = assembly, wanted, math.nan

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None:
        pass

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        if not last or self._assembly.comm.rank != 0:
            return
        riser, at_end = riser_snapshot(self._assembly, stepper), self._wanted.name == "end"
        if self._wanted.asked.angle is None:
            self.seen = float(riser.effective_tension[-1 if at_end else 0])
        else:
            self.seen = from_vertical(riser.end_tangent if at_end else -riser.start_tangent)

    def relaxed(self, relaxed: object) -> None:
        pass


def from_vertical(upwards: Array) -> float:
    """Angle [deg] of a unit tangent (3,) that points out of the riser, from the upward vertical."""
    return math.degrees(math.atan2(math.hypot(upwards[0], upwards[1]), upwards[2]))
