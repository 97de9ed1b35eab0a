"""Riser and ground at one state: gaps, and the forces and stiffness where they touch."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from riser_soil.arrays import Array, IntArray
from riser_soil.compiled import njit
from riser_soil.contact.gap import gap_forms, heights, penalty_hessian
from riser_soil.contact.ground import ContactPoints, Soil
from riser_soil.contact.law import Penalty
from riser_soil.part import State

PLANE, SOIL = "contact.plane", "contact.soil"
NONE = -1


class RiserNodes(Protocol):
    """The riser as contact sees it; nn nodes in d = 2 or 3 dimensions.

    arc (nn,) [m]. basis (3, d): the riser's axes in global ones. translation_dofs (nn, d): local numbers.
    """

    @property
    def offset(self) -> int: ...

    @property
    def size(self) -> int: ...

    @property
    def arc(self) -> Array: ...

    @property
    def basis(self) -> Array: ...

    @property
    def translation_dofs(self) -> IntArray: ...

    @property
    def tributary_length(self) -> Array: ...

    def positions3(self, state: State) -> Array: ...


@dataclass(frozen=True, eq=False)
class Touching:
    """Contact points that carry force on one ground; n points, nr dofs each, the riser's d translations
    first.

    node, facet (n,): facet −1 on a plane. length (n,): of riser [m]. penetration (n,) [m]. rows (n, nr):
    local dofs. forms (n, 5, nr), H (n, 2, 2): derivatives of the gap, see `gap`.
    """

    key: str
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
class Encounter:
    """Contact points near the ground at a state.

    facet (n,): soil facet below, −1 where there is none. gap (n,): height [m] of the riser's underside over
    the ground, inf where there is no ground. surface (np, 3): deformed points of the soil [m]. touching: one
    entry for each ground.
    """

    state: State
    points: ContactPoints
    facet: IntArray
    gap: Array
    surface: Array
    touching: list[Touching]

    @property
    def potential(self) -> float:
        return sum(t.potential for t in self.touching)


class Grounds:
    """Riser, soil and plane, and the laws by which they push: `meet` brings them together at a state.

    laws: the penalty law of each ground that exists, by its key. level: height of the plane [m]. radius
    (nn,): [m] from the axis to the line that touches. near: height [m] over the highest ground up to which
    nodes are looked at.
    """

    def __init__(
        self,
        riser: RiserNodes,
        radius: Array,
        points: ContactPoints,
        laws: dict[str, Penalty],
        level: float,
        soil: Soil | None,
        near: float,
    ) -> None:
        self._riser, self._radius, self._points = riser, radius, points
        self._laws, self._level, self._soil, self._near = laws, level, soil, near

    def meet(self, state: State) -> Encounter:
        """Gaps at a state, and forces where the riser touches."""
        x = self._riser.positions3(state)
        surface = np.empty((0, 3)) if self._soil is None else self._soil.deformed(state)
        ceiling = max(self._level, surface[:, 2].max(initial=-np.inf))
        points = self._points.of_chosen(x[:, 2] - self._radius < ceiling + self._near)
        facet, xi, soil_height = self._soil_below(x[points.node, :2] + points.offset, surface)
        ground = np.where(facet >= 0, soil_height, self._level)
        gap = x[points.node, 2] - self._radius[points.node] - ground
        encounter = Encounter(state, points, facet, gap, surface, [])
        for key, law in self._laws.items():
            on_this = (facet >= 0) == (key == SOIL)
            at = np.flatnonzero(on_this & (gap < law.smoothing))
            encounter.touching.append(self._touch(key, law, encounter, at, xi[at]))
        return encounter

    def starts(self, facet: IntArray) -> Array:
        """Gap [m] at which the force begins, over soil (facet ≥ 0) and over the plane."""
        soil, plane = (self._laws[k].smoothing if k in self._laws else 0.0 for k in (SOIL, PLANE))
        return np.where(facet >= 0, soil, plane)

    def _soil_below(self, xy: Array, surface: Array) -> tuple[IntArray, Array, Array]:
        if self._soil is None:
            return np.full(len(xy), NONE), np.zeros((len(xy), 2)), np.zeros(len(xy))
        facet, xi = self._soil.locate(xy, surface)
        return facet, xi, heights(facet, xi, self._soil.facets, surface)

    def _touch(self, key: str, law: Penalty, met: Encounter, at: IntArray, xi: Array) -> Touching:
        node, facet = met.points.node[at], met.facet[at]
        rows = self._riser.translation_dofs[node]
        if key == SOIL and self._soil is not None:
            forms, H = gap_forms(facet, xi, self._soil.facets, met.surface)
            forms = np.concatenate((forms[:, :, :3] @ self._riser.basis, forms[:, :, 3:]), axis=2)
            rows = np.hstack((rows, self._soil.facet_dofs(facet)))
        else:
            forms, H = self._level_forms(len(at)), np.zeros((len(at), 2, 2))
        return Touching(key, law, node, facet, met.points.length[at], -met.gap[at], rows, forms, H)

    def _level_forms(self, n: int) -> Array:
        """On a plane the gap grows with the height alone."""
        forms = np.zeros((n, 5, self._riser.basis.shape[1]))
        forms[:, 0] = self._riser.basis[2]
        return forms


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
