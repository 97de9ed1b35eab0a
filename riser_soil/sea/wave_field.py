"""Ramped linear wave field in time."""

from __future__ import annotations

from typing import Literal, assert_never

from riser_soil.core.arrays import Array
from riser_soil.core.smooth_step import smooth_step
from riser_soil.sea import waves
from riser_soil.sea.components import Components
from riser_soil.sea.water import WaterMotion

Stretching = Literal["wheeler", "vertical"]


class WaveField:
    """Linear waves that grow smoothly, with surface, velocity and acceleration ramped alike.

    The acceleration is the rate of the ramped velocity, the ramp's own share included. depth [m] may be inf.
    surface_level: z of the mean surface [m]. clock: what the waves' clock, which their phases are counted on, shows
    when the stage begins [s]. ramp [s] is counted from the waves' beginning; since: how long they have acted when the
    stage begins [s], by default what the clock shows.
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
        self._train, self._depth, self._level = waves.train(components, depth), depth, surface_level
        self._stretching, self._ramp, self._clock = stretching, ramp, clock
        self._since = clock if since is None else since

    def add(self, t: float, x: Array, motion: WaterMotion) -> None:
        time = self._clock + t
        r, rate, _ = smooth_step(self._since + t, self._ramp)
        cosine, sine = waves.circular(self._train, time, x)
        eta, slope = (r * part for part in waves.surface(self._train, cosine, sine))
        full = waves.kinematics(self._train, cosine, sine, self._heights(x[:, 2] - self._level, eta, slope))
        motion.velocity[:] += r * full.v
        motion.velocity_gradient[:] += r * full.dv
        motion.acceleration[:] += r * full.a + rate * full.v
        motion.acceleration_gradient[:] += r * full.da + rate * full.dv
        motion.immersion[:] += eta
        motion.immersion_gradient[:, :2] += slope

    def _heights(self, z: Array, eta: Array, slope: Array) -> waves.Heights:
        match self._stretching:
            case "wheeler":
                return waves.wheeler(z, eta, slope, self._depth)
            case "vertical":
                return waves.vertical(z, self._depth)
            case _:
                assert_never(self._stretching)
