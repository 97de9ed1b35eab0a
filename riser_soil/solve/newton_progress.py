"""Progress of Newton's method: line search along a step, and round-off of the residual, where nothing improves.

Where contact opens or soil is near its limit, a Newton step may lead far beyond the equilibrium. With the residual r as
the slope of an energy, g(a) = r(x + a d)·d falls to zero where the energy is least along the step d; g(0) < 0. A full
step is taken where it does not go far beyond that, else the zero is bracketed by false position, the slope at the end
that stays counting half each time (after the Illinois method, so that neither end stays for long).

Round-off of the residual: where Newton's method ends because nothing is left that it could improve.

The residual of a stiff line or contact is a small difference of large numbers: some eps EA of a bar that has turned,
eps k z of a penalty k at a height z, eps EI phi/L^2 of an element that has turned by an angle phi. The coordinates x
that the forces follow from are known to a rounding each, so that a row i of the residual can't be told from

    eps sum_j |K_ij| |x_j|,

summed over the elements, their tangents K at held rates: a bound of the error of a sum of products in floating point
(Higham, Accuracy and Stability of Numerical Algorithms, 2002, 3.1), here with a factor for the few roundings of each
term. Where that is above what is allowed, the norms of the residual stay as they are. A load or time step that stops so
is solved as far as it can be told; a larger floor for the residual would hide small loads on long lines instead.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit

FAR = 0.5  # of the slope at the start: up to this slope beyond the zero the full step is taken
NEAR = 0.25  # of the slope at the start: near enough to zero
MOST = 10  # evaluations of the slope within the step
STALLED = 0.5  # the norm of a residual that falls by less in each of two iterations stays as it is
EPS = float(np.finfo(float).eps)
ROUND_OFF = 8.0 * EPS  # of the sum of sizes; residuals that stayed were found at up to 2 eps of it


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
        found = slope(part)
        if abs(found) <= NEAR * -start:
            break
        if found < 0.0:
            low, below, above = part, found, 0.5 * above
        else:
            high, above, below = part, found, 0.5 * below
    return part


def _between(low: float, high: float, below: float, above: float) -> float:
    """The secant's zero, kept from both ends by a twentieth; the middle where a slope is not finite."""
    middle = 0.5 * (low + high)
    if not math.isfinite(above - below):
        return middle
    part = low - below * (high - low) / (above - below)
    edge = 0.05 * (high - low)
    return min(max(part, low + edge), high - edge)


@njit
def stays(norms: Array) -> bool:
    """Whether the last two iterations have left the residual's norm as it is, of all its norms so far (n,)."""
    if norms.size < 3:
        return False
    return norms[-1] > STALLED * norms[-2] and norms[-2] > STALLED * norms[-3]
