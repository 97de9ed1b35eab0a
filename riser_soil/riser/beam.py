"""Elastic beam elements of the line under submerged weight: the part "riser"."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.part import Traits, Weights
from riser_soil.riser import beam2d, beam3d, rotations
from riser_soil.riser.configuration import Maps, PlanarConfiguration, SpatialConfiguration
from riser_soil.riser.directors import PlanarFrames
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent
from riser_soil.riser.sections import Elements
from riser_soil.riser.stiffness import LineStiffness
from riser_soil.riser.tension_only import Heaped, blend_forces, blend_tangent, blended, heaped
from riser_soil.riser.vectors import vector


def _ends(orientation: Array) -> tuple[Array, Array]:
    """Orientations of both ends of elements, from (ne, 2, ...)."""
    return np.ascontiguousarray(orientation[:, 0]), np.ascontiguousarray(orientation[:, 1])


DOWN = np.array([0.0, 0.0, -1.0])


class PlanarBeam(NamedTuple):
    """Elements of a plane line, and load per length (ne, 2) [N/m]."""

    reference: beam2d.LineReference
    section: LineStiffness
    load: Array


class SpatialBeam(NamedTuple):
    """Elements of a line in space, and load per length (ne, 3) [N/m]."""

    reference: beam3d.SpatialReference
    section: LineStiffness
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
        line, load, stiffness = self.line, self._load.copy(), self._elements.stiffness(self.line.length)
        if isinstance(line.frames, PlanarFrames):
            return PlanarBeam(beam2d.reference(line.chord0, *_ends(line.frames.alpha0)), stiffness, load)
        reference = beam3d.reference(line.chord0, *_ends(line.frames.T0), line.length)
        return SpatialBeam(reference, stiffness, load)

    def renew_kernel_data(self, start: float, end: float) -> None:
        if (factor := self.factor(end)) != self._factor_now:
            np.multiply(factor, self._load, out=self._data.load)
            self._factor_now = factor


@njit
def corotated(at: PlanarConfiguration, e: int) -> beam2d.PlanarCorotated:
    """Element e in its own frame."""
    local: beam2d.PlanarCorotated = beam2d.corotate(at.chord[e], at.end_angle[e, 0], at.end_angle[e, 1])
    return local


@add_forces.of(PlanarBeam)
def _planar_forces(part: PlanarBeam, at: PlanarConfiguration, out: LineForces) -> None:
    f, heap = np.empty(6), np.empty(6)
    for e in range(part.load.shape[0]):
        local = corotated(at, e)
        beam2d.write_element_forces(e, local, part.reference, part.section, f)
        beam2d.add_load_forces(local, part.section.L[e], part.load[e], f)
        state = heaped(part.section.law, e, at.chord[e], part.section.L[e], part.section.EA[e])
        _blend_planar_forces(state, part, at, e, local, f, heap)
        for i in range(6):
            out.force_e[e, i] += f[i]


@njit
def _blend_planar_forces(
    state: Heaped | None,
    part: PlanarBeam,
    at: PlanarConfiguration,
    e: int,
    local: beam2d.PlanarCorotated,
    f: Array,
    heap: Array,
) -> None:
    """Make forces f (6,) of an element with its bow those that it has in its state; workspace heap (6,)."""
    if state is None:
        return
    if state.g == 1.0:
        return
    chord, L, w = at.chord[e], part.section.L[e], part.load[e]
    beam2d.write_heaped_forces(state, chord, at.end_angle[e, 0], at.end_angle[e, 1], L, w, heap)
    blend_forces(state, chord, L, _more_than_in_planar_heap(state, part, at, e, local), f, heap)


@njit
def _more_than_in_planar_heap(
    state: Heaped, part: PlanarBeam, at: PlanarConfiguration, e: int, local: beam2d.PlanarCorotated
) -> float:
    """Energy [J] of an element with its bow less that in a heap."""
    L, chord = part.section.L[e], at.chord[e]
    bowed = beam2d.element_energy(e, local, part.reference, part.section)
    bowed += beam2d.load_potential(local, L, part.load[e], 0.0, 0.0)
    turned = at.end_angle[e]
    spring = beam2d.heaped_energy(state, chord, turned[0], turned[1], L)
    return bowed - spring - beam2d.heaped_load_potential(turned[0], turned[1], L, part.load[e])


@add_forces.of(SpatialBeam)
def _spatial_forces(part: SpatialBeam, at: SpatialConfiguration, out: LineForces) -> None:
    f, heap = np.empty(12), np.empty(12)
    for e in range(part.load.shape[0]):
        beam3d.write_element_forces(e, at.chord, at.frame1, at.frame2, part.reference, part.section, part.load, f)
        state = heaped(part.section.law, e, at.chord[e], part.section.L[e], part.section.EA[e])
        _blend_spatial_forces(state, part, at, e, f, heap)
        rotations.element_to_increments(e, f, at.H)
        for i in range(12):
            out.force_e[e, i] += f[i]


@njit
def _blend_spatial_forces(
    state: Heaped | None, part: SpatialBeam, at: SpatialConfiguration, e: int, f: Array, heap: Array
) -> None:
    """Make forces f (12,) of an element with its bow those that it has in its state; workspace heap (12,)."""
    if state is None:
        return
    if state.g == 1.0:
        return
    chord, L, w = at.chord[e], part.section.L[e], part.load[e]
    beam3d.write_heaped_forces(state, chord, at.frame1[e], at.frame2[e], L, w, heap)
    blend_forces(state, chord, L, _more_than_in_spatial_heap(state, part, at, e), f, heap)


@njit
def _more_than_in_spatial_heap(state: Heaped, part: SpatialBeam, at: SpatialConfiguration, e: int) -> float:
    """Energy [J] of an element with its bow less that in a heap."""
    L, chord = part.section.L[e], at.chord[e]
    local = beam3d.element_shape(e, at.chord, at.frame1, at.frame2, part.section)
    bowed = beam3d.element_energy(e, local, part.reference, part.section)
    bowed += beam3d.element_potential(local, L, vector(part.load[e]), beam3d.STILL)
    spring = beam3d.heaped_energy(state, chord, at.frame1[e], at.frame2[e], L)
    return bowed - spring - beam3d.heaped_load_potential(at.frame1[e], at.frame2[e], L, part.load[e])


@add_tangent.of(PlanarBeam)
def _planar_tangent(part: PlanarBeam, at: PlanarConfiguration, maps: Maps, weights: Weights, K: Array) -> None:
    f, own, heap, heap_own = np.empty(6), np.empty((6, 6)), np.empty(6), np.empty((6, 6))
    for e in range(part.load.shape[0]):
        local = corotated(at, e)
        beam2d.write_element(e, local, part.reference, part.section, f, own)
        beam2d.add_load_tangent(local, part.section.L[e], part.load[e], own)
        state = heaped(part.section.law, e, at.chord[e], part.section.L[e], part.section.EA[e])
        _blend_planar_tangent(state, part, at, e, local, f, own, heap, heap_own)
        for i in range(6):
            for j in range(6):
                K[e, i, j] += weights.force * own[i, j]


@njit
def _blend_planar_tangent(
    state: Heaped | None,
    part: PlanarBeam,
    at: PlanarConfiguration,
    e: int,
    local: beam2d.PlanarCorotated,
    f: Array,
    K: Array,
    heap: Array,
    heap_K: Array,
) -> None:
    """Make the tangent K (6, 6) of an element with its bow and forces f (6,), to which the load's are added, that in
    its state; workspaces of both.
    """
    if state is None:
        return
    if state.g == 1.0:
        return
    chord, L, w, turned = at.chord[e], part.section.L[e], part.load[e], at.end_angle[e]
    beam2d.add_load_forces(local, L, w, f)
    beam2d.write_heaped_forces(state, chord, turned[0], turned[1], L, w, heap)
    beam2d.write_heaped_tangent(state, turned[0], turned[1], L, w, heap_K)
    blend_tangent(state, chord, L, _more_than_in_planar_heap(state, part, at, e, local), f, K, heap, heap_K)


@add_tangent.of(SpatialBeam)
def _spatial_tangent(part: SpatialBeam, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array) -> None:
    f, own, workspace = np.empty(12), np.empty((12, 12)), beam3d.tangent_workspace()
    heap, heap_own = np.empty(12), np.empty((12, 12))
    for e in range(part.load.shape[0]):
        beam3d.write_element(
            e, at.chord, at.frame1, at.frame2, part.reference, part.section, part.load, workspace, f, own
        )
        state = heaped(part.section.law, e, at.chord[e], part.section.L[e], part.section.EA[e])
        _blend_spatial_tangent(state, part, at, e, f, own, heap, heap_own)
        rotations.tangent_to_increments(e, f, own, at.H, at.Rn, at.Theta)
        for i in range(12):
            for j in range(12):
                K[e, i, j] += weights.force * own[i, j]


@njit
def _blend_spatial_tangent(
    state: Heaped | None,
    part: SpatialBeam,
    at: SpatialConfiguration,
    e: int,
    f: Array,
    K: Array,
    heap: Array,
    heap_K: Array,
) -> None:
    """Make forces f (12,) and tangent K (12, 12) of an element with its bow those in its state; workspaces of both."""
    if state is None:
        return
    if state.g == 1.0:
        return
    chord, L, more = at.chord[e], part.section.L[e], _more_than_in_spatial_heap(state, part, at, e)
    beam3d.write_heaped_forces(state, chord, at.frame1[e], at.frame2[e], L, part.load[e], heap)
    beam3d.write_heaped_tangent(state, at.frame1[e], at.frame2[e], L, part.load[e], heap_K)
    blend_tangent(state, chord, L, more, f, K, heap, heap_K)
    blend_forces(state, chord, L, more, f, heap)


@add_energy.of(PlanarBeam)
def _planar_energy(part: PlanarBeam, at: PlanarConfiguration, energy: Array) -> None:
    section, load = part.section, part.load
    for e in range(part.load.shape[0]):
        local, x, L = corotated(at, e), at.x, part.section.L[e]
        stored = beam2d.element_energy(e, local, part.reference, section)
        by_bow = beam2d.load_potential(local, L, load[e], 0.0, 0.0)
        state = heaped(section.law, e, at.chord[e], L, section.EA[e])
        stored, by_bow = _blended_planar_energy(state, at, e, L, load[e], stored, by_bow)
        energy[1] += stored
        energy[2] += by_bow
        for i in range(2):
            energy[2] -= 0.5 * L * load[e, i] * (x[e, i] + x[e + 1, i])


@njit
def _blended_planar_energy(
    state: Heaped | None, at: PlanarConfiguration, e: int, L: float, w: Array, stored: float, by_bow: float
) -> tuple[float, float]:
    """Strain energy of an element in its state, and potential of the load w on its bow [J], from those with its bow."""
    if state is None:
        return stored, by_bow
    if state.g == 1.0:
        return stored, by_bow
    chord, turned = at.chord[e], at.end_angle[e]
    spring = beam2d.heaped_energy(state, chord, turned[0], turned[1], L)
    potential = beam2d.heaped_load_potential(turned[0], turned[1], L, w)
    return blended(state, stored, spring), blended(state, by_bow, potential)


@add_energy.of(SpatialBeam)
def _spatial_energy(part: SpatialBeam, at: SpatialConfiguration, energy: Array) -> None:
    section, load = part.section, part.load
    for e in range(part.load.shape[0]):
        local, x, L = beam3d.element_shape(e, at.chord, at.frame1, at.frame2, part.section), at.x, part.section.L[e]
        stored = beam3d.element_energy(e, local, part.reference, section)
        by_bow = beam3d.element_potential(local, L, vector(load[e]), beam3d.STILL)
        state = heaped(section.law, e, at.chord[e], L, section.EA[e])
        stored, by_bow = _blended_spatial_energy(state, at, e, L, load[e], stored, by_bow)
        energy[1] += stored
        energy[2] += by_bow
        for i in range(3):
            energy[2] -= 0.5 * L * load[e, i] * (x[e, i] + x[e + 1, i])


@njit
def _blended_spatial_energy(
    state: Heaped | None, at: SpatialConfiguration, e: int, L: float, w: Array, stored: float, by_bow: float
) -> tuple[float, float]:
    """Strain energy of an element in its state, and potential of the load w on its bow [J], from those with its bow."""
    if state is None:
        return stored, by_bow
    if state.g == 1.0:
        return stored, by_bow
    chord, frame1, frame2 = at.chord[e], at.frame1[e], at.frame2[e]
    spring = beam3d.heaped_energy(state, chord, frame1, frame2, L)
    potential = beam3d.heaped_load_potential(frame1, frame2, L, w)
    return blended(state, stored, spring), blended(state, by_bow, potential)
