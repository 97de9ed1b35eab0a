"""Soil mesh from a user's file: read by gmsh, checked, left in gmsh as one volume of numbered nodes and cells.

Node numbers may have gaps, nodes may belong to no cell, and a cell may be listed once for each of its physical groups:
gmsh writes such files. What would give another soil than the one drawn is refused.

Needs a running gmsh.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import gmsh
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.errors import MeshError

TETRAHEDRON, HEXAHEDRON = 4, 5  # gmsh's numbers of the first-order cells
_FACES = {
    TETRAHEDRON: ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)),
    HEXAHEDRON: ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
}
_SAME = 1e-9  # distance of two nodes, over the size of the mesh, that is none
_BESIDE = 1e-6  # over the size of a face: distance of a node from it that is none
_FARTHEST = 1e12  # m


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes (n, 3) [m] and cells (nc, nv) of them, of one of gmsh's kinds; number (nc,) of the volume of each."""

    kind: int
    points: Array
    cells: IntArray
    volume: IntArray


def read_mesh(path: Path, volumes: Sequence[str] = ()) -> float:
    """Leave a file's mesh in gmsh's current model; the model's unit of length [m]; MeshError if it won't do.

    volumes: names of physical groups, one physical group each from 1 on in the model; without them there is one.
    """
    _merge(path)
    mesh = _mesh(cell_type(), volumes)
    _check_nodes(mesh)
    _check_faces(mesh)
    _replace_model(mesh)
    return 1.0


def cell_type() -> int:
    """The kind of the model's cells, tetrahedra or hexahedra; MeshError for all else."""
    types = [int(t) for t in gmsh.model.mesh.getElementTypes(3)]
    if len(types) == 1 and types[0] in _FACES:
        return types[0]
    kinds = ", ".join(gmsh.model.mesh.getElementProperties(t)[0] for t in types) or "no volume cells"
    raise MeshError(
        f"soil mesh: found {kinds}; it must hold first-order tetrahedra only or hexahedra only "
        "(in gmsh: mesh in 3 dimensions, element order 1)"
    )


def _merge(path: Path) -> None:
    if not path.is_file():
        raise MeshError(f"soil mesh {path}: there is no such file")
    try:
        gmsh.merge(str(path))
    except Exception as err:  # gmsh raises nothing more specific
        raise MeshError(f"soil mesh {path}: gmsh can't read it ({err}); save it as .msh") from err
    if not gmsh.model.getEntities(3):
        raise MeshError(f"soil mesh {path}: no volume in it; save a 3-dimensional mesh as .msh")


def _mesh(kind: int, volumes: Sequence[str]) -> Mesh:
    """The cells, each once, with the nodes that they use, in the order of their numbers."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, connected = gmsh.model.mesh.getElementsByType(kind)
    cells = np.asarray(connected, dtype=np.int64).reshape(-1, 4 if kind == TETRAHEDRON else 8)
    numbers, first = np.unique(np.asarray(tags, dtype=np.int64), return_index=True)
    used = np.unique(cells)
    if not np.isin(used, numbers).all():
        raise MeshError(f"soil mesh: cells have {int((~np.isin(used, numbers)).sum())} nodes that it doesn't hold")
    points = np.asarray(coordinates).reshape(-1, 3)[first[np.searchsorted(numbers, used)]]
    _, once = np.unique(np.sort(cells, axis=1), axis=0, return_index=True)
    once = np.sort(once)
    mesh = Mesh(kind, points, np.searchsorted(used, cells[once]), np.zeros(len(once), dtype=np.int64))
    return replace(mesh, volume=_volumes(mesh, cells, once, volumes)) if volumes else mesh


def _volumes(mesh: Mesh, cells: IntArray, once: IntArray, names: Sequence[str]) -> IntArray:
    """Number of the named volume that each of the mesh's cells lies in."""
    groups = {gmsh.model.getPhysicalName(3, tag): tag for _, tag in gmsh.model.getPhysicalGroups(3)}
    missing = [name for name in names if name not in groups]
    if missing:
        named = ", ".join(name for name in groups if name) or "none"
        raise MeshError(f"soil mesh: it has no volume named {missing[0]}; named volumes (physical groups): {named}")
    _, same = np.unique(np.sort(cells, axis=1), axis=0, return_inverse=True)
    same, inside = same.ravel(), np.zeros((len(names), len(once)), dtype=bool)
    for k, name in enumerate(names):
        within = np.isin(same, same[_cells_of(mesh.kind, groups[name])])
        inside[k] = within[once]
    wrong = np.flatnonzero(inside.sum(axis=0) != 1)
    if len(wrong):
        place = _place(mesh.points[mesh.cells[wrong[0]]].mean(axis=0))
        raise MeshError(
            f"soil mesh: the cell at {place} lies in {inside[:, wrong[0]].sum()} of the volumes "
            f"{', '.join(names)} ({len(wrong)} such cells); each must lie in one"
        )
    return np.asarray(inside.argmax(axis=0), dtype=np.int64)


def _cells_of(kind: int, group: int) -> IntArray:
    """Places of a physical group's cells among all cells of this kind."""
    everything, _ = gmsh.model.mesh.getElementsByType(kind)
    entities = gmsh.model.getEntitiesForPhysicalGroup(3, group)
    own = np.concatenate([gmsh.model.mesh.getElementsByType(kind, int(entity))[0] for entity in entities])
    return np.flatnonzero(np.isin(everything, own))


def _check_nodes(mesh: Mesh) -> None:
    size = float(np.abs(mesh.points).max())
    if not size <= _FARTHEST:
        raise MeshError(f"soil mesh: a node lies {size:.3g} m off; coordinates must be within {_FARTHEST:g} m")
    near = _SAME * float(np.ptp(mesh.points, axis=0).max())
    pairs = cKDTree(mesh.points).query_pairs(near, output_type="ndarray")
    if len(pairs):
        raise MeshError(
            f"soil mesh: {len(pairs)} pairs of nodes share a place, one at {_place(mesh.points[pairs[0, 0]])}, and the "
            "soil would come apart there; merge them (in gmsh: Coherence Mesh)"
        )


def _check_faces(mesh: Mesh) -> None:
    """Cells must meet face to face, all in one piece."""
    faces = np.concatenate([mesh.cells[:, face] for face in _FACES[mesh.kind]])
    owner = np.tile(np.arange(len(mesh.cells)), len(_FACES[mesh.kind]))
    _, first, number, count = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    if count.max() > 2:
        crowded = mesh.points[faces[first[count.argmax()]]].mean(axis=0)
        raise MeshError(f"soil mesh: {count.max()} cells share the face at {_place(crowded)}; a face has two at most")
    _check_one_piece(mesh, owner, number.ravel())
    _check_hanging_nodes(mesh, faces[count[number.ravel()] == 1])


def _check_one_piece(mesh: Mesh, owner: IntArray, number: IntArray) -> None:
    """owner, number: cell and face of each cell's faces."""
    order = np.argsort(number, kind="stable")
    same = number[order][1:] == number[order][:-1]
    a, b = owner[order][:-1][same], owner[order][1:][same]
    n = len(mesh.cells)
    pieces, of_cell = connected_components(coo_array((np.ones(a.size), (a, b)), shape=(n, n)), directed=False)
    if pieces > 1:
        middle = mesh.points[mesh.cells[of_cell != of_cell[0]][0]].mean(axis=0)
        raise MeshError(
            f"soil mesh: it is in {pieces} pieces that no face joins, one at {_place(middle)}; let the volumes share "
            "their faces (in gmsh: Coherence, before meshing)"
        )


def _check_hanging_nodes(mesh: Mesh, faces: IntArray) -> None:
    """Where cells don't meet face to face, nodes of outer faces (n, 3 or 4) lie within other outer faces."""
    corners = np.concatenate([faces[:, [0, k, k + 1]] for k in range(1, faces.shape[1] - 1)])
    nodes = np.unique(faces)
    middle = mesh.points[corners].mean(axis=1)
    radius = np.linalg.norm(mesh.points[corners] - middle[:, None], axis=2).max(axis=1)
    near = cKDTree(mesh.points[nodes]).query_ball_point(middle, 1.001 * radius)
    triangle = np.repeat(np.arange(len(corners)), [len(group) for group in near])
    node = nodes[np.concatenate(near).astype(np.int64)]
    other = (corners[triangle] != node[:, None]).all(axis=1)
    inside = _inside(mesh.points[node[other]], mesh.points[corners[triangle[other]]])
    if inside.any():
        count, at = np.unique(node[other][inside]).size, _place(mesh.points[node[other][inside.argmax()]])
        raise MeshError(
            f"soil mesh: {count} nodes lie within faces that they don't belong to, one at {at}; "
            "cells must meet face to face"
        )


def _inside(points: Array, corners: Array) -> BoolArray:
    """Whether points (n, 3) lie in triangles (n, 3, 3), their edges included."""
    a, b, arm = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], points - corners[:, 0]
    across = np.cross(a, b)
    twice = np.maximum(np.einsum("ni,ni->n", across, across), np.finfo(float).tiny)
    v = np.einsum("ni,ni->n", np.cross(arm, b), across) / twice
    w = np.einsum("ni,ni->n", np.cross(a, arm), across) / twice
    off = np.abs(np.einsum("ni,ni->n", arm, across)) / twice**0.75
    inside: BoolArray = (off < _BESIDE) & (v > -_BESIDE) & (w > -_BESIDE) & (v + w < 1.0 + _BESIDE)
    return inside


def _replace_model(mesh: Mesh) -> None:
    """Nodes and cells numbered from 1, and a physical group for each volume, from 1 on."""
    gmsh.model.add("soil")
    for k in range(int(mesh.volume.max()) + 1):
        volume = gmsh.model.addDiscreteEntity(3)
        if k == 0:
            numbers = np.arange(1, len(mesh.points) + 1)
            gmsh.model.mesh.addNodes(3, volume, numbers, mesh.points.ravel())
        cells = mesh.cells[mesh.volume == k]
        gmsh.model.mesh.addElementsByType(volume, mesh.kind, [], (cells + 1).ravel())
        gmsh.model.addPhysicalGroup(3, [volume], k + 1)


def _place(point: Array) -> str:
    return f"({', '.join(f'{x:.4g}' for x in point)}) m"
