"""Kernels of the buoyancy that is lost out of the water, see `part_kernels`."""

from __future__ import annotations

from typing import NamedTuple

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.held import Held
from riser_soil.riser import stations
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent, add_work
from riser_soil.sea import waterline
from riser_soil.sea.stream_kernels import END, START, SeenWater, see
from riser_soil.sea.wet_section import dry_height, wet_share, wet_slope


class DryStationNumbers(NamedTuple):
    """A `DryStations`; element (ne,): of the line, in which its own lie. flat: see `Buoyancy`. Room for one station and
    one element.
    """

    stream: Held
    seen: SeenWater
    element: IntArray
    at: stations.Stations
    share: Array
    span: Array
    displaced: Array
    flat: bool
    f: Array
    by_x: Array
    change: stations.ElementRoom


class DryPipeNumbers(NamedTuple):
    """A `DryPipe`. flat: see `Buoyancy`. Room for one element: its tangent, heights of its q (4,) and of its stations
    (ng,), dry lengths (4,).
    """

    stream: Held
    seen: SeenWater
    points: waterline.FinePoints
    at: stations.Stations
    length: Array
    width: Array
    displaced: Array
    flat: bool
    room: waterline.TangentRoom
    z: Array
    heights: Array
    dry: Array


@njit
def _lost(part: DryStationNumbers, when: int, m: int, g: int) -> float:
    """Force per length on a station, downwards."""
    h = part.seen.motion.immersion[when, m * part.share.shape[1] + g]
    lost: float = part.displaced[m] * (1.0 - wet_share(h, part.span[m, g]))
    return lost


@add_forces.of(DryStationNumbers)
def _station_forces(part: DryStationNumbers, at: Configuration, out: LineForces) -> None:
    see(part.stream, at.q, END)
    for m in range(part.element.size):
        for g in range(part.share.shape[1]):
            part.f[len(at.D) - 1] = _lost(part, END, m, g)
            stations.add_integrand(part.at.weighted[m, g], part.f, out.force_q[part.element[m]], at.D)


@add_tangent.of(DryStationNumbers)
def _station_tangent(part: DryStationNumbers, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
    motion, up = part.seen.motion, len(at.D) - 1
    for m in range(part.element.size):
        e = part.element[m]
        for g in range(part.share.shape[1]):
            p = m * part.share.shape[1] + g
            slope = -weights.force * part.displaced[m] * wet_slope(motion.immersion[END, p], part.span[m, g])
            for j in range(len(at.D)):
                part.by_x[up, j] = slope * motion.immersion_gradient[END, p, j]
            part.change.change[g] = 0.0
            stations.add_position(part.change.change[g], part.at.N[m, g], part.by_x, 1.0, at.P[e], at.D, at.R)
        stations.add_element(K[e], part.change, part.at.weighted[m], at.P[e], at.D, at.R)


@add_energy.of(DryStationNumbers)
def _station_energy(part: DryStationNumbers, at: Configuration, energy: Array) -> None:
    if not part.flat:
        return
    for m in range(part.element.size):
        for g in range(part.share.shape[1]):
            h = part.seen.motion.immersion[END, m * part.share.shape[1] + g]
            energy[2] += part.share[m, g] * part.displaced[m] * dry_height(h, part.span[m, g])


@add_work.of(DryStationNumbers)
def _station_work(part: DryStationNumbers, first: Configuration, last: Configuration, work: Array) -> None:
    if part.flat:
        return
    see(part.stream, first.q, START)
    up = len(last.D) - 1
    for m in range(part.element.size):
        e = part.element[m]
        for g in range(part.share.shape[1]):
            risen = 0.0
            for a in range(4):
                risen += part.at.N[m, g, a] * (last.q[e, a, up] - first.q[e, a, up])
            work[1] -= 0.5 * part.share[m, g] * (_lost(part, START, m, g) + _lost(part, END, m, g)) * risen


@njit
def _element(part: DryPipeNumbers, at: Configuration, when: int, e: int) -> waterline.WetElement:
    """An element, its heights in the room."""
    up, ng = len(at.D) - 1, part.heights.size
    for a in range(4):
        part.z[a] = at.q[e, a, up]
    for g in range(ng):
        part.heights[g] = 0.0
        for a in range(4):
            part.heights[g] += part.at.N[e, g, a] * part.z[a]
    h = part.seen.motion.immersion[when, e * ng : (e + 1) * ng]
    return waterline.WetElement(part.z, h, part.heights, part.length[e], part.width[e])


@add_forces.of(DryPipeNumbers)
def _pipe_forces(part: DryPipeNumbers, at: Configuration, out: LineForces) -> None:
    see(part.stream, at.q, END)
    up = len(at.D) - 1
    for e in range(part.length.size):
        waterline.put_dry_lengths(part.points, _element(part, at, END, e), part.dry)
        for a in range(4):
            out.force_q[e, a, up] += part.displaced[e] * part.dry[a]


@add_tangent.of(DryPipeNumbers)
def _pipe_tangent(part: DryPipeNumbers, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
    ng = part.heights.size
    for e in range(part.length.size):
        weight, N = weights.force * part.displaced[e], part.at.N[e]
        gradient = part.seen.motion.immersion_gradient[END, e * ng : (e + 1) * ng]
        wet = _element(part, at, END, e)
        waterline.add_element_tangent(K[e], part.points, wet, N, gradient, weight, at.P[e], part.room, at.D, at.R)


@add_energy.of(DryPipeNumbers)
def _pipe_energy(part: DryPipeNumbers, at: Configuration, energy: Array) -> None:
    if part.flat:
        for e in range(part.length.size):
            energy[2] += part.displaced[e] * waterline.dry_potential(part.points, _element(part, at, END, e))


@add_work.of(DryPipeNumbers)
def _pipe_work(part: DryPipeNumbers, first: Configuration, last: Configuration, work: Array) -> None:
    if part.flat:
        return
    see(part.stream, first.q, START)
    for e in range(part.length.size):
        _take(part, first, last, START, e, work)
        _take(part, first, last, END, e, work)


@njit
def _take(
    part: DryPipeNumbers, first: Configuration, last: Configuration, when: int, e: int, work: Array
) -> None:
    """Half the work of the force on an element where the step starts or ends."""
    up = len(last.D) - 1
    wet = _element(part, first, when, e) if when == START else _element(part, last, when, e)
    waterline.put_dry_lengths(part.points, wet, part.dry)
    for a in range(4):
        work[1] -= 0.5 * part.displaced[e] * part.dry[a] * (last.q[e, a, up] - first.q[e, a, up])
