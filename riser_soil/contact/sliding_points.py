"""Friction of the pipe at the points of the soil's surface that press on it, see `coulomb`: tractions and their
derivatives.

z is q of an element, then the nodes of a facet, as in `pressed_points`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.contact.closest_point import Axis
from riser_soil.contact.coulomb import limits, return_map
from riser_soil.contact.cylinder_gap import Slide, gap_forms, slide_workspace, write_slide, write_slide_columns
from riser_soil.contact.friction import components, read_along, resistance_by_movement, vector_of, write_along
from riser_soil.contact.integration_points import PointHistory, write_history
from riser_soil.contact.near_points import NearPoints, Surface, first_of
from riser_soil.contact.on_condensed_soil import POINTS, TopMotion, add_contact, add_contact_tangent
from riser_soil.contact.pressed_points import Pairs, Start, add_products, in_dofs, paired, spread
from riser_soil.contact.surface_kernels import SurfaceContactData, add_pairs
from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.part_kernels import Border, LineForces
from riser_soil.riser.vectors import add, scale, sub, vector, write

AREA = 3  # column of a point's history, behind the traction


class Resistance(NamedTuple):
    """Coefficients (2,) of friction, axial and lateral, and stiffness of the soil's surface along itself [N/m3]."""

    mu: Array
    stiffness: float


class SlidingPoints(NamedTuple):
    """Friction at n points in a trial state.

    From the accepted state: history (n, 4) and adhesion (n,) [Pa]. In the trial: way slid (n, 3) [m], directions
    (n, 2, 3), elastic guess and traction (n, 3) [Pa], and force (n, 3) [N] on the riser.
    """

    before: Array
    most: Array
    moved: Array
    along: Array
    elastic: Array
    traction: Array
    on_riser: Array


def sliding_workspace(n: int) -> SlidingPoints:
    """Workspace for so many points, without adhesion."""
    moved, elastic, traction, on_riser = (np.empty((n, 3)) for _ in range(4))
    before, most, along = np.empty((n, AREA + 1)), np.full(n, np.inf), np.empty((n, 2, 3))
    return SlidingPoints(before, most, moved, along, elastic, traction, on_riser)


@njit
def find_tractions(
    resistance: Resistance,
    near: NearPoints,
    n: int,
    force: Array,
    start: Start,
    axis: Axis,
    surface: Surface,
    out: SlidingPoints,
) -> None:
    """Find the tractions of the first n points, pressed by forces (n,) [N]."""
    k, mu, at = resistance.stiffness, (resistance.mu[0], resistance.mu[1]), slide_workspace(surface.facets.shape[1], 0)
    for i in range(n):
        write_slide(near, i, start, axis, surface, at)
        along, elastic = read_along(at.along.T), sub(vector(out.before[i]), scale(k, vector(at.moved)))
        limit, _ = limits(force[i] / near.area[i], 0.0, mu, (out.most[i], 0.0))
        t, _, _ = return_map(components(along, elastic), limit, (0.0, 0.0))
        traction = vector_of(along, t)
        write(vector(at.moved), out.moved[i])
        write_along(along, out.along[i].T)
        write(elastic, out.elastic[i])
        write(traction, out.traction[i])
        write(scale(near.area[i], traction), out.on_riser[i])


@njit
def friction_tangents(
    resistance: Resistance,
    near: NearPoints,
    force: Array,
    slope: Array,
    start: Start,
    axis: Axis,
    surface: Surface,
    basis: Array,
    forms: Array,
    pairs: Pairs,
    sliding: SlidingPoints,
    P: Array,
) -> Array:
    """Derivative (m, nr, nr) of the residual of friction by the dofs of its pairs, at constant P (ne, 2, d, r).
    force (n,) [N] and slope (n,) [N/m]: of the pressure; forms: of the gap, see `gap_forms`.
    """
    n, _, nz = forms.shape
    at, by_z = slide_workspace(surface.facets.shape[1], basis.shape[1]), np.zeros((len(pairs.element), nz, nz))
    left, right = np.empty((n, 4, nz)), np.empty((n, 4, nz))
    for i in range(n):
        write_slide(near, i, start, axis, surface, at)
        write_slide_columns(near, i, axis, basis, at)
        pushed = force[i] / near.area[i], slope[i] / near.area[i], sliding.most[i]
        _write_factors(resistance, pushed, sliding.elastic[i], sliding.on_riser[i], at, forms[i], left[i], right[i])
        for c in range(nz):
            for j in range(3):
                left[i, j, c] = -near.area[i] * at.by_z[j, c]
    add_products(by_z, pairs.pair, left, right)
    return in_dofs(by_z, pairs.element, P)


@njit
def _write_factors(
    resistance: Resistance,
    pushed: tuple[float, float, float],
    elastic: Array,
    on_riser: Array,
    at: Slide,
    forms: Array,
    left: Array,
    right: Array,
) -> None:
    """Write the derivative of a point's traction by z (nz,) to right (4, nz), and below it that of its place on the
    axis; beside which the force, whose point moves along the axis, has the last row of left. pushed: pressure, its
    slope and adhesion.
    """
    k, along, turns = resistance.stiffness, read_along(at.along.T), read_along(at.along_by_s.T)
    limit, rise = limits(pushed[0], pushed[1], (resistance.mu[0], resistance.mu[1]), (pushed[2], 0.0))
    t, by_elastic, by_penetration = return_map(components(along, vector(elastic)), limit, rise)
    by_way, by_gap = resistance_by_movement(along, k, by_elastic), vector_of(along, by_penetration)
    a, b = components(turns, vector(elastic))
    c, d = components(along, vector(at.moved_by_s))
    turned = a - k * c, b - k * d  # t*, with the place on the axis
    (e, f), (g, h) = by_elastic
    follows = e * turned[0] + f * turned[1], g * turned[0] + h * turned[1]
    by_place, force = add(vector_of(along, follows), vector_of(turns, t)), vector(on_riser)
    for z in range(forms.shape[1]):
        x, y, up = at.by_z[0, z], at.by_z[1, z], at.by_z[2, z]
        for j in range(3):
            elastic_part = by_way[j][0] * x + by_way[j][1] * y + by_way[j][2] * up
            right[j, z] = by_place[j] * forms[3, z] - by_gap[j] * forms[0, z] - elastic_part
        right[3, z] = forms[3, z]
        left[3, z] = -force[0] * at.by_s_z[0, z] - force[1] * at.by_s_z[1, z] - force[2] * at.by_s_z[2, z]


class SoilFrictionData(NamedTuple):
    """A `SoilFriction` on condensed soil: the kernel data of the contact, what resists, history of the points, and
    q (ne, 4, 3) of the axis where the step starts; points: as evaluated last, with room for more.
    """

    contact: SurfaceContactData
    resistance: Resistance
    history: PointHistory
    q: Array
    points: SlidingPoints


@add_contact.of(SoilFrictionData)
def _friction(
    part: SoilFrictionData, top: TopMotion, at: Configuration, out: LineForces, border: Border
) -> None:
    contact, sliding = part.contact, part.points
    near, n = contact.pressed.near, contact.touched.counts[POINTS]
    write_history(part.history, near.number, n, sliding.before)
    pressed, start = (near, n, contact.pressed.force), (part.q, top.accepted)
    find_tractions(part.resistance, *pressed, start, contact.axis, contact.surface, sliding)
    forces = contact.axis, contact.surface, contact.basis, near, n, sliding.on_riser
    spread(*forces, out.end_q, top.rows, border.residual, contact.touched.newly_loaded)


@add_contact_tangent.of(SoilFrictionData)
def _friction_tangent(
    part: SoilFrictionData, top: TopMotion, at: Configuration, K: Array, border: Border
) -> None:
    contact, n = part.contact, part.contact.touched.counts[POINTS]
    workspace, pipe = contact.pressed, (contact.axis, contact.surface)
    near, pressed = first_of(workspace.near, n), (workspace.force[:n], workspace.slope[:n])
    pairs, forms = paired(near, K.shape[0]), gap_forms(*pipe, near, contact.basis)[0]
    place = (part.q, top.accepted), *pipe, contact.basis
    by_dofs = friction_tangents(part.resistance, near, *pressed, *place, forms, pairs, part.points, at.P)
    add_pairs(by_dofs, pairs, contact.surface.facets, top.rows, K, border)
