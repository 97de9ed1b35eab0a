"""Kernels of the line's mass and of its sections' rotary inertia, see `part_kernels`."""

from __future__ import annotations

from typing import NamedTuple

from riser_soil.core.arrays import Array
from riser_soil.riser import rotary_moments
from riser_soil.riser.configuration import Configuration, Maps, PlanarConfiguration, SpatialConfiguration
from riser_soil.riser.hermite import add_mass_to, add_weighed
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent


class Mass(NamedTuple):
    """Consistent mass of the elements, M (ne, 4, 4) [kg], as in `hermite.weigh`."""

    M: Array


class SpatialRotaryMass(NamedTuple):
    """Inertia tensors J (ne, 2, 3, 3) [kg m2] of element ends in body axes."""

    J: Array


class PlanarRotaryMass(NamedTuple):
    """Inertia (ne,) [kg m2] of each element end in the plane."""

    inertia: Array


@add_forces.of(Mass)
def _mass_forces(part: Mass, at: Configuration, out: LineForces) -> None:
    add_weighed(part.M, at.acceleration, out.inertia_q, at.D)


@add_tangent.of(Mass)
def _mass_tangent(part: Mass, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
    add_mass_to(K, weights.inertia, at.P, maps.acceleration_rows, part.M, at.D, at.R)


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


@add_energy.of(Mass)
def _mass_energy(part: Mass, at: Configuration, energy: Array) -> None:
    for e in range(part.M.shape[0]):
        for i in range(len(at.D)):
            for a in range(4):
                momentum = 0.0
                for b in range(4):
                    momentum += part.M[e, a, b] * at.rate[e, b, i]
                energy[0] += 0.5 * at.rate[e, a, i] * momentum


@add_energy.of(SpatialRotaryMass)
def _spatial_energy(part: SpatialRotaryMass, at: SpatialConfiguration, energy: Array) -> None:
    energy[0] += rotary_moments.kinetic_energy(part.J, at.v[:, 3:])


@add_energy.of(PlanarRotaryMass)
def _planar_energy(part: PlanarRotaryMass, at: PlanarConfiguration, energy: Array) -> None:
    for e in range(part.inertia.size):
        energy[0] += 0.5 * part.inertia[e] * (at.v[e, 2] ** 2 + at.v[e + 1, 2] ** 2)
