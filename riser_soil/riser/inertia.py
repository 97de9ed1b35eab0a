"""Inertia of the line's mass: the part "inertia" of dynamic stages."""

import numpy as np

from riser_soil.arrays import Array
from riser_soil.part import Block, Energy, Forces, State, Weights, Work
from riser_soil.riser.hermite import add_mass, consistent_mass, weigh
from riser_soil.riser.line import Line
from riser_soil.riser.trial import Trial


class Inertia:
    """Consistent mass of the cubic line and of what is attached to it, turning with the tangents (group I).

    line: the riser's field. mass: kg/m per element (ne,), contents included, water excluded. attached: further mass
    matrices (ne, 4, 4), see `attachments.mass_matrices`.
    The section's own rotary inertia is left out: it is (diameter/wavelength)^2 of the rest.
    The tangent is not symmetric, as the tangents' accelerations depend on their rates.
    """

    name = "inertia"
    symmetric = False

    def __init__(self, line: Line, mass: Array, attached: Array | None = None) -> None:
        self.line = line
        self.M = consistent_mass(line.length, mass)
        if attached is not None:
            self.M += attached

    def blocks(self) -> dict[str, Block]:
        return {"riser": self.line.element_block()} if self.line.active else {}

    def _F(self, trial: Trial) -> Array:
        """Residual conjugate to q (ne, 4, d)."""
        return weigh(self.M, trial.q_acceleration)

    def _element_forces(self, trial: Trial) -> Array:
        return trial.pull_back(trial.once((self, "F"), self._F))

    def element_forces(self, state: State) -> tuple[Array, None]:
        """Element residuals (inertia, force), each (ne, 2 ndof) or None."""
        return self.line.trial(state).once((self, "element forces"), self._element_forces), None

    def residual(self, state: State, forces: Forces) -> None:
        if self.line.active:
            self.line.scatter(self.element_forces(state)[0], forces.inertia)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        if self.line.active:
            trial, K = self.line.trial(state), values["riser"]
            trial.add_turning(K, weights.inertia, trial.once((self, "F"), self._F))
            columns, shift = trial.columns(weights)[2]
            add_mass(K, weights.inertia, trial.turn.P, columns, shift, self.M)

    def energy(self, state: State) -> Energy:
        if not self.line.active:
            return Energy()
        rate = self.line.trial(state).q_rate
        return Energy(kinetic=0.5 * float(np.sum(rate * weigh(self.M, rate))))

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        pass
