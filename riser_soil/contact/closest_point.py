"""The pipe's axis, and the place on it that is closest to a point.

The axis is the cubic c(s) = Σ N_a(s) q_a of a beam element. A point that has come through to above the axis counts as
lying below it: the pipe pushes it down all the same.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser.hermite import Four, bend, slope
from riser_soil.riser.hermite import shape as axis_shape

MAX_ITERATIONS = 30
CONVERGED = 1e-8  # step along an element, as a part of its length, whose square, the next one, is below round-off
THROUGH = 0.5  # radii beside the axis within which a point above it has come through
THINNEST = 1e-3  # radii: nearer to the axis the direction from it means nothing


class Axis(NamedTuple):
    """The riser's axis in global axes: q (ne, 4, 3), see `hermite`, lengths and radii (ne,) [m]."""

    q: Array
    length: Array
    radius: Array


@njit
def nearest(
    axis: Axis, bow: Array, elements: IntArray, p: tuple[float, float, float], within: float
) -> tuple[int, float, float, float]:
    """Nearest of some elements to a point: its number, the place on its axis, the gap [m] and the clearance [m].

    The first one where two come as near; -1 where no gap is less than `within`, and then no gap is less than the
    clearance.
    """
    nearest, place_on, gap, distance, clearance = -1, 0.0, np.inf, np.inf, np.inf
    for e in elements:
        beside = _from_chord(axis.q[e], p) - bow[e]
        clearance = min(clearance, beside - axis.radius[e])
        if beside - axis.radius[e] >= within or beside >= distance:
            continue
        along = closest(axis.q[e], axis.length[e], p)
        c = combined(axis.q[e], axis_shape(along, axis.length[e]))
        rho = signed_distance(c, p, axis.radius[e])
        if abs(rho) < distance:
            nearest, place_on, gap, distance = e, along, rho - axis.radius[e], abs(rho)
    return nearest, place_on, gap, clearance


@njit
def _from_chord(q: Array, p: tuple[float, float, float]) -> float:
    """Distance of a point from the straight line between an element's ends [m]."""
    share, beside = _along_chord(q, p), 0.0
    for i in range(3):
        beside += (p[i] - q[0, i] - share * (q[2, i] - q[0, i])) ** 2
    return math.sqrt(beside)


@njit
def _along_chord(q: Array, p: tuple[float, float, float]) -> float:
    """Place, 0 to 1, on the straight line between an element's ends that is closest to a point."""
    along = square = 0.0
    for i in range(3):
        chord = q[2, i] - q[0, i]
        along += (p[i] - q[0, i]) * chord
        square += chord * chord
    return min(max(along / square, 0.0), 1.0) if square > 0.0 else 0.0


@njit
def bow_of(axis: Axis) -> Array:
    """How far (ne,) the axis leaves the chord at most [m], stretched as it may be: being a Bézier curve, no farther
    than 3/4 of what its handles do, whose weights sum to that at most.
    """
    out = np.empty(len(axis.length))
    for e in range(len(out)):
        q, third = axis.q[e], axis.length[e] / 3.0
        first, last = combined(q, (1.0, third, 0.0, 0.0)), combined(q, (1.0, 0.0, 0.0, third))
        out[e] = 0.75 * max(_from_chord(q, first), _from_chord(q, last))
    return out


@njit
def signed_distance(c: tuple[float, float, float], p: tuple[float, float, float], radius: float) -> float:
    """Distance of p from the axis at c [m], < 0 where it has come through to above."""
    x, y, z = p[0] - c[0], p[1] - c[1], p[2] - c[2]
    beside = math.sqrt(x * x + y * y)
    rho = max(math.sqrt(beside * beside + z * z), THINNEST * radius)
    return -rho if z > 0.0 and beside < THROUGH * radius else rho


@njit
def closest(q: Array, L: float, p: tuple[float, float, float]) -> float:
    """Place xi in 0..1 on an element's axis that is closest to a point."""
    xi = _along_chord(q, p)
    for _ in range(MAX_ITERATIONS):
        c, c1 = combined(q, axis_shape(xi, L)), combined(q, slope(xi, L))
        c2 = combined(q, bend(xi, L))
        against = ahead = turning = 0.0
        for i in range(3):
            against += (p[i] - c[i]) * c1[i]
            ahead += c1[i] * c1[i]
            turning += (p[i] - c[i]) * c2[i]
        rate = ahead - turning
        if rate <= 0.1 * ahead:  # far from the axis, beyond its centre of curvature
            rate = ahead
        new = min(max(xi + against / (rate * L), 0.0), 1.0)
        step, xi = abs(new - xi), new
        if step < CONVERGED:
            break
    return xi


@njit
def combined(q: Array, N: Four) -> tuple[float, float, float]:
    """Sum of the q (4, 3) of an element by their shape functions."""
    x = N[0] * q[0, 0] + N[1] * q[1, 0] + N[2] * q[2, 0] + N[3] * q[3, 0]
    y = N[0] * q[0, 1] + N[1] * q[1, 1] + N[2] * q[2, 1] + N[3] * q[3, 1]
    z = N[0] * q[0, 2] + N[1] * q[1, 2] + N[2] * q[2, 2] + N[3] * q[3, 2]
    return x, y, z
