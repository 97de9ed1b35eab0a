"""Integration points of contact on the soil's surface: facets divided evenly, and the history kept at points.

Points are fixed to the soil: each keeps its place on its facet and the area that belongs to it. They lie in rows,
spaced evenly on straight lines in (xi, eta). quad4 and strip8 are cut into rows along eta and these into columns. tri6
is cut along the riser, from its corner in the middle across the riser to the side opposite; both parts are cut into
rows from that line to their last corner, of even height, and each row into as many pieces. The points lie in the
middles.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.contact.facets import triangular
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.carried import carried
from riser_soil.core.compiled import njit
from riser_soil.core.saved_state import Saved

Place = tuple[float, float]  # (xi, eta)

LARGEST = 512  # divisions of a facet in each direction
ENOUGH = 12  # points along a facet or an element, whichever is shorter: they leave 1e-4 of the force, of a cubic gap
NOBODY = np.iinfo(np.int64).max  # number that no point has
LEVEL = 1e-6  # parts of a triangle's width below which two corners lie side by side

CORNERS = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))  # of tri6 in (xi, eta)


def divisions(
    points: Array, facets: IntArray, along: Array, spacing: tuple[float, float], element: float = 0.0
) -> IntArray:
    """How facets are cut, (nf, 5): rows, points in each, and of triangles how many rows lie below the middle corner,
    the number of the lowest corner and that of the middle one, across the riser.

    points (np, 3): undeformed [m]. facets (nf, 4, 6 or 8). along (2,): horizontal unit vector of the riser. spacing: of
    points along and across it [m]; triangles take that across for both. element: length of the riser's elements [m],
    over which the gap is smooth; along the riser points are spread wider than asked for where that is enough for it and
    for the facet.
    """
    at = points[facets]
    if triangular(facets.shape[1]):
        return _of_triangles(at[:, :3], along, spacing[1], element)
    a, b, c, d = at[:, 0], at[:, 1], at[:, 2], at[:, 3]
    sides = 0.5 * np.stack([b + c - a - d, c + d - a - b], axis=1)
    lengthwise, across = np.abs(sides[..., :2] @ along), sides[..., :2] @ np.array([-along[1], along[0]])
    apart = _apart(lengthwise, spacing[0], element)
    wanted = np.maximum(lengthwise / apart, np.hypot(across, sides[..., 2]) / spacing[1])
    return np.pad(_count(wanted), ((0, 0), (0, 3)))


def _of_triangles(at: Array, along: Array, spacing: float, element: float) -> IntArray:
    """How finely to divide triangles with corners (nf, 3, 3) [m]; across the riser is square to it in their plane."""
    sides = at - at[:, :1]
    ahead = np.array([*along, 0.0])
    normal = np.cross(sides[:, 1], sides[:, 2])
    across = _unit(np.cross(normal, ahead))
    t, s = (np.einsum("fvi,fi->fv", sides, axis) for axis in (across, _unit(np.cross(across, normal))))
    width = np.ptp(t, axis=1)
    order = np.argsort(np.round((t - t.min(axis=1, keepdims=True)) / (LEVEL * width[:, None])), axis=1, kind="stable")
    low, middle, high = order.T
    f = np.arange(len(at))
    share = (t[f, middle] - t[f, low]) / width
    chord = np.abs(s[f, low] + share * (s[f, high] - s[f, low]) - s[f, middle])
    rows, columns = _count(width / spacing), _count(chord / _apart(chord, spacing, element))
    below = np.ceil(rows * share - 0.5 - LEVEL).astype(np.int64)
    return np.stack([rows, columns, below, low, middle], axis=1)


def _apart(length: Array, spacing: float, element: float) -> Array:
    """Spacing of points along the riser on facets of a length [m]."""
    return np.maximum(spacing, np.minimum(length, element) / ENOUGH)


def _count(parts: Array) -> IntArray:
    """Whole parts, no larger than those wanted."""
    return np.clip(np.ceil(parts - 1e-9).astype(np.int64), 1, LARGEST)


def _unit(v: Array) -> Array:
    return np.asarray(v / np.linalg.norm(v, axis=1, keepdims=True))


@njit
def row_of(nodes: int, cut: IntArray, row: int) -> tuple[Place, Place, float]:
    """Ends of a facet's row in (xi, eta), and the area there that belongs to each of its points."""
    rows, columns, below = cut[0], cut[1], cut[2]
    if not triangular(nodes):
        xi = -1.0 + (2 * row + 1) / rows
        return (xi, -1.0), (xi, 1.0), 4.0 / (rows * columns)
    low, middle, high = CORNERS[cut[3]], CORNERS[cut[4]], CORNERS[3 - cut[3] - cut[4]]
    opposite = between(low, high, below / rows)
    tip, count, from_tip = low, below, row
    if row >= below:
        tip, count, from_tip = high, rows - below, rows - 1 - row
    u = (from_tip + 0.5) / count
    return between(tip, middle, u), between(tip, opposite, u), (from_tip + 0.5) / (rows * count * columns)


@njit
def between(a: Place, b: Place, share: float) -> Place:
    """The place at a share of the way from one to another."""
    return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])


@njit
def area(points: Array, facet: IntArray, dN: Array) -> float:
    """Area of a facet per area in (xi, eta) [m2], where its shape functions have the derivatives dN (nv, 2)."""
    a1 = a2 = a3 = b1 = b2 = b3 = 0.0
    for v in range(len(facet)):
        x, y, z = points[facet[v], 0], points[facet[v], 1], points[facet[v], 2]
        a1, a2, a3 = a1 + x * dN[v, 0], a2 + y * dN[v, 0], a3 + z * dN[v, 0]
        b1, b2, b3 = b1 + x * dN[v, 1], b2 + y * dN[v, 1], b3 + z * dN[v, 1]
    return math.sqrt((a2 * b3 - a3 * b2) ** 2 + (a3 * b1 - a1 * b3) ** 2 + (a1 * b2 - a2 * b1) ** 2)


class PointHistory(NamedTuple):
    """History of points: rows (m, k) by the points' numbers (m,), which rise; `untouched` (k,) is that of all others.
    """

    numbers: IntArray
    rows: Array
    untouched: Array


@njit
def write_history(history: PointHistory, numbers: IntArray, n: int, out: Array) -> None:
    """Write the history (n, k) of the first n of points by their numbers."""
    for i in range(n):
        row = np.searchsorted(history.numbers, numbers[i])
        has_row = row < history.numbers.size and history.numbers[row] == numbers[i]
        for k in range(history.untouched.size):
            out[i, k] = history.rows[row, k] if has_row else history.untouched[k]


class PointMemory:
    """History of points between steps: rows (n, k) by the points' numbers (n,), `untouched` (k,) of all others.

    history: with room for more points, NOBODY their number; a new one is made only where the room does not suffice.
    """

    def __init__(self, untouched: Array) -> None:
        self._count = 0
        self.history = PointHistory(np.empty(0, dtype=np.int64), np.empty((0, len(untouched))), untouched)

    @property
    def numbers(self) -> IntArray:
        """Numbers (n,) of the points, which rise; written to with the next step."""
        return self.history.numbers[: self._count]

    @property
    def rows(self) -> Array:
        """Rows (n, k) of the points; written to with the next step."""
        return self.history.rows[: self._count]

    def at(self, numbers: IntArray) -> Array:
        """History (n, k) of points (n,)."""
        out = np.empty((len(numbers), self.history.untouched.size))
        write_history(self.history, numbers, len(numbers), out)
        return out

    def keep(self, numbers: IntArray, rows: Array) -> None:
        """Keep the history (n, k) of these points (n,), each at most once, and forget that of all others."""
        changed = np.any(rows != self.history.untouched, axis=1)
        order = np.argsort(numbers[changed])
        self._write(numbers[changed][order], rows[changed][order])

    def _write(self, numbers: IntArray, rows: Array) -> None:
        self._count = n = len(numbers)
        if n > len(self.history.numbers):
            room, untouched = np.empty((2 * n, rows.shape[1])), self.history.untouched
            self.history = PointHistory(np.empty(2 * n, dtype=np.int64), room, untouched)
        self.history.numbers[:n], self.history.numbers[n:] = numbers, NOBODY
        self.history.rows[:n] = rows

    def go_over(self, numbers: IntArray, before: Array, after: Array) -> None:
        """Points (n,) that lay at places (n, 3) lie at others now: the history stays where it was, see `carried`."""
        if self._count:
            self.keep(numbers, carried(before, self.at(numbers), after))

    def state(self) -> Saved:
        return {"numbers": self.numbers.copy(), "rows": self.rows.copy()}

    def restore(self, saved: Saved) -> None:
        self._write(saved["numbers"], saved["rows"])
