"""Buoyancy lost by the riser where it is out of the water: the part "buoyancy"."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed
from riser_soil.core.part import Energy, Forces, State, Traits, Weights, Work
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.stations import Derivatives, element_room
from riser_soil.riser.trial import Trial
from riser_soil.sea.buoyancy_kernels import DryPipeNumbers, DryStationNumbers
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.stream_kernels import bring
from riser_soil.sea.wetting import Wetting


class LostBuoyancy(Protocol):
    """Buoyancy lost where a body is dry: the weight of the displaced water times the dry share 1 - S."""

    def residual(self, trial: Trial) -> Array:
        """Conjugate to q (ne, 4, d)."""
        ...

    def add_tangent(self, K: Array, trial: Trial, weights: Weights) -> None:
        """Add its tangent to K (ne, n, n), directors held constant."""
        ...

    def potential(self, trial: Trial) -> float:
        """Potential [J] under a level surface, zero when all is submerged."""
        ...

    def numbers(self, flat: bool) -> DryPipeNumbers | DryStationNumbers:
        """Those of a `Buoyancy` in the compiled loop over a riser alone."""
        ...


class DryStations:
    """Lost buoyancy by the dry share at the stations of a pipe. displaced: weight of the displaced water [N/m] (ne,).
    """

    def __init__(self, pipe: Pipe, wetting: Wetting, displaced: Array) -> None:
        self._pipe, self._wetting, self._displaced = pipe, wetting, displaced[:, None]

    def residual(self, trial: Trial) -> Array:
        dry = 1.0 - self._wetting.at(trial).share
        resistance = np.zeros((*dry.shape, self._pipe.line.dimension))
        resistance[..., -1] = dry * self._displaced
        return self._pipe.integrate(resistance)

    def add_tangent(self, K: Array, trial: Trial, weights: Weights) -> None:
        gradient = self._wetting.at(trial).gradient
        by_position = np.zeros((*gradient.shape, self._pipe.line.dimension))
        by_position[..., -1, :] = -weights.force * self._displaced[..., None] * gradient
        nothing = np.zeros_like(by_position)
        self._pipe.add_tangent(K, trial, weights, Derivatives(by_position, nothing, nothing, nothing))

    def potential(self, trial: Trial) -> float:
        return float(np.sum(self._pipe.share * self._displaced * self._wetting.dry_height(trial)))

    def numbers(self, flat: bool) -> DryStationNumbers:
        pipe, water, d = self._pipe, self._wetting.surface.in_loop, self._pipe.line.dimension
        return DryStationNumbers(
            stream=water.stream,
            seen=water.seen,
            element=pipe.element,
            at=pipe.at,
            share=pipe.share,
            span=self._wetting.span,
            displaced=self._displaced[:, 0].copy(),
            flat=flat,
            f=np.zeros(d),
            by_x=np.zeros((d, d)),
            change=element_room(2 * pipe.line.ndof, fixed(d)),
        )


class Buoyancy(LinePart):
    """Lost buoyancy of the dry part of the riser (group F), downwards.

    flat: whether the surface is level and at rest; the force then has a potential. Waves do work on it instead.
    """

    name = "buoyancy"

    def __init__(self, pipe: Pipe, dry: LostBuoyancy, flat: bool) -> None:
        super().__init__(pipe.line)
        self._pipe, self._dry, self._flat = pipe, dry, flat
        self.traits = Traits("F", symmetric=flat)

    def _F(self, trial: Trial) -> Array:
        found: Array = trial.once((self, "F"), self._dry.residual)
        return found

    def _element_forces(self, trial: Trial) -> Array:
        return trial.pull_back(self._F(trial))

    def element_forces(self, state: State) -> tuple[None, Array]:
        """Element residuals (inertia, force), each (ne, 2 ndof) or None."""
        found: Array = self.line.trial(state).once((self, "element forces"), self._element_forces)
        return None, found

    def residual(self, state: State, forces: Forces) -> None:
        trial = self.line.trial(state)
        self.line.collect(trial, trial.once((self, "F"), self._F), forces.force)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        trial, K = self.line.trial(state), values[self.line.name]
        self._dry.add_tangent(K, trial, weights)
        trial.add_turning(K, weights.force, self._F(trial))

    def numbers(self) -> tuple[Any, ...]:
        self._in_loop = self._dry.numbers(self._flat)
        return self._in_loop

    def renew_numbers(self, start: float, end: float) -> None:
        bring(self._in_loop.seen, start, end)

    def energy(self, state: State) -> Energy:
        """Potential under a flat surface."""
        return Energy(potential=self._dry.potential(self.line.trial(state))) if self._flat else Energy()

    def work(self, before: State, after: State) -> Work:
        """Work that waves put in."""
        if self._flat:
            return Work()
        first, last = self.line.left_at(before), self.line.trial(after)
        return Work(external=-self._pipe.taken(lambda trial: trial.once((self, "F"), self._F), first, last))
