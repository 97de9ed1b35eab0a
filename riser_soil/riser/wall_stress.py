"""Stress in the wall of a round pipe from wall tension, bending, torsion and pressure.

A point of the section lies at the radius r and the angle theta from the section's y axis towards its z axis:

    axial   T_w/A + (M_y sin theta - M_z cos theta) r/I
    hoop    (p_i a^2 - p_o b^2)/(b^2 - a^2) + (p_i - p_o) a^2 b^2/((b^2 - a^2) r^2)
    radial  the same with a minus between its terms: -p_i inside, -p_o outside
    shear   M_x r/(2 I), of torsion; that of the transverse force, largest where bending does nothing, is left out

with the inner and outer radius a and b, A = pi (b^2 - a^2), I = pi/4 (b^4 - a^4). Stresses are positive in tension.
Sources: Lame's tube by Timoshenko and Goodier, Theory of Elasticity, 3rd ed. (1970), article 28; wall tension by
Sparks, see `wall_tension`; von Mises' stress as in API STD 2RD (2013) and DNV-ST-F201 (2018).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array


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
