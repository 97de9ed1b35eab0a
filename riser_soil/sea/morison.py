"""Morison's loads in water that may move and need not cover all: drag, Froude-Krylov force, added mass; part "morison".

The pipe's velocity v and acceleration a meet those of the undisturbed water at its axis, u and u'. With the cross-
section A = pi D^2/4 and the added mass m of `morison_law`,

    force = drag of (v - u) - m a + m u' + rho A u'.

The last term, that of Froude and Krylov, is what the pressure of the undisturbed water does to a piece of the pipe of
length ds closed at both ends: minus its gradient rho u' times the volume A ds, in all directions. A piece within the
line is open; the dynamic pressure on its ends is part of the effective tension, as the static one is (Sparks, Journal
of Energy Resources Technology 106, 1984, on closed pressure fields; DNV-RP-C205, 6.2, for the whole formula). All terms
with u' are known from where the pipe is; as external forces they belong to group F, so that the time scheme stays of
second order, while m a is inertia.
Where a surface leaves some of the pipe dry, all act on its wet share S alone. The added mass is what is wet at the
time, at rest as it gets wet: force = S m (u' - a), without a term for entry into the water (slamming).
Source: Morison et al., Petroleum Transactions 189 (1950), in its relative form.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.part import Traits, Weights
from riser_soil.core.rows import Term, add_pulled_back, as_tuple, times, write_weighed
from riser_soil.riser import stations
from riser_soil.riser.bound_parts import KernelData
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.hermite import Size
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent, add_work
from riser_soil.sea import morison_law as law
from riser_soil.sea.moving_water_kernels import moving_water
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.stream_kernels import FlowAtStations, update

PAIR = fixed(2)
NG = len(stations.THREE_POINTS.points)
ELEMENTS = 8  # at once, so that numbers of their stations fill whole vectors
BATCH = ELEMENTS * NG  # stations at once


def pushed_masses(mass: Array, displaced: Array) -> Array:
    """m and rho A (ne, 2) of an added mass (ne, 2) and the mass of the displaced water (ne,) [kg/m], which is the same
    across and along the pipe.
    """
    return np.asarray(mass + displaced[:, None])


class StationWorkspace(NamedTuple):
    """Workspace for the derivatives (NG, d, d) of the force at the stations of an element."""

    by_v: Array
    by_a: Array
    by_slope: Array


def station_workspace(d: int) -> StationWorkspace:
    """Workspace for a line of d dimensions."""
    return StationWorkspace(*(np.empty((NG, d, d)) for _ in StationWorkspace._fields))


class StillWaterData(NamedTuple):
    """Loads of still water on a pipe that it covers. drag, mass: as in `MovingWaterData`.

    at: stations, and their shares (ne, NG) of arc length [m]. Workspace: for the stations of one element, NG, and for
    it.
    """

    at: stations.Stations
    share: Array
    drag: Array
    mass: Array
    workspace: StationWorkspace
    element: Array


def still_water(pipe: Pipe, drag: Array, mass: Array) -> StillWaterData:
    """Drag and added mass along a pipe in water that stands still, and covers all."""
    d, n = pipe.line.dimension, 2 * pipe.line.ndof
    return StillWaterData(
        pipe.at, pipe.share, drag, mass, station_workspace(d), stations.element_workspace(n, fixed(d))
    )


class Batch(NamedTuple):
    """What the water's resistance depends on at LANES stations, a column each: velocity, acceleration and unit tangent
    (d, LANES), the stretch |x'| (LANES,), and coefficients of drag and mass (2, LANES).
    """

    v: Array
    a: Array
    tau: Array
    stretch: Array
    drag: Array
    mass: Array


class StepBatch(NamedTuple):
    """Velocities and what else resistance depends on at LANES stations, where a step starts and where it ends; places
    there (d, LANES).
    """

    first: Batch
    last: Batch
    began: Array
    ended: Array


@njit
def _batch(rows: Array, D: Size) -> Batch:
    """The first 3 d + 5 rows of a workspace. It is to be allocated where loops over its batch are: the compiler then
    knows its size, and that what they write lies apart from what they read, as it must to do them on vectors.
    """
    d = len(D)
    after = 3 * d + 1
    coefficients = rows[after : after + 2], rows[after + 2 : after + 4]
    return Batch(rows[:d], rows[d : 2 * d], rows[2 * d : 3 * d], rows[3 * d], *coefficients)


@njit
def _read_stations(part: StillWaterData, at: Configuration, first: int, after: int, batch: Batch) -> None:
    """Write what the resistance depends on at the stations of elements first to after, but for accelerations."""
    D = at.D
    for e in range(first, after):
        for g in range(NG):
            k, p = (e - first) * NG + g, e * NG + g
            v = stations.value_at(part.at.N, p, at.rate, e, D)
            tau, batch.stretch[k] = stations.unit_tangent_at(part.at.dN, p, at.chord, at.tangent, e, D)
            for i in range(len(D)):
                batch.v[i, k], batch.tau[i, k] = v[i], tau[i]
            for i in range(2):
                batch.drag[i, k], batch.mass[i, k] = part.drag[e, i], part.mass[e, i]


@njit
def _read_values(part: StillWaterData, q: Array, first: int, after: int, out: Array, D: Size) -> None:
    """Write the values of q, q' or q'' (ne, 4, d) at those stations to columns of out (d, LANES)."""
    for e in range(first, after):
        for g in range(NG):
            value = stations.value_at(part.at.N, e * NG + g, q, e, D)
            for i in range(len(D)):
                out[i, (e - first) * NG + g] = value[i]


@add_forces.of(StillWaterData)
def _still_forces(part: StillWaterData, at: Configuration, out: LineForces) -> None:
    ne, D, weighted = part.drag.shape[0], at.D, part.at.weighted
    d = len(D)
    batch, inertia, force = _batch(np.zeros((3 * d + 5, BATCH)), D), np.zeros((d, BATCH)), np.zeros((d, BATCH))
    for first in range(0, ne, ELEMENTS):
        after = min(first + ELEMENTS, ne)
        _read_stations(part, at, first, after, batch)
        _read_values(part, at.acceleration, first, after, batch.a, D)
        for k in range(BATCH):
            _write_forces(batch, inertia, force, k, D)
        for e in range(first, after):
            for g in range(NG):
                k, p = (e - first) * NG + g, e * NG + g
                stations.add_integrand_at(weighted, p, as_tuple(inertia[:, k], D), out.inertia_q, e, D)
                stations.add_integrand_at(weighted, p, as_tuple(force[:, k], D), out.force_q, e, D)


@njit
def _write_forces(batch: Batch, inertia: Array, force: Array, k: int, D: Size) -> None:
    """Write the resistance at one station, by groups."""
    tau = as_tuple(batch.tau[:, k], D)
    law.write_added(as_tuple(batch.a[:, k], D), tau, as_tuple(batch.mass[:, k], PAIR), inertia[:, k], D)
    law.write_drag(as_tuple(batch.v[:, k], D), tau, as_tuple(batch.drag[:, k], PAIR), force[:, k], D)


@add_tangent.of(StillWaterData)
def _still_tangent(part: StillWaterData, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    if weights.force == 0.0:
        _add_mass(part, at, maps, weights.inertia, K)
    else:
        _add_whole_tangent(part, at, maps, weights, K)


@njit
def _add_mass(part: StillWaterData, at: Configuration, maps: Maps, weight: float, K: Array) -> None:
    """The tangent at rest but for drag: the mass alone."""
    D, workspace, N, moved = at.D, part.workspace, part.at.N, maps.acceleration_rows
    for e in range(part.mass.shape[0]):
        for g in range(NG):
            tau, stretch = stations.unit_tangent_at(part.at.dN, e * NG + g, at.chord, at.tangent, e, D)
            at_rest = times(0.0, tau)
            law.write_added_derivatives(
                at_rest, tau, stretch, part.mass[e], weight, workspace.by_a[g], workspace.by_slope[g], D
            )
        weighted, by = part.at.weighted[e], workspace.by_a
        first = weighted[0], ((N[e, 0], by[0], moved[e]),)
        second = weighted[1], ((N[e, 1], by[1], moved[e]),)
        third = weighted[2], ((N[e, 2], by[2], moved[e]),)
        write_weighed(part.element, (first, second, third), D, at.R)
        add_pulled_back(K[e], at.P[e], part.element, D, at.R)


@njit
def _add_whole_tangent(
    part: StillWaterData, at: Configuration, maps: Maps, weights: Weights, K: Array
) -> None:
    ne, D, d, workspace = part.drag.shape[0], at.D, len(at.D), part.workspace
    # Ones: what is computed where a batch has no station is not read, but divides by a stretch.
    batch, by = _batch(np.ones((3 * d + 5, BATCH)), D), np.zeros((3, d, d, BATCH))
    for first in range(0, ne, ELEMENTS):
        after = min(first + ELEMENTS, ne)
        _read_stations(part, at, first, after, batch)
        _read_values(part, at.acceleration, first, after, batch.a, D)
        for k in range(BATCH):
            _write_derivatives(batch, by, k, weights, D)
        for e in range(first, after):
            for g in range(NG):
                _copy_derivatives(by, (e - first) * NG + g, g, workspace, D)
            each = _terms(part, maps, e, 0), _terms(part, maps, e, 1), _terms(part, maps, e, 2)
            write_weighed(part.element, each, D, at.R)
            add_pulled_back(K[e], at.P[e], part.element, D, at.R)


@njit
def _terms(part: StillWaterData, maps: Maps, e: int, g: int) -> tuple[Array, tuple[Term, Term, Term]]:
    """Weights (4,) of a station and the terms of its force's derivative, as of `add_weighed`."""
    N, workspace = part.at.N[e, g], part.workspace
    slope = part.at.dN[e, g], workspace.by_slope[g], maps.place_rows[e]
    moved = (N, workspace.by_v[g], maps.rate_rows[e]), (N, workspace.by_a[g], maps.acceleration_rows[e])
    return part.at.weighted[e, g], (slope, *moved)


@njit
def _write_derivatives(batch: Batch, by: Array, k: int, weights: Weights, D: Size) -> None:
    """Write the weighted derivatives by velocity, acceleration and slope at one station."""
    tau, stretch, by_slope = as_tuple(batch.tau[:, k], D), batch.stretch[k], by[2, :, :, k]
    v, drag = as_tuple(batch.v[:, k], D), as_tuple(batch.drag[:, k], PAIR)
    law.write_drag_derivatives(v, tau, stretch, drag, weights.force, by[0, :, :, k], by_slope, D)
    a, mass = as_tuple(batch.a[:, k], D), as_tuple(batch.mass[:, k], PAIR)
    law.write_added_derivatives(a, tau, stretch, mass, weights.inertia, by[1, :, :, k], by_slope, D)


@njit
def _copy_derivatives(by: Array, k: int, g: int, workspace: StationWorkspace, D: Size) -> None:
    """Copy the derivatives at one station of many."""
    for i in range(len(D)):
        for j in range(len(D)):
            of_v, of_a, of_slope = by[0, i, j, k], by[1, i, j, k], by[2, i, j, k]
            workspace.by_v[g, i, j], workspace.by_a[g, i, j], workspace.by_slope[g, i, j] = of_v, of_a, of_slope


@add_energy.of(StillWaterData)
def _still_energy(part: StillWaterData, at: Configuration, energy: Array) -> None:
    f, D = np.empty(len(at.D)), at.D
    for e in range(part.mass.shape[0]):
        for g in range(NG):
            p = e * NG + g
            v = stations.value_at(part.at.N, p, at.rate, e, D)
            tau, _ = stations.unit_tangent_at(part.at.dN, p, at.chord, at.tangent, e, D)
            law.write_added(v, tau, part.mass[e], f, D)
            for i in range(len(D)):
                energy[0] += 0.5 * part.share[e, g] * v[i] * f[i]


@add_work.of(StillWaterData)
def _still_work(part: StillWaterData, first: Configuration, last: Configuration, work: Array) -> None:
    """Drag dissipates; a change of the added mass as it turns is external, see `Morison`."""
    ne, D = part.drag.shape[0], last.D
    d = len(D)
    rows, workspace, done = np.zeros((8 * d + 10, BATCH)), np.zeros((3, d, BATCH)), np.zeros((2, BATCH))
    batch = StepBatch(_batch(rows, D), _batch(rows[3 * d + 5 :], D), rows[6 * d + 10 : 7 * d + 10], rows[7 * d + 10 :])
    for start in range(0, ne, ELEMENTS):
        after = min(start + ELEMENTS, ne)
        _read_stations(part, first, start, after, batch.first)
        _read_stations(part, last, start, after, batch.last)
        _read_values(part, first.q, start, after, batch.began, D)
        _read_values(part, last.q, start, after, batch.ended, D)
        for k in range(BATCH):
            _write_work(batch, workspace, done, k, D)
        for e in range(start, after):
            for g in range(NG):
                k, share = (e - start) * NG + g, part.share[e, g]
                work[0] += share * done[0, k]
                work[1] += share * done[1, k]
                work[2] += share * done[1, k]


@njit
def _write_work(batch: StepBatch, workspace: Array, done: Array, k: int, D: Size) -> None:
    """Write the work per length of the mean drag at one station, and half the change of the added mass along the mean
    velocity.
    """
    before, after, mean, lost, changed = workspace[0, :, k], workspace[1, :, k], workspace[2, :, k], 0.0, 0.0
    drag, mass = as_tuple(batch.last.drag[:, k], PAIR), as_tuple(batch.last.mass[:, k], PAIR)
    tau, turned = as_tuple(batch.first.tau[:, k], D), as_tuple(batch.last.tau[:, k], D)
    law.write_drag(as_tuple(batch.first.v[:, k], D), tau, drag, before, D)
    law.write_drag(as_tuple(batch.last.v[:, k], D), turned, drag, after, D)
    for i in range(len(D)):
        lost += 0.5 * (before[i] + after[i]) * (batch.ended[i, k] - batch.began[i, k])
        mean[i] = 0.5 * (batch.first.v[i, k] + batch.last.v[i, k])
    law.write_added(mean, tau, mass, before, D)
    law.write_added(mean, turned, mass, after, D)
    for i in range(len(D)):
        changed += 0.5 * mean[i] * (after[i] - before[i])
    done[0, k], done[1, k] = lost, changed


class Morison(CompiledPart):
    """Loads of the water at the pipe's stations, brought to the line: group I is the added mass, F all the rest.

    make: makes the loads' kernel data, once kernels need them. water: around the pipe, where it moves or has a surface.

    Drag of still water dissipates; all that moving water does is external work, of either sign. So a riser at rest in a
    current neither gains nor loses energy, whatever supports it. External, too, is the change of kinetic energy by a
    change dm of the added mass, as it turns or gets wet, beyond the work of its force. That force is m a, so the
    remainder is 1/2 v.dm v per length. Written in rates alone it does not depend on the accelerations, which are of
    first order only in generalised-alpha.
    """

    name = "morison"
    traits = Traits("IF", symmetric=False, follows=True)

    def __init__(self, line: Line, make: Callable[[], KernelData], water: FlowAtStations | None = None) -> None:
        super().__init__(line)
        self._make, self._water = make, water

    def make_kernel_data(self) -> KernelData:
        return self._make()

    def renew_kernel_data(self, start: float, end: float) -> None:
        if self._water is not None:
            update(self._water.stream.water, start, end)


def in_still_water(pipe: Pipe, drag: Array, mass: Array) -> Morison:
    """Loads on a pipe that still water covers; arguments as in `StillWaterData`."""
    return Morison(pipe.line, lambda: still_water(pipe, drag, mass))


def in_sea(
    water: FlowAtStations,
    drag: Array,
    mass: Array,
    pushed: Array | None = None,
    span: Array | None = None,
    dissipative: bool = False,
) -> Morison:
    """Loads in water that may move, or have a surface; arguments as in `moving_water`."""
    return Morison(water.pipe.line, lambda: moving_water(water, drag, mass, pushed, span, dissipative), water)
