"""New meshes of a block of hexahedra that has been strained: its sections across the riser, each smoothed by itself.

A block of hexahedra is a grid of sections along the riser, columns across it and layers in depth, and stays one. In
each section the nodes of the surface are spread anew along it, as they were along the level surface at first, and the
inner ones follow by Winslow's equations: the map from where they are to where they were at first is harmonic, which
never folds and leaves an undisturbed section as it is. A. M. Winslow, Numerical solution of the quasilinear Poisson
equation in a nonuniform triangle mesh, J. Comput. Phys. 1 (1966).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from riser_soil.core import banded
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import njit
from riser_soil.soil.families import FOLDS, QUAD4, skewness

SAME = 1e-6  # of the block's size: coordinates nearer to each other are those of one plane of the grid
MOST_RAISED = 0.5  # of the ways that surface nodes have gone, for the soil below
MOST_PASSES, SETTLED = 30, 1e-6  # of Winslow's equations; movement of a pass over the smallest cell
CELLS = tuple(replace(QUAD4, axes=(across, 2)) for across in (0, 1))  # of a section across x, y


class Differences(NamedTuple):
    """Weights (n - 2, 3) of first and second derivatives across a section, and of those in depth: of the inner nodes
    and their neighbours.
    """

    first_across: Array
    second_across: Array
    first_down: Array
    second_down: Array


class Pressing(NamedTuple):
    """What a new surface asks of the pipe: gaps (n,) [m] between it and points (n, 3); points (n, 3), those near it at
    given gaps (n,); and the gap from which on a node is free of it.
    """

    gaps: Callable[[Array], Array]
    brought_to: Callable[[Array, Array], Array]
    clear: float

    def kept_clear(self, refilled: Callable[[BoolArray], Array], free: BoolArray) -> Array:
        """A surface whose free nodes (n,) are raised; one that would be raised to the pipe stays."""
        out, raised = refilled(free), np.flatnonzero(free)
        close = raised[self.gaps(out[raised]) < self.clear]
        if not len(close):
            return out
        clear = free.copy()
        clear[close] = False
        return self.kept_clear(refilled, clear)


@dataclass(frozen=True, eq=False)
class Sections:
    """Numbers of a block's nodes (ns, nc, nl), section by section, columns across, layers from the bottom up; places of
    the columns (nc,) and layers (nl,) at first [m]. across: axis, x (0) or y (1), of the columns.
    """

    nodes: IntArray
    columns: Array
    layers: Array
    across: int

    def renewed(self, points: Array, worn: BoolArray, pipe: Pressing) -> tuple[Array, BoolArray]:
        """All nodes (n, 3), and which of them (n,) are those of new sections: of those with worn ones (n,)."""
        out, made = points.copy(), np.zeros(len(points), dtype=bool)
        for section in self.nodes:
            new = self._renewed(points[section], pipe) if worn[section].any() else None
            if new is not None:
                out[section], made[section] = new, True
        return out, made

    def _renewed(self, at: Array, pipe: Pressing) -> Array | None:
        """New nodes of a section (nc, nl, 3), none of whose cells is folded; None where there is no such way."""
        line = at[:, -1]
        gaps = pipe.gaps(line)
        for top, beside in (spread(line, self.columns, gaps), at_columns(line, self.columns, gaps, self.across)):
            new = self.beneath(at, self._at_pipe(line, top, beside, pipe))
            if self.skewness(new) > FOLDS:
                return new
        return None

    def _at_pipe(self, line: Array, top: Array, beside: Array, pipe: Pressing) -> Array:
        """A surface (nc, 3) at gaps (nc,) from the pipe, with as much soil below it as below the line before."""
        brought = pipe.brought_to(top, beside)
        return pipe.kept_clear(lambda free: refilled(line, brought, free, self.across), beside > pipe.clear)

    def beneath(self, at: Array, top: Array) -> Array:
        """A section's nodes (nc, nl, 3): those of the surface at (nc, 3), the inner ones as these ask."""
        at = at.copy()
        at[:, -1] = top
        return smoothed(at, self.columns, self.layers, self.across)

    def skewness(self, at: Array) -> float:
        """Least of the skewness of a section's cells (1 for bricks, 0 as one folds), with nodes at (nc, nl, 3)."""
        cells = grid_cells(*at.shape[:2])
        return float(skewness(CELLS[self.across], at.reshape(-1, 3), cells).min())


def sections_of(points: Array, along: int) -> Sections | None:
    """Sections of nodes at points (n, 3), the riser along x (0) or y (1); None where they form no grid along x, y and
    z.
    """
    near = SAME * float(np.ptp(points, axis=0).max())
    place = [_planes(points[:, axis], near) for axis in (along, 1 - along, 2)]
    counts = [int(planes.max()) + 1 for planes in place]
    if np.prod(counts) != len(points):
        return None
    nodes = np.empty(counts, dtype=np.int64)
    nodes[tuple(place)] = np.arange(len(points))
    return Sections(nodes, points[nodes[0, :, 0], 1 - along], points[nodes[0, 0, :], 2], 1 - along)


def grid_cells(columns: int, layers: int) -> IntArray:
    """Nodes (nc, 4) of a section's cells, in lexicographic order; nodes are numbered column by column, upwards."""
    number = np.arange(columns * layers).reshape(columns, layers)
    corners = number[:-1, :-1], number[1:, :-1], number[:-1, 1:], number[1:, 1:]
    return np.stack([corner.ravel() for corner in corners], axis=1)


def _planes(x: Array, near: float) -> IntArray:
    """Number (n,) of the plane that each of some coordinates lies on, in rising order."""
    order = np.argsort(x)
    out = np.empty(len(x), dtype=np.int64)
    out[order] = np.append(0, np.cumsum(np.diff(x[order]) > near))
    return out


def spread(line: Array, places: Array, beside: Array) -> tuple[Array, Array]:
    """Nodes (nc, 3) spread anew along the smooth curve through those of a surface line (nc, 3), in proportion to their
    places (nc,) at first; values (nc,) beside them as they are along the line.
    """
    arc = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1)))
    now = (places - places[0]) / (places[-1] - places[0]) * arc[-1]
    return np.asarray(PchipInterpolator(arc, line)(now)), np.interp(now, arc, beside)


def at_columns(line: Array, places: Array, beside: Array, across: int) -> tuple[Array, Array]:
    """Nodes (nc, 3) of a surface line (nc, 3) put back to their places (nc,) across, and values (nc,) there; where a
    lip leans over it is cut off.
    """
    x = np.maximum.accumulate(line[:, across])
    top = np.stack([np.interp(places, x, each) for each in line.T], axis=1)
    top[:, across] = places
    return top, np.interp(places, x, beside)


def refilled(line: Array, top: Array, free: BoolArray, across: int) -> Array:
    """A new surface line `top` (nc, 3) with as much soil below it as below the old one: its free nodes (nc,) are raised
    by a share of the ways that they have gone, as corners are cut off on these.
    """
    before, after = line[:, [across, 2]], top[:, [across, 2]]
    along = np.zeros_like(after)
    along[1:-1] = 0.5 * (after[2:] - after[:-2])
    width = np.linalg.norm(along, axis=1)
    ways = np.where(free & (width > 0.0), np.linalg.norm(after - before, axis=1), 0.0)
    lost, swept = _below(before) - _below(after), float(ways @ width)
    if swept == 0.0:
        return top
    raised = ways * min(max(lost / swept, -MOST_RAISED), MOST_RAISED)
    out, up = top.copy(), along / np.where(width > 0.0, width, 1.0)[:, None]
    out[:, across] -= raised * up[:, 1]
    out[:, 2] += raised * up[:, 0]
    return out


def _below(line: Array) -> float:
    """Area below a line of points (n, 2), down to 0."""
    return float(np.sum(0.5 * (line[1:, 1] + line[:-1, 1]) * np.diff(line[:, 0])))


def smoothed(at: Array, columns: Array, layers: Array, across: int) -> Array:
    """A section's nodes (nc, nl, 3), those of its rim as they are, the inner ones by Winslow's equations from there."""
    at = at.copy()
    inner, nl = (len(columns) - 2) * (len(layers) - 2), len(layers)
    band, _ = banded.workspace(inner, nl - 1)
    smallest = min(np.diff(columns).min(), np.diff(layers).min())
    differences = Differences(*_differences(columns), *_differences(layers))
    for _ in range(MOST_PASSES if inner else 0):
        band[:] = 0.0
        largest = smooth(at, differences, across, band, np.zeros(nl - 1))
        if not largest >= SETTLED * smallest:
            break
    return at


def _differences(x: Array) -> tuple[Array, Array]:
    """Weights (n - 2, 3) of first and second derivatives at the inner ones of n places x."""
    a, b = x[1:-1] - x[:-2], x[2:] - x[1:-1]
    first = np.stack([-b / (a * (a + b)), (b - a) / (a * b), a / (b * (a + b))], axis=1)
    second = np.stack([2.0 / (a * (a + b)), -2.0 / (a * b), 2.0 / (b * (a + b))], axis=1)
    return first, second


@njit
def smooth(at: Array, differences: Differences, across: int, band: Array, width: Array) -> float:
    """Move a section's inner nodes (nc - 2, nl - 2, 3), column by column, to g22 x_11 - 2 g12 x_12 + g11 x_22 = 0, with
    metrics as they are before; by how much at most [m]. They are no numbers where that can't be solved. band: workspace
    of zeros, width: see `banded`.
    """
    nc, nl, _ = at.shape
    (d1, dd1, d2, dd2), b, size = differences, width.size, (nc - 2) * (nl - 2)
    load, pivots = np.zeros((3, size)), np.empty(size, np.int64)
    for row in range(size):
        p, q = row // (nl - 2), row % (nl - 2)
        g11 = g12 = g22 = 0.0
        for axis in (across, 2):
            x1 = x2 = 0.0
            for k in range(3):
                x1 += d1[p, k] * at[p + k, q + 1, axis]
                x2 += d2[q, k] * at[p + 1, q + k, axis]
            g11, g12, g22 = g11 + x1 * x1, g12 + x1 * x2, g22 + x2 * x2
        for i in range(3):
            for j in range(3):
                weight = -2.0 * g12 * d1[p, i] * d2[q, j]
                weight += g22 * dd1[p, i] if j == 1 else 0.0
                weight += g11 * dd2[q, j] if i == 1 else 0.0
                if 0 < p + i < nc - 1 and 0 < q + j < nl - 1:
                    band[row, b + (i - 1) * (nl - 2) + j - 1] = weight
                else:
                    for axis in range(3):
                        load[axis, row] -= weight * at[p + i, q + j, axis]
    sound, largest = banded.factorise(band, pivots, width), 0.0
    for axis in range(3):
        banded.solve(band, pivots, load[axis], width)
        for row in range(size):
            value = load[axis, row] if sound else math.nan
            p, q = 1 + row // (nl - 2), 1 + row % (nl - 2)
            largest = max(largest, abs(value - at[p, q, axis]))
            at[p, q, axis] = value
    return largest
