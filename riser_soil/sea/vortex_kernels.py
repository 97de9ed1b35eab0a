"""Kernels of the force of shed vortices, see `part_kernels`."""

from __future__ import annotations

import math
from typing import NamedTuple

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.rows import add_pulled_back, add_weighed, held
from riser_soil.riser import stations
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.part_kernels import (
    LineForces,
    LineWeights,
    add_energy,
    add_forces,
    add_tangent,
    add_work,
    find_water,
    keep,
)
from riser_soil.sea import vortex_law as law
from riser_soil.sea.moving_water_kernels import FlowRoom, MovingWaterNumbers, move, resisted_at, wet
from riser_soil.sea.stream_kernels import see_end, see_start
from riser_soil.sea.water import WaterMotion
from riser_soil.sea.wet_section import wet_slope

START, END = 0, 1


class VortexNumbers(NamedTuple):
    """Vortices behind a pipe in space. flow: the pipe in the water, without other loads; phases (2, ne, ng): where a
    step starts and ends.
    """

    flow: MovingWaterNumbers
    shed: law.Shedding
    wake: law.Wake
    phases: Array


@njit
def _resist(
    part: VortexNumbers, at: Configuration, water: WaterMotion, side: int, m: int, g: int, room: FlowRoom
) -> float:
    """Write motion and resistance at a station, as if it were wet; the stretch |x'|."""
    stretch, p = move(part.flow, at, m, g, room), m * part.flow.share.shape[1] + g
    for i in range(3):
        room.through[i] = room.v[i] - water.velocity[p, i]
    k = part.shed.lift[m] * math.cos(part.phases[side, m, g])
    law.put_resistance(room.through, room.tau, k, room.force)
    return stretch


@find_water.of(VortexNumbers)
def _find_water(part: VortexNumbers, at: Configuration) -> None:
    see_end(part.flow.stream, at.q)


@add_forces.of(VortexNumbers)
def _forces(part: VortexNumbers, at: Configuration, out: LineForces) -> None:
    flow = part.flow
    see_end(flow.stream, at.q)
    room, water = flow.room, flow.seen.end
    for m in range(flow.element.size):
        e = flow.element[m]
        for g in range(flow.share.shape[1]):
            _resist(part, at, water, END, m, g, room)
            share = wet(flow, water, m, g)
            for i in range(3):
                room.force[i] *= share
            p = m * flow.share.shape[1] + g
            stations.add_integrand_at(flow.at.weighted, p, held(room.force, at.D), out.force_q, e, at.D)


@add_tangent.of(VortexNumbers)
def _tangent(part: VortexNumbers, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
    if weights.force == 0.0:
        return
    flow, by = part.flow, part.flow.by
    for m in range(flow.element.size):
        e = flow.element[m]
        flow.change[:] = 0.0
        for g in range(flow.share.shape[1]):
            stretch = _resist(part, at, flow.seen.end, END, m, g, flow.room)
            _differentiate(part, flow.seen.end, m, g, stretch, weights.force)
            N, places = flow.at.N[m, g], maps.place_rows[e]
            placed = (flow.at.dN[m, g], by.by_slope, places), (N, by.by_x, places)
            moved = (N, by.by_v, maps.rate_rows[e])
            add_weighed(flow.change, flow.at.weighted[m, g], (*placed, moved), at.D, at.R)
        add_pulled_back(K[e], at.P[e], flow.change, at.D, at.R)


@njit
def _differentiate(part: VortexNumbers, water: WaterMotion, m: int, g: int, stretch: float, weight: float) -> None:
    """Write the weighted derivatives of the force at a station whose resistance is known."""
    flow, p, steep = part.flow, m * part.flow.share.shape[1] + g, 0.0
    room, by = flow.room, flow.by
    if flow.partly:
        steep = wet_slope(water.immersion[p], flow.span[m, g])
    k = weight * wet(flow, water, m, g) * part.shed.lift[m] * math.cos(part.phases[END, m, g])
    law.put_derivatives(room.through, room.tau, stretch, k, by.by_v, by.by_slope)
    for i in range(3):
        for j in range(3):
            followed = weight * steep * room.force[i] * water.immersion_gradient[p, j]
            for n in range(3):
                followed -= by.by_v[i, n] * water.velocity_gradient[p, n, j]
            by.by_x[i, j] = followed


@add_energy.of(VortexNumbers)
def _energy(part: VortexNumbers, at: Configuration, energy: Array) -> None:
    """None is stored."""


@add_work.of(VortexNumbers)
def _work(part: VortexNumbers, first: Configuration, last: Configuration, work: Array) -> None:
    """All is external."""
    flow, seen = part.flow, part.flow.seen
    see_start(flow.stream, first.q)
    for m in range(flow.element.size):
        for g in range(flow.share.shape[1]):
            _resist(part, first, seen.start, START, m, g, flow.first)
            _resist(part, last, seen.end, END, m, g, flow.room)
            before, after = wet(flow, seen.start, m, g), wet(flow, seen.end, m, g)
            work[1] -= flow.share[m, g] * resisted_at(flow, first, last, m, g, before, after)


@keep.of(VortexNumbers)
def _keep(part: VortexNumbers, at: Configuration) -> None:
    flow, wake, t = part.flow, part.wake, part.flow.seen.t[END]
    see_end(flow.stream, at.q)
    for m in range(flow.element.size):
        for g in range(flow.share.shape[1]):
            _resist(part, at, flow.seen.end, END, m, g, flow.room)
            room, phase = flow.room, part.phases[END, m, g]
            law.advance(wake, part.shed, t, phase, m, g, room.through, room.v, room.a, room.tau)
    wake.time[0] = t
