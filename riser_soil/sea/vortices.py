"""Vortices shed by the pipe, which shake it across the flow: the part "vortices" of dynamic stages in space."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State, Traits, Weights, Work
from riser_soil.core.roles import Starting
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.stations import POINTS
from riser_soil.riser.trial import Trial
from riser_soil.sea import vortex_law as law
from riser_soil.sea.morison import Morison
from riser_soil.sea.moving_water import FlowAtStations
from riser_soil.sea.moving_water_kernels import MovingWaterNumbers
from riser_soil.sea.still_water import StationLoads
from riser_soil.sea.through import ThroughLoads
from riser_soil.sea.vortex_kernels import Push, VortexNumbers


class Shed:
    """Vortices behind a pipe: their wake, kept from step to step, and the loads that follow from it."""

    def __init__(self, stream: FlowAtStations, shed: law.Shedding) -> None:
        self.stream, self.shed, self.wake = stream, shed, _new_wake(stream)
        self.loads = ThroughLoads(stream, self._push, dissipative=False)

    def _push(self, t: float) -> Push:
        """At a time of the step under way, where it ends."""
        return Push(self.shed.lift, np.stack(2 * [law.phases_at(self.wake, t)]))

    def begin(self, trial: Trial) -> None:
        """Shed as behind a pipe at rest, then as behind one in this motion."""
        through, own, a, tau = self._motion(trial)
        law.advance_all(self.wake, self.shed, trial.state.t, through, 0.0 * own, 0.0 * a, tau)
        self.advance(trial)

    def advance(self, trial: Trial) -> None:
        """Keep the wake at the end of an accepted step."""
        law.advance_all(self.wake, self.shed, trial.state.t, *self._motion(trial))

    def _motion(self, trial: Trial) -> tuple[Array, Array, Array, Array]:
        """Velocity through the water, own velocity and acceleration, tangent; each (ne, ng, 3)."""
        own = self.stream.pipe.flow(trial)
        return self.stream.through(trial).v, own.v, own.a, own.tau


def _new_wake(stream: FlowAtStations) -> law.Wake:
    """Phases once around along the line, so that no shape is left out; the rates follow."""
    line, shape = stream.pipe.line, stream.pipe.share.shape
    arc = line.arc[:-1, None] + line.length[:, None] * POINTS
    return law.Wake(np.zeros(1), 2.0 * np.pi * arc / line.arc[-1], np.zeros(shape), np.zeros(shape))


class Vortices(LinePart):
    """Force of the vortices on the pipe. loads: theirs, or what a surface makes of them."""

    name = "vortices"
    traits = Traits("F", symmetric=False, follows=True, keeps_way=True, roles=(Stateful, Starting))

    def __init__(self, loads: StationLoads, vortices: Shed) -> None:
        pipe = vortices.stream.pipe
        super().__init__(pipe.line)
        self._vortices, self._acting = vortices, Morison(pipe, loads, self._numbers)

    def element_forces(self, state: State) -> tuple[Array, Array]:
        """Element residuals (inertia, force), each (ne, 2 ndof)."""
        return self._acting.element_forces(state)

    def residual(self, state: State, forces: Forces) -> None:
        self._acting.residual(state, forces)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        self._acting.tangent(state, weights, values)

    def work(self, before: State, after: State) -> Work:
        """All is external work, of either sign."""
        return self._acting.work(before, after)

    def numbers(self) -> tuple[object, ...]:
        return self._acting.numbers()

    def _numbers(self, flow: MovingWaterNumbers) -> VortexNumbers:
        shed = self._vortices
        self._push = Push(shed.shed.lift, np.zeros((2, *flow.share.shape)))
        return VortexNumbers(flow, self._push, shed.shed, shed.wake)

    def renew_numbers(self, start: float, end: float) -> None:
        self._acting.renew_numbers(start, end)
        for phases, t in zip(self._push.phases, (start, end), strict=True):
            phases[:] = law.phases_at(self._vortices.wake, t)

    def begin_stage(self, state: State) -> None:
        self._vortices.begin(self.line.trial(state))

    def commit(self, state: State) -> None:
        """Keep the wake."""
        self._vortices.advance(self.line.trial(state))

    def state(self) -> Saved:
        return {name: values.copy() for name, values in self._vortices.wake._asdict().items()}

    def restore(self, saved: Saved) -> None:
        for name, values in self._vortices.wake._asdict().items():
            values[:] = saved[name]
