"""Consistent mass of the line: the part "inertia" of dynamic stages."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import State, Traits
from riser_soil.riser.attachments import Masses
from riser_soil.riser.compiled_part import CompiledPart
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.hermite import add_mass_to, add_weighed, consistent_mass
from riser_soil.riser.line import Line
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent


class Mass(NamedTuple):
    """Mass matrices along the elements, M (ne, 4, 4) [kg], as in `hermite.weigh`; masses at the line's ends (2,)."""

    M: Array
    ends: Array


class Inertia(CompiledPart):
    """Consistent mass of the cubic line and of what is attached to it, turning with the tangents (group I).

    line: the riser's field. mass: kg/m per element (ne,), contents included, water excluded. attached: further masses.
    The section's own rotary inertia is left out: it is (diameter/wavelength)^2 of the rest.
    The tangent is not symmetric, as the tangents' accelerations depend on their rates.
    """

    name = "inertia"
    traits = Traits("I", symmetric=False)

    def __init__(self, line: Line, mass: Array, attached: Masses | None = None) -> None:
        super().__init__(line)
        along = consistent_mass(line.length, mass)
        ends: Array = np.zeros(2)
        if attached is not None:
            along, ends = along + attached.along, attached.ends
        self._mass = Mass(along, ends)

    @property
    def M(self) -> Array:
        """Mass matrices of the elements (ne, 4, 4), with what sits at the line's ends."""
        M = self._mass.M.copy()
        M[0, 0, 0] += self._mass.ends[0]
        M[-1, 2, 2] += self._mass.ends[1]
        return M

    def make_kernel_data(self) -> Mass:
        return self._mass

    def nodal_forces(self, state: State) -> Array | None:
        return self.forces_on_nodes(state) if self._mass.ends.any() else None


@add_forces.of(Mass)
def _add_forces(part: Mass, at: Configuration, out: LineForces) -> None:
    add_weighed(part.M, at.acceleration, out.inertia_q, at.D)
    last = at.a.shape[0] - 1
    for i in range(len(at.D)):
        out.inertia[0, i] += part.ends[0] * at.a[0, i]
        out.inertia[last, i] += part.ends[1] * at.a[last, i]


@add_tangent.of(Mass)
def _add_tangent(part: Mass, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
    add_mass_to(K, weights.inertia, at.P, maps.acceleration_rows, part.M, at.D, at.R)
    follows, last, second = weights.inertia * maps.shift_a, K.shape[0] - 1, K.shape[1] // 2
    for i in range(len(at.D)):
        K[0, i, i] += follows * part.ends[0]
        K[last, second + i, second + i] += follows * part.ends[1]


@add_energy.of(Mass)
def _add_energy(part: Mass, at: Configuration, energy: Array) -> None:
    last = at.v.shape[0] - 1
    for i in range(len(at.D)):
        energy[0] += 0.5 * (part.ends[0] * at.v[0, i] ** 2 + part.ends[1] * at.v[last, i] ** 2)
    for e in range(part.M.shape[0]):
        for i in range(len(at.D)):
            for a in range(4):
                momentum = 0.0
                for b in range(4):
                    momentum += part.M[e, a, b] * at.rate[e, b, i]
                energy[0] += 0.5 * at.rate[e, a, i] * momentum
