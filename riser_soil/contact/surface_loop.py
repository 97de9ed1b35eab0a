"""Contact of the pipe's cylinder with the surface of condensed soil in the line solver, see `solve.soil_border`.

The formulas are those of `pressed_points`. The soil's reached dofs are the loop's border: what it adds there are the
facets' shares.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, NamedTuple

import numpy as np

from riser_soil.contact.closest_point import Axis
from riser_soil.contact.cylinder_gap import gap_forms
from riser_soil.contact.integration_points import KeptRows
from riser_soil.contact.near_points import PairsByFacet, Surface, boxes, fill_near, first_of
from riser_soil.contact.pressed_points import (
    Pairs,
    PressWorkspace,
    find_pressed,
    pair_tangents,
    paired,
    spread,
    work_of,
    write_axis,
)
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.compiled import njit
from riser_soil.core.part import Part, State, Work
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.part_kernels import FULL, LEFT, POINTS, Border, LineForces, TopMotion


class TouchData(NamedTuple):
    """The pipe and the surface. axis: workspace for q; surface: with workspace for its present points. basis (3, d),
    origin (3,): of the line. law: its kernel data, and what is kept of its points; within a gap of `reach` [m] it may
    act.
    """

    axis: Axis
    surface: Surface
    basis: Array
    origin: Array
    law: Any
    kept: KeptRows
    reach: float


class Watched(NamedTuple):
    """What may touch as long as elements stay within their boxes, low and high (ne, 3), or above a level [m]."""

    pairs: PairsByFacet
    low: Array
    high: Array
    level: float


class TouchWorkspace(NamedTuple):
    """What was found last. pressed: the points, with room for more; found, met, energy: see `LoopContact`."""

    pressed: PressWorkspace
    found: IntArray
    met: BoolArray
    energy: Array


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
    axis, surface, pressed = touch.axis, touch.surface, workspace.pressed
    write_axis(touch.origin, touch.basis, at.q, axis.q)
    n, room = fill_near(axis, surface, watched.pairs, touch.reach, pressed.near), len(pressed.force)
    workspace.met[:] = False
    workspace.found[FULL], workspace.found[LEFT] = n > room, _leaves(axis, watched, touch.reach)
    n, workspace.energy[0] = find_pressed(touch.law, touch.kept, axis, surface, min(n, room), pressed)
    workspace.found[POINTS] = n
    given = axis, surface, touch.basis, pressed.near, n, pressed.on_riser
    spread(*given, out.end_q, top.rows, border.residual, workspace.met)


@njit
def _leaves(axis: Axis, watched: Watched, reach: float) -> bool:
    """Whether an element may touch what is not watched, which it can within a reach [m]."""
    low, high = boxes(axis, reach, reach)
    for e in range(low.shape[0]):
        if low[e, 2] > watched.level:
            continue
        for i in range(3):
            if low[e, i] < watched.low[e, i] or high[e, i] > watched.high[e, i]:
                return True
    return False


@njit
def add_touch_tangent(
    touch: TouchData, top: TopMotion, at: Configuration, K: Array, border: Border, workspace: TouchWorkspace
) -> None:
    """Add the derivative of the contact's residual, found last, to K (ne, n, n) and to the border's."""
    n, facets, pressed = workspace.found[POINTS], touch.surface.facets, workspace.pressed
    near, force, slope = first_of(pressed.near, n), pressed.force[:n], pressed.slope[:n]
    pairs = paired(near, K.shape[0])
    forms, C = gap_forms(touch.axis, touch.surface, near, touch.basis)
    by_dofs = pair_tangents(forms, C, force, slope, pairs, at.P)
    add_pairs(by_dofs, pairs, top.rows, facets, K, border)


@njit
def add_pairs(by_dofs: Array, pairs: Pairs, rows: IntArray, facets: IntArray, K: Array, border: Border) -> None:
    """Add the blocks (m, nr, nr) of pairs to K (ne, n, n) and to the border's; rows: see `TopMotion`."""
    for k in range(pairs.element.size):
        _spread(by_dofs[k], pairs.element[k], rows, facets[pairs.facet[k]], K, border)


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
            border.below[e * (n // 2) + i, row] += block[n + a, i]
        for b in range(3 * nodes.size):
            column = rows[nodes[b // 3], b % 3]
            if column >= 0:
                border.corner[row, column] += block[n + a, n + b]


@njit
def write_touch_work(
    touch: TouchData, top: TopMotion, first: Configuration, workspace: TouchWorkspace, work: Array
) -> None:
    """Write to work (1,) what the force at a step's end, found last, takes along the step [J], see `SurfaceContact`."""
    before = np.empty(touch.axis.q.shape)
    write_axis(touch.origin, touch.basis, first.q, before)
    pressed = workspace.pressed
    given = touch.axis, touch.surface, pressed.near, workspace.found[POINTS], pressed.on_riser
    work[0] = work_of(*given, before, top.accepted)


class LoopFriction(ABC):
    """Friction with condensed soil in the line solver: kernels, bound to what they read and write. part: its own."""

    part: Part

    @abstractmethod
    def begin(self, before: State) -> None:
        """Begin a step from an accepted state."""

    @abstractmethod
    def make_room(self, count: int) -> None:
        """For so many points that touch."""

    @abstractmethod
    def forces(self, touch: Packed, top: Packed, *out: Packed) -> Bound:
        """The kernel that adds to the residuals, contact's being found."""

    @abstractmethod
    def tangent(self, touch: Packed, top: Packed, *out: Packed) -> Bound:
        """The kernel that adds to the tangents."""

    @abstractmethod
    def account(self, area: Array) -> tuple[float, Work]:
        """What it stores [J] at the points that touch, of areas (n,), and its work in the step."""
