"""Element families: eight-node hexahedra with mean dilatation (B-bar), ten-node tetrahedra.

Undrained clay is nearly incompressible: fully integrated linear elements lock and never reach a collapse
load. Node numbers are basix' (vertices 0.. in lexicographic order, then the edges' midpoints).
"""

from __future__ import annotations

from dataclasses import dataclass

import basix
import numpy as np

from riser_soil.core.arrays import Array


@dataclass(frozen=True)
class Family:
    """An element family: nodes, shape functions and quadrature of its cells.

    faces: local nodes of each face, corners in a cycle (`quad4`), for `tri6` followed by the midpoints of the
    sides 12, 23, 31. vtk: basix' local node at each place of VTK's order. flip: face nodes of the same face
    seen from behind. axes: along which its cells extend; thickness: along the third one, where there is one [m].
    """

    cell: basix.CellType
    degree: int
    vertices: int
    quadrature_degree: int
    mean_dilatation: bool
    corners: int
    faces: tuple[tuple[int, ...], ...]
    flip: tuple[int, ...]
    vtk: tuple[int, ...]
    axes: tuple[int, ...] = (0, 1, 2)
    thickness: float = 1.0

    @property
    def plane(self) -> bool:
        """Whether its cells are in plane strain."""
        return len(self.axes) == 2

    def quadrature(self) -> tuple[Array, Array]:
        """Points (nq, 3) and weights (nq,) on the reference cell; in a plane (nq, 2)."""
        points, weights = basix.make_quadrature(self.cell, self.quadrature_degree)
        return np.asarray(points), np.asarray(weights)

    def values(self, points: Array) -> Array:
        """Shape functions (nq, nn)."""
        return np.asarray(_tabulate(self.cell, self.degree, points)[0, :, :, 0])

    def gradients(self, points: Array) -> Array:
        """Derivatives of the shape functions on the reference cell (nq, nn, 3); in a plane (nq, nn, 2)."""
        return _reference_gradients(self.cell, self.degree, points)


def _reference_gradients(cell: basix.CellType, degree: int, points: Array) -> Array:
    return np.ascontiguousarray(np.moveaxis(_tabulate(cell, degree, points)[1:, :, :, 0], 0, 2))


def _tabulate(cell: basix.CellType, degree: int, points: Array) -> Array:
    element = basix.create_element(basix.ElementFamily.P, cell, degree, basix.LagrangeVariant.gll_warped)
    table: Array = element.tabulate(1, points)
    return table


HEX8 = Family(
    cell=basix.CellType.hexahedron,
    degree=1,
    vertices=8,
    quadrature_degree=3,
    mean_dilatation=True,
    corners=4,
    faces=((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)),
    flip=(0, 3, 2, 1),
    vtk=(0, 1, 3, 2, 4, 5, 7, 6),
)

TET10 = Family(
    cell=basix.CellType.tetrahedron,
    degree=2,
    vertices=4,
    quadrature_degree=2,
    mean_dilatation=False,
    corners=3,
    faces=((0, 1, 2, 9, 6, 8), (0, 1, 3, 9, 5, 7), (0, 2, 3, 8, 4, 7), (1, 2, 3, 6, 4, 5)),
    flip=(0, 2, 1, 5, 4, 3),
    vtk=(0, 1, 2, 3, 9, 6, 8, 7, 5, 4),
)

QUAD4 = Family(
    cell=basix.CellType.quadrilateral,
    degree=1,
    vertices=4,
    quadrature_degree=3,
    mean_dilatation=True,
    corners=2,
    faces=((0, 1), (0, 2), (1, 3), (2, 3)),
    flip=(1, 0),
    vtk=(0, 1, 3, 2),
    axes=(1, 2),
)
