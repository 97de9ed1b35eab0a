"""Adhesion of a pipe on clay along a seabed: the force per length up to which clay holds it along the ground."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.contact.coulomb import Pair
from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.seabed.bearing import Strength
from riser_soil.seabed.pipe_bearing import strength_at


class Adhesion(NamedTuple):
    """The share of the clay's undrained shear strength that holds a pipe of a diameter [m]; 0 where nothing limits
    friction but the pressure.
    """

    share: float = 0.0
    strength: Strength = Strength(0.0)
    diameter: float = 0.0


@njit
def adhesion_at(clay: Adhesion, penetration: float) -> Pair:
    """Adhesion per length [N/m] and its derivative by the penetration: that of su at the pipe's bottom, over the arc
    that lies below the seabed, half of its circumference at most.
    """
    if clay.share == 0.0:
        return math.inf, 0.0
    z, D = max(penetration, 0.0), clay.diameter
    deep = min(2.0 * z / D, 1.0)
    arc = 2.0 * D * math.asin(math.sqrt(0.5 * deep))
    widening = 2.0 / math.sqrt(deep * (2.0 - deep)) if 0.0 < deep < 1.0 else 0.0
    su = strength_at(clay.strength, z)
    return clay.share * su * arc, clay.share * (clay.strength.gradient * arc + su * widening)


@njit
def adhesions(clay: Adhesion, penetration: Array) -> tuple[Array, Array]:
    """`adhesion_at` stations (m, ng)."""
    value, slope = np.empty(penetration.shape), np.empty(penetration.shape)
    for i in range(penetration.shape[0]):
        for g in range(penetration.shape[1]):
            value[i, g], slope[i, g] = adhesion_at(clay, penetration[i, g])
    return value, slope
