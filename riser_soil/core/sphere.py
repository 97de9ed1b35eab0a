"""Sphere of a body's volume: how wide a body of no given shape is."""

from __future__ import annotations

import math


def radius_of(volume: float) -> float:
    """Radius [m] of a sphere of a volume [m3]."""
    return float((3.0 * volume / (4.0 * math.pi)) ** (1.0 / 3.0))
