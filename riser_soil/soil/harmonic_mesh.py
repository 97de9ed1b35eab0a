"""New meshes of cells in no order, such as tetrahedra, that have been strained: nodes go where a harmonic map says.

The map from where nodes are to where they were at first is taken as harmonic between nodes that stay, on the surface
and then within; a node goes to the place that is mapped to where it was at first. It leaves what is undisturbed as it
is, and is that of Winslow's equations: A. M. Winslow, Numerical solution of the quasilinear Poisson equation in a
nonuniform triangle mesh, J. Comput. Phys. 1 (1966). Here it is linear in each of the simplices that cells and facets
are cut into.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import factorial

import basix
import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.soil.families import FOLDS, Family, skewness, tabulate
from riser_soil.soil.field import GatheredMesh
from riser_soil.soil.grid import DistributedMesh
from riser_soil.soil.sections import MOST_RAISED, Pressing
from riser_soil.soil.surface import SoilTop

BESIDE = 1.001  # radii of a simplex about its middle, within which it may hold a place
FLAT = 1e-12  # of a simplex' size: a volume that is none

TETRAHEDRA = {  # tetrahedra of a cell, by its nodes
    10: (
        *((0, 9, 8, 7), (1, 9, 6, 5), (2, 8, 6, 4), (3, 7, 5, 4)),
        *((9, 4, 8, 7), (9, 4, 7, 5), (9, 4, 5, 6), (9, 4, 6, 8)),
    ),
    8: ((0, 1, 3, 7), (0, 1, 5, 7), (0, 2, 3, 7), (0, 2, 6, 7), (0, 4, 5, 7), (0, 4, 6, 7)),
}


@dataclass(frozen=True, eq=False)
class FacetKind:
    """Facets of the top: their reference cell and degree, places (nv, 2) of its nodes, the number that basix gives
    them, and the triangles that they are cut into.
    """

    cell: basix.CellType
    degree: int
    places: Array
    order: tuple[int, ...]
    triangles: tuple[tuple[int, int, int], ...]

    def shape(self, at: Array) -> Array:
        """Shape functions and their derivatives (3, n, nv) at places (n, 2)."""
        return tabulate(self.cell, self.degree, at)[:, :, self.order, 0]


TRI6 = FacetKind(
    basix.CellType.triangle,
    2,
    np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]]),
    (0, 1, 2, 5, 3, 4),
    ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
)
QUAD = FacetKind(
    basix.CellType.quadrilateral,
    1,
    np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
    (0, 1, 3, 2),
    ((0, 1, 2), (0, 2, 3)),
)


@dataclass(frozen=True, eq=False)
class HarmonicMesh:
    """Nodes at first (n, 3), cells (nc, nn) of a family, facets (nf, nv) of the top as `SoilTop` has them, and which
    directions (n, 3) are fixed.
    """

    family: Family
    first: Array
    cells: IntArray
    facets: IntArray
    fixed: BoolArray

    @classmethod
    def of(cls, grid: DistributedMesh, mesh: GatheredMesh, top: SoilTop) -> HarmonicMesh:
        """The mesh motion of a whole mesh, gathered, and its top."""
        facets = (top.global_index[::3] // 3)[top.facets]
        return cls(grid.family, mesh.points, mesh.cells, facets, grid.fixed_directions(mesh.points))

    def renewed(self, points: Array, worn: BoolArray, pipe: Pressing) -> tuple[Array, BoolArray]:
        """All nodes (n, 3), and which of them (n,) go to new places: those of cells with worn ones (n,); none where a
        new cell would be folded.
        """
        free = np.zeros_like(worn)
        free[self.cells[worn[self.cells].any(axis=1)]] = True
        cells = self.cells[free[self.cells].any(axis=1)]
        out, at_first = self._surface(points, free & self._top, pipe)
        numbers = np.flatnonzero(free & ~self._top)
        tetrahedra = _cut(cells, TETRAHEDRA[cells.shape[1]])
        now = _harmonic(points, at_first, tetrahedra, _may_move(numbers, self.fixed))
        number, shares = _located(self.first[numbers], now, tetrahedra)
        out[numbers] = np.einsum("nk,nki->ni", shares, points[tetrahedra[number]])
        out[self.fixed] = points[self.fixed]
        if skewness(self.family, out, cells).min(initial=1.0) > FOLDS:
            return out, free
        return points, np.zeros_like(free)

    @cached_property
    def _top(self) -> BoolArray:
        """Which nodes are of the top (n,)."""
        out = np.zeros(len(self.first), dtype=bool)
        out[self.facets] = True
        return out

    def _surface(self, points: Array, free: BoolArray, pipe: Pressing) -> tuple[Array, Array]:
        """All nodes, the free ones of the top (n,) spread anew along it; and where these places were at first."""
        out, at_first, numbers = points.copy(), self.first.copy(), np.flatnonzero(free)
        if not len(numbers):
            return out, at_first
        facets = Facets.of(self.facets[free[self.facets].any(axis=1)])
        may, in_plan = _may_move(numbers, self.fixed)[:, :2], self.first[:, :2]
        now, then = (_harmonic(at, in_plan, facets.triangles, may) for at in (points, self.first))
        at_first[numbers] = facets.values(self.first, *facets.located(now[numbers], then))
        place, gaps, near = facets.located(then[numbers], now), np.zeros((len(points), 1)), np.unique(facets.nodes)
        gaps[near, 0] = pipe.gaps(points[near])
        beside = facets.values(gaps, *place)[:, 0]
        out[numbers] = pipe.brought_to(facets.values(points, *place), beside)
        above = np.zeros(len(points), dtype=bool)
        above[numbers] = beside > pipe.clear
        return pipe.kept_clear(lambda raised: facets.refilled(points, out, raised), above), at_first


@dataclass(frozen=True, eq=False)
class Facets:
    """Facets (nf, nv) of the surface, and the triangles (nt, 3) that they are cut into, one facet's after the other."""

    kind: FacetKind
    nodes: IntArray
    triangles: IntArray

    @classmethod
    def of(cls, nodes: IntArray) -> Facets:
        kind = TRI6 if nodes.shape[1] == 6 else QUAD
        return cls(kind, nodes, _cut(nodes, kind.triangles))

    def located(self, points: Array, images: Array) -> tuple[IntArray, Array]:
        """Facets (n,) and places (n, 2) on them of points (n, 2), among the nodes' images (np, 2)."""
        number, shares = _located(points, images, self.triangles)
        facet, piece = np.divmod(number, len(self.kind.triangles))
        corners = self.kind.places[np.array(self.kind.triangles)[piece]]
        return facet, np.asarray(np.einsum("nk,nki->ni", shares, corners))

    def values(self, nodal: Array, facet: IntArray, at: Array) -> Array:
        """Values (n, k) at places (n, 2) on facets (n,) of those at nodes."""
        return np.asarray(np.einsum("nv,nvk->nk", self.kind.shape(at)[0], nodal[self.nodes[facet]]))

    def refilled(self, before: Array, after: Array, free: BoolArray) -> Array:
        """Nodes (n, 3) after, with as much soil below the facets as before: free ones are raised by a share of the ways
        that they have gone, as corners are cut off on these.
        """
        ways = np.where(free, np.linalg.norm(after - before, axis=1), 0.0)
        up = ways[:, None] * self._normals(after)
        below = self._volume_below(after)
        gained = self._volume_below(after + up) - below
        if gained <= 0.0:
            return after
        share = (self._volume_below(before) - below) / gained
        return after + min(max(share, -MOST_RAISED), MOST_RAISED) * up

    def _normals(self, points: Array) -> Array:
        """Unit normals (n, 3) at nodes, upwards."""
        a, b, c = (points[self.triangles[:, k]] for k in range(3))
        out = np.zeros_like(points)
        np.add.at(out, self.triangles, np.cross(b - a, c - a)[:, None])
        size = np.linalg.norm(out, axis=1, keepdims=True)
        return np.asarray(out / np.where(size > 0.0, size, 1.0))

    def _volume_below(self, points: Array) -> float:
        """Down to z = 0 [m3]."""
        at, weights = basix.make_quadrature(self.kind.cell, 2 * self.kind.degree)
        N, *dN = self.kind.shape(at)
        x, along, aside = (np.einsum("qv,fvi->fqi", each, points[self.nodes]) for each in (N, *dN))
        in_plan = along[..., 0] * aside[..., 1] - along[..., 1] * aside[..., 0]
        return float(np.sum(weights * x[..., 2] * in_plan))


def _cut(cells: IntArray, pieces: Sequence[Sequence[int]]) -> IntArray:
    """The pieces of each cell by its nodes, one cell's after the other."""
    cut = cells[:, np.array(pieces)]
    return cut.reshape(-1, cut.shape[2])


def _may_move(numbers: IntArray, fixed: BoolArray) -> BoolArray:
    """Directions (n, 3) in which nodes (k,) may move: those not fixed."""
    out = np.zeros_like(fixed)
    out[numbers] = ~fixed[numbers]
    return out


def _harmonic(at: Array, values: Array, pieces: IntArray, free: BoolArray) -> Array:
    """Values (n, k) at nodes, free ones (n, k) by the harmonic fields between the others; nodes at (n, 3)."""
    out = values.copy()
    stiffness = _laplacian(at, pieces)
    for k in range(values.shape[1]):
        unknown, given = np.flatnonzero(free[:, k]), np.flatnonzero(~free[:, k])
        if len(unknown):
            rows = stiffness[unknown]
            out[unknown, k] = splu(rows[:, unknown].tocsc()).solve(-rows[:, given] @ values[given, k])
    return out


def _laplacian(at: Array, pieces: IntArray) -> csr_matrix:
    """Laplace matrix (n, n) of fields that are linear in simplices (m, d + 1) of nodes at (n, 3)."""
    edges = at[pieces[:, 1:]] - at[pieces[:, :1]]
    metric = np.einsum("mai,mbi->mab", edges, edges)
    size = np.sqrt(np.linalg.det(metric)) / factorial(edges.shape[1])
    inverse = np.linalg.inv(metric)
    local = np.empty((len(pieces), pieces.shape[1], pieces.shape[1]))
    local[:, 1:, 1:] = inverse
    local[:, 0, 1:] = local[:, 1:, 0] = -inverse.sum(axis=1)
    local[:, 0, 0] = inverse.sum(axis=(1, 2))
    rows, columns = np.broadcast_arrays(pieces[:, :, None], pieces[:, None, :])
    values = (size[:, None, None] * local).ravel()
    return csr_matrix((values, (rows.ravel(), columns.ravel())), shape=(len(at), len(at)))


def _located(points: Array, images: Array, pieces: IntArray) -> tuple[IntArray, Array]:
    """Simplices (n,) of nodes at images (np, d) that points (n, d) lie in most deeply, and barycentric coordinates."""
    corners = images[pieces]
    middle = corners.mean(axis=1)
    radius = np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1)
    near = cKDTree(points).query_ball_point(middle, BESIDE * radius)
    simplex, place = np.repeat(np.arange(len(pieces)), [len(group) for group in near]), np.concatenate(near).astype(int)
    simplex, place = np.append(simplex, cKDTree(middle).query(points)[1]), np.append(place, np.arange(len(points)))
    edges = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)
    flat = np.abs(np.linalg.det(edges)) <= FLAT * radius ** edges.shape[1]
    inverse = np.linalg.inv(np.where(flat[:, None, None], np.eye(edges.shape[1]), edges))
    inner = np.einsum("nij,nj->ni", inverse[simplex], points[place] - corners[simplex, 0])
    shares = np.column_stack([1.0 - inner.sum(axis=1), inner])
    depth = np.where(flat[simplex], -np.inf, shares.min(axis=1))
    _, deepest = np.unique(place[order := np.lexsort((-depth, place))], return_index=True)
    chosen = order[deepest]
    return simplex[chosen], shares[chosen]
