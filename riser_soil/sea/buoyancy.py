"""Buoyancy that the pipe loses where it comes out of the water: the part "buoyancy"."""

from __future__ import annotations

import numpy as np

from riser_soil.arrays import Array
from riser_soil.part import Block, Energy, Forces, State, Weights, Work
from riser_soil.riser.stations import Derivatives
from riser_soil.riser.trial import Trial
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.wetting import Wetting


class Buoyancy:
    """The weight, beyond the submerged one, of what is not wet (group F): (1 - S) rho g pi D^2/4 per length, downwards.

    displaced: weight of the water in the pipe's place [N/m] (ne,). flat: whether the surface is level and at rest; the
    force then has a potential, zero when the whole pipe is submerged. Waves do work on it instead.
    """

    name = "buoyancy"

    def __init__(self, pipe: Pipe, wetting: Wetting, displaced: Array, flat: bool) -> None:
        self.line, self._pipe, self._wetting = pipe.line, pipe, wetting
        self._displaced, self._flat = displaced, flat
        self.symmetric = flat

    def blocks(self) -> dict[str, Block]:
        return {"riser": self.line.element_block()} if self.line.active else {}

    def _F(self, trial: Trial) -> Array:
        """Residual conjugate to q (ne, 4, d)."""
        dry = 1.0 - self._wetting.at(trial).share
        resistance = np.zeros((*dry.shape, self.line.dimension))
        resistance[..., -1] = dry * self._displaced[:, None]
        return self._pipe.integrate(resistance)

    def _element_forces(self, trial: Trial) -> Array:
        return trial.pull_back(trial.once((self, "F"), self._F))

    def element_forces(self, state: State) -> tuple[None, Array]:
        """Element residuals (inertia, force), each (ne, 2 ndof) or None."""
        found: Array = self.line.trial(state).once((self, "element forces"), self._element_forces)
        return None, found

    def residual(self, state: State, forces: Forces) -> None:
        if self.line.active:
            self.line.scatter(self.element_forces(state)[1], forces.force)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        if self.line.active:
            trial, K = self.line.trial(state), values["riser"]
            self._pipe.add_tangent(K, trial, weights, self._derivatives(trial, weights))
            trial.add_turning(K, weights.force, trial.once((self, "F"), self._F))

    def _derivatives(self, trial: Trial, weights: Weights) -> Derivatives:
        gradient = self._wetting.at(trial).gradient
        by_position = np.zeros((*gradient.shape, self.line.dimension))
        by_position[..., -1, :] = -weights.force * self._displaced[:, None, None] * gradient
        nothing = np.zeros_like(by_position)
        return Derivatives(by_position, nothing, nothing, nothing)

    def energy(self, state: State) -> Energy:
        """Potential under a flat surface."""
        if not (self.line.active and self._flat):
            return Energy()
        lifted = self._pipe.share * self._displaced[:, None] * self._wetting.dry_height(self.line.trial(state))
        return Energy(potential=float(lifted.sum()))

    def work(self, before: State, after: State) -> Work:
        """Work that waves put in."""
        if self._flat or not self.line.active:
            return Work()
        return Work(external=-self._pipe.taken(lambda state: self.element_forces(state)[1], before, after))

    def commit(self, state: State) -> None:
        pass
