"""How much of the pipe is under water, where the water has a surface.

At immersion h, the height of the surface above the pipe's axis, the wet share of a station is that of a lying circular
pipe of diameter b cut by a level surface,

    S(h) = 1/2 + (eta sqrt(1 - eta^2) + asin(eta))/pi,    eta = 2 h/b within -1..1,

0 above and 1 below. It is exact for a lying pipe when b is its diameter. An upright pipe gets wet along its length, so
b is at least the arc length that the station stands for: the wetted length then grows evenly with the water.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from riser_soil.arrays import Array
from riser_soil.part import Weights
from riser_soil.riser.stations import Derivatives
from riser_soil.riser.trial import Trial
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.still_water import StationLoads


def wet_share(h: Array, b: Array) -> Array:
    """S, from 0 to 1."""
    eta = np.clip(2.0 * h / b, -1.0, 1.0)
    return np.asarray(0.5 + (eta * np.sqrt(1.0 - eta * eta) + np.arcsin(eta)) / np.pi)


def wet_slope(h: Array, b: Array) -> Array:
    """dS/dh [1/m]."""
    eta = np.clip(2.0 * h / b, -1.0, 1.0)
    return np.asarray(4.0 / np.pi * np.sqrt(1.0 - eta * eta) / b)


def dry_height(h: Array, b: Array) -> Array:
    """Integral of 1 - S from h up to full immersion [m]; -h above the water."""
    eta = np.clip(2.0 * h / b, -1.0, 1.0)
    across = np.sqrt(1.0 - eta * eta)
    within = 0.5 * b * ((eta * np.arcsin(eta) + across - across**3 / 3.0) / np.pi - 0.5 * eta)
    return np.asarray(within + np.maximum(-h - 0.5 * b, 0.0))


class Surface(Protocol):
    """The water's surface above the stations."""

    def immersion(self, trial: Trial) -> tuple[Array, Array]:
        """Height of the surface above the stations (ne, ng) [m] and its gradient (ne, ng, d)."""
        ...


class FlatSurface:
    """A surface at the height `level` [m]."""

    def __init__(self, pipe: Pipe, level: float) -> None:
        self._pipe, self._level = pipe, level

    def immersion(self, trial: Trial) -> tuple[Array, Array]:
        x = self._pipe.position(trial)
        gradient = np.zeros_like(x)
        gradient[..., -1] = -1.0
        return self._level - x[..., -1], gradient


class Wet(NamedTuple):
    """Wet share (ne, ng) and its gradient by position (ne, ng, d) [1/m]."""

    share: Array
    gradient: Array


class Wetting:
    """The wet share of the pipe's stations under a surface.

    span: b of the stations (ne, 1) [m]; by default the pipe's.
    """

    def __init__(self, pipe: Pipe, surface: Surface, span: Array | None = None) -> None:
        self._surface = surface
        self._span = np.maximum(pipe.line.outer_diameter[:, None], pipe.share) if span is None else span

    def at(self, trial: Trial) -> Wet:
        wet: Wet = trial.once((self, "wet"), self._see)
        return wet

    def _see(self, trial: Trial) -> Wet:
        h, gradient = self._surface.immersion(trial)
        return Wet(wet_share(h, self._span), wet_slope(h, self._span)[..., None] * gradient)

    def dry_height(self, trial: Trial) -> Array:
        """`dry_height` of the stations (ne, ng) [m]."""
        return dry_height(self._surface.immersion(trial)[0], self._span)


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
        held = Derivatives(*(wet.share[..., None, None] * d for d in by))
        return held._replace(position=held.position + whole[..., :, None] * wet.gradient[..., None, :])

    def momentum(self, trial: Trial, v: Array) -> Array:
        return self._wetting.at(trial).share[..., None] * self._loads.momentum(trial, v)
