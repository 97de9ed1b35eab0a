"""The sea of a stage: its surface, and the sum of its current and waves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.sea.water import WaterMotion


class FlowComponent(Protocol):
    """A component of the flow: current or waves."""

    def add(self, t: float, x: Array, motion: WaterMotion) -> None:
        """Add the flow at time t to the motion of points x (n, 3), whose immersion so far is that under calm water."""
        ...


class Sea:
    """A `Water`: the sum of its flows under a surface whose mean level is z = surface_level [m]; None: no surface.

    Flows don't act on each other: waves run as in still water, and the current isn't stretched with the surface.
    """

    def __init__(self, surface_level: float | None, flows: Sequence[FlowComponent] = ()) -> None:
        self._level, self._flows = surface_level, tuple(flows)

    def __call__(self, t: float, x: Array) -> WaterMotion:
        motion = at_rest(x, self._level)
        for flow in self._flows:
            flow.add(t, x, motion)
        return motion


def at_rest(x: Array, surface_level: float | None) -> WaterMotion:
    """Still water at points x (n, 3)."""
    n = len(x)
    motion = WaterMotion(*(np.zeros((n, *shape)) for shape in ((3,), (3,), (3, 3), (3, 3), (), (3,))))
    if surface_level is None:
        motion.immersion[:] = np.inf
    else:
        motion.immersion[:] = surface_level - x[:, 2]
        motion.immersion_gradient[:, 2] = -1.0
    return motion
