"""What touches at a trial: pairs of an element and a facet with their points, contact forces and contact stiffness."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.contact.near_points import NearPoints
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit


@dataclass(frozen=True, eq=False)
class ActivePairs:
    """What touches at a trial: n points in m pairs of an element and a facet.

    points: the n points. pair (n,): of each point; element, facet (m,): of each pair. forms (n, k, nz), C: see
    `gap_forms` and `row_forms`; by_place (n, nz): the form of the place on the axis.
    force (n,) [N] = area times pressure, slope (n,) [N/m]: derivative by the penetration; potential [J] of all.
    history (n, nh): of the pressure law after a step that ends here. dimension: d of the line.
    """

    points: NearPoints
    pair: IntArray
    element: IntArray
    facet: IntArray
    forms: Array
    C: Array
    by_place: Array
    force: Array
    slope: Array
    potential: float
    history: Array
    dimension: int

    @property
    def on_line(self) -> Array:
        """Force of each point on the line (n, d) [N]: against the normal, which the positions' share in δg has."""
        d = self.dimension
        return np.asarray(self.force[:, None] * (self.forms[:, 0, :d] + self.forms[:, 0, 2 * d : 3 * d]))

    @cached_property
    def gradient(self) -> Array:
        """dψ/dz (m, nz) of the pairs by z: q of the element, then the facet's nodes [N, N.m]."""
        out = np.zeros((len(self.element), self.forms.shape[2]))
        add_rows(out, self.pair, -self.force, self.forms[:, 0])
        return out

    def hessian(self) -> Array:
        """d²ψ/dz² (m, nz, nz) of the pairs."""
        nz = self.forms.shape[2]
        out = np.zeros((len(self.element), nz, nz))
        add_products(out, self.pair, self.forms, by_curvature(self.forms, self.C, self.force, self.slope))
        return out


@njit
def paired(element: IntArray, facet: IntArray, elements: int) -> tuple[IntArray, IntArray, IntArray]:
    """Pairs of n points that come facet by facet, numbered as they come: the pair of each point (n,), element and facet
    of each pair (m,). elements: of the riser.
    """
    n, m = len(element), 0
    pair, first, last = np.empty(n, np.int64), np.empty(n, np.int64), np.full(elements, -1)
    for i in range(n):
        known = last[element[i]]
        if known < 0 or facet[first[known]] != facet[i]:
            known, first[m], m = m, i, m + 1
            last[element[i]] = known
        pair[i] = known
    return pair, element[first[:m]], facet[first[:m]]


@njit
def add_rows(out: Array, pair: IntArray, factor: Array, rows: Array) -> None:
    """Add factor (n,) times rows (n, nz) to those (m, nz) of the points' pairs (n,)."""
    for i in range(len(pair)):
        for c in range(rows.shape[1]):
            out[pair[i], c] += factor[i] * rows[i, c]


@njit
def in_dofs(by_z: Array, element: IntArray, P: Array) -> Array:
    """Second derivatives (m, nr, nr) by the dofs of pairs, from those (m, nz, nz) by their z. P (ne, 2, d, r): those of
    the tangents in q by the rotation dofs; all else in z is a dof.
    """
    m, nz, (d, r) = len(element), by_z.shape[1], P.shape[2:]
    n, ns = d + r, nz - 4 * d
    half, out = np.zeros((nz, 2 * n + ns)), np.zeros((m, 2 * n + ns, 2 * n + ns))
    for k in range(m):
        half[...] = 0.0
        for i in range(nz):
            _add_in_dofs(half[i], by_z[k, i], P[element[k]])
        for j in range(2 * n + ns):
            _add_in_dofs(out[k, :, j], half[:, j], P[element[k]])
    return out


@njit
def _add_in_dofs(out: Array, by_z: Array, P: Array) -> None:
    """Add a derivative (nz,) by z to that by the dofs (nr,); P (2, d, r) of the element."""
    d, r = P.shape[1], P.shape[2]
    for side in range(2):
        q, dof = 2 * side * d, side * (d + r)
        for i in range(d):
            out[dof + i] += by_z[q + i]
            for j in range(r):
                out[dof + d + j] += by_z[q + d + i] * P[side, i, j]
    for i in range(4 * d, by_z.size):
        out[2 * (d + r) + i - 4 * d] += by_z[i]


@njit
def by_curvature(forms: Array, C: Array, force: Array, slope: Array) -> Array:
    """Forms (n, k, nz) times the matrices (n, k, k) with which forms·…·forms is d²ψ: of the law's slope, and of its
    force by C.
    """
    out = np.zeros_like(forms)
    for i in range(len(force)):
        for a in range(forms.shape[1]):
            for b in range(forms.shape[1]):
                factor = slope[i] - force[i] * C[i, 0, 0] if a == b == 0 else -force[i] * C[i, a, b]
                if factor != 0.0:
                    for c in range(forms.shape[2]):
                        out[i, a, c] += factor * forms[i, b, c]
    return out


@njit
def add_products(out: Array, pair: IntArray, left: Array, right: Array) -> None:
    """Add the sums of left (n, k, nz) times right (n, k, nz), by row and column, to those (m, nz, nz) of the pairs."""
    for i in range(len(pair)):
        for k in range(left.shape[1]):
            for r in range(left.shape[2]):
                row, factor, columns = out[pair[i], r], left[i, k, r], right[i, k]
                for c in range(len(row)):
                    row[c] += factor * columns[c]
