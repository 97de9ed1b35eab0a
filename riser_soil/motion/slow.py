"""Prescribed motion of an end in static stages, by the load factor, and in quasi-static ones, without rates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser.ends import Kinematics, Motion, SupportRotation


@dataclass(frozen=True, eq=False)
class SlowMotion:
    """The places of a motion."""

    motion: Motion

    def __call__(self, t: float) -> Kinematics:
        """Position [m] at t; nothing has a velocity."""
        return self.motion(t)[0], np.zeros(3), np.zeros(3)


@dataclass(frozen=True, eq=False)
class SlowTurning:
    """The rotations of a support."""

    turning: Callable[[float], SupportRotation]

    def __call__(self, t: float) -> SupportRotation:
        """Turning at t; nothing has an angular velocity."""
        return SupportRotation(self.turning(t).rotation, np.zeros(3), np.zeros(3))


@dataclass(frozen=True, eq=False)
class SmoothMove:
    """Straight from `origin` to `target` (3,) [m] as the load factor grows from 0 to 1."""

    origin: Array
    target: Array

    def __call__(self, t: float) -> tuple[Array, Array, Array]:
        """Position [m] at the load factor t; there are no rates in statics."""
        return self.origin + t * (self.target - self.origin), np.zeros(3), np.zeros(3)
