"""Submerged share of a horizontal circular pipe.

At immersion h, the height of the surface above the pipe's axis, the wet share of a section of diameter b is

    S(h) = 1/2 + (eta sqrt(1 - eta^2) + asin(eta))/pi,    eta = 2 h/b within -1..1,

0 above and 1 below: Archimedes' law for a level surface. S is continuous with its slope.
"""

import math

from riser_soil.core.compiled import njit


@njit
def wet_share(h: float, b: float) -> float:
    """S, from 0 to 1."""
    if abs(2.0 * h) >= b:
        return 1.0 if h > 0.0 else 0.0
    eta = 2.0 * h / b
    return 0.5 + (eta * math.sqrt(1.0 - eta * eta) + math.asin(eta)) / math.pi


@njit
def wet_slope(h: float, b: float) -> float:
    """dS/dh [1/m]."""
    if abs(2.0 * h) >= b:
        return 0.0
    eta = 2.0 * h / b
    return 4.0 / math.pi * math.sqrt(1.0 - eta * eta) / b


@njit
def dry_height(h: float, b: float) -> float:
    """Integral of 1 - S from h up to full immersion [m]; -h above the water."""
    if abs(2.0 * h) >= b:
        return max(-h, 0.0)
    eta = 2.0 * h / b
    across = math.sqrt(1.0 - eta * eta)
    return 0.5 * b * ((eta * math.asin(eta) + across - across**3 / 3.0) / math.pi - 0.5 * eta)
