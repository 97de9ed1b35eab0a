"""Rotary inertia of the cross-sections: the part "rotary inertia" of dynamic stages."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Traits
from riser_soil.riser import rotary_moments
from riser_soil.riser.compiled_part import CompiledPart
from riser_soil.riser.configuration import Maps, PlanarConfiguration, SpatialConfiguration
from riser_soil.riser.directors import PlanarFrames
from riser_soil.riser.line import Line
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent


class SpatialRotaryMass(NamedTuple):
    """Inertia tensors J (ne, 2, 3, 3) [kg m2] of element ends in body axes."""

    J: Array


class PlanarRotaryMass(NamedTuple):
    """Inertia (ne,) [kg m2] of each element end in the plane."""

    inertia: Array


class RotaryInertia(CompiledPart):
    """Rotary inertia of the sections, gathered at the nodes (group I).

    line: the riser's field. across: kg m per element (ne,) about an axis across the pipe (rho I of the section).
    polar: about the pipe's own axis, by default twice that, as of a round section; it counts in space only. Half of an
    element's belongs to each of its ends, so that its share in a frequency is second-order accurate.

    In the plane moments and tangent, linear there, cost 0.7 to 0.9 of those in space (`benchmarks.twins`).
    In space a line without polar inertia must not move: nothing but GJ would resist its spin, so that the scheme's
    weighting of moments at both ends of a step, which no inertia slows down, winds a soft pipe up.
    """

    name = "rotary inertia"

    def __init__(self, line: Line, across: Array, polar: Array | None = None) -> None:
        super().__init__(line)
        self.traits = Traits("I", symmetric=line.dimension == 2)
        self.across = 0.5 * line.length * across  # of ends, kg m2
        self.polar = 2.0 * self.across if polar is None else 0.5 * line.length * polar

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

    def make_kernel_data(self) -> PlanarRotaryMass | SpatialRotaryMass:
        frames = self.line.frames
        if isinstance(frames, PlanarFrames):
            return PlanarRotaryMass(self.across)
        return _in_space(self.across, self.polar, frames.T0)


def _in_space(across: Array, polar: Array, T0: Array) -> SpatialRotaryMass:
    """Inertia of each element end about an axis across the pipe and about its own; T0: unstressed frames there."""
    about_axes = np.stack([polar, across, across], axis=1)[:, None, None, :]
    return SpatialRotaryMass(np.ascontiguousarray(T0 * about_axes @ np.swapaxes(T0, 2, 3)))


@add_forces.of(SpatialRotaryMass)
def _spatial_forces(part: SpatialRotaryMass, at: SpatialConfiguration, out: LineForces) -> None:
    W, A = at.v[:, 3:], at.a[:, 3:]
    for e in range(part.J.shape[0]):
        for side in range(2):
            moment = rotary_moments.end_moment(part.J, e, side, at.Theta, W, A)
            for i in range(3):
                out.inertia_e[e, 6 * side + 3 + i] += moment[i]


@add_tangent.of(SpatialRotaryMass)
def _spatial_tangent(
    part: SpatialRotaryMass, at: SpatialConfiguration, maps: Maps, weights: LineWeights, K: Array
) -> None:
    W, A = at.v[:, 3:], at.a[:, 3:]
    rotary_moments.add_tangent(K, weights.inertia, part.J, at.Theta, W, A, maps.shift_v, maps.shift_a)


@add_forces.of(PlanarRotaryMass)
def _planar_forces(part: PlanarRotaryMass, at: PlanarConfiguration, out: LineForces) -> None:
    for e in range(part.inertia.size):
        for side in range(2):
            out.inertia_e[e, 3 * side + 2] += part.inertia[e] * at.a[e + side, 2]


@add_tangent.of(PlanarRotaryMass)
def _planar_tangent(
    part: PlanarRotaryMass, at: PlanarConfiguration, maps: Maps, weights: LineWeights, K: Array
) -> None:
    for e in range(part.inertia.size):
        for side in range(2):
            K[e, 2 + 3 * side, 2 + 3 * side] += weights.inertia * maps.shift_a * part.inertia[e]


@add_energy.of(SpatialRotaryMass)
def _spatial_energy(part: SpatialRotaryMass, at: SpatialConfiguration, energy: Array) -> None:
    energy[0] += rotary_moments.kinetic_energy(part.J, at.v[:, 3:])


@add_energy.of(PlanarRotaryMass)
def _planar_energy(part: PlanarRotaryMass, at: PlanarConfiguration, energy: Array) -> None:
    for e in range(part.inertia.size):
        energy[0] += 0.5 * part.inertia[e] * (at.v[e, 2] ** 2 + at.v[e + 1, 2] ** 2)
