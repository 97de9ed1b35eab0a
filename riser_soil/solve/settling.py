"""Settling: a riser sinks into clay that as it is does not bear it, in short steps, until it does.

A step on soil that moves is linear about its start, and clay at its limit bears no more in it, however far the riser
goes; it does once the riser is deeper. So the riser sinks against a drag, where it touches, that takes up what the clay
does not bear. These are steps of the soil, which moves with each, with all its history. The drag falls as the clay
bears more, and from where it bears nearly nothing, equilibrium without it is tried.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.communicator import Communicator, destroyed_together
from riser_soil.core.part import Model, State
from riser_soil.core.roles import Renewing, with_role
from riser_soil.core.system import System, Timer
from riser_soil.errors import SolveError
from riser_soil.riser.line import Line
from riser_soil.solve.dynamic_relaxation import Relaxation, RelaxationResult, at_rest, step_against
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step import NotConvergedError

LONGEST, ALLOWED = 1 / 200, 1 / 130  # diameters by which a step is to move the riser, and may
DEEPEST, LOOKED_AT = 2.0, 0.1  # diameters by which it settles at a load factor at most; between looks whether it will
NEARLY_BORNE = 0.01  # share of the weight on the drag from which equilibrium without it is tried
STIFFEST = 1e6  # drag over the first
MOST_STEPS = 1000
FALLS, RISES = 0.4, 3.0  # factors of the drag after a step that moved less, and after one that failed


class SinkingError(SolveError):
    """The riser sinks, and comes to no rest."""


@dataclass(frozen=True)
class Pressed:
    """The line that sinks. force: per length (nn,) [N/m] on the soil in a state, the same on all ranks; weight: typical
    force per length [N/m]; diameter [m].
    """

    line: Line
    force: Callable[[State], Array]
    weight: float
    diameter: float


def settle(
    comm: Communicator, model: Model, pressed: Pressed, settings: NewtonSettings, clock: Timer, t: float
) -> RelaxationResult:
    """Let the line sink until there is an equilibrium at the load factor t, and commit it.

    Raises SinkingError where nothing bears it, SolveError where no step converges.
    """
    part = Relaxation([pressed.line], pressed.weight / (LONGEST * pressed.diameter))
    system = System(comm, replace(model, parts=[*model.parts, part]), clock)
    newton = Newton(system, replace(settings, least_iterations=1))  # a slow move's forces may pass for balance
    with destroyed_together(comm, newton.destroy, system.destroy):
        return _Settling(system, newton, part, pressed, t).to_rest()


class _Settling:
    def __init__(self, system: System, newton: Newton, part: Relaxation, pressed: Pressed, t: float) -> None:
        self._system, self._newton, self._part, self._pressed, self._t = system, newton, part, pressed, t
        self._done, self._stiffest, self._least = RelaxationResult(), STIFFEST * part.drag, 0.0

    def to_rest(self) -> RelaxationResult:
        nearly, missing = NEARLY_BORNE, self._sink()
        looked = self._done.sunk, missing
        for _ in range(MOST_STEPS):
            missing = self._sink()
            if missing < self._newton.settings.tolerance:
                return self._done
            if missing < nearly:
                nearly = 0.5 * missing
                if self._step(0.0) is not None:
                    return self._done
            since = self._done.sunk - looked[0]
            if since > LOOKED_AT * self._pressed.diameter:
                self._require_end(missing, (looked[1] - missing) / since)
                looked = self._done.sunk, missing
        raise SinkingError(
            f"the riser creeps on where it touches the soil: {missing:.2g} of what presses there is not borne after "
            f"{MOST_STEPS} steps, in which it sank by {self._done.sunk:.3g} m, at t = {self._t:.6g}"
        )

    def _require_end(self, missing: float, gained: float) -> None:
        """SinkingError where all will not be borne at DEEPEST, even if each metre gains as much as of late."""
        if missing <= gained * (DEEPEST * self._pressed.diameter - self._done.sunk):
            return
        arc = float(self._pressed.line.arc[self._places > 0.0].mean())
        raise SinkingError(
            f"the riser sinks on at arc {arc:.4g} m: by {self._done.sunk:.3g} m at t = {self._t:.6g}, where the soil "
            f"bears {1.0 - missing:.2g} of what presses on it; take less weight there, stronger soil, or a deeper block"
        )

    def _sink(self) -> float:
        """A step against the drag; the share of the load on the soil that the drag bears."""
        self._renew()
        part, line = self._part, self._pressed.line
        part.places[line.name] = 1.0 * (self._pressed.force(self._at_rest) > 0.0)
        if not self._places.any():
            raise SolveError("the riser touches nothing that it could settle in")
        while (moved := self._step(part.drag)) is None:
            pass
        lengths, farthest = line.tributary_length, float(moved.max())
        dragged = part.drag * float(lengths @ moved)
        self._done.sunk += farthest
        part.drag = max(self._least, part.drag * float(np.clip(farthest / self._longest, FALLS, 1.0)))
        return dragged / (dragged + float(lengths @ self._pressed.force(self._at_rest)))

    def _step(self, drag: float) -> Array | None:
        """How far (nn,) [m] the nodes that touched have moved, once the step is committed; None where it could not be
        taken, and another drag is needed.
        """
        line = self._pressed.line
        try:
            solution = step_against(self._system, self._newton, self._part, self._t, drag)
        except NotConvergedError as failure:
            if drag:
                self._least = 0.5 * RISES * drag
                self._stiffen(RISES, str(failure))
            return None
        self._done.iterations += solution.iterations
        moved: Array = self._places * np.abs(solution.state.u[line.translation_dofs]).max(axis=1)
        if drag and moved.max() > ALLOWED * self._pressed.diameter:
            self._stiffen(float(moved.max()) / self._longest, "its supports move it farther than soil follows")
            return None
        self._system.commit(solution.state)
        return moved

    def _stiffen(self, by: float, reason: str) -> None:
        self._part.drag *= by
        if self._part.drag > self._stiffest:
            sort = SinkingError if self._done.sunk else SolveError
            raise sort(f"the riser does not settle even in tiny steps: {reason}")

    @property
    def _places(self) -> Array:
        """1 at nodes that are dragged, else 0."""
        return self._part.places[self._pressed.line.name]

    @property
    def _longest(self) -> float:
        return LONGEST * self._pressed.diameter

    @property
    def _at_rest(self) -> State:
        return at_rest(self._system, self._t)

    def _renew(self) -> None:
        """New meshes where cells are worn; the next step takes up what they lack of balance."""
        for part in with_role(self._system.model.parts, Renewing):
            stored = self._system.energy(self._at_rest).total
            if part.renew(self._at_rest):
                part.lose(stored - self._system.energy(self._at_rest).total)
