"""Steady current profile over height."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.sea.flows import WaterMotion, add_flow


@njit
def at_heights(z: Array, level: Array, velocity: Array) -> tuple[Array, Array]:
    """Horizontal velocity [m/s] and its derivative by z [1/s], each (n, 2), at heights z (n,).

    level (m,) [m] increases; velocity (m, 2) holds there. Linear between the levels, constant beyond them; at a level,
    the derivative is that of the layer above it.
    """
    values, slopes = np.empty((z.size, 2)), np.zeros((z.size, 2))
    for p in range(z.size):
        above = np.searchsorted(level, z[p], side="right")
        below = max(above - 1, 0)
        for i in range(2):
            if 0 < above < level.size:
                slopes[p, i] = (velocity[above, i] - velocity[below, i]) / (level[above] - level[below])
            values[p, i] = velocity[below, i] + slopes[p, i] * (z[p] - level[below])
    return values, slopes


class CurrentData(NamedTuple):
    """A `SteadyCurrent`."""

    level: Array
    velocity: Array
    grows: bool


@dataclass(frozen=True, eq=False)
class SteadyCurrent:
    """A current by height.

    level (m,) [m], increasing; velocity (m, 2) [m/s] towards x and y. grows: with the stage's time, the load factor of
    statics, by which it is multiplied then; that accelerates nothing.
    """

    level: Array
    velocity: Array
    grows: bool = False

    @property
    def kernel_data(self) -> CurrentData:
        return CurrentData(self.level, self.velocity, self.grows)


@add_flow.of(CurrentData)
def _add_current(current: CurrentData, motion: WaterMotion, t: Array, x: Array) -> None:
    values, slopes = at_heights(x[:, 2], current.level, current.velocity)
    factor = t[0] if current.grows else 1.0
    for p in range(x.shape[0]):
        for i in range(2):
            motion.velocity[p, i] += factor * values[p, i]
            motion.velocity_gradient[p, i, 2] += factor * slopes[p, i]
