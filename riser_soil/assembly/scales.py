"""Characteristic scales of a riser, from which defaults follow: weight per length, diameter, round-off force."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser.sections import Elements
from riser_soil.scene.scene import Scene

FORCE_FLOOR = 1e-14  # of EA: a residual below this is round-off even where all forces vanish
THINNEST = 1e-3  # of the length: stands for the diameter of a chain that has none
SHALLOWEST = 1.0 / 300.0  # of the diameter: soil that gains strength from nothing has at least that of this depth
LEAST_WEIGHT = 1e-6  # of EA/L: stands for the weight of a line that has none


@dataclass(frozen=True)
class Scales:
    """weight: typical force per length [N/m]. force_floor [N]: what counts as zero.

    diameter: the largest outer one [m]; of a line without one, that of a solid bar with its stiffnesses.
    """

    weight: float
    diameter: float
    force_floor: float


def scales_of(elements: Elements) -> Scales:
    EA = float(elements.EA.max())
    bar = float(4.0 * np.sqrt((elements.EI_y / elements.EA).max())) or THINNEST * float(elements.arc[-1])
    weight = max(float(np.abs(elements.weight).max()), LEAST_WEIGHT * EA / float(elements.arc[-1]))
    return Scales(weight, float(elements.outer_diameter.max()) or bar, FORCE_FLOOR * EA)


def of_several(lines: Iterable[Scales]) -> Scales:
    """The heaviest's weight, the thinnest's diameter, the stiffest's round-off."""
    each = list(lines)
    weight, floor = max(one.weight for one in each), max(one.force_floor for one in each)
    return Scales(weight, min(one.diameter for one in each), floor)


def contact_radius(scene: Scene, elements: Elements) -> Array:
    """Distance (ne,) from the axis to the line of the pipe that touches [m]."""
    return 0.5 * elements.outer_diameter * (scene.contact_at == "outer")
