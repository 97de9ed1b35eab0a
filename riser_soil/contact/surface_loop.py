"""Contact of the pipe's cylinder with the surface of condensed soil in the compiled loop, see `solve.soil_border`.

The formulas are those of `pressed_points`. The soil's reached dofs are the loop's border: what it adds there are the
facets' shares.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from riser_soil.contact.closest_point import Axis
from riser_soil.contact.cylinder_gap import gap_forms
from riser_soil.contact.integration_points import KeptRows, write_kept
from riser_soil.contact.near_points import (
    FEW,
    NearPoints,
    PairsByFacet,
    Surface,
    boxes,
    fill_near,
    first_of,
    points_workspace,
)
from riser_soil.contact.pressed_points import (
    Pairs,
    keep_active,
    pair_tangents,
    paired,
    press,
    spread,
    work_of,
    write_axis,
    write_on_riser,
)
from riser_soil.contact.soil_contact import FULL, LEFT, POINTS, LoopContact, TopMotion
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.compiled import njit
from riser_soil.core.part import State, Work
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.part_kernels import Border, LineForces

if TYPE_CHECKING:
    from riser_soil.contact.soil_friction import LoopFriction
    from riser_soil.contact.surface_contact import SurfaceContact

NONE: IntArray = np.empty(0, dtype=np.int64)

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
    """What was found last. near: the points; their histories before and after the step (n, nh), force [N] and its
    derivative by the penetration [N/m] (n,), area included; on_riser (n, 3): force on the pipe [N]; found, met, energy:
    see `LoopContact`.
    """

    near: NearPoints
    before: Array
    after: Array
    force: Array
    slope: Array
    on_riser: Array
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
    axis, surface, near, force = touch.axis, touch.surface, workspace.near, workspace.force
    write_axis(touch.origin, touch.basis, at.q, axis.q)
    n = fill_near(axis, surface, watched.pairs, touch.reach, near)
    workspace.met[:] = False
    workspace.found[FULL], workspace.found[LEFT] = n > len(force), _leaves(axis, watched, touch.reach)
    n = min(n, len(force))
    write_kept(touch.kept, near.number, n, workspace.before)
    n = workspace.found[POINTS] = keep_active(touch.law, near, n, workspace.before)
    given = axis, surface, touch.basis, near, n, workspace.on_riser
    workspace.energy[0] = press(touch.law, near, n, workspace.before, workspace.after, force, workspace.slope)
    write_on_riser(axis, surface, near, n, force, workspace.on_riser)
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
    n, facets = workspace.found[POINTS], touch.surface.facets
    near, force, slope = first_of(workspace.near, n), workspace.force[:n], workspace.slope[:n]
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
    given = touch.axis, touch.surface, workspace.near, workspace.found[POINTS], workspace.on_riser
    work[0] = work_of(*given, before, top.accepted)


class SurfaceInLoop(LoopContact):
    """`SurfaceContact` in the compiled loop, with its friction, if any."""

    contact: SurfaceContact

    def __init__(self, contact: SurfaceContact, friction: LoopFriction | None) -> None:
        super().__init__(contact, contact.around)
        self._line, self._friction = contact.line, friction
        self.parts = (contact,) if friction is None else (contact, friction.part)
        self._touch = contact.touch_data()
        self.deformed, ne = self._touch.surface.deformed, self._line.length.size
        self.met: BoolArray = np.zeros(len(self.deformed), dtype=np.bool_)
        self._data, self._workspace = Packed(self._touch), Packed(self._with_room(FEW))
        boxes = np.zeros((ne, 3)), np.zeros((ne, 3))
        self._watched = Packed(Watched(PairsByFacet(NONE, NONE, NONE), *boxes, 0.0))

    def _with_room(self, count: int) -> TouchWorkspace:
        """For so many points that touch."""
        if self._friction is not None:
            self._friction.make_room(count)
        columns = len(self.contact.law.columns)
        histories = np.zeros((count, columns)), np.zeros((count, columns))
        forces = np.zeros(count), np.zeros(count), np.zeros((count, 3))
        return TouchWorkspace(points_workspace(count), *histories, *forces, self.found, self.met, self.energy)

    def begin(self, before: State) -> None:
        self._data.renew(self.contact.begun(self._touch))
        if self._friction is not None:
            self._friction.begin(before)

    def look(self, before: State, tried: bool) -> IntArray:
        if self.found[FULL]:
            self._workspace.renew(self._with_room(2 * len(self._workspace.value.force)))
        axes = [self.contact.axis(self._line.trial(before))]
        if tried:
            axes.append(self._touch.axis._replace(q=self._touch.axis.q.copy()))
        low, high, pairs = self.contact.watch(axes, self.deformed)
        level = float(self.deformed[:, 2].max()) + self.slack
        self._watched.renew(Watched(pairs, low + self.slack, high - self.slack, level))
        return np.unique(self._touch.surface.facets[pairs.facets])

    def forces(self, top: Packed, at: Packed, forces: Packed, border: Packed) -> list[Bound]:
        out = forces, border, self._workspace
        touched = Bound(add_touch, self._data, self._watched, top, at, *out)
        return [touched] if self._friction is None else [touched, self._friction.forces(self._data, top, *out)]

    def tangent(self, top: Packed, at: Packed, K: Packed, border: Packed) -> list[Bound]:
        out = at, K, border, self._workspace
        touched = Bound(add_touch_tangent, self._data, top, *out)
        return [touched] if self._friction is None else [touched, self._friction.tangent(self._data, top, *out)]

    def account(self, top: Packed, first: Packed) -> list[Bound]:
        return [Bound(write_touch_work, self._data, top, first, self._workspace, Packed(self.taken))]

    def add_work(self, before: State, after: State, work: dict[str, Work]) -> float:
        stored = super().add_work(before, after, work)
        if self._friction is None:
            return stored
        by_friction, turned = self._friction.account(self._workspace.value.near.area[: self.found[POINTS]])
        work[self._friction.part.name] += turned
        return stored + by_friction
