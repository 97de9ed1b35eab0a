"""Kernels of the elastic elements under submerged weight, see `part_kernels`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser import beam2d, beam3d, increments, uniform_load
from riser_soil.riser.configuration import Configuration, Maps, PlanarConfiguration, SpatialConfiguration
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent


class PlanarBeam(NamedTuple):
    """Elements of a plane line: arc lengths (ne,) and load per length (ne, 2) [N/m]."""

    reference: beam2d.PlanarReference
    section: beam2d.PlanarSection
    length: Array
    load: Array


class SpatialBeam(NamedTuple):
    """Elements of a line in space: arc lengths (ne,) and load per length (ne, 3) [N/m]."""

    reference: beam3d.SpatialReference
    section: beam3d.SpatialSection
    length: Array
    load: Array


@add_forces.of(PlanarBeam)
def _planar_forces(part: PlanarBeam, at: PlanarConfiguration, out: LineForces) -> None:
    f, first, second = np.empty(6), at.end_angle[:, 0], at.end_angle[:, 1]
    for e in range(part.length.size):
        beam2d.put_element_forces(e, at.chord, first, second, part.reference, part.section, f)
        for i in range(6):
            out.force_e[e, i] += f[i]
    uniform_load.add_residual(at.D, at.chord, at.tangent, part.length, part.load, out.force_q)


@add_forces.of(SpatialBeam)
def _spatial_forces(part: SpatialBeam, at: SpatialConfiguration, out: LineForces) -> None:
    f = np.empty(12)
    for e in range(part.length.size):
        beam3d.put_element_forces(e, at.chord, at.frame1, at.frame2, part.reference, part.section, f)
        increments.element_to_increments(e, f, at.H)
        for i in range(12):
            out.force_e[e, i] += f[i]
    uniform_load.add_residual(at.D, at.chord, at.tangent, part.length, part.load, out.force_q)


@add_tangent.of(PlanarBeam)
def _planar_tangent(part: PlanarBeam, at: PlanarConfiguration, maps: Maps, weights: LineWeights, K: Array) -> None:
    f, own, first, second = np.empty(6), np.empty((6, 6)), at.end_angle[:, 0], at.end_angle[:, 1]
    for e in range(part.length.size):
        beam2d.put_element(e, at.chord, first, second, part.reference, part.section, f, own)
        for i in range(6):
            for j in range(6):
                K[e, i, j] += weights.force * own[i, j]
    uniform_load.add_tangent_to(
        at.D, at.R, K, weights.force, at.P, at.chord, at.tangent, part.length, part.load
    )


@add_tangent.of(SpatialBeam)
def _spatial_tangent(part: SpatialBeam, at: SpatialConfiguration, maps: Maps, weights: LineWeights, K: Array) -> None:
    f, own = np.empty(12), np.empty((12, 12))
    for e in range(part.length.size):
        beam3d.put_element(e, at.chord, at.frame1, at.frame2, part.reference, part.section, f, own)
        increments.tangent_to_increments(e, f, own, at.H, at.Rn, at.Theta)
        for i in range(12):
            for j in range(12):
                K[e, i, j] += weights.force * own[i, j]
    uniform_load.add_tangent_to(
        at.D, at.R, K, weights.force, at.P, at.chord, at.tangent, part.length, part.load
    )


@add_energy.of(PlanarBeam)
def _planar_energy(part: PlanarBeam, at: PlanarConfiguration, energy: Array) -> None:
    first, second = at.end_angle[:, 0], at.end_angle[:, 1]
    for e in range(part.length.size):
        energy[1] += beam2d.element_energy(e, at.chord, first, second, part.reference, part.section)
    energy[2] += _potential(part, at)


@add_energy.of(SpatialBeam)
def _spatial_energy(part: SpatialBeam, at: SpatialConfiguration, energy: Array) -> None:
    for e in range(part.length.size):
        energy[1] += beam3d.element_energy(e, at.chord, at.frame1, at.frame2, part.reference, part.section)
    energy[2] += _potential(part, at)


@njit
def _potential(part: PlanarBeam | SpatialBeam, at: Configuration) -> float:
    """Of weight and load [J]."""
    total, middle, room = 0.0, np.empty(len(at.D)), np.empty(len(at.D))
    for e in range(part.length.size):
        for i in range(len(at.D)):
            middle[i] = 0.5 * (at.x[e, i] + at.x[e + 1, i])
        total += uniform_load.element_potential(
            at.D, at.chord[e], middle, at.tangent[e], part.length[e], part.load[e], room
        )
    return total
