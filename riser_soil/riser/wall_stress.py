"""The pipe's wall: its sections, its tension from effective tension and pressures, and its stress.

A point of the section lies at the radius r and the angle theta from the section's y axis towards its z axis:

    axial   T_w/A + (M_y sin theta - M_z cos theta) r/I
    hoop    (p_i a^2 - p_o b^2)/(b^2 - a^2) + (p_i - p_o) a^2 b^2/((b^2 - a^2) r^2)
    radial  the same with a minus between its terms: -p_i inside, -p_o outside
    shear   M_x r/(2 I), of torsion; that of the transverse force, largest where bending does nothing, is left out

with the inner and outer radius a and b, A = pi (b^2 - a^2), I = pi/4 (b^4 - a^4). Stresses are positive in tension.
Sources: Lame's tube by Timoshenko and Goodier, Theory of Elasticity, 3rd ed. (1970), article 28; wall tension by
Sparks, see `wall_tension`; von Mises' stress as in API STD 2RD (2013) and DNV-ST-F201 (2018).

Sections of the riser's wall: one at each node, two where unlike walls meet.

At a joint both walls bear the same effective tension, moments and pressures, on diameters of their own. In a bend
stiffener the pipe bears the share of the moments that it has of the stiffness.

Wall tension of the pipe from effective tension, internal and external pressure.

    T_w = T + p_i A_i - p_o A_o,    p_i = p + rho_i g (z_p - z),    p_o = rho_o g (z_s - z), at least 0.

A_i and A_o are areas of the pipe itself: a coat, buoyancy modules and a lining bear an axial force that is the pressure
around them times their own area, and nothing else.

The effective tension T is what carries, bends and stretches the line here: its elements strain by T/EA, to which
neither the pressures' action on closed ends nor Poisson's ratio add. Gauge pressures of fluids at rest: what waves and
the contents' acceleration add is left out. Source: Sparks, Journal of Energy Resources Technology 106 (1984).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.riser.sections import Elements


class Wall(NamedTuple):
    """The wall that bears the stress, by its diameters [m], each (...,)."""

    outer_diameter: Array
    inner_diameter: Array

    @property
    def thickness(self) -> Array:
        """m."""
        return 0.5 * (self.outer_diameter - self.inner_diameter)

    @property
    def area(self) -> Array:
        """m2."""
        return np.asarray(0.25 * np.pi * (self.outer_diameter**2 - self.inner_diameter**2))

    @property
    def second_moment(self) -> Array:
        """Second moment of area I [m4] about an axis across the pipe."""
        return np.asarray(np.pi / 64.0 * (self.outer_diameter**4 - self.inner_diameter**4))


class Loads(NamedTuple):
    """Loads on a section, each (...,): wall tension [N], moments about the section's axes [N m], exerted by the part
    towards the riser's end, inner and outer pressure [Pa].
    """

    tension: Array
    moment_y: Array
    moment_z: Array
    torque: Array
    inside: Array
    outside: Array

    @property
    def moment(self) -> Array:
        """Size of the bending moment [N m]."""
        return np.hypot(self.moment_y, self.moment_z)


def bending_stress(moment: Array, diameter: Array, wall: Wall) -> Array:
    """Largest bending stress [Pa] on a surface of this diameter [m], M r/I."""
    return np.asarray(0.5 * moment * diameter / wall.second_moment)


def axial_stress_at(angle: Array, loads: Loads, diameter: Array, wall: Wall) -> Array:
    """Stress along the pipe [Pa] at angles [rad] of the surface of this diameter [m]; arrays that broadcast."""
    arm = loads.moment_y * np.sin(angle) - loads.moment_z * np.cos(angle)
    return np.asarray(loads.tension / wall.area + bending_stress(arm, diameter, wall))


def hoop_and_radial_stress(loads: Loads, diameter: Array, wall: Wall) -> tuple[Array, Array]:
    """Lame's stresses [Pa] at a diameter [m] within the wall."""
    outer, inner = wall.outer_diameter**2, wall.inner_diameter**2
    mean = (loads.inside * inner - loads.outside * outer) / (outer - inner)
    change = (loads.inside - loads.outside) * inner * outer / ((outer - inner) * diameter**2)
    return mean + change, mean - change


def shear_stress(torque: Array, diameter: Array, wall: Wall) -> Array:
    """Shear stress of torsion [Pa] at a diameter [m]."""
    return np.asarray(0.25 * torque * diameter / wall.second_moment)


def von_mises(axial: Array, hoop: Array, radial: Array, shear: Array) -> Array:
    """Von Mises' stress [Pa]; the shear stress lies in the plane of axis and hoop."""
    normal = (axial - hoop) ** 2 + (hoop - radial) ** 2 + (radial - axial) ** 2
    return np.sqrt(0.5 * normal + 3.0 * shear**2)


def von_mises_at(angle: Array, loads: Loads, diameter: Array, wall: Wall) -> Array:
    """Von Mises' stress [Pa] at angles [rad] of the surface of this diameter [m]."""
    hoop, radial = hoop_and_radial_stress(loads, diameter, wall)
    axial = axial_stress_at(angle, loads, diameter, wall)
    return von_mises(axial, hoop, radial, shear_stress(loads.torque, diameter, wall))


def largest_von_mises(loads: Loads, wall: Wall) -> Array:
    """Largest von Mises' stress [Pa] around the section, inside and outside.

    Its square is a parabola of the axial stress that opens upwards, so it is largest where bending pulls or presses
    most: no point around is missed. Across the wall it is taken at both surfaces.
    """
    about_y = loads._replace(moment_y=loads.moment, moment_z=np.zeros_like(loads.moment))
    at = [
        von_mises_at(np.asarray(angle), about_y, diameter, wall)
        for angle in (0.5 * np.pi, -0.5 * np.pi)
        for diameter in wall
    ]
    return np.asarray(np.max(at, axis=0))


@dataclass(frozen=True, eq=False)
class WallSections:
    """Sections (ns,) with their node, in the order of the nodes; nodes without a wall beside them have none.

    allowable: stress [Pa], 0 where none is given.
    borne: shares (ns, 2) of the bending moments about y and z that the pipe bears itself.
    """

    node: IntArray
    wall: Wall
    allowable: Array
    borne: Array

    def loads(
        self, effective: Array, moment_y: Array, moment_z: Array, torque: Array, inside: Array, outside: Array
    ) -> Loads:
        """Loads (..., ns) from effective tension [N], moments [N m] and pressures [Pa] at nodes, each (..., nn)."""
        T, My, Mz, Mx, p_i, p_o = (
            values[..., self.node] for values in (effective, moment_y, moment_z, torque, inside, outside)
        )
        bore, outer = (0.25 * np.pi * d**2 for d in (self.wall.inner_diameter, self.wall.outer_diameter))
        borne_y, borne_z = self.borne.T
        return Loads(T + p_i * bore - p_o * outer, borne_y * My, borne_z * Mz, Mx, p_i, p_o)

    def at_nodes(self, values: Array, governing: Array, nodes: int) -> Array:
        """Values (..., ns) at the nodes (..., nn), of two sections that with more `governing` (..., ns), of equal ones
        the second; nan without a wall.
        """
        out, (first, second) = np.full((*values.shape[:-1], nodes), np.nan), self._of_nodes
        out[..., self.node] = values
        more = governing[..., first] > governing[..., second]
        out[..., self.node[first]] = np.where(more, values[..., first], values[..., second])
        return out

    @cached_property
    def _of_nodes(self) -> tuple[IntArray, IntArray]:
        """The sections of nodes that have two."""
        first = np.flatnonzero(self.node[1:] == self.node[:-1])
        return first, first + 1


def walls_of(elements: Elements) -> WallSections:
    """Sections of the elements' walls."""
    wall = Wall(elements.wall_outer_diameter, elements.wall_inner_diameter)
    return wall_sections(wall, elements.allowable_stress, elements.borne_by_pipe)


def wall_sections(wall: Wall, allowable: Array, borne: Array) -> WallSections:
    """Sections from what the elements have (ne,), borne (ne, 2); an outer diameter of 0 is no wall."""
    numbers = np.column_stack([*wall, allowable, borne])
    nodes = len(numbers) + 1
    before, after = np.insert(numbers, 0, 0.0, axis=0), np.append(numbers, np.zeros((1, numbers.shape[1])), axis=0)
    unlike = (before != after).any(axis=1)
    node = np.concatenate([np.arange(nodes)[unlike], np.arange(nodes)])
    rows = np.concatenate([before[unlike], after])
    walled = rows[:, 0] > 0.0
    order = np.argsort(node[walled], kind="stable")
    D, d, limit, *shares = rows[walled][order].T
    return WallSections(node[walled][order], Wall(D, d), limit, np.column_stack(shares))


@dataclass(frozen=True)
class HydrostaticPressure:
    """A fluid at rest: gauge pressure [Pa] at a level z [m], and its increase per depth [Pa/m]."""

    level: float
    per_depth: float
    pressure: float = 0.0

    def at(self, z: Array) -> Array:
        """Pressure [Pa]."""
        return self.pressure + self.per_depth * (self.level - z)


@dataclass(frozen=True, eq=False)
class Pressures:
    """Fluids inside and outside a pipe, None where there is none.

    inner_diameter, outer_diameter: (ne,) m, of the pipe itself, see `Elements.pipe_diameter`. At a joint the areas are
    the means of both sides, as section forces are.
    """

    inside: HydrostaticPressure | None
    outside: HydrostaticPressure | None
    inner_diameter: Array
    outer_diameter: Array

    def at(self, z: Array, more: Array | float = 0.0) -> tuple[Array, Array]:
        """Pressure inside and outside [Pa] at heights (..., nn) [m]; 0 where there is no fluid.

        more (...): pressure inside beyond that of the fluid [Pa], as when a stage changes it.
        """
        inside, outside = (np.zeros_like(z) if fluid is None else fluid.at(z) for fluid in (self.inside, self.outside))
        return inside + np.asarray(more)[..., None], np.maximum(outside, 0.0)

    def wall_tension(self, effective: Array, z: Array, more: Array | float = 0.0) -> Array:
        """N, positive in tension, from the effective tension [N] and the heights [m] of the nodes, each (..., nn).

        more: as of `at`.
        """
        wall, (bore, around) = effective, self._areas
        if self.inside is not None:
            wall = wall + (self.inside.at(z) + np.asarray(more)[..., None]) * bore
        if self.outside is not None:
            wall = wall - np.maximum(self.outside.at(z), 0.0) * around
        return wall

    @cached_property
    def _areas(self) -> tuple[Array, Array]:
        return _areas_at_nodes(self.inner_diameter), _areas_at_nodes(self.outer_diameter)


def _areas_at_nodes(diameter: Array) -> Array:
    area = 0.25 * np.pi * diameter**2
    return np.asarray(0.5 * (np.append(area[0], area) + np.append(area, area[-1])))
