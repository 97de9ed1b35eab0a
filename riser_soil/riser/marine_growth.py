"""Marine growth on elements by their height: what it adds to their section, mass and weight."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser.sections import Elements, Surroundings

POINTS = 4  # of Gauss, over an element


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
