"""The water's motion at given points: the sea of a stage as a sum of flows, compiled by the type of their data."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.bound import Bound, Packed, bound, in_turn
from riser_soil.core.by_type import bound_by_type
from riser_soil.core.compiled import njit


class WaterMotion(NamedTuple):
    """The undisturbed water at points (n, 3), global axes.

    velocity [m/s] and acceleration [m/s2]: (n, 3). velocity_gradient [1/s], acceleration_gradient [1/s2]: (n, 3, 3),
    [i, j] being the derivative of component i by x_j; exact derivatives of what is returned.
    immersion: (n,) height of the water's surface above the point [m], negative above the surface; inf where the water
    has no surface. immersion_gradient: (n, 3).
    """

    velocity: Array
    acceleration: Array
    velocity_gradient: Array
    acceleration_gradient: Array
    immersion: Array
    immersion_gradient: Array


Water = Callable[[float, Array], WaterMotion]
"""Seconds since the stage began (load factor in statics), points (n, 3) -> the water's motion there."""


@bound_by_type
def add_flow(flow: tuple, motion: WaterMotion, t: Array, x: Array) -> None:
    """Add a flow at time t (1,) to the motion of points x (n, 3), whose immersion so far is that under calm water."""


def motion_of(sea: Sea, motion: WaterMotion, t: Array, x: Array) -> list[Bound]:
    """Kernels that write the water's motion at time t (1,) and points x (n, 3), as these then are."""
    out, when, places = Packed(motion), Packed(t), Packed(x)
    flows = (bound(add_flow, flow, out, when, places) for flow in sea.flows)
    return [Bound(write_at_rest, out, Packed(sea.level), places), *flows]


def motion_workspace(n: int, d: int) -> WaterMotion:
    """Workspace for the motion of n points in d dimensions, zero."""
    shapes = (d,), (d,), (d, d), (d, d), (), (d,)
    return WaterMotion(*(np.zeros((n, *shape)) for shape in shapes))


@njit
def write_at_rest(motion: WaterMotion, level: float, x: Array) -> None:
    """Write still water at points x (n, 3)."""
    for p in range(x.shape[0]):
        motion.velocity[p] = 0.0
        motion.acceleration[p] = 0.0
        motion.velocity_gradient[p] = 0.0
        motion.acceleration_gradient[p] = 0.0
        motion.immersion[p] = level - x[p, 2]
        motion.immersion_gradient[p] = 0.0
        if level < math.inf:
            motion.immersion_gradient[p, 2] = -1.0


@njit
def write_in_plane(in_space: WaterMotion, basis: Array, motion: WaterMotion) -> None:
    """Write the share of a motion (n, 3) in a plane, basis (3, 2)."""
    for p in range(in_space.immersion.size):
        motion.immersion[p] = in_space.immersion[p]
        _project(in_space.velocity[p], basis, motion.velocity[p])
        _project(in_space.acceleration[p], basis, motion.acceleration[p])
        _project(in_space.immersion_gradient[p], basis, motion.immersion_gradient[p])
        _project_twice(in_space.velocity_gradient[p], basis, motion.velocity_gradient[p])
        _project_twice(in_space.acceleration_gradient[p], basis, motion.acceleration_gradient[p])


@njit
def _project(v: Array, basis: Array, out: Array) -> None:
    for a in range(2):
        out[a] = v[0] * basis[0, a] + v[1] * basis[1, a] + v[2] * basis[2, a]


@njit
def _project_twice(G: Array, basis: Array, out: Array) -> None:
    """basis^T G basis."""
    for a in range(2):
        for b in range(2):
            total = 0.0
            for i in range(3):
                for j in range(3):
                    total += basis[i, a] * G[i, j] * basis[j, b]
            out[a, b] = total


class Sea:
    """A `Water`: the sum of its flows under a surface whose mean level is z = surface_level [m]; None: no surface.

    Flows don't act on each other: waves run as in still water, and the current isn't stretched with the surface.
    """

    def __init__(self, surface_level: float | None, flows: Sequence[tuple[Any, ...]] = ()) -> None:
        """flows: current or waves, each of a type with a kernel of `add_flow`."""
        self.level, self.flows = math.inf if surface_level is None else surface_level, tuple(flows)

    def __call__(self, t: float, x: Array) -> WaterMotion:
        return SeaAtPoints(self, len(x))(t, x)


class SeaAtPoints:
    """A `Water` at n points, its kernels bound once; what it returns is overwritten when it is asked again."""

    def __init__(self, sea: Sea, n: int) -> None:
        self._motion, self._t, self._x = motion_workspace(n, 3), np.zeros(1), np.zeros((n, 3))
        self._find = in_turn(*motion_of(sea, self._motion, self._t, self._x))

    def __call__(self, t: float, x: Array) -> WaterMotion:
        self._t[0], self._x[...] = t, x
        self._find()
        return self._motion
