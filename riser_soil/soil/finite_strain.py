"""Finite strain within a step: strain, internal force and stiffness of cells, in batches.

The geometry is that at the step's start, its gradients g and weights w those of `families`. With the deformation
gradient F = 1 + Σ u_a⊗g_a of the step, C = FᵀF and A = C⁻¹, the strain is

    ε = dev ¼(C − A) + ⅓ ln(V/V₀) 1,

which is the logarithmic one but for terms of third order (Z. P. Bažant, Easy-to-compute tensors with symmetric inverse
approximating Hencky finite strain and its rate, J. Eng. Mater. Technol. 120 (1998)), in axes that turn with the
material. V is the volume of the cell, or where there is no mean dilatation what belongs to the point. Forces are the
derivative of the work ∫ T:dε of the law's stress T, with the deviator s and the mean p,

    f_a = Σ w F S g_a + Σ w p ĝ_a,    S = ½(s + A s A),    ĝ_a = Σ w J F⁻ᵀg_a / V,

and the stiffness is the derivative of the force: symmetric where the law's tangent is.

Stress and strain in the components of mandel.py. nc cells, nq quadrature points, nn nodes a cell; full (nc, nq, nn, 3)
[1/m], weights (nc, nq) [m3]; together: points that have one change of volume, nq or 1.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit

SAME = 1e-4  # change of a displacement gradient that leaves a cell's stiffness as it is
_SHEAR, _TWICE = 1.0 / math.sqrt(2.0), math.sqrt(2.0)
_ROW, _COLUMN = (0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)  # of Mandel's components
_SIZE = (1.0, 1.0, 1.0, _TWICE, _TWICE, _TWICE)


class StrainWorkspace(NamedTuple):
    """Of one point: 3 x 3 matrices F, C, A, M = A s A and S; 6 x 6 ones; B, DB (6, 3nn): strain E = ½(C − 1) by the
    displacements, and its moduli times B; h (3nn,): ∂ln J by the displacements.
    """

    F: Array
    C: Array
    A: Array
    M: Array
    S: Array
    P: Array
    D: Array
    half: Array
    B: Array
    DB: Array
    h: Array


@njit
def workspace(nodes: int) -> StrainWorkspace:
    """For cells of so many nodes."""
    F, C, A, M, S = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    P, D, half = np.empty((6, 6)), np.empty((6, 6)), np.empty((6, 6))
    return StrainWorkspace(
        F, C, A, M, S, P, D, half, np.empty((6, 3 * nodes)), np.empty((6, 3 * nodes)), np.empty(3 * nodes)
    )


@njit
def strain(full: Array, weights: Array, together: int, cells: IntArray, u: Array, out: Array) -> None:
    """Write the strain (nc, nq, 6) of nodal displacements u (3n,): not a number where a cell is turned inside out."""
    nc, nq = weights.shape
    at = workspace(cells.shape[1])
    for c in range(nc):
        for first in range(0, nq, together):
            before = after = 0.0
            for q in range(first, first + together):
                _write_deformation(full[c, q], cells[c], u, at.F)
                J = _write_stretches(at.F, at.C, at.A)
                before, after = before + weights[c, q], after + (weights[c, q] * J if J > 0.0 else math.nan)
                _write_deviator(at.C, at.A, out[c, q])
            dilatation = math.log(after / before) / 3.0
            for q in range(first, first + together):
                for k in range(3):
                    out[c, q, k] += dilatation


@njit
def add_internal_force(
    full: Array, weights: Array, together: int, cells: IntArray, u: Array, stress: Array, out: Array
) -> None:
    """Add the nodal forces [N] of the stress (nc, nq, 6) [Pa] at displacements u (3n,) to out (3n,)."""
    nc, nq = weights.shape
    nn = cells.shape[1]
    at, growth = workspace(nn), np.empty(3 * nn)
    for c in range(nc):
        for first in range(0, nq, together):
            volume = pressed = 0.0
            growth[:] = 0.0
            for q in range(first, first + together):
                w, g = weights[c, q], full[c, q]
                _write_deformation(g, cells[c], u, at.F)
                J = _write_stretches(at.F, at.C, at.A)
                volume, pressed = volume + w * J, pressed + w * _mean(stress[c, q])
                _write_stresses(stress[c, q], at.A, at.M, at.S)
                _write_growth(at.F, at.A, g, at.h)
                _multiply(at.F, at.S, at.C)
                for a in range(nn):
                    for i in range(3):
                        growth[3 * a + i] += w * J * at.h[3 * a + i]
                        out[3 * cells[c, a] + i] += w * (
                            at.C[i, 0] * g[a, 0] + at.C[i, 1] * g[a, 1] + at.C[i, 2] * g[a, 2]
                        )
            for a in range(nn):
                for i in range(3):
                    out[3 * cells[c, a] + i] += pressed / volume * growth[3 * a + i]


@njit
def renew_stiffness(
    full: Array,
    weights: Array,
    together: int,
    cells: IntArray,
    u: Array,
    stress: Array,
    moduli: Array,
    known: Array,
    deformed: Array,
    out: Array,
) -> None:
    """Write the cells' matrices (nc, 3nn, 3nn) [N/m] at displacements u (3n,), of the stress (nc, nq, 6) and the moduli
    (nc, nq, 6, 6) [Pa], where out does not hold them yet: known and deformed (nc, nq, 3, 3), which become those of now,
    are the moduli that it is of, and F but for SAME.
    """
    nc, nq = weights.shape
    at, F = workspace(cells.shape[1]), np.empty((nq, 3, 3))
    for c in range(nc):
        for q in range(nq):
            _write_deformation(full[c, q], cells[c], u, F[q])
        if _near(F, deformed[c]) and _same(moduli[c], known[c]):
            continue
        known[c], deformed[c], out[c] = moduli[c], F, 0.0
        for first in range(0, nq, together):
            last = first + together
            points = full[c, first:last], weights[c, first:last], F[first:last]
            _add_stiffness(points, stress[c, first:last], moduli[c, first:last], at, out[c])


@njit
def _near(F: Array, known: Array) -> bool:
    a, b, k = F.ravel(), known.ravel(), 0
    while k < a.size and abs(a[k] - b[k]) <= SAME:
        k += 1
    return k == a.size


@njit
def _same(a: Array, b: Array) -> bool:
    x, y, k = a.ravel(), b.ravel(), 0
    while k < x.size and x[k] == y[k]:
        k += 1
    return k == x.size


@njit
def _write_deformation(g: Array, nodes: IntArray, u: Array, F: Array) -> None:
    """F = 1 + Σ u_a⊗g_a of a point with gradients g (nn, 3)."""
    F[:] = 0.0
    for i in range(3):
        F[i, i] = 1.0
    for a in range(g.shape[0]):
        for i in range(3):
            moved = u[3 * nodes[a] + i]
            for j in range(3):
                F[i, j] += moved * g[a, j]


@njit
def _write_stretches(F: Array, C: Array, A: Array) -> float:
    """C = FᵀF, A = C⁻¹; J = det F."""
    for i in range(3):
        for j in range(3):
            C[i, j] = F[0, i] * F[0, j] + F[1, i] * F[1, j] + F[2, i] * F[2, j]
    A[0, 0] = C[1, 1] * C[2, 2] - C[1, 2] * C[1, 2]
    A[1, 1] = C[0, 0] * C[2, 2] - C[0, 2] * C[0, 2]
    A[2, 2] = C[0, 0] * C[1, 1] - C[0, 1] * C[0, 1]
    A[0, 1] = A[1, 0] = C[0, 2] * C[1, 2] - C[0, 1] * C[2, 2]
    A[0, 2] = A[2, 0] = C[0, 1] * C[1, 2] - C[0, 2] * C[1, 1]
    A[1, 2] = A[2, 1] = C[0, 1] * C[0, 2] - C[1, 2] * C[0, 0]
    square = C[0, 0] * A[0, 0] + C[0, 1] * A[0, 1] + C[0, 2] * A[0, 2]
    for i in range(3):
        for j in range(3):
            A[i, j] /= square
    return (
        F[0, 0] * (F[1, 1] * F[2, 2] - F[1, 2] * F[2, 1])
        - F[0, 1] * (F[1, 0] * F[2, 2] - F[1, 2] * F[2, 0])
        + F[0, 2] * (F[1, 0] * F[2, 1] - F[1, 1] * F[2, 0])
    )


@njit
def _write_deviator(C: Array, A: Array, out: Array) -> None:
    """That of ¼(C − A), in Mandel's components (6,)."""
    third = (C[0, 0] - A[0, 0] + C[1, 1] - A[1, 1] + C[2, 2] - A[2, 2]) / 12.0
    for k in range(6):
        i, j = _ROW[k], _COLUMN[k]
        out[k] = 0.25 * _SIZE[k] * (C[i, j] - A[i, j]) - (third if k < 3 else 0.0)


@njit
def _mean(stress: Array) -> float:
    return (stress[0] + stress[1] + stress[2]) / 3.0


@njit
def _multiply(X: Array, Y: Array, out: Array) -> None:
    for i in range(3):
        for j in range(3):
            out[i, j] = X[i, 0] * Y[0, j] + X[i, 1] * Y[1, j] + X[i, 2] * Y[2, j]


@njit
def _write_stresses(stress: Array, A: Array, M: Array, S: Array) -> None:
    """M = A s A and S = ½(s + M), s the deviator of a stress (6,)."""
    p = _mean(stress)
    xx, yy, zz = stress[0] - p, stress[1] - p, stress[2] - p
    xy, xz, yz = _SHEAR * stress[3], _SHEAR * stress[4], _SHEAR * stress[5]
    for i in range(3):
        S[i, 0] = A[i, 0] * xx + A[i, 1] * xy + A[i, 2] * xz
        S[i, 1] = A[i, 0] * xy + A[i, 1] * yy + A[i, 2] * yz
        S[i, 2] = A[i, 0] * xz + A[i, 1] * yz + A[i, 2] * zz
    _multiply(S, A, M)
    S[0, 0], S[1, 1], S[2, 2] = 0.5 * (xx + M[0, 0]), 0.5 * (yy + M[1, 1]), 0.5 * (zz + M[2, 2])
    S[0, 1] = S[1, 0] = 0.5 * (xy + M[0, 1])
    S[0, 2] = S[2, 0] = 0.5 * (xz + M[0, 2])
    S[1, 2] = S[2, 1] = 0.5 * (yz + M[1, 2])


@njit
def _write_growth(F: Array, A: Array, g: Array, h: Array) -> None:
    """∂ln J by the displacements (3nn,): F⁻ᵀg = F A g of each node."""
    for a in range(g.shape[0]):
        x = A[0, 0] * g[a, 0] + A[0, 1] * g[a, 1] + A[0, 2] * g[a, 2]
        y = A[1, 0] * g[a, 0] + A[1, 1] * g[a, 1] + A[1, 2] * g[a, 2]
        z = A[2, 0] * g[a, 0] + A[2, 1] * g[a, 1] + A[2, 2] * g[a, 2]
        for i in range(3):
            h[3 * a + i] = F[i, 0] * x + F[i, 1] * y + F[i, 2] * z


@njit
def _add_stiffness(
    points: tuple[Array, Array, Array], stress: Array, moduli: Array, at: StrainWorkspace, K: Array
) -> None:
    """Add to K (3nn, 3nn) that of points (nq, ...) with one change of volume: their full, weights and F."""
    full, weights, F = points
    nq, size = len(weights), K.shape[0]
    growth, left, right = np.zeros(size), np.zeros(size), np.zeros(size)
    volume = pressed = bulk = 0.0
    for q in range(nq):
        volume += weights[q] * _write_stretches(F[q], at.C, at.A)
        pressed += weights[q] * _mean(stress[q])
    for q in range(nq):
        w, J = weights[q], _write_stretches(F[q], at.C, at.A)
        _write_stresses(stress[q], at.A, at.M, at.S)
        _write_operator(F[q], full[q], at.B)
        bulk += w * _write_moduli(moduli[q], at)
        _add_products(w, at, left, right, K)
        _write_growth(F[q], at.A, full[q], at.h)
        _add_geometric(w, at.S, w * J * pressed / volume, full[q], at.h, K)
        for i in range(size):
            growth[i] += w * J / volume * at.h[i]
    for i in range(size):
        for j in range(size):
            K[i, j] += left[i] * growth[j] + growth[i] * right[j] + (bulk - pressed) * growth[i] * growth[j]


@njit
def _write_operator(F: Array, g: Array, B: Array) -> None:
    """Mandel's components (6, 3nn) of E = ½(C − 1) by the displacements."""
    for a in range(g.shape[0]):
        x, y, z = g[a, 0], g[a, 1], g[a, 2]
        for i in range(3):
            k = 3 * a + i
            B[0, k], B[1, k], B[2, k] = F[i, 0] * x, F[i, 1] * y, F[i, 2] * z
            B[3, k] = _SHEAR * (F[i, 0] * y + F[i, 1] * x)
            B[4, k] = _SHEAR * (F[i, 0] * z + F[i, 2] * x)
            B[5, k] = _SHEAR * (F[i, 1] * z + F[i, 2] * y)


@njit
def _write_moduli(moduli: Array, at: StrainWorkspace) -> float:
    """D = Pᵀ dev C dev P + ∂S/∂E of the law's moduli C, P = ∂ε/∂E but for the change of volume, and what couples both,
    Pᵀ dev C 1/3 and its like from the left, in the first two rows of `half`; 1·C 1/9 is what belongs to that alone.
    """
    P, D, half = at.P, at.D, at.half
    _write_pair(at.A, at.A, 0.25, P)
    for k in range(6):
        P[k, k] += 0.5
    for n in range(6):
        third = (P[0, n] + P[1, n] + P[2, n]) / 3.0
        for k in range(3):
            P[k, n] -= third
    for k in range(6):
        for n in range(6):
            half[k, n] = 0.0
            for m in range(6):
                half[k, n] += moduli[k, m] * P[m, n]
    _write_pair(at.A, at.M, -1.0, D)
    for k in range(6):
        for n in range(6):
            for m in range(6):
                D[k, n] += P[m, k] * half[m, n]
    bulk = 0.0
    for n in range(6):
        before = after = 0.0
        for m in range(6):
            before += P[m, n] * (moduli[m, 0] + moduli[m, 1] + moduli[m, 2]) / 3.0
        after = (half[0, n] + half[1, n] + half[2, n]) / 3.0
        half[3, n], half[4, n] = before, after
    for i in range(3):
        for j in range(3):
            bulk += moduli[i, j] / 9.0
    for n in range(6):
        half[0, n], half[1, n] = half[3, n], half[4, n]
    return bulk


@njit
def _write_pair(X: Array, Y: Array, factor: float, out: Array) -> None:
    """Mandel's matrix (6, 6) of E ↦ factor (X E Y + Y E X), X and Y symmetric."""
    for m in range(6):
        i, j = _ROW[m], _COLUMN[m]
        for n in range(6):
            k, l = _ROW[n], _COLUMN[n]
            both = X[i, k] * Y[j, l] + X[i, l] * Y[j, k] + Y[i, k] * X[j, l] + Y[i, l] * X[j, k]
            out[m, n] = 0.5 * factor * _SIZE[m] * _SIZE[n] * both


@njit
def _add_products(w: float, at: StrainWorkspace, left: Array, right: Array, K: Array) -> None:
    """Add w BᵀDB to K, w Bᵀ times the first row of `half` to left (3nn,), and times the second to right (3nn,)."""
    B, D, DB, half = at.B, at.D, at.DB, at.half
    size = K.shape[0]
    for k in range(6):
        row = DB[k]
        row[:] = 0.0
        for m in range(6):
            factor = w * D[k, m]
            for j in range(size):
                row[j] += factor * B[m, j]
        for j in range(size):
            left[j] += w * half[0, k] * B[k, j]
            right[j] += w * half[1, k] * B[k, j]
    for i in range(size):
        row = K[i]
        for k in range(6):
            factor = B[k, i]
            for j in range(size):
                row[j] += factor * DB[k, j]


@njit
def _add_geometric(w: float, S: Array, pressed: float, g: Array, h: Array, K: Array) -> None:
    """Add what the stress does as its axes and the volume change: w (g_a·S g_b) 1 + pressed (h_a⊗h_b − h_b⊗h_a)."""
    nn = g.shape[0]
    for a in range(nn):
        x = w * (g[a, 0] * S[0, 0] + g[a, 1] * S[1, 0] + g[a, 2] * S[2, 0])
        y = w * (g[a, 0] * S[0, 1] + g[a, 1] * S[1, 1] + g[a, 2] * S[2, 1])
        z = w * (g[a, 0] * S[0, 2] + g[a, 1] * S[1, 2] + g[a, 2] * S[2, 2])
        for b in range(nn):
            along = x * g[b, 0] + y * g[b, 1] + z * g[b, 2]
            for i in range(3):
                K[3 * a + i, 3 * b + i] += along
                for j in range(3):
                    K[3 * a + i, 3 * b + j] += pressed * (h[3 * a + i] * h[3 * b + j] - h[3 * a + j] * h[3 * b + i])
