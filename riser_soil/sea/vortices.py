"""Vortices shed by the pipe, which shake it across the flow: the part "vortices" of dynamic stages in space."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State, Traits, Weights, Work
from riser_soil.core.roles import Starting
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.stations import POINTS, Derivatives
from riser_soil.riser.trial import Trial
from riser_soil.sea import vortex_law as law
from riser_soil.sea.morison import Morison
from riser_soil.sea.moving_water import FlowAtStations
from riser_soil.sea.moving_water_kernels import MovingWaterNumbers, moving_water
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.still_water import StationLoads
from riser_soil.sea.stream_kernels import WaterInLoop, bring
from riser_soil.sea.vortex_kernels import VortexNumbers


class VortexLoads:
    """Force of the vortices per length, a `StationLoads`, by a wake that is kept from step to step."""

    dissipative = False

    def __init__(self, pipe: Pipe, stream: FlowAtStations, shed: law.Shedding) -> None:
        self.pipe, self._stream, self.shed = pipe, stream, shed
        self.wake = self._new_wake()

    def _new_wake(self) -> law.Wake:
        """Phases once around along the line, so that no shape is left out; the rates follow."""
        line, shape = self.pipe.line, self.pipe.share.shape
        arc = line.arc[:-1, None] + line.length[:, None] * POINTS
        return law.Wake(np.zeros(1), 2.0 * np.pi * arc / line.arc[-1], np.zeros(shape), np.zeros(shape))

    def begin(self, trial: Trial) -> None:
        """Shed as behind a pipe at rest, then as behind one in this motion."""
        through, own, a, tau = self._motion(trial)
        law.advance_all(self.wake, self.shed, trial.state.t, through, 0.0 * own, 0.0 * a, tau)
        self.advance(trial)

    def _motion(self, trial: Trial) -> tuple[Array, Array, Array, Array]:
        """Velocity through the water, own velocity and acceleration, tangent; each (ne, ng, 3)."""
        own = self.pipe.flow(trial)
        return self._stream.through(trial).v, own.v, own.a, own.tau

    def _push(self, trial: Trial) -> Array:
        """Half rho D Cv cos(phi) (ne, ng) [kg/m2]."""
        return np.asarray(self.shed.lift[:, None] * np.cos(law.phases_at(self.wake, trial.state.t)))

    def forces(self, trial: Trial) -> tuple[Array, Array]:
        flow = self._stream.through(trial)
        return np.zeros_like(flow.v), law.resistance(flow.v, flow.tau, self._push(trial))

    def derivatives(self, trial: Trial, weights: Weights) -> Derivatives:
        flow = self._stream.through(trial)
        by_v, by_slope = law.derivatives(flow.v, flow.tau, flow.stretch, weights.force * self._push(trial))
        by_x = -by_v @ self._stream.at(trial).velocity_gradient
        return Derivatives(by_x, by_slope, by_v, np.zeros_like(by_v))

    def numbers(self) -> MovingWaterNumbers:
        return self.seen_in(self._stream.in_loop)

    def seen_in(self, water: WaterInLoop) -> MovingWaterNumbers:
        """The pipe in the water alone, see `VortexNumbers`."""
        nothing = np.zeros((self.shed.lift.size, 2))
        return moving_water(water, self.pipe, nothing, nothing)._replace(dissipative=False)

    def momentum(self, trial: Trial, v: Array) -> Array:
        return np.zeros_like(v)

    def advance(self, trial: Trial) -> None:
        """Keep the wake at the end of an accepted step."""
        law.advance_all(self.wake, self.shed, trial.state.t, *self._motion(trial))


class Vortices(LinePart):
    """Force of the vortices on the pipe, or on its wet share.

    loads: those of `vortices`, or what a surface makes of them.
    """

    name = "vortices"
    traits = Traits("F", symmetric=False, follows=True, keeps_way=True, roles=(Stateful, Starting))

    def __init__(self, pipe: Pipe, loads: StationLoads, vortices: VortexLoads) -> None:
        super().__init__(pipe.line)
        self._loads, self._vortices, self._acting = loads, vortices, Morison(pipe, loads)

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

    def numbers(self) -> VortexNumbers:
        flow, vortices = self._loads.numbers(), self._vortices
        assert isinstance(flow, MovingWaterNumbers)
        self._in_loop = VortexNumbers(flow, vortices.shed, vortices.wake, np.zeros((2, *flow.share.shape)))
        return self._in_loop

    def renew_numbers(self, start: float, end: float) -> None:
        bring(self._in_loop.flow.seen, start, end)
        for phases, t in zip(self._in_loop.phases, (start, end), strict=True):
            phases[:] = law.phases_at(self._in_loop.wake, t)

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
