"""Kernels of Morison's loads in moving or partly covering water, and of those on modules, see `part_kernels`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.part import Weights
from riser_soil.core.rows import add_pulled_back, add_weighed, as_tuple
from riser_soil.riser import stations
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.hermite import Size
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent, add_work, find_water
from riser_soil.sea import morison_law as law
from riser_soil.sea.flows import WaterMotion
from riser_soil.sea.stream_kernels import FlowAtStations, Stream, add_at_station, evaluate_end, evaluate_start
from riser_soil.sea.waterline import wet_share, wet_slope


class FlowWorkspace(NamedTuple):
    """What a kernel evaluates at one station, vectors (d,): the pipe's own velocity v, that through the water, and
    acceleration; tangent; resistance of both groups, wet share counted in, and of one term.
    """

    v: Array
    through: Array
    a: Array
    tau: Array
    inertia: Array
    force: Array
    f: Array


class FlowDerivatives(NamedTuple):
    """Derivatives (d, d) of the force at one station by the pipe's place, slope x', velocity and acceleration, and by
    the water's acceleration.
    """

    by_x: Array
    by_slope: Array
    by_v: Array
    by_a: Array
    by_u: Array


class MovingWaterData(NamedTuple):
    """Resistance of the water per length [N/m], the negative of its force on what moves in it.

    drag, mass: coefficients (ne, 2), normal and tangential, of `morison_law.drag_coefficients` [kg/m2] and
    `morison_law.added_masses` [kg/m]. pushed (ne, 2) [kg/m]: mass on which the water's acceleration acts. partly:
    whether it acts on the wet share alone, of sections of width span (ne, ng) [m]. alike: whether what moves is alike
    in all directions. dissipative: whether all work of the group F is lost, as in still water, and none can be put in.
    """

    stream: Stream
    drag: Array
    mass: Array
    pushed: Array
    span: Array
    partly: bool
    alike: bool
    dissipative: bool
    workspace: FlowWorkspace
    first: FlowWorkspace
    by: FlowDerivatives
    change: Array


def moving_water(
    water: FlowAtStations,
    drag: Array | None = None,
    mass: Array | None = None,
    pushed: Array | None = None,
    span: Array | None = None,
    dissipative: bool = False,
) -> MovingWaterData:
    """Loads of the water around a pipe, without what is not given.

    pushed: as of `morison.pushed_masses`. span: where sections may get dry.
    """
    pipe = water.pipe
    d, n, nothing = pipe.line.dimension, 2 * pipe.line.ndof, np.zeros((len(pipe.share), 2))
    workspace, first = (FlowWorkspace(*(np.zeros(d) for _ in FlowWorkspace._fields)) for _ in range(2))
    return MovingWaterData(
        stream=water.stream,
        drag=nothing if drag is None else drag,
        mass=nothing if mass is None else mass,
        pushed=nothing if pushed is None else pushed,
        span=np.ones_like(pipe.share) if span is None else span,
        partly=span is not None,
        alike=pipe.points_alone,
        dissipative=dissipative,
        workspace=workspace,
        first=first,
        by=FlowDerivatives(*(np.zeros((d, d)) for _ in FlowDerivatives._fields)),
        change=stations.element_workspace(n, fixed(d)),
    )


@njit
def move(part: MovingWaterData, at: Configuration, m: int, g: int, workspace: FlowWorkspace) -> float:
    """Motion and tangent of the pipe at a station; the stretch |x'|."""
    e, p, N = part.stream.element[m], m * part.stream.share.shape[1] + g, part.stream.at.N
    v, a = stations.value_at(N, p, at.rate, e, at.D), stations.value_at(N, p, at.acceleration, e, at.D)
    tau, stretch = stations.unit_tangent_at(part.stream.at.dN, p, at.chord, at.tangent, e, at.D)
    for i in range(len(at.D)):
        workspace.v[i], workspace.a[i], workspace.tau[i] = v[i], a[i], 0.0 if part.alike else tau[i]
    return stretch


@njit
def _resist(part: MovingWaterData, water: WaterMotion, m: int, g: int, workspace: FlowWorkspace, D: Size) -> None:
    """Resistance at a station in motion, as if it were wet."""
    p = m * part.stream.share.shape[1] + g
    for i in range(len(D)):
        workspace.through[i] = workspace.v[i] - water.velocity[p, i]
    law.write_added(workspace.a, workspace.tau, part.mass[m], workspace.inertia, D)
    law.write_drag(workspace.through, workspace.tau, part.drag[m], workspace.force, D)
    law.write_added(water.acceleration[p], workspace.tau, part.pushed[m], workspace.f, D)
    for i in range(len(D)):
        workspace.force[i] -= workspace.f[i]


@njit
def wet(part: MovingWaterData, water: WaterMotion, m: int, g: int) -> float:
    """The wet share of a station."""
    if not part.partly:
        return 1.0
    share: float = wet_share(water.immersion[m * part.stream.share.shape[1] + g], part.span[m, g])
    return share


@njit
def wetting(part: MovingWaterData, water: WaterMotion, m: int, g: int) -> float:
    """The derivative of a station's wet share by its immersion [1/m]."""
    if not part.partly:
        return 0.0
    slope: float = wet_slope(water.immersion[m * part.stream.share.shape[1] + g], part.span[m, g])
    return slope


@find_water.of(MovingWaterData)
def _find_water(part: MovingWaterData, at: Configuration) -> None:
    evaluate_end(part.stream, at.q)


@add_forces.of(MovingWaterData)
def _forces(part: MovingWaterData, at: Configuration, out: LineForces) -> None:
    evaluate_end(part.stream, at.q)
    workspace, water = part.workspace, part.stream.water.end
    for m in range(part.stream.element.size):
        for g in range(part.stream.share.shape[1]):
            move(part, at, m, g, workspace)
            _resist(part, water, m, g, workspace, at.D)
            share = wet(part, water, m, g)
            for i in range(len(at.D)):
                workspace.inertia[i] *= share
                workspace.force[i] *= share
            add_at_station(part.stream, m, g, as_tuple(workspace.inertia, at.D), out.inertia_q)
            add_at_station(part.stream, m, g, as_tuple(workspace.force, at.D), out.force_q)


@add_tangent.of(MovingWaterData)
def _tangent(part: MovingWaterData, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    if weights.force == 0.0:
        _add_mass(part, at, maps, weights.inertia, K)
    else:
        _add_whole_tangent(part, at, maps, weights, K)


@njit
def _add_mass(part: MovingWaterData, at: Configuration, maps: Maps, weight: float, K: Array) -> None:
    """The tangent at rest but for drag and what the water's own motion brings: the mass alone."""
    by, workspace, D = part.by, part.workspace, at.D
    for m in range(part.stream.element.size):
        e = part.stream.element[m]
        part.change[:] = 0.0
        for g in range(part.stream.share.shape[1]):
            stretch = move(part, at, m, g, workspace)
            mass, share = part.mass[m], weight * wet(part, part.stream.water.end, m, g)
            law.write_added_derivatives(workspace.a, workspace.tau, stretch, mass, share, by.by_a, by.by_slope, D)
            moved = part.stream.at.N[m, g], by.by_a, maps.acceleration_rows[e]
            add_weighed(part.change, part.stream.at.weighted[m, g], (moved,), D, at.R)
        add_pulled_back(K[e], at.P[e], part.change, D, at.R)


@njit
def _add_whole_tangent(
    part: MovingWaterData, at: Configuration, maps: Maps, weights: Weights, K: Array
) -> None:
    by = part.by
    for m in range(part.stream.element.size):
        e = part.stream.element[m]
        part.change[:] = 0.0
        for g in range(part.stream.share.shape[1]):
            stretch = move(part, at, m, g, part.workspace)
            _resist(part, part.stream.water.end, m, g, part.workspace, at.D)
            _differentiate(part, part.stream.water.end, m, g, stretch, weights, at.D)
            N, places = part.stream.at.N[m, g], maps.place_rows[e]
            placed = (part.stream.at.dN[m, g], by.by_slope, places), (N, by.by_x, places)
            moved = (N, by.by_v, maps.rate_rows[e]), (N, by.by_a, maps.acceleration_rows[e])
            add_weighed(part.change, part.stream.at.weighted[m, g], (*placed, *moved), at.D, at.R)
        add_pulled_back(K[e], at.P[e], part.change, at.D, at.R)


@njit
def _differentiate(
    part: MovingWaterData, water: WaterMotion, m: int, g: int, stretch: float, weights: Weights, D: Size
) -> None:
    """Write the weighted derivatives of the force at a station whose resistance is known."""
    workspace, by, p = part.workspace, part.by, m * part.stream.share.shape[1] + g
    share, steep = wet(part, water, m, g), wetting(part, water, m, g)
    axis, force = (workspace.tau, stretch), share * weights.force
    law.write_drag_derivatives(workspace.through, *axis, part.drag[m], force, by.by_v, by.by_slope, D)
    law.write_added_derivatives(workspace.a, *axis, part.mass[m], share * weights.inertia, by.by_a, by.by_slope, D)
    law.write_added_derivatives(water.acceleration[p], *axis, part.pushed[m], -force, by.by_u, by.by_slope, D)
    for i in range(len(D)):
        whole = weights.inertia * workspace.inertia[i] + weights.force * workspace.force[i]
        for j in range(len(D)):
            followed = 0.0
            for k in range(len(D)):
                followed += by.by_u[i, k] * water.acceleration_gradient[p, k, j]
                followed -= by.by_v[i, k] * water.velocity_gradient[p, k, j]
            by.by_x[i, j] = steep * whole * water.immersion_gradient[p, j] + followed


@add_energy.of(MovingWaterData)
def _energy(part: MovingWaterData, at: Configuration, energy: Array) -> None:
    """Kinetic energy of the added mass at the pipe's own velocity, wet as when the forces were evaluated last."""
    workspace = part.workspace
    for m in range(part.stream.element.size):
        for g in range(part.stream.share.shape[1]):
            move(part, at, m, g, workspace)
            law.write_added(workspace.v, workspace.tau, part.mass[m], workspace.f, at.D)
            share = part.stream.share[m, g] * wet(part, part.stream.water.end, m, g)
            for i in range(len(at.D)):
                energy[0] += 0.5 * share * workspace.v[i] * workspace.f[i]


@add_work.of(MovingWaterData)
def _work(part: MovingWaterData, first: Configuration, last: Configuration, work: Array) -> None:
    """Write the work of Morison's forces over a step [J]."""
    evaluate_start(part.stream, first.q)
    resisted, changed, water = 0.0, 0.0, part.stream.water
    for m in range(part.stream.element.size):
        for g in range(part.stream.share.shape[1]):
            move(part, first, m, g, part.first)
            _resist(part, water.start, m, g, part.first, last.D)
            move(part, last, m, g, part.workspace)
            _resist(part, water.end, m, g, part.workspace, last.D)
            before, after = wet(part, water.start, m, g), wet(part, water.end, m, g)
            resisted += part.stream.share[m, g] * resisted_at(part, first, last, m, g, before, after)
            changed += part.stream.share[m, g] * _changed(part, m, before, after, last.D)
    if part.dissipative:
        work[0] += resisted
    else:
        work[1] -= resisted
    work[1] += changed
    work[2] += changed


@njit
def resisted_at(
    part: MovingWaterData, first: Configuration, last: Configuration, m: int, g: int, before: float, after: float
) -> float:
    """Work per length against the mean force of a step, at a station."""
    e, p, total = part.stream.element[m], m * part.stream.share.shape[1] + g, 0.0
    began = stations.value_at(part.stream.at.N, p, first.q, e, last.D)
    ended = stations.value_at(part.stream.at.N, p, last.q, e, last.D)
    for i in range(len(last.D)):
        mean = 0.5 * (before * part.first.force[i] + after * part.workspace.force[i])
        total += mean * (ended[i] - began[i])
    return total


@njit
def _changed(part: MovingWaterData, m: int, before: float, after: float, D: Size) -> float:
    """What the change of the added mass at a station does per length to the kinetic energy, see `Morison`."""
    first, workspace, total = part.first, part.workspace, 0.0
    for i in range(len(D)):
        workspace.through[i] = 0.5 * (first.v[i] + workspace.v[i])
    law.write_added(workspace.through, first.tau, part.mass[m], first.f, D)
    law.write_added(workspace.through, workspace.tau, part.mass[m], workspace.f, D)
    for i in range(len(D)):
        total += 0.5 * workspace.through[i] * (after * workspace.f[i] - before * first.f[i])
    return total
