"""Largest bending between the nodes of a line, from values and slopes at the ends of its elements.

A section's moment M changes along the unstressed arc s as M' = F x t, with the section's force F and the unit tangent
t, so its magnitude as |M|' = M . (F x t)/|M|. Both ends of an element have a value and a slope of their own: the cubic
through them is the moment itself under an even or linear load, whatever jumps at the nodes. In an element far too long
for the bend, whose load is borne by tension, it would tower over its ends: it rises above them by no more than twice
what a parabola with the second differences of the values beside it would.
"""

from __future__ import annotations

import math

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit

TIE = 1e-9  # of a value, by which another must be larger to count as larger: round-off does not choose


@njit
def slopes(moment: Array, force: Array, tangent: Array, out: Array) -> None:
    """Slopes of the moment's magnitude at the ends of the elements, into out (ne, 2) [N]; 0 where there is no moment.

    moment (nn, 3): across the line at nodes; force, tangent (ne, 2, 3): of the section and unit, at the elements' ends.
    """
    for e in range(len(out)):
        for end in range(2):
            M, F, t = moment[e + end], force[e, end], tangent[e, end]
            size = math.sqrt(M[0] * M[0] + M[1] * M[1] + M[2] * M[2])
            turned = M[0] * (F[1] * t[2] - F[2] * t[1]) + M[1] * (F[2] * t[0] - F[0] * t[2])
            turned += M[2] * (F[0] * t[1] - F[1] * t[0])
            out[e, end] = turned / size if size > 0.0 else 0.0


@njit
def largest(arc: Array, values: Array, slope: Array) -> tuple[float, float, int]:
    """The largest value along a line, its arc length and element, between nodes too; of equal ones the first.

    arc (nn,): of the nodes. values, slope (ne, 2): at the elements' ends.
    """
    best, at, element = values[0, 0], arc[0], 0
    for e in range(len(values)):
        L = arc[e + 1] - arc[e]
        top, x = top_of_cubic(values[e, 0], values[e, 1], slope[e, 0] * L, slope[e, 1] * L)
        top = min(top, max(values[e, 0], values[e, 1]) + 2.0 * L * L / 8.0 * _bend(arc, values, e))
        if top > best + TIE * abs(best):
            best, at, element = top, arc[e] + x * L, e
    return best, at, element


@njit
def _bend(arc: Array, values: Array, e: int) -> float:
    """The larger second derivative by the values of an element and those beside it; inf of one that is alone."""
    largest_bend = math.inf if len(values) == 1 else 0.0
    for other in range(max(e - 1, 0), min(e + 2, len(values))):
        if other != e:
            turned = _chord(arc, values, e) - _chord(arc, values, other)
            both = arc[e + 1] - arc[e] + arc[other + 1] - arc[other]
            largest_bend = max(largest_bend, 2.0 * abs(turned) / both)
    return largest_bend


@njit
def _chord(arc: Array, values: Array, e: int) -> float:
    return (values[e, 1] - values[e, 0]) / (arc[e + 1] - arc[e])


@njit
def top_of_cubic(first: float, second: float, rise: float, fall: float) -> tuple[float, float]:
    """Largest value, and its place in 0..1, of the cubic with these values and slopes at 0 and 1.

    Only where it rises at 0 and falls at 1 it is looked for between them.
    """
    if not rise > 0.0 > fall:
        return (first, 0.0) if first >= second - TIE * abs(first) else (second, 1.0)
    a, b = 3.0 * (rise + fall - 2.0 * (second - first)), 2.0 * (3.0 * (second - first) - 2.0 * rise - fall)
    x = 2.0 * rise / (math.sqrt(b * b - 4.0 * a * rise) - b)  # of a x^2 + b x + rise, the slope at x
    return first + x * (rise + x * (0.5 * b + x * a / 3.0)), x
