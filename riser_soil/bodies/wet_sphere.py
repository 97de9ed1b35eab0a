"""How much of a body is in the water: that of a sphere of the same volume about its centre of buoyancy.

With the height h of the water's surface above the centre, over the radius of that sphere, eta from -1 (dry) to 1 (wet),
the wet share of a sphere is s = (2 + 3 eta - eta^3)/4, whose slope is zero at both ends.
"""

from __future__ import annotations

import math


def radius_of(volume: float) -> float:
    """Of a sphere of a volume [m3]."""
    return float((3.0 * volume / (4.0 * math.pi)) ** (1.0 / 3.0))


def wet(h: float, radius: float) -> tuple[float, float]:
    """s at a height h [m] and its slope [1/m]; without a volume it is 0 above the surface and 1 below."""
    if radius == 0.0:
        return float(h > 0.0), 0.0
    eta = min(1.0, max(-1.0, h / radius))
    return 0.25 * (2.0 + 3.0 * eta - eta**3), 0.75 * (1.0 - eta**2) / radius


def wet_height(h: float, radius: float) -> float:
    """The integral of s over h [m], zero in the air."""
    if h >= radius:
        return h
    eta = max(-1.0, h / radius) if radius > 0.0 else -1.0
    return radius * (0.5 * eta + 0.375 * eta**2 - 0.0625 * eta**4 + 0.1875)
