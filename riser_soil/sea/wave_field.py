"""Ramped linear wave field in time."""

from __future__ import annotations

from typing import Literal

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.sea import waves
from riser_soil.sea.components import Components
from riser_soil.sea.water import WaterMotion

Stretching = Literal["wheeler", "vertical"]


class WaveField:
    """Linear waves that grow smoothly, with surface, velocity and acceleration ramped alike.

    The acceleration is the rate of the ramped velocity, the ramp's own share included. depth [m] may be inf.
    surface_level: z of the mean surface [m]. clock: what the waves' clock, which their phases are counted on, shows
    when the stage begins [s]. ramp [s] is counted from the waves' beginning; since: how long they have acted when the
    stage begins [s], by default what the clock shows. numbers: the same for compiled code.
    """

    def __init__(
        self,
        components: Components,
        depth: float,
        surface_level: float,
        stretching: Stretching = "wheeler",
        ramp: float = 0.0,
        clock: float = 0.0,
        since: float | None = None,
    ) -> None:
        times = ramp, clock, clock if since is None else since
        self.numbers = waves.waves(components, depth, surface_level, stretching == "wheeler", *times)

    def add(self, t: float, x: Array, motion: WaterMotion) -> None:
        waves.add_to(motion, self.numbers, t, np.ascontiguousarray(x))
