"""Reference of cells' strains, forces and matrices: the strain operator at each point, written out with numpy.

Independent of weak_form.py: gradients by basix' shape functions, products by einsum. Components as in mandel.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.soil.families import Family

SHEAR = {(0, 1): 3, (0, 2): 4, (1, 2): 5}


@dataclass(frozen=True, eq=False)
class Cells:
    """nc cells of nodes at points (n, 3): gradients (nc, nq, nn, 3) of the shape functions, volumes (nc, nq) of points,
    strain operators (nc, nq, 6, d nn) of displacements along the family's axes, node by node.
    """

    gradients: Array
    volumes: Array
    operators: Array

    def strain(self, u: Array) -> Array:
        """(nc, nq, 6) of displacements (nc, d nn)."""
        return np.asarray(np.einsum("cqij,cj->cqi", self.operators, u))

    def force(self, stress: Array) -> Array:
        """(nc, d nn) of stress (nc, nq, 6)."""
        return np.asarray(np.einsum("cq,cqij,cqi->cj", self.volumes, self.operators, stress))

    def stiffness(self, moduli: Array) -> Array:
        """(nc, d nn, d nn) of moduli (nc, nq, 6, 6)."""
        CB = np.einsum("cqik,cqkj->cqij", moduli, self.operators)
        return np.asarray(np.einsum("cq,cqia,cqib->cab", self.volumes, self.operators, CB))


def cells_of(family: Family, points: Array, cells: IntArray) -> Cells:
    axes = list(family.axes)
    at = points[cells][:, :, axes]
    J = np.einsum("cai,qaj->cqij", at, family.derivatives)
    gradients = np.zeros((*J.shape[:2], cells.shape[1], 3))
    gradients[..., axes] = np.einsum("qaj,cqji->cqai", family.derivatives, np.linalg.inv(J))
    volumes = np.abs(np.linalg.det(J)) * family.quadrature[1] * family.thickness
    return Cells(gradients, volumes, _operators(family, gradients, volumes))


def _operators(family: Family, gradients: Array, volumes: Array) -> Array:
    mean = np.einsum("cq,cqai->cai", volumes, gradients) / volumes.sum(axis=1)[:, None, None]
    nc, nq, nn, _ = gradients.shape
    B = np.zeros((nc, nq, 6, nn, 3))
    for i in range(3):
        B[:, :, i, :, i] = gradients[..., i]
    for (i, j), row in SHEAR.items():
        B[:, :, row, :, i] = gradients[..., j] / np.sqrt(2.0)
        B[:, :, row, :, j] = gradients[..., i] / np.sqrt(2.0)
    if family.mean_dilatation:
        B[:, :, :3] += ((mean[:, None] - gradients) / 3.0)[:, :, None]
    return B[..., list(family.axes)].reshape(nc, nq, 6, -1)
