"""What is told of a line in balance that is none: an element that is folded, or swings too far in a step."""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array

MOST_SWING = 0.2  # rad by which an element's end may turn against its chord in a time step
BENT_DOUBLE = 1.2  # rad from its chord, beyond which an end was on its way to be folded


def swinging(arc: float) -> str:
    """Of the element at an arc length [m]."""
    return f"the element at arc {arc:.6g} m bends by more than {MOST_SWING:g} rad in the step"


def folded(arc: float, length: float, diameter: float, ends: Array, chord: Array) -> str:
    """Of the element at an arc length, of a length and diameter [m], where it is accepted: with tangents (2, d) at its
    ends, and chord (d,). Of one that was bent double before, its bend is told, which no shorter step prevents.
    """
    found = (
        f"the riser is folded at arc {arc:.6g} m, where an element's end turns by more than "
        "90 degrees from its chord"
    )
    first, second = _swings(ends, chord / np.linalg.norm(chord))
    swing = max(abs(first), abs(second))
    if swing < BENT_DOUBLE:
        return f"{found}; start nearer to the shape sought, or take shorter elements or steps"
    radius = length / abs(first - second)
    return (
        f"{found}; it had come to {math.degrees(swing):.0f} degrees before: loads or motion close a bend there, "
        f"whose radius is down to {radius:.3g} m, {radius / diameter:.2g} diameters, on an "
        f"element of {length:.3g} m; much shorter elements follow it further, and tell whether it becomes a kink"
    )


def _swings(ends: Array, chord: Array) -> tuple[float, float]:
    """Angles [rad] from a unit chord to the tangents; the second's is positive where it turns to the first's side."""
    along = ends @ chord
    across = ends - np.outer(along, chord)
    first, second = np.arctan2(np.linalg.norm(across, axis=1), along)
    return float(first), math.copysign(second, float(across[0] @ across[1]))
