"""What adds to the elements' section, stiffness, mass and weight: a tapered bend stiffener, marine growth."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser.sections import Elements, Surroundings

POINTS = 4  # of Gauss, over the part of an element that it covers: exact for diameters to the seventh power


@dataclass(frozen=True)
class Taper:
    """A cone around the pipe from an end of the riser on: length [m], outer diameters at its base, which is at the end,
    and at its tip [m], Young's modulus E [Pa] and density [kg/m3] of its material. It bends with the pipe and adds
    nothing to EA and GJ.
    """

    length: float
    base_diameter: float
    tip_diameter: float
    E: float
    density: float

    def diameter(self, distance: Array) -> Array:
        """Outer diameter [m] at distances from its base [m]."""
        return self.base_diameter + (self.tip_diameter - self.base_diameter) * distance / self.length


def with_taper(elements: Elements, taper: Taper, from_end: bool, around: Surroundings) -> Elements:
    """The elements with a bend stiffener at the riser's end, or at its start.

    EI grows by E pi (D^4 - d^4)/64, d the pipe's diameter, mass and weight less buoyancy by pi (D^2 - d^2)/4, each in
    the mean over an element. The pipe in it stays what it was (`pipe_diameter`, `pipe_EI_y`, `pipe_EI_z`).
    """
    arc, pipe = elements.arc, elements.outer_diameter
    near, far = (arc[:-1], arc[1:]) if not from_end else (arc[-1] - arc[1:], arc[-1] - arc[:-1])
    covered = np.clip(taper.length - near, 0.0, far - near)
    xi, share = np.polynomial.legendre.leggauss(POINTS)
    D = taper.diameter(near[:, None] + 0.5 * covered[:, None] * (1.0 + xi))
    mean = (0.5 * covered / elements.length)[:, None] * share
    EI = taper.E * np.pi / 64.0 * (mean * (D**4 - pipe[:, None] ** 4)).sum(axis=1)
    section = 0.25 * np.pi * (mean * (D**2 - pipe[:, None] ** 2)).sum(axis=1)
    return replace(
        elements,
        EI_y=elements.EI_y + EI,
        EI_z=elements.EI_z + EI,
        outer_diameter=np.sqrt(pipe**2 + 4.0 / np.pi * section),
        mass=elements.mass + taper.density * section,
        weight=elements.weight + around.gravity * (taper.density - around.water) * section,
    )


@dataclass(frozen=True, eq=False)
class Growth:
    """A layer around the pipe by height z (m,) [m], increasing: thickness [m] and density [kg/m3], linear between the
    heights, constant beyond. It sticks to the pipe and bears nothing.
    """

    z: Array
    thickness: Array
    density: Array

    def at(self, z: Array) -> tuple[Array, Array]:
        """Thickness and density at heights [m]."""
        return np.interp(z, self.z, self.thickness), np.interp(z, self.z, self.density)


def with_growth(elements: Elements, growth: Growth, z: Array, around: Surroundings) -> Elements:
    """The elements with growth, as their nodes lie at heights z (nn,) [m].

    A layer t on a diameter D has the section pi t (D + t): so much mass and, in water, weight less buoyancy come in,
    each in the mean over an element. The diameter grows to that of the same section, D + 2 t where t is the same all
    along: with it drag, added mass, lost buoyancy, vortices and contact. The pipe in it stays what it was
    (`pipe_diameter`), and so does its rotary inertia.
    """
    D, (xi, share) = elements.outer_diameter, np.polynomial.legendre.leggauss(POINTS)
    t, density = growth.at(z[:-1, None] + 0.5 * np.diff(z)[:, None] * (1.0 + xi))
    section = 0.5 * share * np.pi * t * (D[:, None] + t)
    mass, volume = (density * section).sum(axis=1), section.sum(axis=1)
    return replace(
        elements,
        outer_diameter=np.sqrt(D**2 + 4.0 / np.pi * volume),
        mass=elements.mass + mass,
        weight=elements.weight + around.gravity * (mass - around.water * volume),
    )
