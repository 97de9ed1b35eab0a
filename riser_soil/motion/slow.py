"""Prescribed motion of an end in a quasi-static stage: places and rotations without rates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

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
