"""Mesh quality of the soil: sizes, aspect ratios and scaled Jacobians of its cells, over all ranks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.soil.grid import DistributedMesh


@dataclass(frozen=True)
class MeshQuality:
    """Extremes over all cells. smallest, largest: edges [m]. aspect: worst ratio, 1 is best: of a hexahedron its
    longest over its shortest edge, of a tetrahedron its longest edge over 2√6 radii of its inscribed sphere. jacobian:
    smallest scaled Jacobian, 1 is best, 0 flat: volume of the edges from a corner over that of a best-shaped corner
    with edges as long. thin: place of the worst aspect, skewed: of the smallest Jacobian [m]. poor: cells below `POOR`.
    """

    smallest: float
    largest: float
    aspect: float
    thin: tuple[float, ...]
    jacobian: float
    skewed: tuple[float, ...]
    poor: int


POOR = 0.1  # scaled Jacobian below which a warning names the cell


def quality_of(grid: DistributedMesh) -> MeshQuality:
    """Quality of a grid, known on every rank (collective)."""
    corners = grid.nodes.points[grid.nodes.cells[:, : grid.family.vertices]]
    of_kind = _quadrilaterals if grid.family.plane else _tetrahedra if corners.shape[1] == 4 else _hexahedra
    qualities = grid.nodes.comm.allgather(_of_cells(corners, of_kind) if len(corners) else None)
    ranks = [each for each in qualities if each is not None]
    thin, skewed = max(ranks, key=lambda q: q.aspect), min(ranks, key=lambda q: q.jacobian)
    return MeshQuality(
        min(q.smallest for q in ranks),
        max(q.largest for q in ranks),
        thin.aspect,
        thin.thin,
        skewed.jacobian,
        skewed.skewed,
        sum(q.poor for q in ranks),
    )


def _of_cells(corners: Array, of_kind: Callable[[Array], tuple[Array, Array, Array]]) -> MeshQuality:
    """Quality of cells with corners (nc, 4 or 8, 3) [m]."""
    edges, aspect, jacobian = of_kind(corners)
    worst, least = int(aspect.argmax()), int(jacobian.argmin())
    middle = corners.mean(axis=1)
    return MeshQuality(
        float(edges.min()),
        float(edges.max()),
        float(aspect[worst]),
        tuple(middle[worst].tolist()),
        float(jacobian[least]),
        tuple(middle[least].tolist()),
        int(np.count_nonzero(jacobian < POOR)),
    )


def _tetrahedra(corners: Array) -> tuple[Array, Array, Array]:
    """Lengths of the edges (nc, 6), aspect ratios and scaled Jacobians (nc,)."""
    pairs = list(combinations(range(4), 2))
    edges = np.linalg.norm(np.stack([corners[:, b] - corners[:, a] for a, b in pairs], axis=1), axis=2)
    six_volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    area = sum(
        0.5 * np.linalg.norm(np.cross(corners[:, b] - corners[:, a], corners[:, c] - corners[:, a]), axis=1)
        for a, b, c in combinations(range(4), 3)
    )
    inscribed = 0.5 * six_volumes / area
    at_corner = [[k for k, pair in enumerate(pairs) if corner in pair] for corner in range(4)]
    product = np.max([edges[:, own].prod(axis=1) for own in at_corner], axis=0)
    aspect = edges.max(axis=1) / (2.0 * np.sqrt(6.0) * np.maximum(inscribed, np.finfo(float).tiny))
    return edges, aspect, np.sqrt(2.0) * six_volumes / product


def _quadrilaterals(corners: Array) -> tuple[Array, Array, Array]:
    """Lengths of the edges (nc, 8), aspect ratios and scaled Jacobians (nc,); corners in lexicographic order."""
    number = np.arange(4)
    along = corners[:, number[:, None] ^ np.array([1, 2])] - corners[:, :, None]
    length = np.linalg.norm(along, axis=3)
    sine = np.linalg.norm(np.cross(along[:, :, 0], along[:, :, 1]), axis=2) / length.prod(axis=2)
    edges = length.reshape(len(corners), 8)
    return edges, edges.max(axis=1) / edges.min(axis=1), sine.min(axis=1)


def _hexahedra(corners: Array) -> tuple[Array, Array, Array]:
    """Lengths of the edges (nc, 24), aspect ratios and scaled Jacobians (nc,); corners in lexicographic order."""
    number = np.arange(8)
    neighbours = number[:, None] ^ np.array([1, 2, 4])
    along = corners[:, neighbours] - corners[:, :, None]
    length = np.linalg.norm(along, axis=3)
    turned = np.where((number & 1) ^ (number >> 1 & 1) ^ (number >> 2 & 1), -1.0, 1.0)
    jacobian = turned * np.linalg.det(along) / length.prod(axis=2)
    jacobian *= np.sign(jacobian.sum(axis=1, keepdims=True))
    edges = length.reshape(len(corners), 24)
    return edges, edges.max(axis=1) / edges.min(axis=1), jacobian.min(axis=1)
