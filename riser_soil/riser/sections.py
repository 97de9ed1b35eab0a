"""Section properties of a line: arrays by element."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.riser.slack import law_of
from riser_soil.riser.stiffness import LineStiffness, Stiffness
from riser_soil.riser.tension_only import BOWED

CHAIN = 1e-18  # EI of an element without bending stiffness, over EA L^2: below the round-off of its other stiffnesses


@dataclass(frozen=True)
class Surroundings:
    """Fluids in and around the pipe: densities in kg/m3 (0: nothing), gravity in m/s2."""

    gravity: float = 9.81
    contents: float = 0.0
    water: float = 0.0


@dataclass(frozen=True, eq=False)
class Elements:
    """Properties by element (ne,).

    Lengths and diameters m, EA N, EI_y, EI_z and GJ N m2. mass kg/m: with the contents. weight N/m: submerged.
    drag and added_mass (ne, 2): normal and tangential coefficients of Morison's formula, see
    `riser_soil.sea.morison_law`. vortices (ne, 3): coefficient Cv of their force, middle and half width of the range of
    frequencies that shedding locks to, see `riser_soil.sea.vortex_law`; zeros for none. in_line_vortices (ne, 3): of
    the force in line with the flow.
    rotary_inertia kg m: about an axis across the pipe; the wall's mass is spread evenly between the diameters, and the
    contents turn with it. polar_inertia kg m: about its own axis, twice that across it; where that is zero, twice that
    of the diameters; without diameters m (EI_y + EI_z)/EA, as for a homogeneous section. It is zero for a massless pipe
    alone. damping: s, of viscous over elastic stiffness.
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

    def stiffness(self, L: Array) -> LineStiffness:
        """Stiffnesses of elements of the lengths L (ne,) [m]; EI of a chain is too little to count, for each node's
        turn needs a stiffness. Elements without bending stiffness go slack.
        """
        chain = CHAIN * self.EA * self.length**2
        EI_y, EI_z = (np.where(self.bends, EI, chain) for EI in (self.EI_y, self.EI_z))
        return Stiffness(L, self.EA, EI_y, EI_z, self.GJ, law_of(self.bends, self.weight, self.length, self.EA))

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


NOT_GIVEN: dict[str, float | tuple[float, ...]] = {  # properties that a pipe need not have
    "GJ": 0.0,
    "outer_diameter": 0.0,
    "inner_diameter": 0.0,
    "mass": 0.0,
    "drag": (0.0, 0.0),
    "added_mass": (0.0, 0.0),
    "vortices": (0.0, 0.0, 0.0),
    "in_line_vortices": (0.0, 0.0, 0.0),
    "damping": 0.0,
    "min_bend_radius": 0.0,
    "max_tension": 0.0,
    "wall_outer_diameter": 0.0,
    "wall_inner_diameter": 0.0,
    "allowable_stress": 0.0,
    "pipe_diameter": 0.0,
}


def elements(
    lengths: Sequence[float] | Array,
    around: Surroundings,
    *,
    EA: float,
    EI_y: float,
    EI_z: float,
    submerged_weight: float | None = None,
    rotary_inertia: float | None = 0.0,
    **properties: float | tuple[float, ...] | None,
) -> Elements:
    """Elements of one kind of pipe, by their unstressed lengths [m].

    EI_y and EI_z are about the second and third section axis. submerged_weight and rotary_inertia: None computes them
    from masses and diameters. properties: those of NOT_GIVEN, whose values stand for what is missing or None; mass is
    the empty pipe's in air, pipe_diameter is the pipe's inside a coat or buoyancy modules.
    """
    own: dict[str, Any] = NOT_GIVEN | {name: value for name, value in properties.items() if value is not None}
    mass, outer, inner = own["mass"], own["outer_diameter"], own["inner_diameter"]
    filled = mass + around.contents * 0.25 * np.pi * inner**2
    of_round_section = (mass * outer**2 + filled * inner**2) / 16.0
    across = of_round_section if rotary_inertia is None else rotary_inertia
    polar = 2.0 * of_round_section if outer > 0.0 else filled * (EI_y + EI_z) / EA
    displaced = around.water * 0.25 * np.pi * outer**2
    values = own | {
        "EA": EA,
        "EI_y": EI_y,
        "EI_z": EI_z,
        "mass": filled,
        "weight": around.gravity * (filled - displaced) if submerged_weight is None else submerged_weight,
        "rotary_inertia": across,
        "polar_inertia": 2.0 * across or polar,
        "pipe_diameter": own["wall_outer_diameter"] or own["pipe_diameter"] or outer,
        "pipe_bore": own["wall_inner_diameter"] or inner,
        "pipe_EI_y": EI_y,
        "pipe_EI_z": EI_z,
    }
    each = {name: np.repeat(np.array([value], dtype=float), len(lengths), axis=0) for name, value in values.items()}
    return Elements(np.array(lengths, dtype=float), **each)


def joined(segments: Sequence[Elements]) -> Elements:
    """The elements of several segments, one after the other."""
    names = [each.name for each in fields(Elements)]
    return Elements(*(np.concatenate([getattr(segment, name) for segment in segments]) for name in names))
