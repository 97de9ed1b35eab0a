"""The sea's flows in compiled code: each adds its own to the water's motion, by the type of its numbers."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.bound import Bound
from riser_soil.core.by_type import bound_by_type
from riser_soil.core.compiled import njit
from riser_soil.core.packed import Packed
from riser_soil.sea.water import WaterMotion


class SeaNumbers(NamedTuple):
    """A `Sea`: z of its mean surface [m], inf without one, and the numbers of its flows."""

    level: float
    flows: tuple


@bound_by_type
def add_flow(flow: tuple, motion: WaterMotion, t: Array, x: Array) -> None:
    """Add a flow at time t (1,) to the motion of points x (n, 3)."""


def motion_of(sea: SeaNumbers, motion: WaterMotion, t: Array, x: Array) -> list[Bound]:
    """Kernels that write the water's motion at time t (1,) and points x (n, 3), as these then are."""
    out, when, places = Packed(motion), Packed(t), Packed(x)
    flows = (Bound(add_flow.kernels[type(flow)], Packed(flow), out, when, places) for flow in sea.flows)
    return [Bound(put_at_rest, out, Packed(sea.level), places), *flows]


def motion_room(n: int, d: int) -> WaterMotion:
    """Room for the motion of n points in d dimensions, zero."""
    shapes = (d,), (d,), (d, d), (d, d), (), (d,)
    return WaterMotion(*(np.zeros((n, *shape)) for shape in shapes))


@njit
def put_at_rest(motion: WaterMotion, level: float, x: Array) -> None:
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
def put_in_plane(found: WaterMotion, basis: Array, motion: WaterMotion) -> None:
    """Write the motion (n, 3) as it is seen in a plane, basis (3, 2)."""
    for p in range(found.immersion.size):
        motion.immersion[p] = found.immersion[p]
        _project(found.velocity[p], basis, motion.velocity[p])
        _project(found.acceleration[p], basis, motion.acceleration[p])
        _project(found.immersion_gradient[p], basis, motion.immersion_gradient[p])
        _project_twice(found.velocity_gradient[p], basis, motion.velocity_gradient[p])
        _project_twice(found.acceleration_gradient[p], basis, motion.acceleration_gradient[p])


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
