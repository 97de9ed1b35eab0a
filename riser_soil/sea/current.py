"""Steady current profile over height."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.sea.water import WaterMotion


def at_heights(z: Array, level: Array, velocity: Array) -> tuple[Array, Array]:
    """Horizontal velocity [m/s] and its derivative by z [1/s], each (n, 2), at heights z (n,).

    level (m,) [m] increases; velocity (m, 2) holds there. Linear between the levels, constant beyond them; at a level,
    the derivative is that of the layer above it.
    """
    slopes = np.zeros((level.size + 1, 2))
    slopes[1:-1] = np.diff(velocity, axis=0) / np.diff(level)[:, None]
    values = np.stack([np.interp(z, level, u) for u in velocity.T], axis=-1)
    return values, slopes[np.searchsorted(level, z, side="right")]


@dataclass(frozen=True, eq=False)
class SteadyCurrent:
    """A current by height, times a factor of the stage's time; the factor's own rate accelerates nothing.

    level (m,) [m], increasing; velocity (m, 2) [m/s] towards x and y.
    """

    level: Array
    velocity: Array
    factor: Callable[[float], float]

    def add(self, t: float, x: Array, motion: WaterMotion) -> None:
        factor = self.factor(t)
        velocity, slope = at_heights(x[:, 2], self.level, self.velocity)
        motion.velocity[:, :2] += factor * velocity
        motion.velocity_gradient[:, :2, 2] += factor * slope
