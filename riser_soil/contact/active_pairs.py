"""What touches at a trial: pairs of an element and a facet with their points, contact forces and contact stiffness."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.contact.cylinder_gap import NearPoints
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit


@dataclass(frozen=True, eq=False)
class ActivePairs:
    """What touches at a trial: n points in m pairs of an element and a facet.

    points: the n points. pair (n,): of each point; element, facet (m,): of each pair. forms, C: see `gap_forms`.
    force (n,) [N] = area times pressure, slope (n,) [N/m]: derivative by the penetration; potential [J] of all.
    history (n, nh): of the pressure law after a step that ends here. dimension: d of the line.
    """

    points: NearPoints
    pair: IntArray
    element: IntArray
    facet: IntArray
    forms: Array
    C: Array
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
        core = -self.force[:, None, None] * self.C
        core[:, 0, 0] += self.slope
        add_products(out, self.pair, self.forms, core @ self.forms)
        return out


@njit
def add_rows(out: Array, pair: IntArray, factor: Array, rows: Array) -> None:
    """Add factor (n,) times rows (n, nz) to those (m, nz) of the points' pairs (n,)."""
    for i in range(len(pair)):
        for c in range(rows.shape[1]):
            out[pair[i], c] += factor[i] * rows[i, c]


@njit
def add_products(out: Array, pair: IntArray, left: Array, right: Array) -> None:
    """Add the sums of left (n, k, nz) times right (n, k, nz), by row and column, to those (m, nz, nz) of the pairs."""
    for i in range(len(pair)):
        for a in range(left.shape[1]):
            for r in range(left.shape[2]):
                if left[i, a, r] != 0.0:
                    for c in range(right.shape[2]):
                        out[pair[i], r, c] += left[i, a, r] * right[i, a, c]
