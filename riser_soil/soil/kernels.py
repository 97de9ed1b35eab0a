"""Element integration in batches: strain, internal force and stiffness from gradients (see families.py).

Stress and strain in the components of mandel.py: xx, yy, zz, √2 xy, √2 xz, √2 yz.
nc cells, nq quadrature points, nn nodes a cell; `full` (nc, nq, nn, 3), `volume` (nc, 1 or nq, nn, 3).
"""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.soil import mandel
from riser_soil.soil.mandel import DEVIATOR, VOLUME

stretched, modulus = njit(mandel.stretched), njit(mandel.modulus)

_SHEAR = 1.0 / np.sqrt(2.0)


@njit
def write_gradients(at: Array, axes: IntArray, derivatives: Array, determinant: Array, full: Array) -> None:
    """Write gradients (nc, nq, nn, 3) of the shape functions in cells with their nodes at (nc, nn, 3), which extend
    along d axes, from their derivatives (nq, nn, d) on the reference cell; and the maps' determinants (nc, nq).
    """
    nc, nq, nn, _ = full.shape
    d = axes.size
    J, adjugate = np.empty((d, d)), np.empty((d, d))
    for c in range(nc):
        for q in range(nq):
            _write_jacobian(at[c], axes, derivatives[q], J)
            determinant[c, q] = _determinant(J)
            _write_adjugate(J, adjugate)
            for a in range(nn):
                for i in range(d):
                    total = 0.0
                    for j in range(d):
                        total += derivatives[q, a, j] * adjugate[j, i]
                    full[c, q, a, axes[i]] = total / determinant[c, q]


@njit
def write_determinants(at: Array, axes: IntArray, derivatives: Array, out: Array) -> None:
    """Write the determinants (nc, nq) of the maps alone, see `write_gradients`."""
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
def _write_adjugate(J: Array, out: Array) -> None:
    """Write the determinant times the inverse."""
    if len(J) == 2:
        out[0, 0], out[0, 1], out[1, 0], out[1, 1] = J[1, 1], -J[0, 1], -J[1, 0], J[0, 0]
        return
    for i in range(3):
        b, c = (i + 1) % 3, (i + 2) % 3
        for j in range(3):
            m, n = (j + 1) % 3, (j + 2) % 3
            out[j, i] = J[b, m] * J[c, n] - J[b, n] * J[c, m]


@njit
def write_mean(values: Array, weights: Array, out: Array) -> None:
    """Write the means (nc, nn, 3) of values (nc, nq, nn, 3) at points of weights (nc, nq)."""
    nc, nq, nn, d = values.shape
    for c in range(nc):
        total = 0.0
        for q in range(nq):
            total += weights[c, q]
        for a in range(nn):
            for i in range(d):
                mean = 0.0
                for q in range(nq):
                    mean += weights[c, q] * values[c, q, a, i]
                out[c, a, i] = mean / total


@njit
def strain(full: Array, volume: Array, cells: IntArray, u: Array, out: Array) -> None:
    """Strain (nc, nq, 6) of the nodal displacements u (3n,), written to out."""
    nc, nq, nn, _ = full.shape
    step = 0 if volume.shape[1] == 1 else 1
    for c in range(nc):
        for q in range(nq):
            xx = yy = zz = xy = xz = yz = dilatation = 0.0
            for a in range(nn):
                i = 3 * cells[c, a]
                ux, uy, uz = u[i], u[i + 1], u[i + 2]
                gx, gy, gz = full[c, q, a, 0], full[c, q, a, 1], full[c, q, a, 2]
                h = volume[c, q * step, a]
                xx += ux * gx
                yy += uy * gy
                zz += uz * gz
                xy += ux * gy + uy * gx
                xz += ux * gz + uz * gx
                yz += uy * gz + uz * gy
                dilatation += ux * h[0] + uy * h[1] + uz * h[2]
            extra = (dilatation - xx - yy - zz) / 3.0
            e = out[c, q]
            e[0], e[1], e[2] = xx + extra, yy + extra, zz + extra
            e[3], e[4], e[5] = _SHEAR * xy, _SHEAR * xz, _SHEAR * yz


@njit
def spin(full: Array, cells: IntArray, u: Array, out: Array) -> None:
    """Axial vectors (nc, nq, 3) of the skew part of the gradient of the nodal displacements u (3n,), written to out."""
    nc, nq, nn, _ = full.shape
    for c in range(nc):
        for q in range(nq):
            x = y = z = 0.0
            for a in range(nn):
                i = 3 * cells[c, a]
                ux, uy, uz = u[i], u[i + 1], u[i + 2]
                gx, gy, gz = full[c, q, a, 0], full[c, q, a, 1], full[c, q, a, 2]
                x += uz * gy - uy * gz
                y += ux * gz - uz * gx
                z += uy * gx - ux * gy
            out[c, q, 0], out[c, q, 1], out[c, q, 2] = 0.5 * x, 0.5 * y, 0.5 * z


@njit
def add_internal_force(
    full: Array, volume: Array, weights: Array, cells: IntArray, stress: Array, out: Array
) -> None:
    """Add the nodal forces ∫ B̄ᵀσ [N] of the stress (nc, nq, 6) [Pa] to out (3n,)."""
    nc, nq, nn, _ = full.shape
    step = 0 if volume.shape[1] == 1 else 1
    for c in range(nc):
        for q in range(nq):
            s, w = stress[c, q], weights[c, q]
            pressure = (s[0] + s[1] + s[2]) / 3.0
            xx, yy, zz = w * (s[0] - pressure), w * (s[1] - pressure), w * (s[2] - pressure)
            xy, xz, yz = w * _SHEAR * s[3], w * _SHEAR * s[4], w * _SHEAR * s[5]
            pressure *= w
            for a in range(nn):
                i = 3 * cells[c, a]
                gx, gy, gz = full[c, q, a, 0], full[c, q, a, 1], full[c, q, a, 2]
                h = volume[c, q * step, a]
                out[i] += xx * gx + xy * gy + xz * gz + pressure * h[0]
                out[i + 1] += xy * gx + yy * gy + yz * gz + pressure * h[1]
                out[i + 2] += xz * gx + yz * gy + zz * gz + pressure * h[2]


@njit
def renew_stiffness(
    full: Array, volume: Array, weights: Array, axes: IntArray, moduli: Array, known: Array, out: Array
) -> None:
    """Cell matrices ∫ B̄ᵀ C B̄ [N/m] of the moduli C (nc, nq, 6, 6) [Pa], written to out (nc, d nn, d nn) where it does
    not hold them yet, of displacements along d axes. known: the moduli that it is of, which become those.
    """
    nc, nq, nn, _ = full.shape
    step, size = 0 if volume.shape[1] == 1 else 1, axes.size * nn
    B, CB = np.zeros((6, size)), np.zeros((6, size))
    for c in range(nc):
        if _same(moduli[c], known[c]):
            continue
        known[c] = moduli[c]
        K = out[c]
        K[:] = 0.0
        for q in range(nq):
            _operator(full[c, q], volume[c, q * step], axes, B)
            _product(weights[c, q], moduli[c, q], B, CB)
            for i in range(size):
                row = K[i]
                for k in range(6):
                    factor = B[k, i]
                    if factor != 0.0:
                        for j in range(size):
                            row[j] += factor * CB[k, j]


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
def _same(a: Array, b: Array) -> bool:
    x, y, k = a.ravel(), b.ravel(), 0
    while k < x.size and x[k] == y[k]:
        k += 1
    return k == x.size


@njit
def _operator(full: Array, volume: Array, axes: IntArray, B: Array) -> None:
    """B̄ (6, d nn) of one quadrature point, for displacements along d axes; what is zero in it is left so."""
    for a in range(full.shape[0]):
        for k in range(axes.size):
            i, column = axes[k], axes.size * a + k
            extra = (volume[a, i] - full[a, i]) / 3.0
            for j in range(3):
                B[j, column] = extra + (full[a, i] if j == i else 0.0)
                if j != i:
                    B[2 + i + j, column] = _SHEAR * full[a, j]


@njit
def _product(weight: float, C: Array, B: Array, CB: Array) -> None:
    for k in range(6):
        row = CB[k]
        row[:] = 0.0
        for m in range(6):
            factor = weight * C[k, m]
            if factor != 0.0:
                for j in range(row.shape[0]):
                    row[j] += factor * B[m, j]


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
            w, left, square = weights[n, k], shrink[n, k], 0.0
            trial = s[n, 6 * k : 6 * k + 6]
            if w != 0.0:
                for i in range(6):
                    for j in range(6):
                        C[n, i, j] -= w * trial[i] * trial[j]
            for i in range(6):
                stays = left * trial[i]
                trial[i] = stays
                sums[n, i] += stays
                square += stays**2
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
