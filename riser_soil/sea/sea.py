"""The water of a stage: current and waves, and the surface above them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from riser_soil.arrays import Array
from riser_soil.sea import current, waves
from riser_soil.sea.components import Components
from riser_soil.sea.water import WaterMotion
from riser_soil.smooth_step import smooth_step

Stretching = Literal["wheeler", "vertical"]


class Flow(Protocol):
    """Something that moves the water."""

    def add(self, t: float, x: Array, motion: WaterMotion) -> None:
        """Add the flow at time t to the motion of points x (n, 3), whose immersion so far is that under calm water."""
        ...


class Sea:
    """A `Water`: the sum of its flows under a surface whose mean level is z = surface_level [m]; None: no surface.

    Flows don't act on each other: waves run as in still water, and the current isn't stretched with the surface.
    """

    def __init__(self, surface_level: float | None, flows: Sequence[Flow] = ()) -> None:
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
        velocity, slope = current.at_heights(x[:, 2], self.level, self.velocity)
        motion.velocity[:, :2] += factor * velocity
        motion.velocity_gradient[:, :2, 2] += factor * slope


class Waves:
    """Linear waves that grow smoothly, with surface, velocity and acceleration ramped alike.

    The acceleration is the rate of the ramped velocity, the ramp's own share included. depth [m] may be inf.
    surface_level: z of the mean surface [m]. ramp [s] is counted on the waves' clock, as their phases are; clock: what
    it shows when the stage begins [s].
    """

    def __init__(
        self,
        components: Components,
        depth: float,
        surface_level: float,
        stretching: Stretching = "wheeler",
        ramp: float = 0.0,
        clock: float = 0.0,
    ) -> None:
        self._train, self._depth, self._level = waves.train(components, depth), depth, surface_level
        self._stretching, self._ramp, self._clock = stretching, ramp, clock

    def add(self, t: float, x: Array, motion: WaterMotion) -> None:
        time = self._clock + t
        r, rate, _ = smooth_step(time, self._ramp)
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
        if self._stretching == "wheeler":
            return waves.wheeler(z, eta, slope, self._depth)
        return waves.vertical(z, self._depth)
