"""Bearing capacity of clay below a pipe: shear strength, bearing resistance, buoyancy of the displaced clay.

z: penetration of the pipe's lowest line [m], positive into the ground; functions return value and derivative by z.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from riser_soil.core.lazy import LazyModule

if TYPE_CHECKING:
    import numpy as np

    from riser_soil.core.arrays import Array
else:
    np = LazyModule("numpy")

Number = TypeVar("Number", float, "Array")

SHALLOW = 0.1  # z/D below which Randolph & Quiggin's bearing factor follows the square root


@dataclass(frozen=True)
class Strength:
    """Undrained shear strength su + gradient z [Pa], z [m] below the surface."""

    su: float
    gradient: float = 0.0

    def at(self, z: Number) -> Number:
        return self.su + self.gradient * z


@dataclass(frozen=True)
class PowerLaw:
    """Bearing resistance per length a (z/D)^b su(z) D [N/m], 0 for z <= 0.

    shallow: below this z/D the factor is the one there times sqrt(z/(shallow D)); 0 for the power law throughout.
    """

    diameter: float
    strength: Strength
    a: float
    b: float
    shallow: float = 0.0

    def resistance(self, z: Array) -> tuple[Array, Array]:
        below = np.maximum(z, 1e-12 * self.diameter)
        ratio = below / self.diameter
        deep = ratio >= self.shallow
        exponent = np.where(deep, self.b, 0.5)
        scale = self.a * self.shallow ** (self.b - 0.5) if self.shallow > 0.0 else self.a
        factor = np.where(deep, self.a, scale) * ratio**exponent * self.diameter
        su = self.strength.at(below)
        slope = factor * (exponent * su / below + self.strength.gradient)
        return np.where(z > 0.0, factor * su, 0.0), np.where(z > 0.0, slope, 0.0)


def strip_capacity(strength: Strength, width: float) -> float:
    """Least force per length [N/m] under which clay flows from below a strip of a width [m] on its surface.

    (2 + pi) su B + gradient B^2/4: Prandtl's, with a strength that grows with depth after E. H. Davis & J. R. Booker,
    Geotechnique 23 (1973), whose factor of 1 to 1.7 on it, for the gradient's effect, is left at 1.
    """
    return (2.0 + math.pi) * strength.su * width + 0.25 * strength.gradient * width**2


def displaced(z: Array, diameter: float) -> tuple[Array, Array, Array]:
    """Integral over z, value and derivative of the pipe's area below the surface [m3, m2, m]; whole for z > D."""
    r = 0.5 * diameter
    phi = np.arccos(1.0 - np.clip(z, 0.0, diameter) / r)
    sine, cosine = np.sin(phi), np.cos(phi)
    beyond = np.maximum(z - diameter, 0.0) * np.pi * r**2
    integral = r**3 * (sine - phi * cosine - sine**3 / 3.0) + beyond
    return integral, r**2 * (phi - sine * cosine), 2.0 * r * sine
