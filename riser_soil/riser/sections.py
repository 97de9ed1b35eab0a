"""Section properties of the line: from line types and segments to arrays per element."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Self

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.errors import SceneError
from riser_soil.riser.slack import law_of
from riser_soil.riser.tension_only import BOWED, Law

CHAIN = 1e-18  # EI of an element without bending stiffness, over EA L^2: below the round-off of its other stiffnesses


@dataclass(frozen=True)
class SectionProperties:
    """Section properties. Diameters m; mass kg/m, empty, in air; EA N; EI_y, EI_z, GJ N m2; submerged_weight
    N/m.

    EI_y and EI_z are about the second and third section axis. A given submerged weight overrides the computed
    one.
    drag and added_mass: (normal, tangential) coefficients of Morison's formula, see
    `riser_soil.sea.morison_law`. vortices: coefficient Cv of their force, middle and half width of the range of
    frequencies that shedding locks to, see `riser_soil.sea.vortex_law`; zeros for none. in_line_vortices: the same of
    that in line with the flow.
    rotary_inertia: kg m about an axis across the pipe; None computes it from masses and diameters. The inertia about
    the pipe's own axis follows, see `polar_inertia`.
    damping: s, ratio of viscous to elastic stiffness. min_bend_radius: m, the least that is allowed; 0 for any.
    max_tension: N, the largest that is allowed; 0 for any. wall_outer_diameter, wall_inner_diameter: m, of the wall
    that bears the stress, 0 where there is none; allowable_stress: Pa, 0 for any. bare_diameter: m, of the pipe inside
    a coat or buoyancy modules, 0 where outer_diameter is the pipe's own.
    """

    EA: float
    EI_y: float
    EI_z: float
    GJ: float = 0.0
    outer_diameter: float = 0.0
    inner_diameter: float = 0.0
    mass: float = 0.0
    submerged_weight: float | None = None
    drag: tuple[float, float] = (0.0, 0.0)
    added_mass: tuple[float, float] = (0.0, 0.0)
    vortices: tuple[float, float, float] = (0.0, 0.0, 0.0)
    in_line_vortices: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotary_inertia: float | None = 0.0
    damping: float = 0.0
    min_bend_radius: float = 0.0
    max_tension: float = 0.0
    wall_outer_diameter: float = 0.0
    wall_inner_diameter: float = 0.0
    allowable_stress: float = 0.0
    bare_diameter: float = 0.0

    @property
    def pipe_diameter(self) -> float:
        return self.wall_outer_diameter or self.bare_diameter or self.outer_diameter

    @property
    def pipe_bore(self) -> float:
        return self.wall_inner_diameter or self.inner_diameter

    @property
    def pipe_EI_y(self) -> float:
        return self.EI_y

    @property
    def pipe_EI_z(self) -> float:
        return self.EI_z


@dataclass(frozen=True)
class MeshedSegment:
    """A run of elements of one line type: their unstressed lengths in m."""

    line_type: SectionProperties
    lengths: tuple[float, ...]

    @classmethod
    def even(cls, line_type: SectionProperties, length: float, elements: int) -> Self:
        """Equal elements that add up to a length [m]."""
        return cls(line_type, (length / elements,) * elements)


@dataclass(frozen=True)
class Surroundings:
    """Fluids in and around the pipe: densities in kg/m3 (0: nothing), gravity in m/s2."""

    gravity: float = 9.81
    contents: float = 0.0
    water: float = 0.0


@dataclass(frozen=True, eq=False)
class Elements:
    """Properties per element (ne,); drag and added_mass (ne, 2), vortices and in_line_vortices (ne, 3).

    mass includes the contents, weight is submerged. rotary_inertia: kg m about an axis across the pipe, polar_inertia:
    about its own; damping: s, of viscous over elastic stiffness.
    min_bend_radius: m, the least that is allowed, max_tension: N and allowable_stress: Pa, the largest; 0 for any.
    wall_outer_diameter, wall_inner_diameter: m, of the wall that bears the stress, 0 where there is none.
    pipe_diameter and pipe_bore: m, on which the pressures act for the wall tension: those of the wall, if any, else of
    the pipe without coat, modules, stiffener or growth around it; pipe_EI_y, pipe_EI_z: N m2, without a stiffener.
    """

    length: Array
    EA: Array
    EI_y: Array
    EI_z: Array
    GJ: Array
    outer_diameter: Array
    inner_diameter: Array
    mass: Array
    weight: Array
    drag: Array
    added_mass: Array
    vortices: Array
    in_line_vortices: Array
    rotary_inertia: Array
    polar_inertia: Array
    damping: Array
    min_bend_radius: Array
    max_tension: Array
    wall_outer_diameter: Array
    wall_inner_diameter: Array
    allowable_stress: Array
    pipe_diameter: Array
    pipe_bore: Array
    pipe_EI_y: Array
    pipe_EI_z: Array

    @property
    def bends(self) -> BoolArray:
        """Whether an element has bending stiffness (ne,), or is a chain's."""
        return np.asarray(self.EI_y > 0.0)

    @cached_property
    def limits_bending(self) -> bool:
        """Whether any least bend radius is given."""
        return bool(self.min_bend_radius.any())

    @cached_property
    def limits_tension(self) -> bool:
        """Whether any largest tension is given."""
        return bool(self.max_tension.any())

    @cached_property
    def bends_beside(self) -> Array:
        """1 at nodes (nn,) beside an element with bending stiffness, else 0."""
        return larger_beside(self.bends.astype(float))

    @cached_property
    def larger_EI(self) -> Array:
        """The larger EI (ne,) about a section axis [N.m2]."""
        return np.maximum(self.EI_y, self.EI_z)

    @cached_property
    def flexibility(self) -> tuple[Array, Array]:
        """1/EI (ne,) about both section axes [1/(N.m2)], 0 of a chain: no moment bends it."""
        y, z = (np.divide(1.0, EI, out=np.zeros_like(EI), where=self.bends) for EI in (self.EI_y, self.EI_z))
        return y, z

    @property
    def borne_by_pipe(self) -> Array:
        """Share (ne, 2) of the moments about both section axes that the pipe bears, a bend stiffener the rest."""
        pipe, both = (np.column_stack(EI) for EI in ((self.pipe_EI_y, self.pipe_EI_z), (self.EI_y, self.EI_z)))
        return np.divide(pipe, both, out=np.ones_like(both), where=both > 0.0)

    def stiffness(self) -> tuple[Array, Array]:
        """EI (ne,) about both section axes as the elements have it; of a chain too little to count, for each node's
        turn needs a stiffness.
        """
        chain = CHAIN * self.EA * self.length**2
        return np.where(self.bends, self.EI_y, chain), np.where(self.bends, self.EI_z, chain)

    @cached_property
    def axial_law(self) -> Law:
        """How elements without bending stiffness go slack, if there are any."""
        return law_of(self.bends, self.weight, self.length, self.EA)

    @property
    def loose(self) -> Array:
        """Chords (ne,) [m] below which elements without bending stiffness lie in a heap, 0 of others."""
        return np.where(self.bends, 0.0, BOWED * self.length)

    @property
    def arc(self) -> Array:
        """Arc length of the nodes (nn,), m from the start."""
        return np.concatenate([[0.0], np.cumsum(self.length)])


def larger_beside(values: Array) -> Array:
    """The larger (nn,) of what the two elements beside a node have (ne,), never negative."""
    return np.maximum(np.append(values, 0.0), np.append(0.0, values))


def mass_with_contents(line: SectionProperties, around: Surroundings) -> float:
    """Mass of pipe and contents, kg/m."""
    return line.mass + around.contents * 0.25 * np.pi * line.inner_diameter**2


def rotary_inertia(line: SectionProperties, around: Surroundings) -> float:
    """(m (do^2 + di^2) + m_contents di^2)/16 [kg m] about an axis across the pipe, unless it is given.

    The wall's mass m is spread evenly between the diameters; the contents turn with the pipe.
    """
    return _of_round_section(line, around) if line.rotary_inertia is None else line.rotary_inertia


def _of_round_section(line: SectionProperties, around: Surroundings) -> float:
    """Rotary inertia [kg m] about an axis across a pipe of these diameters."""
    outside, inside = line.outer_diameter**2, line.inner_diameter**2
    return (line.mass * outside + mass_with_contents(line, around) * inside) / 16.0


def polar_inertia(line: SectionProperties, around: Surroundings) -> float:
    """Inertia [kg m] about the pipe's own axis: twice that across it, or, where none is given, twice that of the
    diameters. Without diameters m (EI_y + EI_z)/EA, as for a homogeneous section. Never zero but for a massless pipe.
    """
    if across := rotary_inertia(line, around):
        return 2.0 * across
    if line.outer_diameter > 0.0:
        return 2.0 * _of_round_section(line, around)
    return mass_with_contents(line, around) * (line.EI_y + line.EI_z) / line.EA


def submerged_weight(line: SectionProperties, around: Surroundings) -> float:
    """g (m + rho_contents pi di^2/4 - rho_water pi do^2/4), N/m, unless it is given."""
    if line.submerged_weight is not None:
        return line.submerged_weight
    buoyancy = around.water * 0.25 * np.pi * line.outer_diameter**2
    return around.gravity * (mass_with_contents(line, around) - buoyancy)


def elements(segments: Sequence[MeshedSegment], around: Surroundings) -> Elements:
    """Properties of all elements, from start to end."""
    if not segments:
        raise SceneError("riser.segments: none given; at least one is needed")
    count = np.array([len(s.lengths) for s in segments])

    def spread(name: str) -> Array:
        values = [_property(s.line_type, around, name) for s in segments]
        return np.repeat(np.asarray(values, dtype=float), count, axis=0)

    names = (each.name for each in fields(Elements) if each.name != "length")
    return Elements(np.concatenate([s.lengths for s in segments]), **{name: spread(name) for name in names})


_WITH_SURROUNDINGS: dict[str, Callable[[SectionProperties, Surroundings], float]] = {
    "mass": mass_with_contents,
    "weight": submerged_weight,
    "rotary_inertia": rotary_inertia,
    "polar_inertia": polar_inertia,
}


def _property(line: SectionProperties, around: Surroundings, name: str) -> float | tuple[float, float]:
    """One of an element: the line type's own of that name, but for what the surroundings take part in."""
    value: float | tuple[float, float]
    value = _WITH_SURROUNDINGS[name](line, around) if name in _WITH_SURROUNDINGS else getattr(line, name)
    return value
