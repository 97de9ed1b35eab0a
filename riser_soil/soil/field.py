"""Displacement field of the soil, its dofs and supports, and the mesh gathered on rank 0 for output and contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved
from riser_soil.soil.grid import DistributedMesh
from riser_soil.soil.mirror import Unfolding
from riser_soil.soil.surface import SoilTop

T = TypeVar("T", bound=np.generic)


class SoilField:
    """Field "soil": three displacements at every node of this rank, ghosts included.

    The bottom is fixed, the block's upright sides slide on rollers (no normal displacement), the top is free.
    Nodes behind a mirror view their twins' dofs. total (size,): committed displacement since the geostatic start [m].
    section (size,): number of the independent section that each entry lies in; None where the soil has none.
    """

    name = "soil"
    space = "soil"

    def __init__(self, grid: DistributedMesh) -> None:
        nodes = grid.nodes
        self.points = nodes.points
        self.size = 3 * len(nodes.points)
        self.offset = 0
        twins, self.sign = grid.twins(), grid.signs().ravel()
        self.global_index: IntArray = components(nodes.number[twins])
        own = (twins == np.arange(len(twins))) & (np.arange(len(twins)) < nodes.owned)
        self.owned: BoolArray = np.repeat(own, 3)
        self._fixed_dofs: dict[bool, BoolArray] = {  # by whether the boundary is fixed
            boundary: grid.fixed_directions(nodes.points, boundary).ravel() for boundary in (True, False)
        }
        self.prescribed: BoolArray = self._fixed_dofs[True]
        self.section = None if grid.section is None else np.repeat(grid.section, 3)
        self.total: Array = np.zeros(self.size)

    def fix_boundary(self, fixed: bool) -> None:
        """Fix bottom and sides as by default, or let them move."""
        self.prescribed = self._fixed_dofs[fixed]

    @property
    def boundary_dofs(self) -> BoolArray:
        """Which dofs (size,) only a fixed boundary fixes."""
        return np.asarray(self._fixed_dofs[True] & ~self._fixed_dofs[False])

    def own(self, values: Array) -> Array:
        """The field's slice of a local array."""
        return values[self.offset : self.offset + self.size]

    def prescribe(self, t: float, u: Array, v: Array, a: Array) -> None:
        for values in (u, v, a):
            values[self.prescribed] = 0.0

    def magnitudes(self, state: State) -> Array:
        return np.abs(self.total + self.own(state.u))

    def commit(self, state: State) -> None:
        self.total += self.own(state.u)

    def state(self) -> Saved:
        return {"total": self.total.copy()}

    def restore(self, saved: Saved) -> None:
        self.total = saved["total"].copy()

    def describe(self, entry: int) -> str:
        node, direction = divmod(entry, 3)
        x, y, z = np.round(self.points[node], 3) + 0.0
        return f"soil node at ({x:g}, {y:g}, {z:g}) m, {'xyz'[direction]} displacement"


def components(nodes: IntArray, axes: tuple[int, ...] = (0, 1, 2)) -> IntArray:
    """Numbers of each node's components along some axes: (..., n) to (..., d n)."""
    return (3 * nodes[..., None] + np.array(axes)).reshape(*nodes.shape[:-1], len(axes) * nodes.shape[-1])


@dataclass(frozen=True, eq=False)
class GatheredMesh:
    """Points (n, 3) [m] by global node number, cells (nc, nn), rank by rank, and number (nc,) of the named volume that
    each lies in; behind them what a mirror adds, see `Unfolding`. Empty on the other ranks.
    """

    points: Array
    cells: IntArray
    volume: IntArray
    unfolding: Unfolding


def gather(grid: DistributedMesh) -> GatheredMesh:
    """Bring the mesh to rank 0 (collective)."""
    nodes = grid.nodes
    points = gather_rows(grid, nodes.points[: nodes.owned])
    cells, volume = gather_rows(grid, nodes.number[nodes.cells]), gather_rows(grid, grid.volume)
    all_of = Unfolding.of(grid.mirror, points, cells)
    return GatheredMesh(all_of.points(points), all_of.connected(cells), all_of.of_cells(volume), all_of)


def gather_rows(grid: DistributedMesh, rows: npt.NDArray[T]) -> npt.NDArray[T]:
    """Concatenate the ranks' rows on rank 0, in the order of ranks; no rows elsewhere (collective)."""
    pieces = grid.nodes.comm.gather(rows)
    return rows[:0] if pieces is None else np.concatenate(pieces)


def top_of(grid: DistributedMesh, mesh: GatheredMesh, moves: bool) -> SoilTop:
    """The surface that looks upwards; without points where the mesh is not gathered."""
    facets, cells = top_facets(grid, mesh)
    used = np.unique(facets)
    points = mesh.points[used]
    return SoilTop(points, np.searchsorted(used, facets), *views(grid, mesh, used), mesh.volume[cells], moves)


def views(grid: DistributedMesh, mesh: GatheredMesh, nodes: IntArray) -> tuple[IntArray, Array, BoolArray]:
    """Dofs of nodes (n,) of all, three each: number, sign, and whether they are supported."""
    unfolding, supported = mesh.unfolding, grid.fixed_directions(mesh.points[nodes])
    return components(unfolding.source[nodes]), unfolding.sign[nodes].ravel(), supported.ravel()


def top_facets(grid: DistributedMesh, mesh: GatheredMesh) -> tuple[IntArray, IntArray]:
    """Boundary facets that look upwards (nf, nv): counter-clockwise from above, ordered as `Family.faces`; and the
    cell (nf,) of each.
    """
    family = grid.family
    faces: IntArray = mesh.cells[:, np.array(family.faces)].reshape(-1, len(family.flip))
    outer = _unshared(faces[:, : family.corners])
    faces, cells = faces[outer], outer // len(family.faces)
    outward = mesh.points[faces].mean(axis=1) - mesh.points[mesh.cells[cells]].mean(axis=1)
    inside_out = np.einsum("fi,fi->f", _normal(mesh.points, faces), outward) < 0.0
    faces[inside_out] = faces[inside_out][:, family.flip]
    upwards = _normal(mesh.points, faces)[:, 2] > 0.01
    return faces[upwards], cells[upwards]


def _unshared(corners: IntArray) -> IntArray:
    """Rows that no other row repeats in whatever order."""
    _, first, count = np.unique(np.sort(corners, axis=1), axis=0, return_index=True, return_counts=True)
    return np.sort(first[count == 1])


def _normal(points: Array, faces: IntArray) -> Array:
    """Unit normal (nf, 3) from the first three corners."""
    a, b, c = (points[faces[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    return normal / np.linalg.norm(normal, axis=1, keepdims=True)
