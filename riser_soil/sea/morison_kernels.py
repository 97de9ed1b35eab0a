"""Kernels of Morison's loads at the stations of the pipe, see `part_kernels`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.rows import Vector, add_pulled_back, add_weighed, numbers_at
from riser_soil.riser import stations
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent, add_work
from riser_soil.sea import morison_law as law

PAIR = fixed(2)


class StationRoom(NamedTuple):
    """Room for the force at one station (d,), and for its derivatives (d, d)."""

    f: Array
    by_v: Array
    by_a: Array
    by_slope: Array


def station_room(d: int) -> StationRoom:
    """Room for a line of d dimensions."""
    return StationRoom(np.empty(d), *(np.empty((d, d)) for _ in range(3)))


class StillWaterNumbers(NamedTuple):
    """Stations and their shares (ne, ng) of arc length [m], coefficients of drag and mass (ne, 2) as in `StillWater`,
    and room for one station and one element.
    """

    at: stations.Stations
    share: Array
    drag: Array
    mass: Array
    room: StationRoom
    element: Array


@njit
def _see(part: StillWaterNumbers, at: Configuration, e: int, p: int) -> tuple[Vector, Vector, Vector, float]:
    """Velocity, acceleration and unit tangent at station p of all, in element e; the stretch |x'|."""
    v, a = stations.value_at(part.at.N, p, at.rate, e, at.D), stations.value_at(part.at.N, p, at.acceleration, e, at.D)
    tau, stretch = stations.unit_tangent_at(part.at.dN, p, at.chord, at.tangent, e, at.D)
    return v, a, tau, stretch


@add_forces.of(StillWaterNumbers)
def _still_forces(part: StillWaterNumbers, at: Configuration, out: LineForces) -> None:
    f, ng, weighted = part.room.f, part.at.N.shape[1], part.at.weighted
    for e in range(part.drag.shape[0]):
        drag, mass = numbers_at(part.drag, 2 * e, PAIR), numbers_at(part.mass, 2 * e, PAIR)
        for p in range(e * ng, (e + 1) * ng):
            v, a, tau, _ = _see(part, at, e, p)
            law.put_added(a, tau, mass, f, at.D)
            stations.add_integrand_at(weighted, p, numbers_at(f, 0, at.D), out.inertia_q, e, at.D)
            law.put_drag(v, tau, drag, f, at.D)
            stations.add_integrand_at(weighted, p, numbers_at(f, 0, at.D), out.force_q, e, at.D)


@add_tangent.of(StillWaterNumbers)
def _still_tangent(part: StillWaterNumbers, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
    room, ng = part.room, part.at.N.shape[1]
    for e in range(part.drag.shape[0]):
        drag, mass = numbers_at(part.drag, 2 * e, PAIR), numbers_at(part.mass, 2 * e, PAIR)
        part.element[:] = 0.0
        for g in range(ng):
            v, a, tau, stretch = _see(part, at, e, e * ng + g)
            N, weighted = part.at.N[e, g], part.at.weighted[e, g]
            moved = N, room.by_a, maps.acceleration_rows[e]
            if weights.force == 0.0:  # the mass alone is asked for, at rest
                law.put_added_derivatives(a, tau, stretch, mass, weights.inertia, room.by_a, room.by_slope, at.D)
                add_weighed(part.element, weighted, (moved,), at.D, at.R)
            else:
                law.put_drag_derivatives(v, tau, stretch, drag, weights.force, room.by_v, room.by_slope, at.D)
                law.put_added_derivatives(a, tau, stretch, mass, weights.inertia, room.by_a, room.by_slope, at.D)
                slope = part.at.dN[e, g], room.by_slope, maps.place_rows[e]
                add_weighed(part.element, weighted, (slope, (N, room.by_v, maps.rate_rows[e]), moved), at.D, at.R)
        add_pulled_back(K[e], at.P[e], part.element, at.D, at.R)


@add_energy.of(StillWaterNumbers)
def _still_energy(part: StillWaterNumbers, at: Configuration, energy: Array) -> None:
    f, ng = part.room.f, part.at.N.shape[1]
    for e in range(part.drag.shape[0]):
        mass = numbers_at(part.mass, 2 * e, PAIR)
        for g in range(ng):
            v, _, tau, _ = _see(part, at, e, e * ng + g)
            law.put_added(v, tau, mass, f, at.D)
            for i in range(len(at.D)):
                energy[0] += 0.5 * part.share[e, g] * v[i] * f[i]


@add_work.of(StillWaterNumbers)
def _still_work(part: StillWaterNumbers, first: Configuration, last: Configuration, work: Array) -> None:
    """Drag dissipates; a change of the added mass as it turns is external, see `Morison`."""
    f, ng, D = part.room.f, part.at.N.shape[1], last.D
    before, mean = np.empty(len(D)), np.empty(len(D))
    for e in range(part.drag.shape[0]):
        drag, mass = numbers_at(part.drag, 2 * e, PAIR), numbers_at(part.mass, 2 * e, PAIR)
        for g in range(ng):
            p = e * ng + g
            first_v, _, first_tau, _ = _see(part, first, e, p)
            law.put_drag(first_v, first_tau, drag, before, D)
            v, _, tau, _ = _see(part, last, e, p)
            law.put_drag(v, tau, drag, f, D)
            began, ended = stations.value_at(part.at.N, p, first.q, e, D), stations.value_at(part.at.N, p, last.q, e, D)
            for i in range(len(D)):
                work[0] += 0.5 * part.share[e, g] * (before[i] + f[i]) * (ended[i] - began[i])
                mean[i] = 0.5 * (first_v[i] + v[i])
            law.put_added(mean, first_tau, mass, before, D)
            law.put_added(mean, tau, mass, f, D)
            for i in range(len(D)):
                changed = 0.5 * part.share[e, g] * mean[i] * (f[i] - before[i])
                work[1] += changed
                work[2] += changed
