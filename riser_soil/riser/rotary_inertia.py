"""Rotary inertia of the cross-sections: the part "rotary inertia" of dynamic stages."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, State, Traits, Weights
from riser_soil.riser import rotary_moments
from riser_soil.riser.inertia_kernels import PlanarRotaryMass, SpatialRotaryMass
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.planar_directors import PlanarFrames
from riser_soil.riser.spatial_directors import SpatialFrames


class PlanarSections:
    """Sections that turn in the line's plane; inertia [kg m2] of each element end.

    Moments and tangent, linear here, cost 0.7 to 0.9 of those of `SpatialSections` (`benchmarks.twins`).
    """

    def __init__(self, inertia: Array) -> None:
        self._inertia = inertia
        self.numbers = PlanarRotaryMass(inertia)

    def forces(self, u: Array, v: Array, a: Array) -> Array:
        """Moments (ne, 2, 1) from the nodes' rotation dofs, increments and rates (nn, 1)."""
        return np.asarray(self._inertia[:, None, None] * np.stack([a[:-1], a[1:]], axis=1))

    def add_tangent(self, K: Array, weights: Weights, u: Array, v: Array, a: Array) -> None:
        """Add to K (ne, 6, 6)."""
        for at in (2, 5):
            K[:, at, at] += weights.inertia * weights.shift_a * self._inertia

    def kinetic_energy(self, v: Array) -> float:
        return 0.5 * float(np.sum(self._inertia[:, None] * (v[:-1] ** 2 + v[1:] ** 2)))


class SpatialSections:
    """Sections that turn in space; inertia [kg m2] of each element end about an axis across the pipe and about its own.

    T0 (ne, 2, 3, 3): unstressed frames at element ends.
    """

    def __init__(self, across: Array, polar: Array, T0: Array) -> None:
        about_axes = np.stack([polar, across, across], axis=1)[:, None, None, :]
        self._J: Array = np.ascontiguousarray(T0 * about_axes @ np.swapaxes(T0, 2, 3))
        self.numbers = SpatialRotaryMass(self._J)

    def forces(self, u: Array, v: Array, a: Array) -> Array:
        """Moments (ne, 2, 3) from the nodes' rotation dofs, increments and rates (nn, 3)."""
        return np.asarray(rotary_moments.moments(self._J, u, v, a))

    def add_tangent(self, K: Array, weights: Weights, u: Array, v: Array, a: Array) -> None:
        """Add to K (ne, 12, 12)."""
        rotary_moments.add_tangent(K, weights.inertia, self._J, u, v, a, weights.shift_v, weights.shift_a)

    def kinetic_energy(self, v: Array) -> float:
        return float(rotary_moments.kinetic_energy(self._J, v))


class RotaryInertia(LinePart):
    """Rotary inertia of the sections, gathered at the nodes (group I).

    line: the riser's field. across: kg m per element (ne,) about an axis across the pipe (rho I of the section).
    polar: about the pipe's own axis, by default twice that, as of a round section; it counts in space only. Half of an
    element's belongs to each of its ends, so that its share in a frequency is second-order accurate.

    In space a line without polar inertia must not move: nothing but GJ would resist its spin, so that the scheme's
    weighting of moments at both ends of a step, which no inertia slows down, winds a soft pipe up.
    """

    name = "rotary inertia"

    def __init__(self, line: Line, across: Array, polar: Array | None = None) -> None:
        super().__init__(line)
        self.traits = Traits("I", symmetric=line.dimension == 2)
        self.across = 0.5 * line.length * across  # of ends, kg m2
        self.polar = 2.0 * self.across if polar is None else 0.5 * line.length * polar
        self._sections = _sections(line, self.across, self.polar)

    def on_directors(self) -> dict[int, Array]:
        """Masses [kg m2] of element ends (ne,) on the tangent (0) and the normals (1, 2) that have the same inertia.

        In space half the polar inertia sits on each normal, and on the tangent what the inertia across is more than
        that: zero for a round section, negative for one with polar inertia only.
        """
        if self.line.dimension == 2:
            return {1: self.across}
        half = 0.5 * self.polar
        masses: dict[int, Array] = {1: half, 2: half}
        on_tangent = self.across - half
        return {0: on_tangent} | masses if on_tangent.any() else masses

    def _turning(self, values: Array) -> Array:
        """Rotation dofs of the nodes (nn, r)."""
        return np.ascontiguousarray(self.line.nodal(values)[:, self.line.dimension :])

    def element_forces(self, state: State) -> tuple[Array, None]:
        """Element residuals (inertia, force), each (ne, 2 ndof) or None."""
        moments = self._sections.forces(*map(self._turning, (state.u, state.v, state.a)))
        out = np.zeros((len(moments), 2, self.line.ndof))
        out[:, :, self.line.dimension :] = moments
        return out.reshape(len(moments), -1), None

    def residual(self, state: State, forces: Forces) -> None:
        self.line.scatter(self.element_forces(state)[0], forces.inertia)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        turning = map(self._turning, (state.u, state.v, state.a))
        self._sections.add_tangent(values[self.line.name], weights, *turning)

    def numbers(self) -> PlanarRotaryMass | SpatialRotaryMass:
        return self._sections.numbers

    def energy(self, state: State) -> Energy:
        return Energy(kinetic=self._sections.kinetic_energy(self._turning(state.v)))


def _sections(line: Line, across: Array, polar: Array) -> PlanarSections | SpatialSections:
    if isinstance(line.frames, PlanarFrames):
        return PlanarSections(across)
    assert isinstance(line.frames, SpatialFrames)
    return SpatialSections(across, polar, line.frames.T0)
