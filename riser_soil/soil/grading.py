"""Mesh grading of a soil block: how its cells grow away from the riser; needs no mesh."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, Literal

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.errors import MeshError
from riser_soil.soil.seabed_feature import FeatureSpec, GrooveSpec, TrenchSpec

MOST_CELLS = 100_000  # in one direction away from the riser
_PIECES = 16  # on either side of the riser, to count cells by
_EQUAL = 1e-9  # difference of two sizes, over either, that is none
_ROUNDED = 9  # decimals of a number of cells before it is rounded: halves stay halves in any unit of length
_DIGITS = 13  # decimals of a block's lengths over its span: beyond them is round-off, by which tetrahedra differ
LONGER = 4.0  # cells at the block's ends than at the touchdown point, at least, where they grow along the riser
PARALLEL = 1e-6  # slope in plan of a riser that runs along an axis

Point = tuple[float, float]


@dataclass(frozen=True)
class BlockSpec:
    """A block with a level top [m].

    x, y: range in plan. level: z of the top face. depth: thickness. kind: element family. size_at_riser: cell
    size under the riser; size_far: the size that it grows to at the block's far faces. riser: two points of
    the riser's straight line in plan; a cell's middle, not its edge, lies under a line along x or y, so that
    the surface under the riser is smooth. None: fine in the whole plan.
    along: of hexahedra, length of the cells along a riser that runs along x or y, where it is another than their size
    across it; strip: width across the riser, and half of it downwards, within which they do not grow yet. boundaries:
    depths below the level at which layers of soil meet, increasing; cells end there. feature: of the top, along a riser
    that runs along x or y. half: whether only the half beyond the riser's line is meshed, of a block that is symmetric
    about it, with the cells that the line's plane cuts. touchdown: of long hexahedra, range along the riser beyond
    which they grow along it, too; None: nowhere.
    """

    x: Point
    y: Point
    depth: float
    size_at_riser: float
    size_far: float
    level: float = 0.0
    kind: Literal["hex", "tet"] = "hex"
    riser: tuple[Point, Point] | None = None
    along: float | None = None
    strip: float = 0.0
    boundaries: tuple[float, ...] = ()
    feature: FeatureSpec | None = None
    half: bool = False
    touchdown: Point | None = None

    @property
    def axis(self) -> int:
        """The axis, x (0) or y (1), along which the riser mainly runs."""
        (x0, y0), (x1, y1) = self.riser or ((0.0, 0.0), (1.0, 0.0))
        return int(abs(y1 - y0) > abs(x1 - x0))

    @property
    def line(self) -> float:
        """First place of the riser's line, across that axis."""
        return self.riser[0][1 - self.axis] if self.riser else sum((self.x, self.y)[1 - self.axis]) / 2.0

    @property
    def ends(self) -> Point:
        """Ends of the block on that axis."""
        return (self.x, self.y)[self.axis]

    @property
    def finest(self) -> float:
        """Size of the cells under the riser, no coarser than a feature asks for."""
        return self.feature.finest(self.size_at_riser) if self.feature else self.size_at_riser

    def fine_range(self, axis: int) -> Point:
        """Range of x (axis 0) or y (axis 1) that the riser covers in plan, with half a cell, or strip, around."""
        low, high = (self.x, self.y)[axis]
        if self.riser is None:
            return low, high
        ends = sorted(point[axis] for point in self.riser)
        size = self.size(axis)
        if self.touchdown is not None and self.lies_along(axis):
            first, last = np.clip(self.touchdown, max(low, ends[0]), min(high, ends[1]))
            return float(first), float(last)
        half = 0.5 * size if self.lies_along(axis) else 0.5 * size * _odd(self.strip / size)
        if isinstance(self.feature, GrooveSpec) and axis != self.axis:
            half = max(half, self.feature.half_width)
        first, last = np.clip((ends[0] - half, ends[1] + half), low, high)
        return float(first), float(last)

    def lies_along(self, axis: int) -> bool:
        """Whether the riser runs along x (axis 0) or y (axis 1)."""
        if self.riser is None:
            return False
        run = [abs(b - a) for a, b in zip(*self.riser, strict=True)]
        return run[axis] > 0.0 and run[1 - axis] <= PARALLEL * run[axis]

    def size(self, axis: int) -> float:
        """Size of the cells under the riser along x, y or z (axis 2)."""
        lengthened = self.along is not None and axis < 2 and self.lies_along(axis)
        return self.along if lengthened and self.along is not None else self.size_at_riser

    def layers(self) -> tuple[int, int, int]:
        """Numbers of layers of hexahedra there are along x, y and z."""
        x, y, z = (len(self.coordinates(axis)) - 1 for axis in range(3))
        return x, y, z

    def free_nodes(self) -> tuple[int, int, int]:
        """Numbers of nodes along x, y and z that move by themselves: neither those of the bottom nor, of a half,
        images.
        """
        counts = [n + 1 for n in self.layers()]
        counts[2] -= 1
        counts[1 - self.axis] -= self.half
        return counts[0], counts[1], counts[2]

    def coordinates(self, axis: int) -> Array:
        """Coordinates of the layers' boundaries along x, y or z (axis 2), rising; in z also where layers of soil do."""
        places = graded(*self._grading(axis))
        if self.half and axis == 1 - self.axis:
            return places[(len(places) - 1) // 2 :]
        return places if axis < 2 else landing(places, [self.level - depth for depth in self.boundaries[::-1]])

    def _grading(self, axis: int) -> tuple[float, float, Point, float, float]:
        """Low and high end, fine range, size in it and size at the ends."""
        size = self.size(axis)
        far = max(size, self.size_far)
        if self.touchdown is not None and axis < 2 and self.lies_along(axis):
            far = max(far, LONGER * size)
        if axis < 2:
            return *(self.x, self.y)[axis], self.fine_range(axis), size, far
        fine = min(self.depth, size * _nearest(0.5 * self.strip / size))
        return self.level - self.depth, self.level, (self.level - fine, self.level), size, far

    @property
    def span(self) -> float:
        """The longest side [m]."""
        return float(max(self.x[1] - self.x[0], self.y[1] - self.y[0], self.depth))

    @property
    def reach(self) -> float:
        """Greatest distance along an axis from the riser's strip to the block's faces [m]."""
        (x0, x1), (y0, y1) = self.fine_range(0), self.fine_range(1)
        return max(x0 - self.x[0], self.x[1] - x1, y0 - self.y[0], self.y[1] - y1, self.depth)

    def cubes(self) -> float:
        """Integral of 1/size^3, about the number of cubes; the size grows linearly away from the riser's strip."""
        (x, dx), (y, dy), (z, dz) = self._around(0), self._around(1), _outwards(self.depth, self.finest)
        away = np.sqrt(x[:, None, None] ** 2 + y[:, None] ** 2 + z**2)
        size = self.finest + (self.size_far - self.finest) * np.minimum(away / self.reach, 1.0)
        return float(np.einsum("i,j,k,ijk->", dx, dy, dz, size**-3.0))

    def _around(self, axis: int) -> tuple[Array, Array]:
        """Distances of pieces of the block along x or y from the riser's strip, and their lengths [m]."""
        (low, high), (first, last) = (self.x, self.y)[axis], self.fine_range(axis)
        below, above = (_outwards(length, self.finest) for length in (first - low, high - last))
        return np.concatenate((below[0], [0.0], above[0])), np.concatenate((below[1], [last - first], above[1]))


def in_units(spec: BlockSpec, unit: float) -> BlockSpec:
    """The block in units of length of so many metres."""
    block: BlockSpec = _in_units(spec, unit)
    return block


def _in_units(lengths: Any, unit: float) -> Any:
    match lengths:
        case bool():
            return lengths
        case float() | int():
            return round(lengths / unit, _DIGITS)
        case tuple():
            return tuple(_in_units(each, unit) for each in lengths)
        case BlockSpec() | TrenchSpec() | GrooveSpec():
            return type(lengths)(**{f.name: _in_units(getattr(lengths, f.name), unit) for f in fields(lengths)})
        case _:
            return lengths


def _odd(cells: float) -> int:
    """The odd number nearest to a number of cells."""
    return max(1, 2 * _nearest(0.5 * (cells - 1.0)) + 1)


def _nearest(cells: float) -> int:
    return round(round(cells, _ROUNDED))


def graded(low: float, high: float, fine: Point, size: float, size_far: float) -> Array:
    """Coordinates from low to high: cells of `size` in the fine range, growing to `size_far` at the ends."""
    count = max(1, _nearest((fine[1] - fine[0]) / size))
    middle = np.linspace(fine[0], fine[1], count + 1) if fine[1] > fine[0] else np.array([fine[0]])
    below = fine[0] - growing(fine[0] - low, size, size_far)[:0:-1]
    above = fine[1] + growing(high - fine[1], size, size_far)[1:]
    return np.concatenate((below, middle, above))


def landing(x: Array, places: Sequence[float]) -> Array:
    """Coordinates that grow like x (n,) and have all of the places, increasing and within x, among them."""
    number = np.arange(len(x), dtype=float)
    at = np.interp(np.array([x[0], *places, x[-1]]), x, number)
    cells = np.maximum(1, np.round(np.round(np.diff(at), _ROUNDED))).astype(int)
    pieces = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(at, at[1:], cells, strict=False)]
    out: Array = np.interp(np.append(np.concatenate(pieces), at[-1]), number, x)
    out[np.cumsum(cells[:-1])] = places
    return out


def _outwards(length: float, size: float) -> tuple[Array, Array]:
    """Middles and lengths of pieces from 0 to `length`, the longer the farther out."""
    if length <= 0.0:
        return np.zeros(0), np.zeros(0)
    edges = np.concatenate(([0.0], np.geomspace(min(0.5 * size, 0.5 * length), length, _PIECES)))
    return 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)


def growing(length: float, size: float, size_far: float) -> Array:
    """Distances 0..length whose steps grow geometrically from about `size` to about `size_far`."""
    count, ratio = steps(length, size, size_far), size_far / size
    if count == 0:
        return np.zeros(1)
    if count > MOST_CELLS:
        raise MeshError(
            f"soil.mesh: {length:.4g} m of the block in cells of {size:.4g} to {size_far:.4g} m are {count:.4g} cells "
            f"in a row, at most {MOST_CELLS:,} are made; take a smaller soil.block or a larger soil.mesh.size_far"
        )
    if abs(ratio - 1.0) < _EQUAL:
        return np.linspace(0.0, length, count + 1)
    distances: Array = length * (ratio ** (np.arange(count + 1) / count) - 1.0) / (ratio - 1.0)
    return distances


def steps(length: float, size: float, size_far: float) -> int:
    """Number of steps that `growing` takes."""
    if length <= 1e-9 * size:
        return 0
    if abs(size_far / size - 1.0) < _EQUAL:
        return max(1, _nearest(length / size))
    return max(1, math.ceil(length * math.log(size_far / size) / (size_far - size) - 1e-9))
