"""Elastic beam elements of the line under submerged weight: the part "riser"."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, State, Traits, Weights
from riser_soil.riser.beam_kernels import PlanarBeam, SpatialBeam
from riser_soil.riser.elastic import elastic_elements
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.sections import Elements
from riser_soil.riser.trial import Trial

DOWN = np.array([0.0, 0.0, -1.0])


class Beam(LinePart):
    """Elastic elements and their submerged weight, both with a potential (group F).

    line: the riser's field. elements: section properties and weight (N/m) per element.
    load: further constant load per length (3,) or (ne, 3), N/m, global axes.
    factor: of weight and load, from seconds since the stage began (load factor in statics); 1 unless a stage
    grows them.
    """

    name = "riser"
    traits = Traits("F", symmetric=True)

    def __init__(self, line: Line, elements: Elements, load: Array | None = None) -> None:
        super().__init__(line)
        self.factor: Callable[[float], float] = lambda _: 1.0
        self._elastic = elastic_elements(line, elements)
        per_length = elements.weight[:, None] * DOWN + (np.zeros(3) if load is None else load)
        self._load = np.ascontiguousarray(per_length @ line.basis)

    def _load_at(self, trial: Trial) -> Array:
        """Weight and load at a trial's time (ne, d) [N/m]."""
        return np.asarray(self.factor(trial.state.t) * self._load)

    def _element_forces(self, trial: Trial) -> Array:
        return self._elastic.forces(trial, self._load_at(trial))

    def element_forces(self, state: State) -> tuple[None, Array]:
        """Element residuals (inertia, force), each (ne, 2 ndof) or None."""
        return None, self.line.trial(state).once((self, "element forces"), self._element_forces)

    def residual(self, state: State, forces: Forces) -> None:
        self.line.scatter(self.element_forces(state)[1], forces.force)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        trial, K = self.line.trial(state), values[self.line.name]
        self._elastic.add_tangent(K, weights.force, trial, self._load_at(trial))

    def numbers(self) -> PlanarBeam | SpatialBeam:
        kind = PlanarBeam if self.line.dimension == 2 else SpatialBeam
        elastic = self._elastic
        self._load_now, self._factor_now = self._load.copy(), 1.0
        return kind(elastic.reference, elastic.section, self.line.length, self._load_now)

    def renew_numbers(self, start: float, end: float) -> None:
        if (factor := self.factor(end)) != self._factor_now:
            np.multiply(factor, self._load, out=self._load_now)
            self._factor_now = factor

    def energy(self, state: State) -> Energy:
        """Strain energy, and the potential of weight and load, zero at the origin of the axes."""
        trial = self.line.trial(state)
        potential = self._elastic.load_potential(trial, self._load_at(trial))
        return Energy(strain=self._elastic.energy(trial), potential=potential)
