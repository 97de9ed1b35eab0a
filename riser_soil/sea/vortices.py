"""Vortices shed by the pipe: the parts "vortices", across the flow, and "vortices in line" of stages in space."""

from __future__ import annotations

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.compiled import njit
from riser_soil.core.part import State, Traits
from riser_soil.core.roles import Starting
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.hermite import Size
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import keep
from riser_soil.riser.stations import POINTS
from riser_soil.sea import through_kernels
from riser_soil.sea import vortex_law as law
from riser_soil.sea.morison_law import write_drag, write_drag_derivatives
from riser_soil.sea.moving_water_kernels import FlowWorkspace, MovingWaterData, moving_water
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.stream_kernels import END, FlowAtStations, evaluate_end, update
from riser_soil.sea.through_kernels import resist, write_derivatives, write_resistance


class Push(NamedTuple):
    """Half rho D Cv (ne,) [kg/m2], and phases (2, ne, ng) where a step starts and ends; in line with the flow or
    across.
    """

    lift: Array
    phases: Array
    in_line: bool


class VortexData(NamedTuple):
    """Forces of vortices behind a pipe in space, as kernels read them."""

    flow: MovingWaterData
    law: Push
    shed: law.Shedding
    wake: law.Wake


class Vortices(CompiledPart):
    """Force of the vortices on the pipe (group F), whose wake is kept from step to step; all is external work.

    in_line: whether it acts in line with the flow, or across it. span: where sections may get dry, see `moving_water`.
    """

    traits = Traits("F", symmetric=False, follows=True, path_dependent=True, roles=(Stateful, Starting))

    def __init__(
        self, water: FlowAtStations, shed: law.Shedding, in_line: bool = False, span: Array | None = None
    ) -> None:
        super().__init__(water.pipe.line)
        self.name = "vortices in line" if in_line else "vortices"
        self._water, self._span, self._wake = water, span, _new_wake(water.pipe)
        self._shed, self._in_line = shed, in_line

    def make_kernel_data(self) -> VortexData:
        flow = moving_water(self._water, span=self._span)
        push = Push(self._shed.lift, np.zeros((2, *flow.stream.share.shape)), self._in_line)
        return VortexData(flow, push, self._shed, self._wake)

    def renew_kernel_data(self, start: float, end: float) -> None:
        """Phases are known before a step, when the wake is kept where it starts."""
        update(self._water.stream.water, start, end)
        for phases, t in zip(self._data.law.phases, (start, end), strict=True):
            phases[:] = law.phases_at(self._wake, t)

    @cached_property
    def _shed_at_rest(self) -> Bound:
        return Bound(shed_at_rest, Packed(self._data), Packed(self._trials.now.at))

    def begin_stage(self, state: State) -> None:
        """Shed as behind a pipe at rest, then as behind one in this motion."""
        self._alone.go_to(state)
        self._shed_at_rest()
        self.commit(state)

    def state(self) -> Saved:
        return {name: values.copy() for name, values in self._wake._asdict().items()}

    def restore(self, saved: Saved) -> None:
        for name, values in self._wake._asdict().items():
            values[:] = saved[name]


def _new_wake(pipe: Pipe) -> law.Wake:
    """Phases once around along the line, so that no shape is left out; the rates follow."""
    line, shape = pipe.line, pipe.share.shape
    arc = line.arc[:-1, None] + line.length[:, None] * POINTS
    return law.Wake(np.zeros(1), 2.0 * np.pi * arc / line.arc[-1], np.zeros(shape), np.zeros(shape))


through_kernels.with_kernels(VortexData)


@write_resistance.of(Push)
def _write_resistance(push: Push, side: int, m: int, g: int, at: FlowWorkspace, D: Size) -> None:
    k = push.lift[m] * math.cos(push.phases[side, m, g])
    if push.in_line:
        write_drag(at.through, at.tau, (k, 0.0), at.force, D)
    else:
        law.write_resistance(at.through, at.tau, k, at.force)


@write_derivatives.of(Push)
def _write_derivatives(
    push: Push, m: int, g: int, v: Array, tau: Array, stretch: float, weight: float,
    by_v: Array, by_slope: Array, D: Size,
) -> None:
    k = weight * push.lift[m] * math.cos(push.phases[END, m, g])
    if push.in_line:
        write_drag_derivatives(v, tau, stretch, (k, 0.0), 1.0, by_v, by_slope, D)
    else:
        law.write_derivatives(v, tau, stretch, k, by_v, by_slope)


@njit
def _shed(part: VortexData, at: Configuration, moves: float) -> None:
    """Keep the wake behind a pipe of this share of its motion."""
    flow, wake, t = part.flow, part.wake, part.flow.stream.water.t[END]
    evaluate_end(flow.stream, at.q)
    for m in range(flow.stream.element.size):
        for g in range(flow.stream.share.shape[1]):
            resist(part, at, flow.stream.water.end, END, m, g, flow.workspace)
            workspace, phase = flow.workspace, part.law.phases[END, m, g]
            for i in range(len(at.D)):
                workspace.v[i] *= moves
                workspace.a[i] *= moves
            moved = workspace.through, workspace.v, workspace.a, workspace.tau
            law.advance(wake, part.shed, part.law.in_line, t, phase, m, g, *moved)
    wake.time[0] = t


@njit
def shed_at_rest(part: VortexData, at: Configuration) -> None:
    """Keep the wake behind a pipe at rest."""
    _shed(part, at, 0.0)


@keep.of(VortexData)
def _keep(part: VortexData, at: Configuration) -> None:
    _shed(part, at, 1.0)
