"""Contact detection at a trial state: gaps of candidate pairs, contact forces and contact stiffness."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.contact.gap import gap_forms, heights, penalty_hessian
from riser_soil.contact.ground import ContactPoints, DeformedSurface
from riser_soil.contact.law import Penalty
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.part import State
from riser_soil.riser.line import Line

SOIL = "contact.soil"


@dataclass(frozen=True, eq=False)
class ActiveContacts:
    """Contact points that carry force; n points, nr dofs each, the riser's d translations first.

    node, facet (n,). length (n,): of riser [m]. penetration (n,) [m]. rows (n, nr): local dofs. forms (n, 5, nr),
    H (n, 2, 2): derivatives of the gap, see `gap`.
    """

    law: Penalty
    node: IntArray
    facet: IntArray
    length: Array
    penetration: Array
    rows: IntArray
    forms: Array
    H: Array

    @cached_property
    def force(self) -> Array:
        """Contact force of each point (n,) [N], ≥ 0."""
        return self.length * self.law.force(self.penetration)

    @cached_property
    def gradient(self) -> Array:
        """dψ/du (n, nr) [N]: minus the forces on riser and soil."""
        return np.asarray(-self.force[:, None] * self.forms[:, 0])

    @property
    def hessian(self) -> Array:
        """d²ψ/du² (n, nr, nr) [N/m]."""
        return penalty_hessian(self.forms, self.H, self.force, self.length * self.law.slope(self.penetration))

    @property
    def potential(self) -> float:
        """ψ [J]."""
        return float(self.length @ self.law.potential(self.penetration))


@dataclass(frozen=True, eq=False)
class ContactState:
    """Contact points near the ground at a state.

    facet (n,): soil facet below, −1 where there is none. gap (n,): height [m] of the riser's underside over
    the ground, inf where there is no ground. surface (np, 3): deformed points of the soil [m]. touching: one
    entry for each ground.
    """

    points: ContactPoints
    facet: IntArray
    gap: Array
    surface: Array
    touching: ActiveContacts


class ContactDetection:
    """Contact detection between riser and soil: `detect` gives gaps and contact forces at a state.

    radius (nn,): [m] from the axis to the line that touches. near: height [m] over the soil's highest point up to which
    nodes are looked at.
    """

    def __init__(
        self, line: Line, radius: Array, points: ContactPoints, law: Penalty, soil: DeformedSurface, near: float
    ) -> None:
        self._line, self._radius, self._points = line, radius, points
        self._law, self._soil, self._near = law, soil, near

    def detect(self, state: State) -> ContactState:
        """Gaps at a state, and forces where the riser touches."""
        x, surface = self._line.positions3(state), self._soil.deformed(state)
        points = self._points.of_chosen(x[:, 2] - self._radius < surface[:, 2].max() + self._near)
        facet, xi = self._soil.locate(x[points.node, :2] + points.offset, surface)
        ground = heights(facet, xi, self._soil.facets, surface)
        gap = x[points.node, 2] - self._radius[points.node] - ground
        at = np.flatnonzero(gap < self._law.smoothing)
        return ContactState(points, facet, gap, surface, self._touch(points, facet, gap, surface, at, xi[at]))

    def _touch(
        self, points: ContactPoints, facet: IntArray, gap: Array, surface: Array, at: IntArray, xi: Array
    ) -> ActiveContacts:
        node, below = points.node[at], facet[at]
        forms, H = gap_forms(below, xi, self._soil.facets, surface)
        forms = np.concatenate((forms[:, :, :3] @ self._line.basis, forms[:, :, 3:]), axis=2)
        rows = np.hstack((self._line.translation_dofs[node], self._soil.facet_dofs(below)))
        return ActiveContacts(self._law, node, below, points.length[at], -gap[at], rows, forms, H)


@njit
def add_shares(values: Array, rows: IntArray, shares: Array) -> None:
    """Add shares (n, nr) to values at rows (n, nr), which may repeat."""
    for i in range(rows.shape[0]):
        for j in range(rows.shape[1]):
            values[rows[i, j]] += shares[i, j]


@njit
def add_blocks(values: Array, places: IntArray, blocks: Array) -> None:
    """Add blocks (n, nr, nr) to values[places], which may repeat; blocks at −1 are left out."""
    for i in range(places.size):
        if places[i] >= 0:
            values[places[i]] += blocks[i]
