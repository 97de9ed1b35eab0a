"""Contact of the pipe's cylinder with the surface of condensed soil in the compiled loop, see `solve.soil_border`.

The same formulas as in `surface_contact`, called for all points at once; the law has no history. The soil's reached
dofs are the loop's border: what it adds there are the facets' shares.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from riser_soil.contact.active_pairs import add_products, by_curvature, in_dofs, paired
from riser_soil.contact.closest_point import Axis
from riser_soil.contact.cylinder_gap import FORMS, away_from_axis, put_gap_forms
from riser_soil.contact.near_points import NearPoints, PairsByFacet, Surface, boxes, fill_near, first_of, point_on
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.hermite import shape as axis_shape
from riser_soil.riser.part_kernels import LineForces
from riser_soil.riser.vectors import Vec
from riser_soil.seabed.compiled_law import answer

HELD, BEYOND = -1, -2  # in place of the border's row: of dofs that are supported, and of those that are not reached
POINTS, LEFT = range(2)  # in `TouchWorkspace.found`: how many points touch; whether something has left what is watched


class TouchData(NamedTuple):
    """The pipe and the surface. axis: workspace for q; surface: with workspace for its present points. basis (3, d),
    origin (3,): of the line. law: its numbers, its force begins at a gap of `reach` [m].
    """

    axis: Axis
    surface: Surface
    basis: Array
    origin: Array
    law: Any
    reach: float


class Watched(NamedTuple):
    """What may touch as long as elements stay within their boxes, low and high (ne, 3), or above a level [m]."""

    pairs: PairsByFacet
    low: Array
    high: Array
    level: float


class TopMotion(NamedTuple):
    """How the watched nodes (k,) of the top move by the border's increments: by (3 k, nb). accepted (np, 3): where all
    are before [m]. rows (np, 3): of the border, HELD or BEYOND.
    """

    nodes: IntArray
    by: Array
    accepted: Array
    rows: IntArray


class Border(NamedTuple):
    """Unknowns beside the line's dofs (n,), which all couple with each other: increments u (nb,), residual (nb,); of
    the tangent the corner (nb, nb) and what couples it with the line (n, nb), symmetrically, and the line's nodes
    (nn,) that are.
    """

    u: Array
    residual: Array
    corner: Array
    right: Array
    coupled: BoolArray


class TouchWorkspace(NamedTuple):
    """What was found last. near: the points, their force [N] and its derivative by the penetration [N/m] (n,), area
    included; found (2,): see POINTS, LEFT; met (np,): nodes of the top that are not reached, and bear a force. energy
    (1,): stored [J].
    """

    near: NearPoints
    force: Array
    slope: Array
    found: IntArray
    met: BoolArray
    energy: Array


@njit
def move_top(touch: TouchData, top: TopMotion, border: Border) -> None:
    """Write where the watched nodes are."""
    moved = np.dot(top.by, border.u)
    for k in range(top.nodes.size):
        for i in range(3):
            touch.surface.deformed[top.nodes[k], i] = top.accepted[top.nodes[k], i] + moved[3 * k + i]


@njit
def add_touch(
    touch: TouchData,
    watched: Watched,
    top: TopMotion,
    at: Configuration,
    out: LineForces,
    border: Border,
    workspace: TouchWorkspace,
) -> None:
    """Add the contact's residual to that of the line and to the border's."""
    _put_axis(touch, at.q)
    n = fill_near(touch.axis, touch.surface, watched.pairs, touch.reach, workspace.near)
    workspace.energy[0], workspace.met[:] = 0.0, False
    workspace.found[LEFT] = n > len(workspace.force) or _leaves(touch.axis, watched)
    n = workspace.found[POINTS] = min(n, len(workspace.force))
    nv, after = touch.surface.facets.shape[1], np.empty(0)
    N, dN = np.empty(nv), np.empty((nv, 2))
    for i in range(n):
        force, slope, stored = answer(touch.law, -workspace.near.gap[i], after, after)
        area = workspace.near.area[i]
        workspace.force[i], workspace.slope[i] = area * force, area * slope
        workspace.energy[0] += area * stored
        _press(touch, top, i, N, dN, out.end_q, border.residual, workspace)


@njit
def _put_axis(touch: TouchData, q: Array) -> None:
    """Write q (ne, 4, d) of a line in global axes."""
    axis, basis = touch.axis.q, touch.basis
    for e in range(q.shape[0]):
        for a in range(4):
            for i in range(3):
                value = touch.origin[i] if a % 2 == 0 else 0.0
                for j in range(q.shape[2]):
                    value += basis[i, j] * q[e, a, j]
                axis[e, a, i] = value


@njit
def _leaves(axis: Axis, watched: Watched) -> bool:
    """Whether an element may touch what is not watched."""
    low, high = boxes(axis, 0.0, 0.0)
    for e in range(low.shape[0]):
        if low[e, 2] > watched.level:
            continue
        for i in range(3):
            if low[e, i] < watched.low[e, i] or high[e, i] > watched.high[e, i]:
                return True
    return False


@njit
def _normal(touch: TouchData, near: NearPoints, i: int, N: Array, dN: Array) -> Vec:
    """Away from the axis at a point; writes the facet's shape functions."""
    e, axis = near.element[i], touch.axis
    p = point_on(touch.surface.deformed, touch.surface.facets[near.facet[i]], near.xi[i, 0], near.xi[i, 1], N, dN)
    _, n = away_from_axis(axis.q[e], axis.length[e], axis.radius[e], near.along[i], p)
    return n


@njit
def _press(
    touch: TouchData,
    top: TopMotion,
    i: int,
    N: Array,
    dN: Array,
    end_q: Array,
    residual: Array,
    workspace: TouchWorkspace,
) -> None:
    """Add minus the force of a point on the element, and on the facet's nodes: dψ = -force n·(δp - N δq)."""
    near, basis = workspace.near, touch.basis
    n, e = _normal(touch, near, i, N, dN), near.element[i]
    shares = axis_shape(near.along[i], touch.axis.length[e])
    for j in range(basis.shape[1]):
        along = workspace.force[i] * (basis[0, j] * n[0] + basis[1, j] * n[1] + basis[2, j] * n[2])
        for a in range(4):
            end_q[e, a, j] += along * shares[a]
    nodes = touch.surface.facets[near.facet[i]]
    for a in range(nodes.size):
        for j in range(3):
            row = top.rows[nodes[a], j]
            if row >= 0:
                residual[row] -= workspace.force[i] * N[a] * n[j]
            elif row == BEYOND and workspace.force[i] != 0.0:
                workspace.met[nodes[a]] = True


@njit
def add_touch_tangent(
    touch: TouchData, top: TopMotion, at: Configuration, K: Array, border: Border, workspace: TouchWorkspace
) -> None:
    """Add the derivative of the contact's residual, found last, to K (ne, n, n) and to the border's."""
    n, facets = workspace.found[POINTS], touch.surface.facets
    near = first_of(workspace.near, n)
    nq = 4 * touch.basis.shape[1]
    nz = nq + 3 * facets.shape[1]
    forms, C = np.empty((n, FORMS, nz)), np.zeros((n, FORMS, FORMS))
    put_gap_forms(touch.axis, touch.surface, near, touch.basis, forms, C)
    pair, element, facet = paired(near.element, near.facet, K.shape[0])
    by_z = np.zeros((element.size, nz, nz))
    add_products(by_z, pair, forms, by_curvature(forms, C, workspace.force[:n], workspace.slope[:n]))
    by_dofs = in_dofs(by_z, element, at.P)
    for k in range(element.size):
        _spread(by_dofs[k], element[k], top.rows, facets[facet[k]], K, border)


@njit
def _spread(block: Array, e: int, rows: IntArray, nodes: IntArray, K: Array, border: Border) -> None:
    """Add the block of a pair: the element's dofs, then the facet's."""
    n = K.shape[1]
    border.coupled[e] = border.coupled[e + 1] = True
    for i in range(n):
        for j in range(n):
            K[e, i, j] += block[i, j]
    for a in range(3 * nodes.size):
        row = rows[nodes[a // 3], a % 3]
        if row < 0:
            continue
        for i in range(n):
            border.right[e * (n // 2) + i, row] += block[i, n + a]
        for b in range(3 * nodes.size):
            column = rows[nodes[b // 3], b % 3]
            if column >= 0:
                border.corner[row, column] += block[n + a, n + b]


@njit
def put_touch_work(
    touch: TouchData, top: TopMotion, first: Configuration, last: Configuration, workspace: TouchWorkspace, work: Array
) -> None:
    """Write to work (1,) what the force at a step's end, found last, takes along the step [J]: see
    `SurfaceContact.work`.
    """
    near, nv, taken = workspace.near, touch.surface.facets.shape[1], 0.0
    N, dN = np.empty(nv), np.empty((nv, 2))
    for i in range(workspace.found[POINTS]):
        n, e = _normal(touch, near, i, N, dN), near.element[i]
        nodes, shares, moved = touch.surface.facets[near.facet[i]], axis_shape(near.along[i], touch.axis.length[e]), 0.0
        for j in range(3):
            for a in range(nv):
                was = top.accepted[nodes[a], j]
                moved += n[j] * N[a] * (touch.surface.deformed[nodes[a], j] - was)
            for a in range(4):
                for k in range(touch.basis.shape[1]):
                    moved -= n[j] * shares[a] * touch.basis[j, k] * (last.q[e, a, k] - first.q[e, a, k])
        taken -= workspace.force[i] * moved
    work[0] = taken
