"""Morison loads in still water, per length: drag and added mass."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed
from riser_soil.core.part import Weights
from riser_soil.riser.stations import Derivatives, element_room
from riser_soil.riser.trial import Trial
from riser_soil.sea import morison_law as law
from riser_soil.sea.morison_kernels import StillWaterNumbers, station_room
from riser_soil.sea.moving_water_kernels import MovingWaterNumbers, moving_water
from riser_soil.sea.pipe import Pipe, StationFlow
from riser_soil.sea.sea import Sea
from riser_soil.sea.stream_kernels import WaterInLoop, water_in_loop


class StationLoads(Protocol):
    """Resistance of the water per length [N/m], the negative of its force on the pipe, in the line's axes.

    dissipative: whether all work of the group F is lost, and none can be put in.
    """

    dissipative: bool

    def forces(self, trial: Trial) -> tuple[Array, Array]:
        """Groups I and F, each (ne, ng, d)."""
        ...

    def derivatives(self, trial: Trial, weights: Weights) -> Derivatives:
        """Derivatives of both groups, weighted and summed."""
        ...

    def numbers(self) -> tuple[Any, ...]:
        """The loads in numbers, see `LinePart.numbers`."""
        ...

    def seen_in(self, water: WaterInLoop) -> MovingWaterNumbers:
        """The loads in numbers, in water that need not stand still nor cover all."""
        ...

    def momentum(self, trial: Trial, v: Array) -> Array:
        """Momentum per length (ne, ng, d) [kg/s] that the added mass would have at the velocities v (ne, ng, d)."""
        ...


class StillWater:
    """Drag (group F) and added mass (group I), by which any motion through the water is resisted. A `StationLoads`.

    drag, mass: coefficients (ne, 2), normal and tangential, of `morison_law.drag_coefficients` [kg/m2] and
    `morison_law.added_masses` [kg/m].
    """

    dissipative = True

    def __init__(self, pipe: Pipe, drag: Array, mass: Array) -> None:
        self.pipe, self._drag, self.mass = pipe, drag, mass

    def forces(self, trial: Trial) -> tuple[Array, Array]:
        return self.resist(self.pipe.flow(trial))

    def derivatives(self, trial: Trial, weights: Weights) -> Derivatives:
        return self.linearise(self.pipe.flow(trial), weights)

    def numbers(self) -> StillWaterNumbers | MovingWaterNumbers:
        """Those of a pipe where it is one all along."""
        if self.pipe.points_alone:
            return self.seen_in(water_in_loop(self.pipe, Sea(None).numbers))
        d, n = self.pipe.line.dimension, 2 * self.pipe.line.ndof
        room = station_room(d), element_room(n, fixed(d))
        return StillWaterNumbers(self.pipe.at, self.pipe.share, self._drag, self.mass, *room)

    def seen_in(self, water: WaterInLoop) -> MovingWaterNumbers:
        return moving_water(water, self.pipe, self._drag, self.mass)

    def momentum(self, trial: Trial, v: Array) -> Array:
        return law.added(v, self.pipe.flow(trial).tau, self.mass)

    def resist(self, flow: StationFlow) -> tuple[Array, Array]:
        """Groups I and F, each (ne, ng, d), of a motion through the water."""
        return law.resistance(flow.v, flow.a, flow.tau, self._drag, self.mass)

    def linearise(self, flow: StationFlow, weights: Weights) -> Derivatives:
        """Derivatives of `resist` by that motion, weighed and summed."""
        drag, mass = weights.force * self._drag, weights.inertia * self.mass
        by_v, by_a, by_slope = law.resistance_derivatives(flow.v, flow.a, flow.tau, flow.stretch, drag, mass)
        return Derivatives(np.zeros_like(by_v), by_slope, by_v, by_a)
