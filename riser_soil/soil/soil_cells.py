"""A rank's cells of soil as they were placed last: strain, forces, stiffness and means, by kernels of UFL."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.c_function import CFunction
from riser_soil.core.communicator import raised_on_all_ranks
from riser_soil.soil import cell_loops
from riser_soil.soil.cell_loops import kernels_of
from riser_soil.soil.families import point_volumes
from riser_soil.soil.field import components
from riser_soil.soil.grid import DistributedMesh

STRAINED = 1e-4  # of its size, that a cell's nodes move against each other before it is placed anew


class SoilCells:
    """Cells with nodes at points (n, 3), which are placed anew where they have strained.

    nodes (nc, nn): of each cell. shape (nc, nq): of their quadrature points, whose values (n, ...) lie one after the
    other. made_at (nc, nn, 3) [m]: the nodes as they were when the cells were placed. volumes (nc, nq) [m3]: what each
    point stands for. Construction is collective; MeshError if a cell is inverted.
    """

    def __init__(self, grid: DistributedMesh) -> None:
        self._family, self._shares = grid.family, grid.shares() * grid.family.thickness
        self._kernels = kernels_of(grid.family)
        self.nodes = np.ascontiguousarray(grid.nodes.cells)
        self._dofs = components(self.nodes, grid.family.axes)
        self.made_at = grid.nodes.points[self.nodes]
        with raised_on_all_ranks(grid.nodes.comm):
            self.volumes = self._volumes_of(self.made_at)
        self.shape = self.volumes.shape
        self._placed = self._placed_at(self.made_at)
        self._spans = np.ptp(self.made_at, axis=1).min(axis=1)
        self._stiffness: _Stiffness | None = None  # there from the first tangent on

    def _volumes_of(self, at: Array, cells: IntArray | slice = slice(None)) -> Array:
        """Volumes of integration points of some cells, all by default, with their nodes at (nc, nn, 3) [m3]."""
        nc, nn, _ = at.shape
        volumes = point_volumes(self._family, at.reshape(-1, 3), np.arange(nc * nn).reshape(nc, nn))
        return volumes * (self._shares[cells] / self._family.thickness)[:, None]

    def _placed_at(self, at: Array) -> _Placed:
        """Cells with their nodes at (nc, nn, 3)."""
        axes = list(self._family.axes)
        there = np.zeros_like(at)
        there[..., : len(axes)] = at[..., axes]
        mean = np.empty((len(at), self._dofs.shape[1] if self._family.mean_dilatation else 0))
        if self._family.mean_dilatation:
            cell_loops.write_mean_divergence(self._kernels.mean_divergence, there, mean)
        return _Placed(there, mean)

    def make_anew(self, cells: IntArray, at: Array) -> None:
        """Place some cells anew, with their nodes at (n, nn, 3)."""
        self.made_at[cells] = at
        self.volumes[cells] = self._volumes_of(at, cells)
        for all_cells, these in zip(self._placed, self._placed_at(at), strict=True):
            all_cells[cells] = these
        if self._stiffness is not None:
            self._stiffness.moduli[cells] = np.nan

    def renew(self, points: Array) -> None:
        """Place those cells anew that have strained since they were placed; nodes at points (n, 3)."""
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
        if self._stiffness is None:
            self._stiffness = _Stiffness.unknown(self.shape, self._dofs.shape[1])
        cell_loops.renew_matrices(
            self._kernels.tangent, *self._placed, self._shares, self._by_cell(moduli), *self._stiffness
        )
        return self._stiffness.matrices

    def strain(self, u: Array) -> Array:
        """Strain (n, 6) of nodal displacements u (size,)."""
        return self._strain(self._placed, u)

    def _strain(self, placed: _Placed, u: Array) -> Array:
        out = np.empty((self.shape[0], self.shape[1] * 6))
        cell_loops.write_at_points(self._kernels.strain, *placed, self._dofs, u, out)
        return out.reshape(-1, 6)

    def motion(self, points: Array, u: Array) -> tuple[Array, Array]:
        """Strain (n, 6) and spin (n, 3) of nodal displacements u (size,) by the gradients of cells with their nodes at
        points (n, 3).
        """
        at = points[self.nodes]
        self._volumes_of(at)
        placed, spin = self._placed_at(at), np.empty((self.shape[0], self.shape[1] * 3))
        cell_loops.write_at_points(self._kernels.spin, placed.at, placed.mean[:, :0], self._dofs, u, spin)
        return self._strain(placed, u), spin.reshape(-1, 3)

    def internal_force(self, stress: Array, size: int) -> Array:
        """Nodal forces (size,) [N] of a stress (n, 6) [Pa]."""
        out = np.zeros(size)
        cell_loops.add_forces(
            self._kernels.force, *self._placed, self._shares, self._by_cell(stress), self._dofs, out
        )
        return out

    def weight(self, unit_weight: Array, size: int) -> Array:
        """Nodal forces (size,) [N] of a unit weight (n,) [N/m3], downwards."""
        out = np.zeros(size)
        cell_loops.add_forces(
            self._kernels.weight, *self._placed, self._shares, self._by_cell(unit_weight), self._dofs, out
        )
        return out

    def mass(self, density: Array) -> Array:
        """Mass matrices (nc, d nn, d nn) [kg] of the cells, of densities (nc,) [kg/m3]."""
        return self.integrals(self._kernels.mass, [density[:, None]], rank=2)

    def dashpots(self, facets: IntArray, impedances: Array) -> Array:
        """Matrices (nf, d nn, d nn) [kg/s] of facets (nf, 2), cells and their local facets, with impedances (nf, 2)
        [Pa s/m] along the normal and along the side.
        """
        return self.integrals(self._kernels.dashpots, [impedances], 2, facets)

    def integrals(
        self, kernel: CFunction, coefficients: Sequence[Array], rank: int, facets: IntArray | None = None
    ) -> Array:
        """Vectors (m, d nn), rank 1, or matrices (m, d nn, d nn), rank 2, of a form over all cells, or over facets
        (m, 2), with its coefficients (m, ...).
        """
        cells, n = slice(None) if facets is None else facets[:, 0], self._dofs.shape[1]
        at = np.ascontiguousarray(self._placed.at[cells])
        numbers = np.zeros(len(at), dtype=np.int64) if facets is None else np.ascontiguousarray(facets[:, 1])
        rows = np.concatenate([*coefficients, np.zeros((len(at), 1))], axis=1)
        out = np.empty((len(at), *[n] * rank))
        cell_loops.write_integrals(kernel, at, numbers, rows, out)
        return np.asarray(out * self._shares[cells].reshape(-1, *[1] * rank))

    def _by_cell(self, values: Array) -> Array:
        """Values (n, ...) at points as a row for each cell; a rank may have none."""
        return np.ascontiguousarray(values).reshape(self.shape[0], self.shape[1] * math.prod(values.shape[1:]))

    def at_points(self, nodal: Array) -> Array:
        """Values (n, ...) of those (nodes, ...) at nodes."""
        values = np.einsum("qa,ca...->cq...", self._family.values, nodal[self.nodes])
        return np.asarray(values.reshape(-1, *nodal.shape[1:]))

    def slopes(self, nodal: Array) -> Array:
        """Gradients (n, 3) of values (nodes,) at nodes."""
        out = np.empty((self.shape[0], self.shape[1] * 3))
        cell_loops.write_at_points(
            self._kernels.slope, self._placed.at, self._placed.mean[:, :0], self.nodes, nodal, out
        )
        return out.reshape(-1, 3)

    def integral(self, a: Array, b: Array) -> float:
        """Integral over the soil of the product of two fields (n, 6)."""
        return float(np.einsum("n,ni,ni->", self.volumes.ravel(), a, b))

    def mean(self, values: Array) -> Array:
        """Mean (nc,) in each cell of values (n,)."""
        w = self.volumes
        return np.asarray(np.einsum("cq,cq->c", w, values.reshape(self.shape)) / w.sum(axis=1))


class _Placed(NamedTuple):
    """Cells where they are: nodes and mean divergences, see cell_loops."""

    at: Array
    mean: Array


class _Stiffness(NamedTuple):
    """Moduli (nc, nq 36) [Pa] by cell, and the cell matrices (nc, n, n) [N/m] of these: most keep them."""

    moduli: Array
    matrices: Array

    @classmethod
    def unknown(cls, shape: tuple[int, ...], n: int) -> _Stiffness:
        return cls(np.full((shape[0], shape[1] * 36), np.nan), np.zeros((shape[0], n, n)))
