"""Structural damping in proportion to the elastic stiffness: the part "structural damping" of dynamic stages."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State, Traits, Weights, Work
from riser_soil.riser import damping2d, damping3d, increments
from riser_soil.riser.damping_kernels import PlanarViscosity, SpatialViscosity
from riser_soil.riser.elastic import ElasticElements, PlanarElements, elastic_elements, spatial
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.sections import Elements
from riser_soil.riser.trial import Trial


class ViscousElements(ABC):
    """Viscous elements beside elastic ones; beta [s] of each element."""

    def __init__(self, elements: ElasticElements, beta: Array) -> None:
        self._elements = elements
        self._viscosity = type(elements.section)(*(beta * stiffness for stiffness in elements.section))
        self.numbers = self._numbers(beta.size)

    @abstractmethod
    def _numbers(self, ne: int) -> PlanarViscosity | SpatialViscosity: ...

    @abstractmethod
    def _rates(self, trial: Trial, v: Array) -> tuple[Array, Array]:
        """Rates of the chords (ne, d) and of the nodes' orientation, as the kernels take them."""

    def _at(self, trial: Trial, v: Array) -> tuple:
        """Arguments of the kernels."""
        elements = self._elements
        return *elements.configuration(trial), elements.reference, self._viscosity, *self._rates(trial, v)

    @abstractmethod
    def forces(self, trial: Trial, v: Array) -> Array:
        """(ne, 2 ndof), conjugate to the dofs, from their rates (nn, ndof)."""

    @abstractmethod
    def tangent(self, trial: Trial, v: Array, shift_v: float) -> Array:
        """(ne, 2 ndof, 2 ndof)."""


class PlanarDamping(ViscousElements):
    """Viscous elements of a planar line; forces and tangent cost a quarter of those in space (`benchmarks.twins`)."""

    def _numbers(self, ne: int) -> PlanarViscosity:
        return PlanarViscosity(self._elements.reference, self._viscosity, np.empty((ne, 2)))

    def _rates(self, trial: Trial, v: Array) -> tuple[Array, Array]:
        return np.diff(v[:, :2], axis=0), np.ascontiguousarray(v[:, 2])

    def forces(self, trial: Trial, v: Array) -> Array:
        return np.asarray(damping2d.forces(*self._at(trial, v)))

    def tangent(self, trial: Trial, v: Array, shift_v: float) -> Array:
        return np.asarray(damping2d.tangent(*self._at(trial, v), shift_v))


class SpatialDamping(ViscousElements):
    """Viscous elements of a line in space."""

    def _numbers(self, ne: int) -> SpatialViscosity:
        return SpatialViscosity(self._elements.reference, self._viscosity, np.empty((ne, 3)), np.empty((ne + 1, 3)))

    def _rates(self, trial: Trial, v: Array) -> tuple[Array, Array]:
        return np.diff(v[:, :3], axis=0), np.einsum("nij,nj->ni", spatial(trial).R, v[:, 3:])

    def forces(self, trial: Trial, v: Array) -> Array:
        f = damping3d.forces(*self._at(trial, v))
        increments.forces_to_increments(f, spatial(trial).H)
        return np.asarray(f)

    def tangent(self, trial: Trial, v: Array, shift_v: float) -> Array:
        turn = spatial(trial)
        nodes = damping3d.NodeRotations(turn.R, turn.H, turn.Rn, turn.Theta)
        return np.asarray(damping3d.tangent(*self._at(trial, v), nodes, shift_v))


class StructuralDamping(LinePart):
    """Stiffness-proportional damping (group F): stresses beta D times the strains' rates, D the elastic stiffnesses.

    line: the riser's field. elements.damping: beta [s] per element. A mode of angular frequency w has the damping
    ratio beta w / 2; rigid motions have none.
    """

    name, traits = "structural damping", Traits("F", symmetric=False)

    def __init__(self, line: Line, elements: Elements) -> None:
        super().__init__(line)
        self._damping = _damping(elastic_elements(line, elements), elements.damping)

    def viscous_forces(self, state: State) -> Array:
        """Element residuals (ne, 2 ndof)."""
        trial = self.line.trial(state)
        return np.asarray(trial.once((self, "forces"), self._forces))

    def _forces(self, trial: Trial) -> Array:
        return self._damping.forces(trial, self.line.nodal(trial.state.v))

    def element_forces(self, state: State) -> tuple[None, Array]:
        """Element residuals (inertia, force), each (ne, 2 ndof) or None."""
        return None, self.viscous_forces(state)

    def residual(self, state: State, forces: Forces) -> None:
        self.line.scatter(self.viscous_forces(state), forces.force)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        trial, v = self.line.trial(state), self.line.nodal(state.v)
        values[self.line.name] += weights.force * self._damping.tangent(trial, v, float(weights.shift_v))

    def numbers(self) -> PlanarViscosity | SpatialViscosity:
        return self._damping.numbers

    def work(self, before: State, after: State) -> Work:
        """Energy that the mean forces take out over the step."""
        forces = Forces.zeros(after.u.size)
        for state in (before, after):
            self.residual(state, forces)
        part = self.line.part
        return Work(dissipated=0.5 * float(forces.force[part] @ (after.u - before.u)[part]))


def _damping(elements: ElasticElements, beta: Array) -> ViscousElements:
    return PlanarDamping(elements, beta) if isinstance(elements, PlanarElements) else SpatialDamping(elements, beta)
