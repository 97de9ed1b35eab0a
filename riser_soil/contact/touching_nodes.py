"""Points around the riser's nodes that touch the soil below them: forces there, and their derivatives.

z is the d translations of a point's node in the line's axes, then the nodes of the facet below the point.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from riser_soil.contact.facets import gap_forms, height_at, penalty_hessian, within_line
from riser_soil.contact.on_condensed_soil import (
    POINTS,
    UNREACHED,
    UNWATCHED,
    TopMotion,
    Touched,
    add_block,
    add_contact,
    add_contact_tangent,
)
from riser_soil.contact.pairing import Cover, facet_below, renew_boxes
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.part_kernels import Border, LineForces
from riser_soil.seabed.compiled_law import answer, may_act

# Sides of facets, and diagonals of simple grids, miss all four points of a node where these have the golden ratio.
ASPECT = 1.618


class ContactPoints(NamedTuple):
    """Points fixed to nodes that carry the nodes' contact forces.

    node (n,). offset (n, 2): horizontal distance from the node [m]. length (n,): riser length that belongs to
    a point [m].
    """

    node: IntArray
    offset: Array
    length: Array

    @classmethod
    def of_nodes(cls, tributary: Array, footprint: float, along: Array) -> ContactPoints:
        """Four points a node, ±ASPECT·footprint along a horizontal unit vector, ±footprint across; or one."""
        across = np.array([-along[1], along[0]])
        corners = np.array([i * ASPECT * along + j * across for i in (-1.0, 1.0) for j in (-1.0, 1.0)])
        corners = footprint * corners if footprint > 0.0 else np.zeros((1, 2))
        node = np.repeat(np.arange(len(tributary)), len(corners))
        return cls(node, np.tile(corners, (len(tributary), 1)), tributary[node] / len(corners))


class PointsBelow(NamedTuple):
    """Soil below contact points (n,): facet, −1 where there is none or none is looked for; place on it (n, 2); gap, the
    height [m] of the riser's underside over the ground, inf without a facet.
    """

    facet: IntArray
    xi: Array
    gap: Array


class TouchingPoints(NamedTuple):
    """What touches of the contact points (n,): node, facet and place on it (n, 2); force [N] and its derivative by the
    penetration [N/m], length included.
    """

    node: IntArray
    facet: IntArray
    xi: Array
    force: Array
    slope: Array


def points_below(count: int) -> PointsBelow:
    """Workspace for so many points."""
    return PointsBelow(np.full(count, -1), np.zeros((count, 2)), np.full(count, np.inf))


def touching_workspace(count: int) -> TouchingPoints:
    """Workspace for so many points."""
    node, facet = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    return TouchingPoints(node, facet, np.zeros((count, 2)), np.zeros(count), np.zeros(count))


@dataclass(frozen=True, eq=False)
class TouchingNodes:
    """What touches at a state. surface (np, 3): points of the soil [m], facets (nf, nv) between them; basis (3, d): of
    the line; potential [J] of all forces.
    """

    points: TouchingPoints
    potential: float
    surface: Array
    facets: IntArray
    basis: Array

    @cached_property
    def forms(self) -> tuple[Array, Array]:
        """Derivatives of the gap by z: linear forms (n, 5, nz) and H (n, 2, 2), see `facets.gap_forms`."""
        forms: tuple[Array, Array] = touching_forms(self.points, self.facets, self.surface, self.basis)
        return forms

    @cached_property
    def gradient(self) -> Array:
        """dψ/dz (n, nz) [N]: minus the forces on riser and soil."""
        return np.asarray(-self.points.force[:, None] * self.forms[0][:, 0])

    def add_residual(self, nodal: Array, soil: Array) -> None:
        """Add dψ/du to the residual of the line's nodes (nn, ndof), and to that of the soil's surface (3 np,)."""
        rows, none = np.arange(soil.size).reshape(-1, 3), np.empty(0, dtype=np.bool_)  # all nodes are reached
        forms, d = self.forms[0], self.basis.shape[1]
        spread_touching(self.points, forms, self.facets, d, nodal, rows, soil, none)

    @property
    def hessian(self) -> Array:
        """d²ψ/dz² (n, nz, nz) [N/m]."""
        return np.asarray(penalty_hessian(*self.forms, self.points.force, self.points.slope))


@njit
def find_below(x: Array, radius: Array, points: ContactPoints, level: float, cover: Cover, out: PointsBelow) -> None:
    """Write the soil below the points of nodes at x (nn, 3), of those whose undersides are below a level [m]. radius
    (nn,): [m] from the axis to the line that touches.
    """
    for p in range(points.node.size):
        n = points.node[p]
        out.facet[p], out.gap[p] = -1, np.inf
        if not x[n, 2] - radius[n] < level:
            continue
        out.facet[p] = facet_below(cover, x[n, 0] + points.offset[p, 0], x[n, 1] + points.offset[p, 1], -1)
        if out.facet[p] >= 0:
            out.xi[p, 0], out.xi[p, 1] = cover.xi[0], cover.xi[1]
            ground = height_at(cover.facets[out.facet[p]], cover.xi[0], cover.xi[1], cover.points)
            out.gap[p] = x[n, 2] - radius[n] - ground


@njit
def find_touching(law: Any, points: ContactPoints, below: PointsBelow, out: TouchingPoints) -> tuple[int, float]:
    """Write what touches of the points, by the kernel data of a law without history: how many do, and the energy that
    they store [J].
    """
    nothing, n, energy = np.empty(0), 0, 0.0
    for p in range(points.node.size):
        if may_act(law, -below.gap[p], nothing):
            force, slope, stored = answer(law, -below.gap[p], nothing, nothing)
            out.node[n], out.facet[n] = points.node[p], below.facet[p]
            out.xi[n, 0], out.xi[n, 1] = below.xi[p, 0], below.xi[p, 1]
            out.force[n], out.slope[n] = points.length[p] * force, points.length[p] * slope
            energy += points.length[p] * stored
            n += 1
    return n, energy


@njit
def first_touching(points: TouchingPoints, n: int) -> TouchingPoints:
    """The first n points."""
    return TouchingPoints(points.node[:n], points.facet[:n], points.xi[:n], points.force[:n], points.slope[:n])


@njit
def touching_forms(points: TouchingPoints, facets: IntArray, surface: Array, basis: Array) -> tuple[Array, Array]:
    """Derivatives of the gap by z at all points: linear forms (n, 5, nz) and H (n, 2, 2), see `facets.gap_forms`."""
    forms, H = gap_forms(points.facet, points.xi, facets, surface)
    return within_line(forms, basis), H


@njit
def spread_touching(
    points: TouchingPoints,
    forms: Array,
    facets: IntArray,
    d: int,
    nodal: Array,
    rows: IntArray,
    residual: Array,
    newly_loaded: BoolArray,
) -> None:
    """Add the residual of what touches to that of the line's nodes (nn, ndof), d translations each, and to the soil's,
    whose rows (np, 3) are given. Nodes of the soil that bear a force and are not reached are marked in `newly_loaded`
    (np,).
    """
    for i in range(points.node.size):
        for j in range(d):
            nodal[points.node[i], j] -= points.force[i] * forms[i, 0, j]
        for k in range(d, forms.shape[2]):
            a, share = facets[points.facet[i], (k - d) // 3], points.force[i] * forms[i, 0, k]
            row = rows[a, (k - d) % 3]
            if row >= 0:
                residual[row] -= share
            elif row == UNREACHED and share != 0.0:
                newly_loaded[a] = True


class WatchedFacets(NamedTuple):
    """Facets (k,) that may come to touch, as marked (nf,), as long as no other lies below a node whose underside is
    below a level [m].
    """

    facets: IntArray
    marked: BoolArray
    level: float


class NodeContactData(NamedTuple):
    """A `NodeContact` on condensed soil: origin (3,) and basis (3, d) of the line, radius (nn,) [m] and points; the
    law; the soil's surface, and which of its facets may come to touch. As evaluated last: places x (nn, 3) of the nodes
    [m], the soil below all points, and what touches.
    """

    origin: Array
    basis: Array
    radius: Array
    points: ContactPoints
    law: Any
    cover: Cover
    watched: WatchedFacets
    x: Array
    below: PointsBelow
    touching: TouchingPoints
    touched: Touched


@njit
def write_places(origin: Array, basis: Array, x: Array, out: Array) -> None:
    """Write places x (nn, d) of a line's nodes in global axes (nn, 3)."""
    for n in range(out.shape[0]):
        for i in range(3):
            out[n, i] = origin[i]
            for j in range(x.shape[1]):
                out[n, i] += basis[i, j] * x[n, j]


@add_contact.of(NodeContactData)
def _node_contact(
    part: NodeContactData, top: TopMotion, at: Configuration, out: LineForces, border: Border
) -> None:
    cover, watched, counts = part.cover, part.watched, part.touched.counts
    write_places(part.origin, part.basis, at.x, part.x)
    renew_boxes(cover, watched.facets)
    find_below(part.x, part.radius, part.points, watched.level, cover, part.below)
    counts[UNWATCHED] = 0
    for facet in part.below.facet:
        if facet >= 0 and not watched.marked[facet]:
            counts[UNWATCHED] = 1
    n, part.touched.energy[0] = find_touching(part.law, part.points, part.below, part.touching)
    counts[POINTS], part.touched.newly_loaded[:] = n, False
    touching = first_touching(part.touching, n)
    forms, _ = touching_forms(touching, cover.facets, cover.points, part.basis)
    soil = top.rows, border.residual, part.touched.newly_loaded
    spread_touching(touching, forms, cover.facets, part.basis.shape[1], out.end, *soil)


@add_contact_tangent.of(NodeContactData)
def _node_contact_tangent(
    part: NodeContactData, top: TopMotion, at: Configuration, K: Array, border: Border
) -> None:
    touching, facets = first_touching(part.touching, part.touched.counts[POINTS]), part.cover.facets
    forms, H = touching_forms(touching, facets, part.cover.points, part.basis)
    blocks, ndof = penalty_hessian(forms, H, touching.force, touching.slope), K.shape[1] // 2
    for i in range(touching.node.size):
        e = min(touching.node[i], K.shape[0] - 1)
        of_node = e, ndof * (touching.node[i] - e), part.basis.shape[1]
        add_block(blocks[i], *of_node, facets[touching.facet[i]], top.rows, K, border)
