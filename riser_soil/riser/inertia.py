"""Consistent mass of the line: the part "inertia" of dynamic stages."""

from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, State, Traits, Weights
from riser_soil.riser.attachments import Masses
from riser_soil.riser.hermite import add_mass, consistent_mass, weigh
from riser_soil.riser.inertia_kernels import Mass
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.trial import Trial


class Inertia(LinePart):
    """Consistent mass of the cubic line and of what is attached to it, turning with the tangents (group I).

    line: the riser's field. mass: kg/m per element (ne,), contents included, water excluded. attached: further masses.
    The section's own rotary inertia is left out: it is (diameter/wavelength)^2 of the rest.
    The tangent is not symmetric, as the tangents' accelerations depend on their rates.
    """

    name = "inertia"
    traits = Traits("I", symmetric=False)

    def __init__(self, line: Line, mass: Array, attached: Masses | None = None) -> None:
        super().__init__(line)
        self.M = consistent_mass(line.length, mass)
        self._at_ends = None if attached is None else attached.ends
        if attached is not None:
            self.M += attached.along + attached.ends

    def _F(self, trial: Trial) -> Array:
        """Residual conjugate to q (ne, 4, d)."""
        return weigh(self.M, trial.q_acceleration)

    def _element_forces(self, trial: Trial) -> Array:
        return trial.pull_back(trial.once((self, "F"), self._F))

    def _all_forces(self, state: State) -> Array:
        forces: Array = self.line.trial(state).once((self, "element forces"), self._element_forces)
        return forces

    def _end_forces(self, state: State) -> Array | None:
        """Share (ne, 2 ndof) of what sits at the line's ends, if anything."""
        if self._at_ends is None:
            return None
        trial = self.line.trial(state)
        return trial.pull_back(weigh(self._at_ends, trial.q_acceleration))

    def element_forces(self, state: State) -> tuple[Array, None]:
        """Element residuals (inertia, force), each (ne, 2 ndof) or None, without what sits at the line's ends."""
        every, ends = self._all_forces(state), self._end_forces(state)
        return every if ends is None else every - ends, None

    def nodal_forces(self, state: State) -> Array | None:
        """Residual (nn, ndof) of what sits at the line's ends, if anything."""
        ends = self._end_forces(state)
        return None if ends is None else self.line.gathered(ends)

    def residual(self, state: State, forces: Forces) -> None:
        trial = self.line.trial(state)
        self.line.collect(trial, trial.once((self, "F"), self._F), forces.inertia)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        trial, K = self.line.trial(state), values[self.line.name]
        trial.add_turning(K, weights.inertia, trial.once((self, "F"), self._F))
        columns, shift = trial.columns(weights)[2]
        add_mass(K, weights.inertia, trial.turn.P, columns, shift, self.M)

    def numbers(self) -> Mass:
        return Mass(self.M)

    def numbers_within(self, numbers: tuple[Any, ...]) -> tuple[Any, ...]:
        return numbers if self._at_ends is None else Mass(self.M - self._at_ends)

    def energy(self, state: State) -> Energy:
        rate = self.line.trial(state).q_rate
        return Energy(kinetic=0.5 * float(np.vdot(rate, weigh(self.M, rate))))
