"""Submerged share of the pipe at its stations, and loads on that share alone."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Weights
from riser_soil.riser.stations import Derivatives
from riser_soil.riser.trial import Trial
from riser_soil.sea import wet_section
from riser_soil.sea.moving_water_kernels import MovingWaterNumbers
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.sea import Sea
from riser_soil.sea.still_water import StationLoads
from riser_soil.sea.stream_kernels import WaterInLoop, water_in_loop


class WaterSurface(Protocol):
    """The water's surface above the stations of a pipe."""

    @property
    def in_loop(self) -> WaterInLoop:
        """The same in the compiled loop over a riser alone."""
        ...

    def immersion(self, trial: Trial) -> tuple[Array, Array]:
        """Height of the surface above the stations (ne, ng) [m] and its gradient (ne, ng, d)."""
        ...


class CalmSurface:
    """Calm water at the height `level` [m]. A `WaterSurface`."""

    def __init__(self, pipe: Pipe, level: float) -> None:
        self._pipe, self._level = pipe, level

    @cached_property
    def in_loop(self) -> WaterInLoop:
        return water_in_loop(self._pipe, Sea(self._level).numbers)

    def immersion(self, trial: Trial) -> tuple[Array, Array]:
        x = self._pipe.position(trial)
        gradient = np.zeros_like(x)
        gradient[..., -1] = -1.0
        return self._level - x[..., -1], gradient


class WetShare(NamedTuple):
    """Wet share (ne, ng) and its gradient by position (ne, ng, d) [1/m]."""

    share: Array
    gradient: Array


class Wetting:
    """The wet share of the pipe's stations under a surface, each like a lying section (`wet_section`).

    span: the section's width b (ne, 1) [m]; by default the pipe's diameter, but no less than the arc length that the
    station stands for, along which an upright pipe gets wet.
    """

    def __init__(self, pipe: Pipe, surface: WaterSurface, span: Array | None = None) -> None:
        self.surface = surface
        given = np.maximum(pipe.line.outer_diameter[:, None], pipe.share) if span is None else span
        self.span = np.ascontiguousarray(np.broadcast_to(given, pipe.share.shape))

    def at(self, trial: Trial) -> WetShare:
        wet: WetShare = trial.once((self, "wet"), self._evaluate)
        return wet

    def _evaluate(self, trial: Trial) -> WetShare:
        h, gradient = self.surface.immersion(trial)
        share, slope = wet_section.wet_shares(h, self.span)
        return WetShare(share, slope[..., None] * gradient)

    def dry_height(self, trial: Trial) -> Array:
        """`wet_section.dry_height` of the stations (ne, ng) [m]."""
        heights: Array = wet_section.dry_heights(self.surface.immersion(trial)[0], self.span)
        return heights


class PartlyWet:
    """Loads of the water on the wet share of the pipe alone.

    The added mass is what is wet at the time, at rest as it gets wet: force = S m (u' - a), without a term for entry
    into the water (slamming).
    """

    def __init__(self, loads: StationLoads, wetting: Wetting) -> None:
        self._loads, self._wetting = loads, wetting
        self.dissipative = loads.dissipative

    def forces(self, trial: Trial) -> tuple[Array, Array]:
        share = self._wetting.at(trial).share[..., None]
        inertia, force = self._submerged(trial)
        return share * inertia, share * force

    def _submerged(self, trial: Trial) -> tuple[Array, Array]:
        found: tuple[Array, Array] = trial.once((self, "submerged"), self._loads.forces)
        return found

    def derivatives(self, trial: Trial, weights: Weights) -> Derivatives:
        wet, by = self._wetting.at(trial), self._loads.derivatives(trial, weights)
        inertia, force = self._submerged(trial)
        whole = weights.inertia * inertia + weights.force * force
        wetted = Derivatives(*(wet.share[..., None, None] * d for d in by))
        return wetted._replace(position=wetted.position + whole[..., :, None] * wet.gradient[..., None, :])

    def numbers(self) -> MovingWaterNumbers:
        return self.seen_in(self._wetting.surface.in_loop)

    def seen_in(self, water: WaterInLoop) -> MovingWaterNumbers:
        return self._loads.seen_in(water)._replace(partly=True, span=self._wetting.span)

    def momentum(self, trial: Trial, v: Array) -> Array:
        return self._wetting.at(trial).share[..., None] * self._loads.momentum(trial, v)
