"""The sea of a stage: its surface, and the sum of its current and waves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Protocol

from riser_soil.core.arrays import Array
from riser_soil.sea.flows import SeaNumbers, motion_room, put_at_rest
from riser_soil.sea.water import WaterMotion


class FlowComponent(Protocol):
    """A component of the flow: current or waves."""

    def add(self, t: float, x: Array, motion: WaterMotion) -> None:
        """Add the flow at time t to the motion of points x (n, 3), whose immersion so far is that under calm water."""
        ...

    @property
    def numbers(self) -> tuple[Any, ...]:
        """The flow in numbers, whose type has a kernel of `flows.add_flow`."""
        ...


class Sea:
    """A `Water`: the sum of its flows under a surface whose mean level is z = surface_level [m]; None: no surface.

    Flows don't act on each other: waves run as in still water, and the current isn't stretched with the surface.
    """

    def __init__(self, surface_level: float | None, flows: Sequence[FlowComponent] = ()) -> None:
        self._level, self._flows = math.inf if surface_level is None else surface_level, tuple(flows)

    def __call__(self, t: float, x: Array) -> WaterMotion:
        motion = motion_room(len(x), 3)
        put_at_rest(motion, self._level, x)
        for flow in self._flows:
            flow.add(t, x, motion)
        return motion

    @property
    def numbers(self) -> SeaNumbers:
        """The same for compiled code."""
        return SeaNumbers(self._level, tuple(flow.numbers for flow in self._flows))
