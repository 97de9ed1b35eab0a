"""Buoyancy lost by the riser where it is out of the water: the part "buoyancy"."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.part import Traits, Weights
from riser_soil.core.rows import add_pulled_back, add_weighed, as_tuple
from riser_soil.riser import stations
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent, add_work, find_water
from riser_soil.sea import waterline
from riser_soil.sea.flows import WaterMotion
from riser_soil.sea.stream_kernels import FlowAtStations, Stream, add_at_station, evaluate_end, evaluate_start, update
from riser_soil.sea.waterline import dry_height, wet_share, wet_slope


class DryStationData(NamedTuple):
    """Lost buoyancy by the dry share at the stations of a pipe. span (ne, ng) [m]: widths of the sections; displaced
    (ne,): weight of the displaced water [N/m]; flat: see `Buoyancy`. Workspace for one station and one element.
    """

    stream: Stream
    span: Array
    displaced: Array
    flat: bool
    f: Array
    by_x: Array
    change: Array


class DryPipeData(NamedTuple):
    """Lost buoyancy of the pipe, by its sections at many points of each element; displaced (ne,): weight of the water
    in its place [N/m]. flat: see `Buoyancy`. Workspace for one element: its tangent, heights of its q (4,) and of its
    stations (ng,), dry lengths and those before the step (4,).
    """

    stream: Stream
    points: waterline.FinePoints
    length: Array
    width: Array
    displaced: Array
    flat: bool
    workspace: waterline.TangentWorkspace
    z: Array
    heights: Array
    dry: Array
    before: Array


@find_water.of(DryStationData)
@find_water.of(DryPipeData)
def _find_water(part: DryStationData | DryPipeData, at: Configuration) -> None:
    evaluate_end(part.stream, at.q)


@njit
def _lost(part: DryStationData, water: WaterMotion, m: int, g: int) -> float:
    """Force per length on a station, downwards."""
    h = water.immersion[m * part.stream.share.shape[1] + g]
    lost: float = part.displaced[m] * (1.0 - wet_share(h, part.span[m, g]))
    return lost


@add_forces.of(DryStationData)
def _station_forces(part: DryStationData, at: Configuration, out: LineForces) -> None:
    evaluate_end(part.stream, at.q)
    for m in range(part.stream.element.size):
        for g in range(part.stream.share.shape[1]):
            part.f[len(at.D) - 1] = _lost(part, part.stream.water.end, m, g)
            add_at_station(part.stream, m, g, as_tuple(part.f, at.D), out.force_q)


@add_tangent.of(DryStationData)
def _station_tangent(part: DryStationData, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    water, up = part.stream.water.end, len(at.D) - 1
    for m in range(part.stream.element.size):
        e = part.stream.element[m]
        part.change[:] = 0.0
        for g in range(part.stream.share.shape[1]):
            p = m * part.stream.share.shape[1] + g
            slope = -weights.force * part.displaced[m] * wet_slope(water.immersion[p], part.span[m, g])
            for j in range(len(at.D)):
                part.by_x[up, j] = slope * water.immersion_gradient[p, j]
            sunk = part.stream.at.N[m, g], part.by_x, maps.place_rows[e]
            add_weighed(part.change, part.stream.at.weighted[m, g], (sunk,), at.D, at.R)
        add_pulled_back(K[e], at.P[e], part.change, at.D, at.R)


@add_energy.of(DryStationData)
def _station_energy(part: DryStationData, at: Configuration, energy: Array) -> None:
    if not part.flat:
        return
    for m in range(part.stream.element.size):
        for g in range(part.stream.share.shape[1]):
            h = part.stream.water.end.immersion[m * part.stream.share.shape[1] + g]
            energy[2] += part.stream.share[m, g] * part.displaced[m] * dry_height(h, part.span[m, g])


@add_work.of(DryStationData)
def _station_work(part: DryStationData, first: Configuration, last: Configuration, work: Array) -> None:
    if part.flat:
        return
    evaluate_start(part.stream, first.q)
    up = len(last.D) - 1
    for m in range(part.stream.element.size):
        e = part.stream.element[m]
        for g in range(part.stream.share.shape[1]):
            risen, lost = 0.0, _lost(part, part.stream.water.start, m, g) + _lost(part, part.stream.water.end, m, g)
            for a in range(4):
                risen += part.stream.at.N[m, g, a] * (last.q[e, a, up] - first.q[e, a, up])
            work[1] -= 0.5 * part.stream.share[m, g] * lost * risen


@njit
def _element(part: DryPipeData, at: Configuration, water: WaterMotion, e: int) -> waterline.WetElement:
    """An element, its heights in the workspace."""
    up, ng = len(at.D) - 1, part.heights.size
    for a in range(4):
        part.z[a] = at.q[e, a, up]
    for g in range(ng):
        part.heights[g] = 0.0
        for a in range(4):
            part.heights[g] += part.stream.at.N[e, g, a] * part.z[a]
    h = water.immersion[e * ng : (e + 1) * ng]
    return waterline.WetElement(part.z, h, part.heights, part.length[e], part.width[e])


@add_forces.of(DryPipeData)
def _pipe_forces(part: DryPipeData, at: Configuration, out: LineForces) -> None:
    evaluate_end(part.stream, at.q)
    up = len(at.D) - 1
    for e in range(part.length.size):
        waterline.write_dry_lengths(part.points, _element(part, at, part.stream.water.end, e), part.dry)
        for a in range(4):
            out.force_q[e, a, up] += part.displaced[e] * part.dry[a]


@add_tangent.of(DryPipeData)
def _pipe_tangent(part: DryPipeData, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    ng = part.heights.size
    for e in range(part.length.size):
        weight, N = weights.force * part.displaced[e], part.stream.at.N[e]
        gradient = part.stream.water.end.immersion_gradient[e * ng : (e + 1) * ng]
        wet = _element(part, at, part.stream.water.end, e)
        waterline.add_element_tangent(K[e], part.points, wet, N, gradient, weight, at.P[e], part.workspace, at.D, at.R)


@add_energy.of(DryPipeData)
def _pipe_energy(part: DryPipeData, at: Configuration, energy: Array) -> None:
    if part.flat:
        for e in range(part.length.size):
            wet = _element(part, at, part.stream.water.end, e)
            energy[2] += part.displaced[e] * waterline.dry_potential(part.points, wet)


@add_work.of(DryPipeData)
def _pipe_work(part: DryPipeData, first: Configuration, last: Configuration, work: Array) -> None:
    if part.flat:
        return
    evaluate_start(part.stream, first.q)
    up = len(last.D) - 1
    for e in range(part.length.size):
        waterline.write_dry_lengths(part.points, _element(part, first, part.stream.water.start, e), part.before)
        waterline.write_dry_lengths(part.points, _element(part, last, part.stream.water.end, e), part.dry)
        for a in range(4):
            risen = last.q[e, a, up] - first.q[e, a, up]
            work[1] -= 0.5 * part.displaced[e] * (part.before[a] + part.dry[a]) * risen


Dry = Callable[[FlowAtStations, bool], DryPipeData | DryStationData]
"""Buoyancy lost where a body is dry in water with a surface, the weight of the displaced water times the dry share
1 - S; flat: see `Buoyancy`.
"""


def dry_stations(span: Array, displaced: Array) -> Dry:
    """Buoyancy by the dry share at the stations of a pipe."""

    def data(water: FlowAtStations, flat: bool) -> DryStationData:
        line = water.pipe.line
        d = line.dimension
        return DryStationData(
            stream=water.stream,
            span=span,
            displaced=displaced,
            flat=flat,
            f=np.zeros(d),
            by_x=np.zeros((d, d)),
            change=stations.element_workspace(2 * line.ndof, fixed(d)),
        )

    return data


class Buoyancy(CompiledPart):
    """Lost buoyancy of the dry part of the riser (group F), downwards.

    flat: whether the surface is level and at rest; the force then has a potential, zero when all is submerged. Waves do
    work on it instead.
    """

    name = "buoyancy"

    def __init__(self, water: FlowAtStations, dry: Dry, flat: bool) -> None:
        super().__init__(water.pipe.line)
        self._water, self._dry, self._flat = water, dry, flat
        self.traits = Traits("F", symmetric=flat)

    def make_kernel_data(self) -> DryPipeData | DryStationData:
        return self._dry(self._water, self._flat)

    def renew_kernel_data(self, start: float, end: float) -> None:
        update(self._water.stream.water, start, end)


# Fine points that a section's width holds at least, so that an upright pipe gets wet evenly; an element has no more
# than MOST of them, and the width of its sections follows where its diameter is too small for that.
WITHIN_WIDTH, MOST = 6, 200


def dry_pipe(displaced: Array) -> Dry:
    """Sections of the pipe at many points of each element, under the surface as its stations see it.

    displaced: weight of the water in the pipe's place [N/m] (ne,).
    """

    def data(water: FlowAtStations, flat: bool) -> DryPipeData:
        line, ng = water.pipe.line, water.pipe.share.shape[1]
        L, D = line.length, line.outer_diameter
        apart = 0.5 * np.pi * L  # times n, at most, between neighbours of n Gauss-Legendre points
        n = min(MOST, max(4, math.ceil(WITHIN_WIDTH * float(np.max(apart / np.maximum(D, 1e-9 * apart))))))
        return DryPipeData(
            stream=water.stream,
            points=waterline.fine_points(n),
            length=L,
            width=np.maximum(D, WITHIN_WIDTH * apart / n),
            displaced=displaced,
            flat=flat,
            workspace=waterline.tangent_workspace(ng, 2 * line.ndof, fixed(line.dimension)),
            z=np.zeros(4),
            heights=np.zeros(ng),
            dry=np.zeros(4),
            before=np.zeros(4),
        )

    return data
