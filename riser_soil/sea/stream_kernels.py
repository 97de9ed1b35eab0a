"""The water around a pipe: its motion at the stations, evaluated once a trial."""

from __future__ import annotations

from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.bound import Bound, Calls, Packed, call_each, calls
from riser_soil.core.compiled import fixed, njit
from riser_soil.riser import stations
from riser_soil.riser.hermite import Size
from riser_soil.sea.flows import Sea, WaterMotion, motion_of, motion_workspace, write_in_plane
from riser_soil.sea.pipe import Pipe

START, END = 0, 1
NEAR = 1e-9  # m, within which places where a step starts are those where the last one ended, but for round-off


class WaterInStep(NamedTuple):
    """The water at the n = ne ng stations of a pipe where a step starts and where it ends.

    t, evaluated (2,): times of the step's START and END, and those at which the motion was evaluated, nan at first;
    places (2, n, 3): where it was evaluated; start and end: that motion in the line's axes.
    """

    t: Array
    evaluated: Array
    places: Array
    start: WaterMotion
    end: WaterMotion


class Stream(NamedTuple):
    """The sea that a pipe is in.

    write_start, write_end: kernels of its motion where a step starts and where it ends, at the stations x.
    element (ne,): of the line, in which those of the pipe lie; at, share (ne, ng): its stations, see `Pipe`;
    origin (3,) and basis (3, d) of the line; x (n, 3): stations of a trial.
    """

    write_start: Calls
    write_end: Calls
    water: WaterInStep
    element: IntArray
    at: stations.Stations
    share: Array
    origin: Array
    basis: Array
    x: Array
    D: Size


class FlowAtStations:
    """The sea around a pipe, still water by default: its motion at the stations, shared by all parts that act there."""

    def __init__(self, pipe: Pipe, sea: Sea | None = None) -> None:
        self.pipe, self._sea = pipe, sea or Sea(None)

    @cached_property
    def stream(self) -> Stream:
        """For kernels, which evaluate the motion once for trials that differ in rates alone."""
        return _stream(self.pipe, self._sea)


def _stream(pipe: Pipe, sea: Sea) -> Stream:
    """The sea around a pipe, its motion evaluated nowhere yet."""
    line, n = pipe.line, pipe.share.size
    motions = (motion_workspace(n, line.dimension) for _ in range(2))
    water = WaterInStep(np.full(2, np.nan), np.full(2, np.nan), np.zeros((2, n, 3)), *motions)
    basis, x = np.ascontiguousarray(line.basis), np.zeros((n, 3))
    write_start = calls(*_writing(sea, water.start, water.t[:1], x, basis))
    write_end = calls(*_writing(sea, water.end, water.t[1:], x, basis))
    at = pipe.element, pipe.at, pipe.share, line.origin, basis, x
    return Stream(write_start, write_end, water, *at, fixed(line.dimension))


def _writing(sea: Sea, motion: WaterMotion, t: Array, x: Array, basis: Array) -> list[Bound]:
    """Kernels that write the motion (n, d) in the line's axes, basis (3, d), at time t (1,) and places x (n, 3)."""
    if basis.shape[1] == 3:
        return motion_of(sea, motion, t, x)
    in_space = motion_workspace(len(x), 3)
    return [*motion_of(sea, in_space, t, x), Bound(write_in_plane, *map(Packed, (in_space, basis, motion)))]


def update(water: WaterInStep, start: float, end: float) -> None:
    """Bring the water to the times of a step, which starts where the last one ended, or that which is tried anew."""
    if water.evaluated[END] == start and water.evaluated[START] != start:
        for at_start, at_end in zip(water.start, water.end, strict=True):
            at_start[:] = at_end
        water.places[START], water.evaluated[START] = water.places[END], start
    water.t[:] = start, end


@partial(njit, apart=True)
def evaluate_start(stream: Stream, q: Array) -> None:
    """Evaluate the motion at the start of a step, q (ne, 4, d), unless it is known there."""
    water, t = stream.water, stream.water.t[START]
    _place(stream, q)
    if water.evaluated[START] != t or not _within(stream.x, water.places[START], NEAR):
        call_each(stream.write_start)
        water.evaluated[START] = t
        _copy(stream.x, water.places[START])


@partial(njit, apart=True)
def evaluate_end(stream: Stream, q: Array) -> None:
    """Evaluate the motion of a trial, q (ne, 4, d), unless it is known there, as parts at the same stations ask in
    turn.
    """
    water, t = stream.water, stream.water.t[END]
    _place(stream, q)
    if water.evaluated[END] != t or not _within(stream.x, water.places[END], 0.0):
        call_each(stream.write_end)
        water.evaluated[END] = t
        _copy(stream.x, water.places[END])


@njit
def add_at_station(stream: Stream, m: int, g: int, f: tuple[float, ...], F: Array) -> None:
    """Add to F (ne, 4, d) of the line what the force per length f (d,) at a station of the pipe has in it."""
    p = m * stream.share.shape[1] + g
    stations.add_integrand_at(stream.at.weighted, p, f, F, stream.element[m], stream.D)


@njit
def _place(stream: Stream, q: Array) -> None:
    """Write the stations' places in global axes."""
    for m in range(stream.at.N.shape[0]):
        for g in range(stream.at.N.shape[1]):
            p = m * stream.at.N.shape[1] + g
            inside = stations.value_at(stream.at.N, p, q, stream.element[m], stream.D)
            for i in range(3):
                x = stream.origin[i]
                for a in range(len(stream.D)):
                    x += stream.basis[i, a] * inside[a]
                stream.x[p, i] = x


@njit
def _copy(x: Array, out: Array) -> None:
    for p in range(x.shape[0]):
        for i in range(3):
            out[p, i] = x[p, i]


@njit
def _within(x: Array, y: Array, least: float) -> bool:
    for p in range(x.shape[0]):
        for i in range(3):
            if not abs(x[p, i] - y[p, i]) <= least:
                return False
    return True
