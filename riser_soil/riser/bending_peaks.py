"""Largest bending along a line, between nodes too, from the values and slopes at the ends of the elements.

The cubic through an element's two values and slopes is the moment itself under an even or linear load. In an element
far too long for the bend, whose load is borne by tension, it would tower over its ends: it rises above them by no more
than twice what a parabola with the second differences of the values beside it would.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray

TIE = 1e-9  # of a value, by which another must be larger to count as larger: round-off does not choose


def largest_between_nodes(arc: Array, values: Array, slope: Array) -> tuple[Array, Array, IntArray]:
    """Largest value along a line, its arc length and element, each (...,); of equal values the first.

    arc (nn,): of the nodes. values, slope (..., ne, 2): at the elements' ends.
    """
    length, shape = np.diff(arc), values.shape[:-2]
    first, second, rise, fall = (
        ends.reshape(-1, length.size) for each in (values, slope) for ends in np.moveaxis(each, -1, 0)
    )
    at_second = _exceeds(second, first)
    top, place = np.where(at_second, second, first), at_second.astype(float)
    inside = np.nonzero((rise > 0.0) & (fall < 0.0))
    if inside[0].size:
        a, b, L = first[inside], second[inside], length[inside[1]]
        highest, place[inside] = top_of_cubic(a, b, rise[inside] * L, fall[inside] * L)
        top[inside] = np.minimum(highest, np.maximum(a, b) + 0.25 * L**2 * _largest_bend(length, first, second, inside))
    e = (~_exceeds(top.max(axis=1, keepdims=True), top)).argmax(axis=1)
    row = np.arange(e.size)
    rows = top[row, e], arc[e] + place[row, e] * length[e], e
    value, at, element = (each.reshape(shape)[()] for each in rows)
    return value, at, element


def top_of_cubic(first: Array, second: Array, rise: Array, fall: Array) -> tuple[Array, Array]:
    """Largest values, and their places in 0..1, of cubics with these values and slopes at 0 and 1.

    Each rises at 0 and falls at 1, so that the largest value lies between.
    """
    a, b = 3.0 * (rise + fall - 2.0 * (second - first)), 2.0 * (3.0 * (second - first) - 2.0 * rise - fall)
    root, turned = np.sqrt(b * b - 4.0 * a * rise), b > 0.0  # of a x^2 + b x + rise, the slope at x
    x = np.where(turned, -b - root, 2.0 * rise) / np.where(turned, 2.0 * a, root - b)  # without cancellation
    return first + x * (rise + x * (0.5 * b + x * a / 3.0)), x


def _exceeds(value: Array, other: Array) -> BoolArray:
    """Where a value is larger than another by more than round-off."""
    return np.asarray(value > other + TIE * np.abs(other))


def _largest_bend(length: Array, first: Array, second: Array, at: tuple[IntArray, ...]) -> Array:
    """The larger second derivative by the values of an element and those beside it, of elements `at` (k,): their row
    and number; inf of an element that is alone.
    """
    row, e = at
    if length.size == 1:
        return np.full(e.size, np.inf)

    def chord(number: IntArray) -> Array:
        return np.asarray((second[row, number] - first[row, number]) / length[number])

    own, beside = chord(e), (np.maximum(e - 1, 0), np.minimum(e + 1, length.size - 1))
    bends = (2.0 * np.abs(own - chord(other)) / (length[e] + length[other]) for other in beside)
    return np.maximum(*bends)
