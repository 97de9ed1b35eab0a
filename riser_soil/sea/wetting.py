"""Submerged share of the pipe at its stations, and loads on that share alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Weights
from riser_soil.riser.stations import Derivatives
from riser_soil.riser.trial import Trial
from riser_soil.sea import wet_section
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.still_water import StationLoads

WaterSurface = Callable[[Trial], tuple[Array, Array]]
"""The line's trial -> height of the water's surface above its stations (ne, ng) [m], and its gradient (ne, ng, d)."""


def flat_surface(pipe: Pipe, level: float) -> WaterSurface:
    """Calm water at the height `level` [m]."""

    def immersion(trial: Trial) -> tuple[Array, Array]:
        x = pipe.position(trial)
        gradient = np.zeros_like(x)
        gradient[..., -1] = -1.0
        return level - x[..., -1], gradient

    return immersion


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
        self._surface = surface
        given = np.maximum(pipe.line.outer_diameter[:, None], pipe.share) if span is None else span
        self._span = np.ascontiguousarray(np.broadcast_to(given, pipe.share.shape))

    def at(self, trial: Trial) -> WetShare:
        wet: WetShare = trial.once((self, "wet"), self._evaluate)
        return wet

    def _evaluate(self, trial: Trial) -> WetShare:
        h, gradient = self._surface(trial)
        share, slope = wet_section.wet_shares(h, self._span)
        return WetShare(share, slope[..., None] * gradient)

    def dry_height(self, trial: Trial) -> Array:
        """`wet_section.dry_height` of the stations (ne, ng) [m]."""
        heights: Array = wet_section.dry_heights(self._surface(trial)[0], self._span)
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

    def numbers(self) -> None:
        return None

    def momentum(self, trial: Trial, v: Array) -> Array:
        return self._wetting.at(trial).share[..., None] * self._loads.momentum(trial, v)
