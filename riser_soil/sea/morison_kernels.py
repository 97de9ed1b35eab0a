"""Kernels of Morison's loads at the stations of the pipe, see `part_kernels`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser import stations
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent, add_work
from riser_soil.sea import morison_law as law


class StationRoom(NamedTuple):
    """Room for what is found at one station (d,), and for derivatives of the force there (d, d)."""

    v: Array
    a: Array
    tau: Array
    f: Array
    by_v: Array
    by_a: Array
    by_slope: Array


def station_room(d: int) -> StationRoom:
    """Room for a line of d dimensions."""
    return StationRoom(*(np.empty(d) for _ in range(4)), *(np.empty((d, d)) for _ in range(3)))


class StillWaterNumbers(NamedTuple):
    """Stations and their shares (ne, ng) of arc length [m], coefficients of drag and mass (ne, 2) as in `StillWater`,
    and room for one station and one element.
    """

    at: stations.Stations
    share: Array
    drag: Array
    mass: Array
    room: StationRoom
    element: stations.ElementRoom


@njit
def _see(part: StillWaterNumbers, at: Configuration, e: int, g: int) -> float:
    """Velocity, acceleration and unit tangent at a station into the room; the stretch |x'|."""
    stations.put_value(part.at.N[e, g], at.rate[e], part.room.v, at.D)
    stations.put_value(part.at.N[e, g], at.acceleration[e], part.room.a, at.D)
    stretch: float = stations.put_unit_tangent(part.at.dN[e, g], at.chord[e], at.tangent[e], part.room.tau, at.D)
    return stretch


@add_forces.of(StillWaterNumbers)
def _still_forces(part: StillWaterNumbers, at: Configuration, out: LineForces) -> None:
    room = part.room
    for e in range(part.drag.shape[0]):
        for g in range(part.at.N.shape[1]):
            _see(part, at, e, g)
            law.put_added(room.a, room.tau, part.mass[e], room.f, at.D)
            stations.add_integrand(part.at.weighted[e, g], room.f, out.inertia_q[e], at.D)
            law.put_drag(room.v, room.tau, part.drag[e], room.f, at.D)
            stations.add_integrand(part.at.weighted[e, g], room.f, out.force_q[e], at.D)


@add_tangent.of(StillWaterNumbers)
def _still_tangent(part: StillWaterNumbers, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
    room = part.room
    for e in range(part.drag.shape[0]):
        stations.begin_changes(part.element)
        for g in range(part.at.N.shape[1]):
            stretch = _see(part, at, e, g)
            axis = room.tau, stretch
            N, element = part.at.N[e, g], part.element
            if weights.force == 0.0:  # the mass alone is asked for
                room.by_slope[...] = 0.0
            else:
                law.put_drag_derivatives(room.v, *axis, part.drag[e], weights.force, room.by_v, room.by_slope, at.D)
                stations.add_change(element, g, N, room.by_v, maps.rate_rows[e], at.D, at.R)
            law.put_added_derivatives(room.a, *axis, part.mass[e], weights.inertia, room.by_a, room.by_slope, at.D)
            stations.add_change(element, g, part.at.dN[e, g], room.by_slope, maps.place_rows[e], at.D, at.R)
            stations.add_change(element, g, N, room.by_a, maps.acceleration_rows[e], at.D, at.R)
        stations.add_element(K[e], part.element, part.at.weighted[e], at.P[e], at.D, at.R)


@add_energy.of(StillWaterNumbers)
def _still_energy(part: StillWaterNumbers, at: Configuration, energy: Array) -> None:
    room = part.room
    for e in range(part.drag.shape[0]):
        for g in range(part.at.N.shape[1]):
            _see(part, at, e, g)
            law.put_added(room.v, room.tau, part.mass[e], room.f, at.D)
            for i in range(len(at.D)):
                energy[0] += 0.5 * part.share[e, g] * room.v[i] * room.f[i]


@add_work.of(StillWaterNumbers)
def _still_work(part: StillWaterNumbers, first: Configuration, last: Configuration, work: Array) -> None:
    """Drag dissipates; a change of the added mass as it turns is external, see `Morison`."""
    room, D = part.room, last.D
    before, v, first_tau = np.empty(len(D)), np.empty(len(D)), np.empty(len(D))
    for e in range(part.drag.shape[0]):
        for g in range(part.at.N.shape[1]):
            _see(part, first, e, g)
            law.put_drag(room.v, room.tau, part.drag[e], before, D)
            for i in range(len(D)):
                v[i], first_tau[i] = room.v[i], room.tau[i]
            _see(part, last, e, g)
            law.put_drag(room.v, room.tau, part.drag[e], room.f, D)
            for i in range(len(D)):
                moved = 0.0
                for a in range(4):
                    moved += part.at.N[e, g, a] * (last.q[e, a, i] - first.q[e, a, i])
                work[0] += 0.5 * part.share[e, g] * (before[i] + room.f[i]) * moved
                v[i] = 0.5 * (v[i] + room.v[i])
            law.put_added(v, first_tau, part.mass[e], before, D)
            law.put_added(v, room.tau, part.mass[e], room.f, D)
            for i in range(len(D)):
                changed = 0.5 * part.share[e, g] * v[i] * (room.f[i] - before[i])
                work[1] += changed
                work[2] += changed
