"""Line search of Newton's method: how much of a step to take.

Where contact opens or soil is near its limit, a Newton step may lead far beyond the equilibrium. With the residual r as
the slope of an energy, g(a) = r(x + a d)·d falls to zero where the energy is least along the step d; g(0) < 0. A full
step is taken where it does not go far beyond that, else the zero is bracketed by false position, the slope at the end
that stays counting half each time (after the Illinois method, so that neither end stays for long).
"""

from __future__ import annotations

import math
from collections.abc import Callable

FAR = 0.5  # of the slope at the start: up to this slope beyond the zero the full step is taken
NEAR = 0.25  # of the slope at the start: near enough to zero
MOST = 10  # evaluations of the slope within the step


def step_length(start: float, slope: Callable[[float], float]) -> float:
    """Part of a step to take, -1 to 1. start: slope at its beginning; slope: of the energy at a part of the step."""
    if start > 0.0:
        return -step_length(-start, lambda part: -slope(-part))
    end = slope(1.0)
    if end <= FAR * -start:
        return 1.0
    low, high, below, above = 0.0, 1.0, start, end
    for _ in range(MOST):
        part = _between(low, high, below, above)
        at_part = slope(part)
        if abs(at_part) <= NEAR * -start:
            break
        if at_part < 0.0:
            low, below, above = part, at_part, 0.5 * above
        else:
            high, above, below = part, at_part, 0.5 * below
    return part


def _between(low: float, high: float, below: float, above: float) -> float:
    """The secant's zero, kept from both ends by a twentieth; the middle where a slope is not finite."""
    middle = 0.5 * (low + high)
    if not math.isfinite(above - below):
        return middle
    part = low - below * (high - low) / (above - below)
    edge = 0.05 * (high - low)
    return min(max(part, low + edge), high - edge)
