"""Structural damping in proportion to the elastic stiffness: the part "structural damping" of dynamic stages."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.part import State, Traits, Weights, Work
from riser_soil.riser import beam2d, beam3d, damping2d, damping3d, rotations
from riser_soil.riser.beam import corotated
from riser_soil.riser.configuration import Configuration, Maps, PlanarConfiguration, SpatialConfiguration
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent
from riser_soil.riser.sections import Elements
from riser_soil.riser.stiffness import LineStiffness, viscosity
from riser_soil.riser.tension_only import Heaped, blend_viscous_forces, blend_viscous_tangent, heaped
from riser_soil.riser.vectors import matrix, matvec, vector


class PlanarViscosity(NamedTuple):
    """Viscous elements of a plane line; workspace for the rates of the chords (ne, 2)."""

    viscosity: LineStiffness
    chord_rate: Array


class SpatialViscosity(NamedTuple):
    """Viscous elements of a line in space; workspace for the rates of the chords (ne, 3) and spatial spins (nn, 3)."""

    viscosity: LineStiffness
    chord_rate: Array
    spin: Array


class StructuralDamping(CompiledPart):
    """Stiffness-proportional damping (group F): stresses beta D times the strains' rates, D the elastic stiffnesses.

    line: the riser's field. elements.damping: beta [s] per element. A mode of angular frequency w has the damping
    ratio beta w / 2; rigid motions have none. In a plane forces and tangent cost a quarter of those in space
    (`benchmarks.twins`).
    """

    line: Line

    name, traits = "structural damping", Traits("F", symmetric=False)

    def __init__(self, line: Line, elements: Elements) -> None:
        super().__init__(line)
        self._elements = elements

    def make_kernel_data(self) -> PlanarViscosity | SpatialViscosity:
        ne, stiffness = self.line.length.size, self._elements.stiffness(self.line.length)
        viscous = viscosity(stiffness, self._elements.damping)
        if self.line.dimension == 2:
            return PlanarViscosity(viscous, np.empty((ne, 2)))
        return SpatialViscosity(viscous, np.empty((ne, 3)), np.empty((ne + 1, 3)))

    def viscous_forces(self, state: State) -> Array:
        return self.element_forces(state)

    def work(self, before: State, after: State) -> Work:
        """Energy that the mean forces take out over the step."""
        return Work(dissipated=self.work_against(before, after))


@njit
def _write_chord_rates(v: Array, out: Array) -> None:
    """Rates of the chords (ne, d) from those of the dofs (nn, ndof)."""
    for e in range(out.shape[0]):
        for i in range(out.shape[1]):
            out[e, i] = v[e + 1, i] - v[e, i]


@njit
def _state(part: PlanarViscosity | SpatialViscosity, at: Configuration, e: int) -> Heaped | None:
    """State of element e, with its viscosity in place of its stiffness."""
    state: Heaped | None = heaped(part.viscosity.law, e, at.chord[e], part.viscosity.L[e], part.viscosity.EA[e])
    return state


@njit
def _blend_forces(state: Heaped | None, chord_rate: Array, f: Array) -> None:
    """Make the forces of an element with its bow those in its state. chord_rate (d,): of the element [m/s]."""
    if state is None:
        return
    if state.g < 1.0:
        blend_viscous_forces(state, chord_rate, f)


@add_forces.of(PlanarViscosity)
def _planar_forces(part: PlanarViscosity, at: PlanarConfiguration, out: LineForces) -> None:
    f = np.empty(6)
    _write_chord_rates(at.v, part.chord_rate)
    for e in range(at.chord.shape[0]):
        local = corotated(at, e)
        damping2d.write_element_forces(e, local, part.viscosity, part.chord_rate, at.v[:, 2], f)
        _blend_forces(_state(part, at, e), part.chord_rate[e], f)
        for i in range(6):
            out.force_e[e, i] += f[i]


@add_tangent.of(PlanarViscosity)
def _planar_tangent(part: PlanarViscosity, at: PlanarConfiguration, maps: Maps, weights: Weights, K: Array) -> None:
    own, f = np.empty((6, 6)), np.empty(6)
    for e in range(at.chord.shape[0]):
        local, rates = corotated(at, e), (part.chord_rate, at.v[:, 2])
        damping2d.write_element_tangent(e, local, part.viscosity, *rates, weights.shift_v, own)
        _blend_planar_tangent(_state(part, at, e), part, at, e, local, weights.shift_v, f, own)
        for i in range(6):
            for j in range(6):
                K[e, i, j] += weights.force * own[i, j]


@njit
def _blend_planar_tangent(
    state: Heaped | None,
    part: PlanarViscosity,
    at: PlanarConfiguration,
    e: int,
    local: beam2d.PlanarCorotated,
    shift_v: float,
    f: Array,
    K: Array,
) -> None:
    """Make the tangent K (6, 6) of element e with its bow that in its state; workspace f (6,)."""
    if state is None:
        return
    if state.g < 1.0:
        rate, L = part.chord_rate, part.viscosity.L[e]
        damping2d.write_element_forces(e, local, part.viscosity, rate, at.v[:, 2], f)
        blend_viscous_tangent(state, at.chord[e], L, rate[e], shift_v, f, K)


@add_forces.of(SpatialViscosity)
def _spatial_forces(part: SpatialViscosity, at: SpatialConfiguration, out: LineForces) -> None:
    f = np.empty(12)
    _write_chord_rates(at.v, part.chord_rate)
    for n in range(at.v.shape[0]):
        spin = matvec(matrix(at.frames[n]), vector(at.v[n, 3:]))
        part.spin[n, 0], part.spin[n, 1], part.spin[n, 2] = spin
    for e in range(at.chord.shape[0]):
        local = beam3d.element_shape(e, at.chord, at.frame1, at.frame2, part.viscosity)
        damping3d.write_element_forces(e, local, part.viscosity, part.chord_rate, part.spin, f)
        _blend_forces(_state(part, at, e), part.chord_rate[e], f)
        rotations.element_to_increments(e, f, at.H)
        for i in range(12):
            out.force_e[e, i] += f[i]


@add_tangent.of(SpatialViscosity)
def _spatial_tangent(
    part: SpatialViscosity, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array
) -> None:
    own, f, nodes = np.empty((12, 12)), np.empty(12), damping3d.NodeRotations(at.frames, at.H, at.Rn, at.Theta)
    rates = part.chord_rate, part.spin
    for e in range(at.chord.shape[0]):
        local = beam3d.element_shape(e, at.chord, at.frame1, at.frame2, part.viscosity)
        damping3d.write_element_tangent(e, local, part.viscosity, *rates, nodes, weights.shift_v, own)
        _blend_spatial_tangent(_state(part, at, e), part, at, e, local, weights.shift_v, f, own)
        for i in range(12):
            for j in range(12):
                K[e, i, j] += weights.force * own[i, j]


@njit
def _blend_spatial_tangent(
    state: Heaped | None,
    part: SpatialViscosity,
    at: SpatialConfiguration,
    e: int,
    local: beam3d.Shape,
    shift_v: float,
    f: Array,
    K: Array,
) -> None:
    """Make the tangent K (12, 12) of element e with its bow that in its state; workspace f (12,)."""
    if state is None:
        return
    if state.g < 1.0:
        rate, L = part.chord_rate, part.viscosity.L[e]
        damping3d.write_element_forces(e, local, part.viscosity, rate, part.spin, f)
        rotations.element_to_increments(e, f, at.H)
        blend_viscous_tangent(state, at.chord[e], L, rate[e], shift_v, f, K)


@add_energy.of(PlanarViscosity)
@add_energy.of(SpatialViscosity)
def _energy(part: PlanarViscosity | SpatialViscosity, at: PlanarConfiguration, energy: Array) -> None:
    """Nothing is stored."""
