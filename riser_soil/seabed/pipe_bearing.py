"""Bearing resistance of clay below a pipe by depth, and the pipe's area below the surface.

z: penetration of the pipe's lowest line [m], positive into the ground.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.seabed.bearing import Strength


class PowerLaw(NamedTuple):
    """Bearing resistance per length a (z/D)^b su(z) D [N/m], 0 for z <= 0.

    shallow: below this z/D the factor is the one there times sqrt(z/(shallow D)); 0 for the power law throughout.
    """

    diameter: float
    strength: Strength
    a: float
    b: float
    shallow: float = 0.0

    def resistance(self, z: Array) -> tuple[Array, Array]:
        """Value and derivative by z."""
        value, slope = np.vectorize(lambda depth: resistance(self, depth))(z)
        return value, slope


strength_at = njit(Strength.at)


@njit
def resistance(law: PowerLaw, z: float) -> tuple[float, float]:
    """Value [N/m] and derivative by z at one depth."""
    if z <= 0.0:
        return 0.0, 0.0
    below = max(z, 1e-12 * law.diameter)
    ratio, exponent = below / law.diameter, law.b
    factor = law.a * law.diameter * max(ratio, law.shallow) ** law.b
    if ratio < law.shallow:
        factor, exponent = factor * math.sqrt(ratio / law.shallow), 0.5
    su = strength_at(law.strength, below)
    return factor * su, factor * (exponent * su / below + law.strength.gradient)


@njit
def displaced(z: float, diameter: float) -> tuple[float, float, float]:
    """Integral over z, value and derivative of the pipe's area below the surface [m3, m2, m]; whole for z > D."""
    r = 0.5 * diameter
    phi = math.acos(1.0 - min(max(z, 0.0), diameter) / r)
    sine, cosine = math.sin(phi), math.cos(phi)
    beyond = max(z - diameter, 0.0) * math.pi * r**2
    integral = r**3 * (sine - phi * cosine - sine**3 / 3.0) + beyond
    return integral, r**2 * (phi - sine * cosine), 2.0 * r * sine
