"""Loads per length that follow from the velocity through the water, by a law with kernels of `through_kernels`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed
from riser_soil.core.part import Weights
from riser_soil.riser.stations import Derivatives
from riser_soil.riser.trial import Trial
from riser_soil.sea.moving_water import FlowAtStations
from riser_soil.sea.moving_water_kernels import MovingWaterNumbers, moving_water
from riser_soil.sea.stream_kernels import WaterInLoop
from riser_soil.sea.through_kernels import all_derivatives, resistances


class ThroughLoads:
    """Resistance by a law, a `StationLoads`. law: its numbers at a time [s]."""

    def __init__(self, stream: FlowAtStations, law: Callable[[float], tuple[Any, ...]], dissipative: bool) -> None:
        self._stream, self._law, self.dissipative = stream, law, dissipative

    def forces(self, trial: Trial) -> tuple[Array, Array]:
        flow = self._stream.through(trial)
        f: Array = resistances(self._law(trial.state.t), flow.v, flow.tau, fixed(flow.v.shape[2]))
        return np.zeros_like(f), f

    def derivatives(self, trial: Trial, weights: Weights) -> Derivatives:
        flow, law = self._stream.through(trial), self._law(trial.state.t)
        by_v, by_slope = all_derivatives(law, flow.v, flow.tau, flow.stretch, weights.force, fixed(flow.v.shape[2]))
        by_x = -by_v @ self._stream.at(trial).velocity_gradient
        return Derivatives(by_x, by_slope, by_v, np.zeros_like(by_v))

    def numbers(self) -> MovingWaterNumbers:
        return self.seen_in(self._stream.in_loop)

    def seen_in(self, water: WaterInLoop) -> MovingWaterNumbers:
        """The pipe in the water alone, see `ThroughNumbers`."""
        pipe = self._stream.pipe
        nothing = np.zeros((len(pipe.share), 2))
        return moving_water(water, pipe, nothing, nothing)._replace(dissipative=self.dissipative)

    def momentum(self, trial: Trial, v: Array) -> Array:
        return np.zeros_like(v)
