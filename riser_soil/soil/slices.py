"""Sections: soil as independent slices in plane strain across the riser, in the place of a block.

Each slice has the columns and layers of the block's cells, as quadrilaterals; nothing moves along the riser. Slices are
not joined, so that the soil's share of the matrix falls apart into one block for each. On top the riser meets one
surface, linear from slice to slice, and level from the outermost ones to the block's ends.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from mpi4py import MPI

from riser_soil.core.snapshot import SoilMesh
from riser_soil.errors import MeshError
from riser_soil.soil.dolfinx_compat import Nodes
from riser_soil.soil.families import QUAD4
from riser_soil.soil.field import GatheredMesh, views
from riser_soil.soil.grading import BlockSpec
from riser_soil.soil.grid import DistributedMesh
from riser_soil.soil.mirror import mirror_of
from riser_soil.soil.sections import grid_cells
from riser_soil.soil.surface import SoilTop


def slice_grid(comm: MPI.Intracomm, spec: BlockSpec) -> DistributedMesh:
    """Slices of a plain block under a riser along x or y, as many as it has cells along it; ranks take turns, as those
    in the touchdown zone have the most to do.
    """
    along, across = spec.axis, 1 - spec.axis
    if not spec.lies_along(along):
        raise MeshError("soil mesh: sections need a riser that runs along x or y; turn the scene, or take model: block")
    (low, high), columns, layers = spec.ends, spec.coordinates(across), spec.coordinates(2)
    count = max(1, len(spec.coordinates(along)) - 1)
    thickness = (high - low) / count
    mine = np.arange(comm.rank, count, comm.size)
    before = sum(len(range(rank, count, comm.size)) for rank in range(comm.rank))
    per_slice = len(columns) * len(layers)
    family = replace(QUAD4, axes=(across, 2), thickness=thickness)
    points = np.zeros((len(mine), len(columns), len(layers), 3))
    points[..., along] = (low + (mine + 0.5) * thickness)[:, None, None]
    points[..., across], points[..., 2] = columns[None, :, None], layers
    cells = grid_cells(len(columns), len(layers))
    local = (per_slice * np.arange(len(mine))[:, None, None] + cells).reshape(-1, 4)
    number = per_slice * before + np.arange(len(mine) * per_slice)
    nodes = Nodes(comm, local, points.reshape(-1, 3), number, len(number))
    corners = np.array([[*spec.x, *spec.y, spec.level - spec.depth, spec.level]]).reshape(3, 2)
    volume = np.zeros(len(local), dtype=np.int64)
    section = np.repeat(mine, per_slice)
    return DistributedMesh(family, nodes, corners[:, 0], corners[:, 1], volume, mirror_of(spec), section)


def top_of_slices(grid: DistributedMesh, mesh: GatheredMesh, moves: bool) -> SoilTop:
    """The surface on rank 0: a row of each slice's top nodes, those of the outermost ones at the block's ends, too."""
    along = grid.family.normal
    top = np.flatnonzero(mesh.points[:, 2] > grid.high[2] - 1e-9 * float(np.ptp([grid.low[2], grid.high[2]])))
    if not len(mesh.points):
        none = np.zeros(0, dtype=np.int64)
        return SoilTop(mesh.points, none.reshape(0, 4), *views(grid, mesh, top), none, moves)
    columns = len(np.unique(mesh.points[top, 1 - along]))
    rows = top[np.lexsort(mesh.points[top][:, [1 - along, along]].T)].reshape(-1, columns)
    rows = np.concatenate([rows[:1], rows, rows[-1:]])
    points = mesh.points[rows]  # (ns + 2, nc, 3)
    points[0, :, along] -= 0.5 * grid.family.thickness
    points[-1, :, along] += 0.5 * grid.family.thickness
    place = np.arange(rows.size).reshape(rows.shape)
    around = place[:-1, :-1], place[1:, :-1], place[1:, 1:], place[:-1, 1:]
    facets = np.stack([each.ravel() for each in (around if along == 0 else around[::-1])], axis=1)
    dofs = views(grid, mesh, rows.ravel())
    return SoilTop(points.reshape(-1, 3), facets, *dofs, np.zeros(len(facets), dtype=np.int64), moves)


def slabs(grid: DistributedMesh, mesh: GatheredMesh) -> SoilMesh:
    """Slices as hexahedra in VTK's order, as thick as they stand for: of the nodes all those in front come first."""
    along = grid.family.normal
    half = np.zeros(3)
    half[along] = 0.5 * grid.family.thickness
    n, quads = len(mesh.points), mesh.cells[:, grid.family.vtk]
    return SoilMesh(np.concatenate([mesh.points - half, mesh.points + half]), np.hstack([quads, quads + n]))
