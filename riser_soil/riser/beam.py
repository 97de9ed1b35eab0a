"""Elastic beam elements of the line under submerged weight: the part "riser"."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.part import Traits
from riser_soil.riser import beam2d, beam3d, rotations
from riser_soil.riser.configuration import Maps, PlanarConfiguration, SpatialConfiguration
from riser_soil.riser.directors import PlanarFrames
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent
from riser_soil.riser.sections import Elements
from riser_soil.riser.spatial_directors import SpatialFrames
from riser_soil.riser.vectors import vector

Planar = tuple[beam2d.PlanarReference, beam2d.PlanarSection]
Spatial = tuple[beam3d.SpatialReference, beam3d.SpatialSection]


def in_plane(line: Line, frames: PlanarFrames, elements: Elements) -> Planar:
    """EI is EI_y, as the second section axis is normal to the plane."""
    section = beam2d.PlanarSection(elements.EA, elements.stiffness()[0], *elements.slack_law)
    return beam2d.reference(line.chord0, *_ends(frames.alpha0), line.length), section


def in_space(line: Line, frames: SpatialFrames, elements: Elements) -> Spatial:
    section = beam3d.SpatialSection(elements.EA, *elements.stiffness(), elements.GJ, *elements.slack_law)
    return beam3d.reference(line.chord0, *_ends(frames.T0), line.length), section


def _ends(orientation: Array) -> tuple[Array, Array]:
    """Of both ends, from (ne, 2, ...)."""
    return np.ascontiguousarray(orientation[:, 0]), np.ascontiguousarray(orientation[:, 1])


DOWN = np.array([0.0, 0.0, -1.0])


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


class Beam(CompiledPart):
    """Elastic elements and their submerged weight, both with a potential (group F), zero at the origin of the axes.

    line: the riser's field. elements: section properties and weight (N/m) per element.
    load: further constant load per length (3,) or (ne, 3), N/m, global axes.
    factor: of weight and load, from seconds since the stage began (load factor in statics); 1 unless a stage
    grows them.
    In a plane forces and tangent cost less than half of those in space (`benchmarks.twins`).
    """

    line: Line

    name = "riser"
    traits = Traits("F", symmetric=True)

    def __init__(self, line: Line, elements: Elements, load: Array | None = None) -> None:
        super().__init__(line)
        self.factor: Callable[[float], float] = lambda _: 1.0
        self._elements, self._factor_now = elements, 1.0
        per_length = elements.weight[:, None] * DOWN + (np.zeros(3) if load is None else load)
        self._load = np.ascontiguousarray(per_length @ line.basis)

    def make_kernel_data(self) -> PlanarBeam | SpatialBeam:
        line, load = self.line, self._load.copy()
        if isinstance(line.frames, PlanarFrames):
            return PlanarBeam(*in_plane(line, line.frames, self._elements), line.length, load)
        return SpatialBeam(*in_space(line, line.frames, self._elements), line.length, load)

    def renew_kernel_data(self, start: float, end: float) -> None:
        if (factor := self.factor(end)) != self._factor_now:
            np.multiply(factor, self._load, out=self._data.load)
            self._factor_now = factor


@njit
def seen_in_plane(at: PlanarConfiguration, e: int) -> beam2d.PlanarCorotated:
    """Element e, seen from its own frame."""
    found: beam2d.PlanarCorotated = beam2d.corotate(at.chord[e], at.end_angle[e, 0], at.end_angle[e, 1])
    return found


@add_forces.of(PlanarBeam)
def _planar_forces(part: PlanarBeam, at: PlanarConfiguration, out: LineForces) -> None:
    f = np.empty(6)
    for e in range(part.length.size):
        seen = seen_in_plane(at, e)
        beam2d.write_element_forces(e, seen, part.reference, part.section, f)
        beam2d.add_load_forces(seen, part.length[e], part.load[e], f)
        for i in range(6):
            out.force_e[e, i] += f[i]


@add_forces.of(SpatialBeam)
def _spatial_forces(part: SpatialBeam, at: SpatialConfiguration, out: LineForces) -> None:
    f = np.empty(12)
    for e in range(part.length.size):
        beam3d.write_element_forces(e, at.chord, at.frame1, at.frame2, part.reference, part.section, part.load, f)
        rotations.element_to_increments(e, f, at.H)
        for i in range(12):
            out.force_e[e, i] += f[i]


@add_tangent.of(PlanarBeam)
def _planar_tangent(part: PlanarBeam, at: PlanarConfiguration, maps: Maps, weights: LineWeights, K: Array) -> None:
    f, own = np.empty(6), np.empty((6, 6))
    for e in range(part.length.size):
        seen = seen_in_plane(at, e)
        beam2d.write_element(e, seen, part.reference, part.section, f, own)
        beam2d.add_load_tangent(seen, part.length[e], part.load[e], own)
        for i in range(6):
            for j in range(6):
                K[e, i, j] += weights.force * own[i, j]


@add_tangent.of(SpatialBeam)
def _spatial_tangent(part: SpatialBeam, at: SpatialConfiguration, maps: Maps, weights: LineWeights, K: Array) -> None:
    f, own, workspace = np.empty(12), np.empty((12, 12)), beam3d.tangent_workspace()
    for e in range(part.length.size):
        beam3d.write_element(
            e, at.chord, at.frame1, at.frame2, part.reference, part.section, part.load, workspace, f, own
        )
        rotations.tangent_to_increments(e, f, own, at.H, at.Rn, at.Theta)
        for i in range(12):
            for j in range(12):
                K[e, i, j] += weights.force * own[i, j]


@add_energy.of(PlanarBeam)
def _planar_energy(part: PlanarBeam, at: PlanarConfiguration, energy: Array) -> None:
    for e in range(part.length.size):
        seen, x = seen_in_plane(at, e), at.x
        energy[1] += beam2d.element_energy(e, seen, part.reference, part.section)
        p, z = 0.5 * (x[e, 0] + x[e + 1, 0]), 0.5 * (x[e, 1] + x[e + 1, 1])
        energy[2] += beam2d.load_potential(seen, part.length[e], part.load[e], p, z)


@add_energy.of(SpatialBeam)
def _spatial_energy(part: SpatialBeam, at: SpatialConfiguration, energy: Array) -> None:
    for e in range(part.length.size):
        seen, x, w = beam3d.element_shape(e, at.chord, at.frame1, at.frame2, part.reference), at.x, vector(part.load[e])
        energy[1] += beam3d.element_energy(e, seen, part.reference, part.section)
        middle = 0.5 * (x[e, 0] + x[e + 1, 0]), 0.5 * (x[e, 1] + x[e + 1, 1]), 0.5 * (x[e, 2] + x[e + 1, 2])
        energy[2] += beam3d.element_potential(seen, part.length[e], w, middle)
