"""Shape-function gradients at the quadrature points (B-bar) of cells with their nodes at given places.

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
    at, axes = points[cells], list(family.axes)
    where, weights = family.quadrature()
    derivatives = family.gradients(where)
    jacobian = _jacobian(derivatives, at[..., axes])
    determinant = np.linalg.det(jacobian)
    _check_shape(determinant, at[..., axes])
    full = np.zeros((*determinant.shape, cells.shape[1], 3))
    full[..., axes] = np.einsum("qnj,cqji->cqni", derivatives, np.linalg.inv(jacobian), optimize=True)
    dx = np.abs(determinant) * weights * family.thickness
    volume = np.einsum("cq,cqni->cni", dx, full)[:, None] / dx.sum(axis=1)[:, None, None, None]
    positions = np.einsum("qn,cni->cqi", family.values(where), at, optimize=True)
    return Gradients(full, volume if family.mean_dilatation else full, dx, positions)


def skewness(family: Family, points: Array, cells: IntArray) -> Array:
    """Least over mean determinant of the map in each cell (nc,), at quadrature points: 1 in bricks, 0 when it folds."""
    at = points[cells][..., list(family.axes)]
    determinant = np.linalg.det(_jacobian(family.gradients(family.quadrature()[0]), at))
    determinant *= np.sign(determinant[:, :1])
    return np.asarray(determinant.min(axis=1) / np.abs(determinant).mean(axis=1))


def _jacobian(derivatives: Array, at: Array) -> Array:
    """Of the maps (nc, nq, d, d) of cells with their nodes at (nc, nn, d)."""
    return np.asarray(np.einsum("cni,qnj->cqij", at, derivatives, optimize=True))


def _check_shape(determinant: Array, at: Array) -> None:
    """The map's determinant keeps its sign and is not negligible beside the cell's size."""
    span = np.ptp(at, axis=1).max(axis=1) if len(at) else np.zeros(0)
    signed = determinant * np.sign(determinant[:, :1])
    bad = np.flatnonzero(signed.min(axis=1, initial=np.inf) <= 1e-9 * span ** at.shape[2])
    if len(bad):
        place = ", ".join(f"{x:.4g}" for x in at[bad[0]].mean(axis=0))
        raise MeshError(
            f"soil mesh: the cell at ({place}) m is inverted or flat "
            f"({len(bad)} such cells); mend the mesh"
        )
