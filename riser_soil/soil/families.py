"""Element families: hexahedra and quadrilaterals with mean dilatation (B-bar), and ten-node tetrahedra.

Undrained clay is nearly incompressible: fully integrated linear elements lock and never reach a collapse
load. Node numbers are basix' (vertices 0.. in lexicographic order, then the edges' midpoints). What happens in a cell
is in weak_form.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import basix
import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import MeshError
from riser_soil.soil import kernels

FOLDS = 0.1  # skewness of a cell


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

    @cached_property
    def normal(self) -> int:
        """The axis along which cells in plane strain don't extend."""
        return next(axis for axis in range(3) if axis not in self.axes)

    @cached_property
    def quadrature(self) -> tuple[Array, Array]:
        """Points (nq, 3) and weights (nq,) on the reference cell; in a plane (nq, 2)."""
        points, weights = basix.make_quadrature(self.cell, self.quadrature_degree)
        return np.asarray(points), np.asarray(weights)

    @cached_property
    def values(self) -> Array:
        """Shape functions (nq, nn) at the quadrature's points."""
        return np.asarray(tabulate(self.cell, self.degree, self.quadrature[0])[0, :, :, 0])

    @cached_property
    def derivatives(self) -> Array:
        """Derivatives of the shape functions on the reference cell (nq, nn, 3) at the quadrature's points; in a plane
        (nq, nn, 2).
        """
        table = tabulate(self.cell, self.degree, self.quadrature[0])[1:, :, :, 0]
        return np.ascontiguousarray(np.moveaxis(table, 0, 2))


def tabulate(cell: basix.CellType, degree: int, points: Array) -> Array:
    """Lagrange shape functions and their derivatives (1 + d, n, nn, 1) at places (n, d) of a reference cell."""
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


def point_volumes(family: Family, points: Array, cells: IntArray) -> Array:
    """What each quadrature point (nc, nq) of the cells (nc, nn) of nodes at points (n, 3) stands for [m3]; MeshError if
    a cell is inverted or flat.
    """
    at, axes = points[cells], np.array(family.axes)
    determinant = _determinants(family, at)
    _check_shape(determinant, at, axes)
    return np.abs(determinant) * family.quadrature[1] * family.thickness


def _determinants(family: Family, at: Array) -> Array:
    """Determinants (nc, nq) of the maps from the reference cell to cells with nodes at (nc, nn, 3)."""
    out = np.empty((len(at), len(family.derivatives)))
    kernels.write_determinants(at, np.array(family.axes), family.derivatives, out)
    return out


def skewness(family: Family, points: Array, cells: IntArray) -> Array:
    """Least over mean determinant of the map in each cell (nc,), at quadrature points: 1 in bricks, 0 when it folds."""
    determinant = _determinants(family, points[cells])
    determinant *= np.sign(determinant[:, :1])
    return np.asarray(determinant.min(axis=1) / np.abs(determinant).mean(axis=1))


def _check_shape(determinant: Array, at: Array, axes: IntArray) -> None:
    """The map's determinant keeps its sign and is not negligible beside the cell's size."""
    span = np.empty(len(at))
    kernels.write_spans(at, axes, span)
    signed = determinant * np.sign(determinant[:, :1])
    bad = np.flatnonzero(signed.min(axis=1, initial=np.inf) <= 1e-9 * span ** len(axes))
    if len(bad):
        place = ", ".join(f"{x:.4g}" for x in at[bad[0]][:, axes].mean(axis=0))
        raise MeshError(
            f"soil mesh: the cell at ({place}) m is inverted or flat ({len(bad)} such cells); mend the mesh"
        )
