"""Kernels of loads that follow from the velocity through the water, as those of `part_kernels` but for history.

A part of such loads has kernel data of a type of its own, with the fields of `ThroughData`: its law, whose type chooses
the formula, and the pipe in the water.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from riser_soil.core.arrays import Array
from riser_soil.core.by_type import by_type
from riser_soil.core.compiled import njit
from riser_soil.core.part import Weights
from riser_soil.core.rows import add_pulled_back, add_weighed, as_tuple
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.hermite import Size
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent, add_work, find_water
from riser_soil.sea.flows import WaterMotion
from riser_soil.sea.moving_water_kernels import (
    FlowWorkspace,
    MovingWaterData,
    move,
    resisted_at,
    wet,
    wetting,
)
from riser_soil.sea.stream_kernels import END, START, add_at_station, evaluate_end, evaluate_start


class ThroughData(NamedTuple):
    """flow: the pipe in the water, without other loads."""

    flow: MovingWaterData
    law: Any


@by_type
def write_resistance(law: tuple, side: int, m: int, g: int, at: FlowWorkspace, D: Size) -> None:
    """Write the resistance per length, `force`, at station g of element m, where a step starts or ends."""


@by_type
def write_derivatives(
    law: tuple, m: int, g: int, v: Array, tau: Array, stretch: float, weight: float,
    by_v: Array, by_slope: Array, D: Size,
) -> None:
    """Write its weighted derivatives (d, d) by the velocity through the water and the axis' slope, at a step's end."""


@njit
def resist(
    part: ThroughData, at: Configuration, water: WaterMotion, side: int, m: int, g: int, workspace: FlowWorkspace
) -> float:
    """Write motion and resistance at a station, as if it were wet; the stretch |x'|."""
    stretch, p = move(part.flow, at, m, g, workspace), m * part.flow.stream.share.shape[1] + g
    for i in range(len(at.D)):
        workspace.through[i] = workspace.v[i] - water.velocity[p, i]
    write_resistance(part.law, side, m, g, workspace, at.D)
    return stretch


def _find_water(part: ThroughData, at: Configuration) -> None:
    evaluate_end(part.flow.stream, at.q)


def _forces(part: ThroughData, at: Configuration, out: LineForces) -> None:
    flow = part.flow
    evaluate_end(flow.stream, at.q)
    workspace, water = flow.workspace, flow.stream.water.end
    for m in range(flow.stream.element.size):
        for g in range(flow.stream.share.shape[1]):
            resist(part, at, water, END, m, g, workspace)
            share = wet(flow, water, m, g)
            for i in range(len(at.D)):
                workspace.force[i] *= share
            add_at_station(flow.stream, m, g, as_tuple(workspace.force, at.D), out.force_q)


def _tangent(part: ThroughData, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    if weights.force == 0.0:
        return
    flow, by = part.flow, part.flow.by
    for m in range(flow.stream.element.size):
        e = flow.stream.element[m]
        flow.change[:] = 0.0
        for g in range(flow.stream.share.shape[1]):
            stretch = resist(part, at, flow.stream.water.end, END, m, g, flow.workspace)
            _differentiate(part, flow.stream.water.end, m, g, stretch, weights.force, at.D)
            N, places = flow.stream.at.N[m, g], maps.place_rows[e]
            placed = (flow.stream.at.dN[m, g], by.by_slope, places), (N, by.by_x, places)
            moved = (N, by.by_v, maps.rate_rows[e])
            add_weighed(flow.change, flow.stream.at.weighted[m, g], (*placed, moved), at.D, at.R)
        add_pulled_back(K[e], at.P[e], flow.change, at.D, at.R)


@njit
def _differentiate(
    part: ThroughData, water: WaterMotion, m: int, g: int, stretch: float, weight: float, D: Size
) -> None:
    """Write the weighted derivatives of the force at a station whose resistance is known."""
    flow, p, steep = part.flow, m * part.flow.stream.share.shape[1] + g, wetting(part.flow, water, m, g)
    workspace, by = flow.workspace, flow.by
    share = weight * wet(flow, water, m, g)
    write_derivatives(part.law, m, g, workspace.through, workspace.tau, stretch, share, by.by_v, by.by_slope, D)
    for i in range(len(D)):
        for j in range(len(D)):
            followed = weight * steep * workspace.force[i] * water.immersion_gradient[p, j]
            for n in range(len(D)):
                followed -= by.by_v[i, n] * water.velocity_gradient[p, n, j]
            by.by_x[i, j] = followed


def _energy(part: ThroughData, at: Configuration, energy: Array) -> None:
    """None is stored."""


def _work(part: ThroughData, first: Configuration, last: Configuration, work: Array) -> None:
    """Write the work of a force on what moves through the water over a step [J]."""
    flow, water, resisted = part.flow, part.flow.stream.water, 0.0
    evaluate_start(flow.stream, first.q)
    for m in range(flow.stream.element.size):
        for g in range(flow.stream.share.shape[1]):
            resist(part, first, water.start, START, m, g, flow.first)
            resist(part, last, water.end, END, m, g, flow.workspace)
            before, after = wet(flow, water.start, m, g), wet(flow, water.end, m, g)
            resisted += flow.stream.share[m, g] * resisted_at(flow, first, last, m, g, before, after)
    if flow.dissipative:
        work[0] += resisted
    else:
        work[1] -= resisted


def with_kernels(data: type) -> None:
    """Let a type of kernel data have these kernels."""
    stubs = find_water, add_forces, add_tangent, add_energy, add_work
    for stub, kernel in zip(stubs, (_find_water, _forces, _tangent, _energy, _work), strict=True):
        stub.of(data)(kernel)
