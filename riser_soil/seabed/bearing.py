"""Strength of clay below a pipe, and what a strip on it bears."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, TypeVar

if TYPE_CHECKING:
    from riser_soil.core.arrays import Array

Number = TypeVar("Number", float, "Array")


class Strength(NamedTuple):
    """Undrained shear strength su + gradient z [Pa], z [m] below the surface."""

    su: float
    gradient: float = 0.0

    def at(self, z: Number) -> Number:
        return self.su + self.gradient * z


def strip_capacity(strength: Strength, width: float) -> float:
    """Least force per length [N/m] under which clay flows from below a strip of a width [m] on its surface.

    (2 + pi) su B + gradient B^2/4: Prandtl's, with a strength that grows with depth after E. H. Davis & J. R. Booker,
    Geotechnique 23 (1973), whose factor of 1 to 1.7 on it, for the gradient's effect, is left at 1.
    """
    return (2.0 + math.pi) * strength.su * width + 0.25 * strength.gradient * width**2
