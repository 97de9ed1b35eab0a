"""Kernels of the contact of the pipe's cylinder with condensed soil, see `on_condensed_soil` and `pressed_points`."""

from __future__ import annotations

from typing import Any, NamedTuple

from riser_soil.contact.closest_point import Axis
from riser_soil.contact.cylinder_gap import gap_forms
from riser_soil.contact.integration_points import PointHistory
from riser_soil.contact.near_points import PairsByFacet, Surface, boxes, fill_near, first_of
from riser_soil.contact.on_condensed_soil import (
    FULL,
    POINTS,
    UNWATCHED,
    TopMotion,
    Touched,
    add_block,
    add_contact,
    add_contact_tangent,
)
from riser_soil.contact.pressed_points import (
    Pairs,
    PressWorkspace,
    find_pressed,
    pair_tangents,
    paired,
    spread,
    write_axis,
)
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.part_kernels import Border, LineForces


class Watched(NamedTuple):
    """What may touch as long as elements stay within their boxes, low and high (ne, 3), or above a level [m]."""

    pairs: PairsByFacet
    low: Array
    high: Array
    level: float


class SurfaceContactData(NamedTuple):
    """A `SurfaceContact` on condensed soil: axis and surface, with workspace for q and for the present points; basis
    (3, d), origin (3,): of the line. law: its kernel data; history: of its points; within a gap of `reach` (1,) [m] it
    may act. watched: what may touch. pressed, touched: as evaluated last, with room for more points.
    """

    axis: Axis
    surface: Surface
    basis: Array
    origin: Array
    law: Any
    history: PointHistory
    reach: Array
    watched: Watched
    pressed: PressWorkspace
    touched: Touched


@add_contact.of(SurfaceContactData)
def _surface_contact(
    part: SurfaceContactData, top: TopMotion, at: Configuration, out: LineForces, border: Border
) -> None:
    axis, surface, pressed, counts, reach = part.axis, part.surface, part.pressed, part.touched.counts, part.reach[0]
    write_axis(part.origin, part.basis, at.q, axis.q)
    n, room = fill_near(axis, surface, part.watched.pairs, reach, pressed.near), len(pressed.force)
    part.touched.newly_loaded[:] = False
    counts[FULL], counts[UNWATCHED] = n > room, leaves(axis, part.watched, reach)
    n, part.touched.energy[0] = find_pressed(part.law, part.history, axis, surface, min(n, room), pressed)
    counts[POINTS] = n
    forces = axis, surface, part.basis, pressed.near, n, pressed.on_riser
    spread(*forces, out.end_q, top.rows, border.residual, part.touched.newly_loaded)


@njit
def leaves(axis: Axis, watched: Watched, reach: float) -> bool:
    """Whether an element may touch what is not watched, which it can within a reach [m]."""
    low, high = boxes(axis, reach, reach)
    for e in range(low.shape[0]):
        if low[e, 2] > watched.level:
            continue
        for i in range(3):
            if low[e, i] < watched.low[e, i] or high[e, i] > watched.high[e, i]:
                return True
    return False


@add_contact_tangent.of(SurfaceContactData)
def _surface_contact_tangent(
    part: SurfaceContactData, top: TopMotion, at: Configuration, K: Array, border: Border
) -> None:
    n, pressed = part.touched.counts[POINTS], part.pressed
    near, force, slope = first_of(pressed.near, n), pressed.force[:n], pressed.slope[:n]
    pairs = paired(near, K.shape[0])
    forms, C = gap_forms(part.axis, part.surface, near, part.basis)
    by_dofs = pair_tangents(forms, C, force, slope, pairs, at.P)
    add_pairs(by_dofs, pairs, part.surface.facets, top.rows, K, border)


@njit
def add_pairs(by_dofs: Array, pairs: Pairs, facets: IntArray, rows: IntArray, K: Array, border: Border) -> None:
    """Add the blocks (m, nr, nr) of pairs to K (ne, n, n) and to the border; see `add_block`."""
    for k in range(pairs.element.size):
        add_block(by_dofs[k], pairs.element[k], 0, K.shape[1], facets[pairs.facet[k]], rows, K, border)
