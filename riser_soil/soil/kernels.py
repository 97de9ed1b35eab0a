"""Loops over cells and their points: determinants of the maps, moduli, elements in parallel, strains of cells.

Stress and strain in the components of mandel.py: xx, yy, zz, √2 xy, √2 xz, √2 yz.
nc cells, nq quadrature points, nn nodes a cell.
"""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.soil import mandel
from riser_soil.soil.mandel import DEVIATOR, VOLUME

stretched, modulus = njit(mandel.stretched), njit(mandel.modulus)


@njit
def write_determinants(at: Array, axes: IntArray, derivatives: Array, out: Array) -> None:
    """Write the determinants (nc, nq) of the maps from the reference cell, by the shape functions' derivatives
    (nq, nn, d) there, to cells with their nodes at (nc, nn, 3), which extend along d axes.
    """
    J = np.empty((axes.size, axes.size))
    for c in range(out.shape[0]):
        for q in range(out.shape[1]):
            _write_jacobian(at[c], axes, derivatives[q], J)
            out[c, q] = _determinant(J)


@njit
def _write_jacobian(at: Array, axes: IntArray, derivatives: Array, J: Array) -> None:
    for i in range(axes.size):
        for j in range(axes.size):
            J[i, j] = 0.0
            for a in range(at.shape[0]):
                J[i, j] += at[a, axes[i]] * derivatives[a, j]


@njit
def _determinant(J: Array) -> float:
    if len(J) == 2:
        return J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0]
    return (
        J[0, 0] * (J[1, 1] * J[2, 2] - J[1, 2] * J[2, 1])
        + J[0, 1] * (J[1, 2] * J[2, 0] - J[1, 0] * J[2, 2])
        + J[0, 2] * (J[1, 0] * J[2, 1] - J[1, 1] * J[2, 0])
    )


@njit
def write_moduli(bulk: Array, shear: Array, consistent: Array, share: float, out: Array) -> None:
    """Write a law's consistent moduli (n, 6, 6) [Pa] with a share of the elastic ones."""
    for n in range(out.shape[0]):
        for i in range(6):
            for j in range(6):
                elastic = modulus(bulk[n], shear[n], VOLUME[i, j], DEVIATOR[i, j])
                out[n, i, j] = consistent[n, i, j] + share * (elastic - consistent[n, i, j])


@njit
def write_flowing(at: IntArray, bulk: Array, shear: Array, along: Array, n: Array, out: Array) -> None:
    """Write moduli (6, 6) [Pa] of the points `at` (k,) that flow to those of all (n, 6, 6); shear, along (k,) and n
    (k, 6): see `mandel.modulus`.
    """
    for k in range(at.size):
        for i in range(6):
            for j in range(6):
                elastic = bulk[at[k]], shear[k], VOLUME[i, j], DEVIATOR[i, j]
                out[at[k], i, j] = modulus(*elastic, along[k], n[k, i], n[k, j])


@njit
def write_spans(at: Array, axes: IntArray, out: Array) -> None:
    """Write the longest extent (nc,) along some axes of points (nc, nn, 3)."""
    for c in range(out.size):
        out[c] = 0.0
        for i in axes:
            low = high = at[c, 0, i]
            for a in range(1, at.shape[1]):
                low, high = min(low, at[c, a, i]), max(high, at[c, a, i])
            out[c] = max(out[c], high - low)


@njit
def stretch_elements(moduli: Array, e: Array, s: Array, q: Array) -> None:
    """Elastic trials of elements in parallel: deviators s (n, 6N) grow by 2G e, of moduli G (n, N) and one deviatoric
    strain increment e (n, 6) for all; their equivalent stresses are written to q (n, N).
    """
    for n in range(q.shape[0]):
        for k in range(q.shape[1]):
            twice, square = 2.0 * moduli[n, k], 0.0
            for i in range(6 * k, 6 * k + 6):
                s[n, i] += twice * e[n, i - 6 * k]
                square += s[n, i] ** 2
            q[n, k] = math.sqrt(1.5 * square)


@njit
def return_elements(
    shrink: Array, weights: Array, moduli: Array, s: Array, sums: Array, energy: Array, C: Array
) -> None:
    """Shares `shrink` (n, N) of trials s (n, 6N) stay. Added: the deviators that stay to sums (n, 6), their energy
    s:s/4G to energy (n,); subtracted: Σ w s⊗s of the trials, of weights w (n, N), from the moduli C (n, 6, 6).
    """
    for n in range(shrink.shape[0]):
        for k in range(shrink.shape[1]):
            w, share, square = weights[n, k], shrink[n, k], 0.0
            trial = s[n, 6 * k : 6 * k + 6]
            if w != 0.0:
                for i in range(6):
                    for j in range(6):
                        C[n, i, j] -= w * trial[i] * trial[j]
            for i in range(6):
                deviator = share * trial[i]
                trial[i] = deviator
                sums[n, i] += deviator
                square += deviator**2
            energy[n] += 0.25 / moduli[n, k] * square


@njit
def write_largest_strains(before: Array, after: Array, cells: IntArray, out: Array) -> None:
    """Write the largest strain (nc,) of each cell, half of the change of squared lengths over these, of lines between
    two of its nodes: before at (nc, nn, 3), after at points (n, 3).
    """
    for c in range(cells.shape[0]):
        most = 0.0
        for a in range(cells.shape[1]):
            for b in range(a):
                was = now = 0.0
                for i in range(3):
                    was += (before[c, a, i] - before[c, b, i]) ** 2
                    now += (after[cells[c, a], i] - after[cells[c, b], i]) ** 2
                most = max(most, abs(now - was) / was)
        out[c] = 0.5 * most
