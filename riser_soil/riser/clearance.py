"""Least distance between two lines, as polygons through their nodes.

Two segments p + s d and q + t e, s and t from 0 to 1, are nearest where the gradient of their squared distance is zero,
or on the border: s and t are found in turn, each held within its segment (Ericson, Real-Time Collision Detection, 2005,
section 5.1.9).
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.compiled import njit
from riser_soil.riser.vectors import add, dot, norm, scale, sub, vector


@njit
def clearance(
    x: Array, radius: Array, counts: BoolArray, other: Array, other_radius: Array, other_counts: BoolArray
) -> tuple[float, int, float, int, float]:
    """Least distance of the surfaces of two lines [m], negative where they overlap; element and place in it, 0 to 1, on
    the one and the other.

    x, other (nn, 3): nodes; radius (ne,) [m]; counts (ne,): the elements that are looked at.
    """
    least, e, s, f, t = np.inf, 0, 0.0, 0, 0.0
    for i in range(radius.size):
        if not counts[i]:
            continue
        for j in range(other_radius.size):
            if not other_counts[j]:
                continue
            distance, along, beside = between_segments(x[i], x[i + 1], other[j], other[j + 1])
            if distance - radius[i] - other_radius[j] < least:
                least, e, s, f, t = distance - radius[i] - other_radius[j], i, along, j, beside
    return least, e, s, f, t


@njit
def between_segments(first: Array, second: Array, third: Array, fourth: Array) -> tuple[float, float, float]:
    """Least distance of two segments, and where on each, from 0 to 1; ends (3,)."""
    p, q = vector(first), vector(third)
    d, e, r = sub(vector(second), p), sub(vector(fourth), q), sub(p, q)
    dd, ee, de, dr, er = dot(d, d), dot(e, e), dot(d, e), dot(d, r), dot(e, r)
    det = dd * ee - de * de
    s = _within((de * er - dr * ee) / det) if det > 1e-12 * dd * ee else 0.0
    t = (de * s + er) / ee
    if t < 0.0 or t > 1.0:
        t = _within(t)
        s = _within((de * t - dr) / dd)
    return norm(sub(add(p, scale(s, d)), add(q, scale(t, e)))), s, t


@njit
def _within(value: float) -> float:
    return min(1.0, max(0.0, value))
