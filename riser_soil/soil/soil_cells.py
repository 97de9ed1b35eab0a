"""A rank's cells of soil as they lie where a step starts: strain, forces, stiffness and means by their gradients."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.soil import kernels
from riser_soil.soil.families import Gradients, cell_gradients
from riser_soil.soil.grid import DistributedMesh, on_all_ranks

STRAINED = 1e-4  # of its size, that a cell's nodes move against each other before its gradients are made anew


class SoilCells:
    """Cells with nodes at points (n, 3), whose gradients are made anew where they have strained.

    nodes (nc, nn): of each cell. shape (nc, nq): of their quadrature points, whose values (n, ...) lie one after the
    other. made_at (nc, nn, 3) [m]: the nodes as they were when the gradients were made. Construction is collective;
    MeshError if a cell is inverted.
    """

    def __init__(self, grid: DistributedMesh) -> None:
        self._family, self._shares = grid.family, grid.shares()
        self.nodes = np.ascontiguousarray(grid.nodes.cells)
        self.made_at = grid.nodes.points[self.nodes]
        self.gradients = on_all_ranks(grid.nodes.comm, lambda: self._gradients_of(self.made_at))
        self.shape = self.gradients.weights.shape
        self._spans = np.ptp(self.made_at, axis=1).min(axis=1)
        self._stiffness: _Stiffness | None = None  # there from the first tangent on

    def _gradients_of(self, corners: Array, cells: IntArray | slice = slice(None)) -> Gradients:
        """Of some cells, all by default, with their nodes at corners (nc, nn, 3)."""
        nc, nn, _ = corners.shape
        found = cell_gradients(self._family, corners.reshape(-1, 3), np.arange(nc * nn).reshape(nc, nn))
        found.weights[:] *= self._shares[cells][:, None]
        return found

    def make_anew(self, cells: IntArray, at: Array) -> None:
        """Make the gradients of some cells anew, with their nodes at (n, nn, 3)."""
        self.made_at[cells] = at
        made = self._gradients_of(at, cells)
        for name, values in vars(made).items():
            vars(self.gradients)[name][cells] = values
        if self._stiffness is not None:
            self._stiffness.moduli[cells] = np.nan

    def renew(self, points: Array) -> None:
        """Make the gradients anew of the cells that have strained since theirs were made; nodes at points (n, 3)."""
        at = points[self.nodes]
        moved = at - self.made_at
        moved -= moved.mean(axis=1, keepdims=True)
        strained = np.flatnonzero(np.abs(moved).max(axis=(1, 2)) > STRAINED * self._spans)
        if strained.size:
            self.make_anew(strained, at[strained])

    def stiffness(self, moduli: Array) -> Array:
        """Matrices (nc, d nn, d nn) [N/m] of the cells by the moduli (n, 6, 6) [Pa] at their points, for displacements
        along the axes along which they extend.
        """
        g, axes = self.gradients, np.array(self._family.axes)
        if self._stiffness is None:
            self._stiffness = _Stiffness.unknown(self.shape, axes.size * self.nodes.shape[1])
        kernels.renew_stiffness(
            g.full, g.volume, g.weights, axes, moduli.reshape(*self.shape, 6, 6), *self._stiffness
        )
        return self._stiffness.matrices

    def strain(self, u: Array) -> Array:
        """Strain (n, 6) of nodal displacements u (size,)."""
        g, out = self.gradients, np.empty((*self.shape, 6))
        kernels.strain(g.full, g.volume, self.nodes, u, out)
        return out.reshape(-1, 6)

    def internal_force(self, stress: Array, size: int) -> Array:
        """Nodal forces (size,) [N] of a stress (n, 6)."""
        g, out = self.gradients, np.zeros(size)
        kernels.add_internal_force(g.full, g.volume, g.weights, self.nodes, stress.reshape(*self.shape, 6), out)
        return out

    def weight(self, unit_weight: Array, size: int) -> Array:
        """Nodal forces (size,) [N] of a unit weight (n,) [N/m3], downwards."""
        down = -np.einsum("cq,cq,qa->ca", unit_weight.reshape(self.shape), self.gradients.weights, self._family.values)
        out = np.zeros(size)
        out[2::3] = np.bincount(self.nodes.ravel(), down.ravel(), minlength=size // 3)
        return out

    def at_points(self, nodal: Array) -> Array:
        """Values (n, ...) of those (nodes, ...) at nodes."""
        found = np.einsum("qa,ca...->cq...", self._family.values, nodal[self.nodes])
        return np.asarray(found.reshape(-1, *nodal.shape[1:]))

    def slopes(self, nodal: Array) -> Array:
        """Gradients (n, 3) of values (nodes,) at nodes."""
        return np.asarray(np.einsum("cqni,cn->cqi", self.gradients.full, nodal[self.nodes]).reshape(-1, 3))

    def integral(self, a: Array, b: Array) -> float:
        """Of the product of two fields (n, 6)."""
        return float(np.einsum("n,ni,ni->", self.gradients.weights.ravel(), a, b))

    def mean(self, values: Array) -> Array:
        """Mean (nc,) in each cell of values (n,)."""
        w = self.gradients.weights
        return np.asarray(np.einsum("cq,cq->c", w, values.reshape(self.shape)) / w.sum(axis=1))


class _Stiffness(NamedTuple):
    """Cell matrices (nc, n, n) [N/m] and the moduli (nc, nq, 6, 6) [Pa] that they are of: most keep them."""

    moduli: Array
    matrices: Array

    @classmethod
    def unknown(cls, shape: tuple[int, ...], n: int) -> _Stiffness:
        return cls(np.full((*shape, 6, 6), np.nan), np.zeros((shape[0], n, n)))
