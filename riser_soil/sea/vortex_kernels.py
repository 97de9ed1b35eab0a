"""Kernels of the force of shed vortices, see `part_kernels` and `through_kernels`."""

from __future__ import annotations

import math
from typing import NamedTuple

from riser_soil.core.arrays import Array
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.hermite import Size
from riser_soil.riser.part_kernels import keep
from riser_soil.sea import through_kernels
from riser_soil.sea import vortex_law as law
from riser_soil.sea.moving_water_kernels import MovingWaterNumbers
from riser_soil.sea.stream_kernels import see_end
from riser_soil.sea.through_kernels import END, put_derivatives, put_resistance, resist


class Push(NamedTuple):
    """Half rho D Cv (ne,) [kg/m2], and phases (2, ne, ng) where a step starts and ends."""

    lift: Array
    phases: Array


class VortexNumbers(NamedTuple):
    """Vortices behind a pipe in space, see `ThroughNumbers`."""

    flow: MovingWaterNumbers
    law: Push
    shed: law.Shedding
    wake: law.Wake


through_kernels.with_kernels(VortexNumbers)


@put_resistance.of(Push)
def _put_resistance(push: Push, side: int, m: int, g: int, v: Array, tau: Array, f: Array, D: Size) -> None:
    law.put_resistance(v, tau, push.lift[m] * math.cos(push.phases[side, m, g]), f)


@put_derivatives.of(Push)
def _put_derivatives(
    push: Push,
    m: int,
    g: int,
    v: Array,
    tau: Array,
    stretch: float,
    weight: float,
    by_v: Array,
    by_slope: Array,
    D: Size,
) -> None:
    k = weight * push.lift[m] * math.cos(push.phases[END, m, g])
    law.put_derivatives(v, tau, stretch, k, by_v, by_slope)


@keep.of(VortexNumbers)
def _keep(part: VortexNumbers, at: Configuration) -> None:
    flow, wake, t = part.flow, part.wake, part.flow.seen.t[END]
    see_end(flow.stream, at.q)
    for m in range(flow.element.size):
        for g in range(flow.share.shape[1]):
            resist(part, at, flow.seen.end, END, m, g, flow.room)
            room, phase = flow.room, part.law.phases[END, m, g]
            law.advance(wake, part.shed, t, phase, m, g, room.through, room.v, room.a, room.tau)
    wake.time[0] = t
