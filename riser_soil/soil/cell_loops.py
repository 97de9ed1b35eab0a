"""Loops over cells that call the kernels of weak_form.py.

nc cells with nn nodes at (nc, nn, 3) [m]: in sections the two coordinates within it, then 0. n displacements a cell,
whose numbers in the field are dofs (nc, n); mean (nc, n): mean divergence in a cell of each displacement's shape
function, where the dilatation is a field of its own, else (nc, 0). With it, θ = mean·u takes the place of the
dilatation: a force b or matrix A of the kernel, its last row and column the dilatation's, becomes

    b_u + b_p mean,    A_uu + A_up ⊗ mean + mean ⊗ A_pu + mean A_pp ⊗ mean
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache, cached_property

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.c_function import CFunction
from riser_soil.core.compiled import njit
from riser_soil.soil.families import Family
from riser_soil.soil.ffcx_compat import cell_kernel, facet_kernel, point_kernel
from riser_soil.soil.weak_form import WeakForm


class CellKernels:
    """Kernels of a family, each compiled when it is asked for first."""

    def __init__(self, family: Family) -> None:
        shape = family.cell.name, family.degree, family.quadrature_degree
        self._form = WeakForm(*shape, family.mean_dilatation, family.axes)
        self._points = family.quadrature[0]

    @cached_property
    def mean_divergence(self) -> CFunction:
        return cell_kernel(self._form.mean_divergence())

    @cached_property
    def strain(self) -> CFunction:
        return point_kernel(self._form.strain_at_points(), self._points)

    @cached_property
    def spin(self) -> CFunction:
        return point_kernel(self._form.spin_at_points(), self._points)

    @cached_property
    def slope(self) -> CFunction:
        return point_kernel(self._form.slope_at_points(), self._points)

    @cached_property
    def force(self) -> CFunction:
        return cell_kernel(self._form.force())

    @cached_property
    def weight(self) -> CFunction:
        return cell_kernel(self._form.weight())

    @cached_property
    def tangent(self) -> CFunction:
        return cell_kernel(self._form.tangent())

    @cached_property
    def mass(self) -> CFunction:
        return cell_kernel(self._form.mass())

    @cached_property
    def dashpots(self) -> CFunction:
        return facet_kernel(self._form.dashpots())


def kernels_of(family: Family) -> CellKernels:
    """Sections of any thickness have the same."""
    return _kernels_of(replace(family, thickness=1.0))


@cache
def _kernels_of(family: Family) -> CellKernels:
    return CellKernels(family)


@njit
def write_mean_divergence(kernel: CFunction, at: Array, mean: Array) -> None:
    """kernel: integrals of the divergences, and of 1."""
    n = mean.shape[1]
    b = np.empty(n + 1)
    for c in range(at.shape[0]):
        b[:] = 0.0
        kernel(place(b, 0), 0, 0, place(at, c), 0, 0, 0)
        for i in range(n):
            mean[c, i] = b[i] / b[n]


@njit
def write_at_points(kernel: CFunction, at: Array, mean: Array, dofs: IntArray, u: Array, out: Array) -> None:
    """Values (nc, m) of a field u and its mean dilatation; dofs (nc, n): where the cells have their part of it."""
    n = dofs.shape[1]
    w = np.zeros(n + 1)
    for c in range(at.shape[0]):
        for i in range(n):
            w[i] = u[dofs[c, i]]
        w[n] = 0.0
        for i in range(mean.shape[1]):
            w[n] += mean[c, i] * w[i]
        out[c] = 0.0
        kernel(place(out, c), place(w, 0), 0, place(at, c), 0, 0, 0)


@njit
def add_forces(
    kernel: CFunction, at: Array, mean: Array, shares: Array, coefficients: Array, dofs: IntArray, out: Array
) -> None:
    """Add the cells' nodal forces, times their shares (nc,), to out; coefficients (nc, m): of the form."""
    n = dofs.shape[1]
    b = np.empty(n + 1)
    for c in range(at.shape[0]):
        b[:] = 0.0
        kernel(place(b, 0), place(coefficients, c), 0, place(at, c), 0, 0, 0)
        for i in range(mean.shape[1]):
            b[i] += b[n] * mean[c, i]
        for i in range(n):
            out[dofs[c, i]] += shares[c] * b[i]


@njit
def renew_matrices(
    kernel: CFunction, at: Array, mean: Array, shares: Array, coefficients: Array, cached: Array, out: Array
) -> None:
    """Write the cells' matrices (nc, n, n), times their shares (nc,), where these are not yet those of the form's
    coefficients (nc, m); cached: the coefficients of the matrices as they are, which are updated.
    """
    n, fields = out.shape[1], out.shape[1] + (1 if mean.shape[1] > 0 else 0)
    A = np.empty((fields, fields))
    for c in range(at.shape[0]):
        if _same(coefficients[c], cached[c]):
            continue
        cached[c] = coefficients[c]
        A[:] = 0.0
        kernel(place(A, 0), place(coefficients, c), 0, place(at, c), 0, 0, 0)
        K, h = out[c], mean[c]
        for i in range(n):
            if fields > n:
                row = A[i, n] + h[i] * A[n, n]
                for j in range(n):
                    K[i, j] = shares[c] * (A[i, j] + row * h[j] + h[i] * A[n, j])
            else:
                for j in range(n):
                    K[i, j] = shares[c] * A[i, j]


@njit
def write_integrals(kernel: CFunction, at: Array, facets: IntArray, coefficients: Array, out: Array) -> None:
    """Write vectors (m, n) or matrices (m, n, n) of cells with nodes at (m, nn, 3), or of facets (m,) by their numbers
    in these; coefficients (m, k): of the form.
    """
    number = np.zeros(1, np.int32)
    for f in range(at.shape[0]):
        number[0] = facets[f]
        out[f] = 0.0
        kernel(place(out, f), place(coefficients, f), 0, place(at, f), place(number, 0), 0, 0)
    number[0] = 0


@njit
def _same(a: Array, b: Array) -> bool:
    k = 0
    while k < a.size and a[k] == b[k]:
        k += 1
    return k == a.size


@njit
def place(array: Array, k: int) -> int:
    """Address of the row k of an array: slices would count references, which takes longer than a small kernel."""
    return array.ctypes.data + k * array.strides[0]
