"""Points of the soil's surface that touch the pipe: forces there, on the pipe and on the soil, and their derivatives.

A force f on the pipe at a point does the work f·(δp - N δq) as the point moves by δp and the axis at its place by N δq.
z is q of an element, then the nodes of a facet.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from riser_soil.contact.closest_point import Axis
from riser_soil.contact.cylinder_gap import away_from_axis, gap_forms
from riser_soil.contact.facets import fill_shape
from riser_soil.contact.integration_points import PointHistory, write_history
from riser_soil.contact.near_points import NearPoints, Surface, first_of, point_on
from riser_soil.contact.on_condensed_soil import UNREACHED
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser.hermite import shape as axis_shape
from riser_soil.riser.vectors import add, dot, scale, sub, vector, write
from riser_soil.seabed.compiled_law import answer, may_act

Start = tuple[Array, Array]  # where a step starts: q (ne, 4, 3) of the pipe's axis, and the soil's points (np, 3) [m]


class Pairs(NamedTuple):
    """Pairs of an element and a facet: the pair of each point (n,), element and facet of each pair (m,)."""

    pair: IntArray
    element: IntArray
    facet: IntArray


class PressWorkspace(NamedTuple):
    """Points near the pipe, and what presses there: histories before and after the step (n, nh), force [N] and its
    derivative by the penetration [N/m] (n,), area included; on_riser (n, 3): force on the pipe [N].
    """

    near: NearPoints
    before: Array
    after: Array
    force: Array
    slope: Array
    on_riser: Array


def press_workspace(near: NearPoints, columns: int) -> PressWorkspace:
    """Workspace for some points; columns: of their history."""
    n = len(near.gap)
    histories = np.zeros((n, columns)), np.zeros((n, columns))
    return PressWorkspace(near, *histories, np.zeros(n), np.zeros(n), np.zeros((n, 3)))


@dataclass(frozen=True, eq=False)
class PressedPoints:
    """What touches at a trial: n points. axis, surface: pipe and soil there; basis (3, d): of the line.

    force (n,) [N] = area times pressure, slope (n,) [N/m]: derivative by the penetration; potential [J] of all.
    on_riser (n, 3): force on the pipe [N], global axes. history (n, nh): of the pressure law after a step that ends
    here.
    """

    axis: Axis
    surface: Surface
    basis: Array
    points: NearPoints
    force: Array
    slope: Array
    potential: float
    on_riser: Array
    history: Array

    @classmethod
    def of(
        cls, axis: Axis, surface: Surface, basis: Array, points: NearPoints, law: Any, history: PointHistory
    ) -> PressedPoints:
        """The points among these where the law may act, by its kernel data and its history."""
        out = press_workspace(points, history.untouched.size)
        n, potential = find_pressed(law, history, axis, surface, len(points.gap), out)
        forces = out.force[:n], out.slope[:n], potential, out.on_riser[:n]
        return cls(axis, surface, basis, first_of(points, n), *forces, out.after[:n])

    @classmethod
    def copied(
        cls, axis: Axis, surface: Surface, basis: Array, n: int, potential: float, workspace: PressWorkspace
    ) -> PressedPoints:
        """Copies of the first n points of a workspace, which is written to again."""
        axis, surface = axis._replace(q=axis.q.copy()), surface._replace(deformed=surface.deformed.copy())
        near = NearPoints._make(each[:n].copy() for each in workspace.near)
        force, slope, on_riser, history = (
            each[:n].copy() for each in (workspace.force, workspace.slope, workspace.on_riser, workspace.after)
        )
        return cls(axis, surface, basis, near, force, slope, potential, on_riser, history)

    @cached_property
    def pairs(self) -> Pairs:
        pairs: Pairs = paired(self.points, len(self.axis.length))
        return pairs

    @cached_property
    def forms(self) -> tuple[Array, Array]:
        """Linear forms (n, 4, 4 d + 3 nv) of the gap at the points, and the symmetric matrices C (n, 4, 4) with which
        δ²g = forms·C·forms, as of `gap_forms`.
        """
        forms: tuple[Array, Array] = gap_forms(self.axis, self.surface, self.points, self.basis)
        return forms

    def spread(self, f: Array) -> tuple[Array, Array]:
        """Residuals of forces f (n, 3) on the pipe: conjugate to q (ne, 4, d), and of the surface (np, 3)."""
        F, soil = np.zeros((len(self.axis.length), 4, self.basis.shape[1])), np.zeros(self.surface.deformed.shape)
        rows, none = np.arange(soil.size).reshape(soil.shape), np.empty(0, dtype=np.bool_)  # all nodes are reached
        spread(self.axis, self.surface, self.basis, self.points, len(f), f, F, rows, soil.ravel(), none)
        return F, soil

    def work(self, f: Array, start: Start) -> float:
        """Work [J] of forces f (n, 3) on the pipe and on the soil on the way from where a step starts."""
        return float(work_of(self.axis, self.surface, self.points, len(f), f, *start))


@njit
def write_axis(origin: Array, basis: Array, q: Array, axis: Array) -> None:
    """Write q (ne, 4, d) of a line in global axes (ne, 4, 3)."""
    for e in range(q.shape[0]):
        for a in range(4):
            for i in range(3):
                value = origin[i] if a % 2 == 0 else 0.0
                for j in range(q.shape[2]):
                    value += basis[i, j] * q[e, a, j]
                axis[e, a, i] = value


@njit
def find_pressed(
    law: Any, history: PointHistory, axis: Axis, surface: Surface, n: int, out: PressWorkspace
) -> tuple[int, float]:
    """Write what presses at those of the first n near points where the law may act, the others being removed: how many
    they are, and the energy that they store [J]. history: of the law.
    """
    write_history(history, out.near.number, n, out.before)
    n = keep_active(law, out.near, n, out.before)
    energy = press(law, out.near, n, out.before, out.after, out.force, out.slope)
    write_on_riser(axis, surface, out.near, n, out.force, out.on_riser)
    return n, energy


@njit
def press(law: Any, points: NearPoints, n: int, before: Array, after: Array, force: Array, slope: Array) -> float:
    """Write force [N] and slope [N/m] of the first n points, area included, and the law's history after them (n, nh);
    the energy stored [J].
    """
    energy = 0.0
    for i in range(n):
        pressure, rise, stored = answer(law, -points.gap[i], before[i], after[i])
        force[i], slope[i] = points.area[i] * pressure, points.area[i] * rise
        energy += points.area[i] * stored
    return energy


@njit
def keep_active(law: Any, points: NearPoints, n: int, before: Array) -> int:
    """Keep those of the first n points where the law may act, with their histories (n, nh); how many they are."""
    k = 0
    for i in range(n):
        if may_act(law, -points.gap[i], before[i]):
            points.element[k], points.facet[k], points.number[k] = points.element[i], points.facet[i], points.number[i]
            points.along[k], points.area[k], points.gap[k] = points.along[i], points.area[i], points.gap[i]
            points.xi[k], before[k] = points.xi[i], before[i]
            k += 1
    return k


@njit
def write_on_riser(axis: Axis, surface: Surface, points: NearPoints, n: int, force: Array, out: Array) -> None:
    """Write the force on the pipe (n, 3) [N] at the first n points: away from the soil."""
    nv = surface.facets.shape[1]
    N, dN = np.empty(nv), np.empty((nv, 2))
    for i in range(n):
        e, nodes = points.element[i], surface.facets[points.facet[i]]
        p = point_on(surface.deformed, nodes, points.xi[i, 0], points.xi[i, 1], N, dN)
        _, away = away_from_axis(axis.q[e], axis.length[e], axis.radius[e], points.along[i], p)
        write(scale(-force[i], away), out[i])


@njit
def spread(
    axis: Axis,
    surface: Surface,
    basis: Array,
    points: NearPoints,
    n: int,
    f: Array,
    F: Array,
    rows: IntArray,
    residual: Array,
    newly_loaded: BoolArray,
) -> None:
    """Add the residual of forces f (n, 3) on the pipe at the first n points: F (ne, 4, d) is conjugate to q, rows
    (np, 3) are those of the soil's residual. Nodes that bear a force and are not reached are marked in `newly_loaded`
    (np,).
    """
    nv = surface.facets.shape[1]
    N, dN = np.empty(nv), np.empty((nv, 2))
    for i in range(n):
        e, nodes, force = points.element[i], surface.facets[points.facet[i]], vector(f[i])
        shares = axis_shape(points.along[i], axis.length[e])
        for j in range(basis.shape[1]):
            along = basis[0, j] * force[0] + basis[1, j] * force[1] + basis[2, j] * force[2]
            for a in range(4):
                F[e, a, j] -= along * shares[a]
        fill_shape(points.xi[i, 0], points.xi[i, 1], N, dN)
        for a in range(nv):
            for j in range(3):
                row = rows[nodes[a], j]
                if row >= 0:
                    residual[row] += N[a] * force[j]
                elif row == UNREACHED and dot(force, force) > 0.0:
                    newly_loaded[nodes[a]] = True


@njit
def work_of(
    axis: Axis, surface: Surface, points: NearPoints, n: int, f: Array, first: Array, before: Array
) -> float:
    """Work [J] of forces f (n, 3) on the pipe at the first n points, and of their opposites on the soil, as q go from
    first (ne, 4, 3) to where they are, and the soil's points from before (np, 3).
    """
    nv, total = surface.facets.shape[1], 0.0
    N, dN = np.empty(nv), np.empty((nv, 2))
    for i in range(n):
        e, nodes, way = points.element[i], surface.facets[points.facet[i]], (0.0, 0.0, 0.0)
        shares = axis_shape(points.along[i], axis.length[e])
        fill_shape(points.xi[i, 0], points.xi[i, 1], N, dN)
        for a in range(nv):
            moved = sub(vector(surface.deformed[nodes[a]]), vector(before[nodes[a]]))
            way = add(way, scale(N[a], moved))
        for a in range(4):
            way = sub(way, scale(shares[a], sub(vector(axis.q[e, a]), vector(first[e, a]))))
        total += dot(vector(f[i]), way)
    return total


@njit
def paired(points: NearPoints, elements: int) -> Pairs:
    """Pairs of n points that come facet by facet, numbered as they come. elements: of the riser."""
    element, facet = points.element, points.facet
    n, m = len(element), 0
    pair, first, last = np.empty(n, np.int64), np.empty(n, np.int64), np.full(elements, -1)
    for i in range(n):
        k = last[element[i]]
        if k < 0 or facet[first[k]] != facet[i]:
            k, first[m], m = m, i, m + 1
            last[element[i]] = k
        pair[i] = k
    return Pairs(pair, element[first[:m]], facet[first[:m]])


@njit
def pair_tangents(forms: Array, C: Array, force: Array, slope: Array, pairs: Pairs, P: Array) -> Array:
    """Derivative (m, nr, nr) of the residual of what presses by the dofs of its pairs, at constant P (ne, 2, d, r).
    forms, C: of the gap, see `gap_forms`.
    """
    by_z = np.zeros((pairs.element.size, forms.shape[2], forms.shape[2]))
    add_products(by_z, pairs.pair, forms, by_curvature(forms, C, force, slope))
    return in_dofs(by_z, pairs.element, P)


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
    n, k, nz = left.shape
    first = 0
    for i in range(1, n + 1):
        if i == n or pair[i] != pair[first]:  # a run of points of one pair
            rows, columns = left[first:i].reshape((i - first) * k, nz), right[first:i].reshape((i - first) * k, nz)
            out[pair[first]] += np.dot(rows.T, columns)
            first = i
