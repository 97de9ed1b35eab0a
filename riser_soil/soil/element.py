"""Shape-function gradients at the quadrature points (B-bar); constant, since strains are small.

The strain-displacement operator B̄ replaces the volumetric part of the symmetric gradient by `volume`
gradients: the cell's mean for hexahedra (mean dilatation: Hughes 1980, doi:10.1002/nme.1620150914; the full
gradients elsewhere).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import MeshError
from riser_soil.soil.families import Family


@dataclass(frozen=True, eq=False)
class Gradients:
    """Shape-function gradients in the nc cells of this rank.

    full (nc, nq, nn, 3) [1/m]: dN/dx. volume (nc, 1 or nq, nn, 3) [1/m]: gradients that give the volume
    change. weights (nc, nq) [m3]: quadrature weight times the map's determinant. points (nc, nq, 3) [m].
    """

    full: Array
    volume: Array
    weights: Array
    points: Array


def cell_gradients(family: Family, points: Array, cells: IntArray) -> Gradients:
    """Gradients of the cells (nc, nn) of nodes at points (n, 3); MeshError if a cell is inverted or flat."""
    corners = points[cells[:, : family.vertices]]
    where, weights = family.quadrature()
    jacobian = np.einsum("cvi,qvj->cqij", corners, family.map_gradients(where))
    determinant = np.linalg.det(jacobian)
    _check_shape(determinant, corners)
    full = np.einsum("qnj,cqji->cqni", family.gradients(where), np.linalg.inv(jacobian))
    dx = np.abs(determinant) * weights
    volume = np.einsum("cq,cqni->cni", dx, full)[:, None] / dx.sum(axis=1)[:, None, None, None]
    return Gradients(full, volume if family.mean_dilatation else full, dx, _positions(family, where, corners))


def _check_shape(determinant: Array, corners: Array) -> None:
    """The map's determinant keeps its sign and is not negligible beside the cell's size."""
    span = np.ptp(corners, axis=1).max(axis=1) if len(corners) else np.zeros(0)
    signed = determinant * np.sign(determinant[:, :1])
    bad = np.flatnonzero(signed.min(axis=1, initial=np.inf) <= 1e-9 * span**3)
    if len(bad):
        x, y, z = corners[bad[0]].mean(axis=0)
        raise MeshError(
            f"soil mesh: the cell at ({x:.4g}, {y:.4g}, {z:.4g}) m is inverted or flat "
            f"({len(bad)} such cells); mend the mesh"
        )


def _positions(family: Family, where: Array, corners: Array) -> Array:
    return np.einsum("qv,cvi->cqi", family.map_values(where), corners)
