"""Extrapolation of a series of finer and finer runs to its limit, with the order observed and the limit's uncertainty.

Richardson's: the value q(h) = q0 + c h^p at three sizes h1 > h2 > h3, in any ratios, gives p from
(q1 - q2)/(q2 - q3) = (h1^p - h2^p)/(h2^p - h3^p), whose right side grows with p, and q0 from the last two (Roache,
Verification and Validation in Computational Science and Engineering, 1998, chapter 5).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

LEAST_ORDER, MOST_ORDER = 0.4, 8.0  # orders of three values that count as observed
LEAST_UNCERTAINTY = 0.3  # of the last correction: two extrapolations may agree by chance


@dataclass(frozen=True)
class Limit:
    """Limit of a refinement series. uncertainty: how far the limit may be off, in the values' unit.

    order: observed with the finest three values, None where they show none: the limit is then the finest value.
    """

    value: float
    uncertainty: float
    order: float | None


def limit(sizes: Sequence[float], values: Sequence[float]) -> Limit:
    """Limit of values at sizes h, in any order, each size once; one value is its own limit, of unknown uncertainty.

    The uncertainty is how far the extrapolation from the finest three is from that of the three before, at least 0.3
    of the last correction. Where there are none before or they show no order, it is the correction, at least half the
    last change. Without an order among the finest three, it is the largest change among them.
    """
    refinement = sorted(zip(sizes, values, strict=True), reverse=True)
    if len({h for h, _ in refinement}) < len(refinement):
        raise ValueError("a refinement level is given twice")
    finest = refinement[-1][1]
    if len(refinement) < 3:
        return Limit(finest, abs(finest - refinement[0][1]) if len(refinement) == 2 else math.inf, None)
    last = _extrapolated(refinement[-3:])
    if last is None:
        of_three = [q for _, q in refinement[-3:]]
        return Limit(finest, max(of_three) - min(of_three), None)
    value, order = last
    before = _extrapolated(refinement[-4:-1]) if len(refinement) > 3 else None
    correction, change = abs(value - finest), abs(finest - refinement[-2][1])
    if before is None:
        return Limit(value, max(correction, 0.5 * change), order)
    return Limit(value, max(abs(value - before[0]), LEAST_UNCERTAINTY * correction), order)


def observed_order(sizes: Sequence[float], values: Sequence[float]) -> float | None:
    """Order p by which three values at falling sizes converge; None where they show none."""
    (h1, h2, h3), (q1, q2, q3) = sizes, values
    first, second = q1 - q2, q2 - q3
    if first * second <= 0.0:
        return None

    def residual(p: float) -> float:
        """Residual of the equation for p, positive where p is too large.

        Sizes are over h2, so that no power over- or underflows.
        """
        a, c = (h1 / h2) ** p, (h3 / h2) ** p
        return (a - 1.0) / (1.0 - c) - first / second

    low, high = LEAST_ORDER, MOST_ORDER
    if residual(low) > 0.0 or residual(high) < 0.0:
        return None
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if residual(middle) > 0.0 else (middle, high)
    return 0.5 * (low + high)


def _extrapolated(three: Sequence[tuple[float, float]]) -> tuple[float, float] | None:
    """Limit and order of three pairs (h, q), h falling; None where they show no order."""
    sizes, values = zip(*three, strict=True)
    order = observed_order(sizes, values)
    if order is None:
        return None
    gain = (sizes[1] / sizes[2]) ** order - 1.0
    return values[2] + (values[2] - values[1]) / gain, order
