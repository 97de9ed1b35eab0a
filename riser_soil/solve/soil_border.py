"""Condensed soil beside lines in the compiled loop: its reached dofs are in the border, and contact couples both.

Which pairs of an element and a facet may touch is found for boxes around the elements, and holds as long as these stay
within; which dofs are reached, see `soil.condensed`. Where either doesn't do, the loop says so, and begins anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from riser_soil.contact.closest_point import Axis
from riser_soil.contact.near_points import FEW, PairsByFacet, points_workspace
from riser_soil.contact.pressed_points import BEYOND, HELD
from riser_soil.contact.surface_contact import SurfaceContact
from riser_soil.contact.surface_loop import (
    FULL,
    LEFT,
    POINTS,
    TopMotion,
    TouchWorkspace,
    Watched,
    add_touch,
    add_touch_tangent,
    move_top,
    write_touch_work,
)
from riser_soil.core.arrays import Array, IntArray, as_list
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.compiled import njit
from riser_soil.core.part import Energy, Part, State, Weights, Work
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.riser.part_kernels import Border
from riser_soil.soil.condensed import CondensedSoil, Reached
from riser_soil.solve.dense_border import DenseBorder, MakeBorder
from riser_soil.solve.newton_progress import OUTGROWN
from riser_soil.solve.packed_line import LoopBorder, PackedLine
from riser_soil.solve.riser_loop import NewtonProgress

if TYPE_CHECKING:
    from riser_soil.contact.soil_friction import LoopFriction

SHARE = 0.25  # of the range around the pipe by which soil may move before the pairs are looked for anew
NONE: IntArray = np.empty(0, dtype=np.int64)


class SoilData(NamedTuple):
    """Of condensed soil: stiffness (nb, nb) [N/m] of its reached dofs, and the forces (nb,) that hold them as they were
    accepted [N].
    """

    stiffness: Array
    holding: Array


@njit
def begin_border(soil: SoilData, border: Border) -> None:
    """Write what the soil's own forces leave out of balance."""
    found = np.dot(soil.stiffness, border.u[: soil.holding.size])
    for i in range(found.size):
        border.residual[i] = soil.holding[i] + found[i]


@njit
def add_norm_of_soil(soil: SoilData, border: Border, sums: Array) -> None:
    """Add the soil's residual to the norms, see `riser_loop.add_norms`."""
    for i in range(soil.holding.size):
        sums[0] += border.residual[i] * border.residual[i]


@njit
def find_outgrown(workspace: TouchWorkspace, progress: NewtonProgress) -> None:
    """Whether something touches what is not watched or not reached."""
    if workspace.found[LEFT] or workspace.found[FULL] or workspace.met.any():
        progress.ending[0] = OUTGROWN


@njit
def clear_border(soil: SoilData, border: Border) -> None:
    """Write the soil's own tangent."""
    count = soil.holding.size
    border.corner[:count, :count] = soil.stiffness
    ndof = border.right.shape[0] // border.coupled.size
    for n in range(border.coupled.size):
        if border.coupled[n]:
            border.right[n * ndof : (n + 1) * ndof] = 0.0
            border.below[n * ndof : (n + 1) * ndof] = 0.0
            border.coupled[n] = False


def border_on_soil(system: System, beside: Sequence[Part]) -> MakeBorder | None:
    """That of lines on condensed soil, one of which touches it; None where there are no kernels."""
    contact = next((part for part in beside if isinstance(part, SurfaceContact)), None)
    soil = next((part for part in beside if isinstance(part, CondensedSoil)), None)
    others = [part for part in beside if part is not contact and part is not soil]
    if contact is None or soil is None:
        return None
    friction = None
    if others:
        from riser_soil.contact.soil_friction import SoilFriction

        part = others[0]
        friction = part.in_loop() if len(others) == 1 and isinstance(part, SoilFriction) else None
        if friction is None:
            return None
    return partial(SoilBorder, system, contact, soil, friction)


class SoilBorder(LoopBorder):
    """The soil's reached dofs with their contact and its friction, if any; their kernels, bound to where they read and
    write.
    """

    knows_round_off = smooth = gradual = False

    def __init__(
        self,
        system: System,
        contact: SurfaceContact,
        soil: CondensedSoil,
        friction: LoopFriction | None,
        dense: DenseBorder,
        lines: Sequence[PackedLine],
    ) -> None:
        packed = next(packed for packed in lines if packed.line is contact.line)
        self._line, self._contact, self._soil, self._top = contact.line, contact, soil, soil.top
        self._system, self._packed, self._friction = system, packed, friction
        self.parts = (contact, soil) if friction is None else (contact, friction.part, soil)
        points, ne = len(soil.top.points), self._line.length.size
        self._touch, self._found = contact.touch_data(), _workspace(FEW, points, len(contact.law.columns))
        if friction is not None:
            friction.make_room(len(self._found.force))
        pairs, boxes = PairsByFacet(NONE, NONE, NONE), (np.zeros((ne, 3)), np.zeros((ne, 3)))
        self._watched = Packed(Watched(pairs, *boxes, 0.0))
        self._workspace, self._data = Packed(self._found), Packed(self._touch)
        self._motion = Packed(self._motion_of(np.zeros((0, 0)), NONE))
        self._dense, self._border, self._held = dense, dense.of[packed], Packed(_held(0))
        self._taken: Array = np.zeros(1)
        self._seen: Array = np.empty((0, 3))
        self._reached: Reached | None = None  # as it was taken last
        self._prescribed: Reached = soil.top.reached  # as the system has it
        self._stored = dict[float, float]()  # contact's energy [J] by the time of states

    def _motion_of(self, by: Array, nodes: IntArray) -> TopMotion:
        rows = np.full(self._top.size, HELD, dtype=np.int64)
        rows[self._top.beside] = BEYOND
        rows[self._top.reached.dofs] = np.arange(len(self._top.reached.dofs))
        return TopMotion(nodes, by, self._touch.surface.deformed.copy(), rows.reshape(-1, 3))

    def forces(self) -> list[Bound]:
        """Kernels that add the border's residual, and contact's."""
        packed = self._packed
        moved = Bound(move_top, self._data, self._motion, self._border)
        begun = Bound(begin_border, self._held, self._border)
        given = self._data, self._watched, self._motion, packed.packed_at, packed.packed_forces
        touched = Bound(add_touch, *given, self._border, self._workspace)
        if self._friction is None:
            return [moved, begun, touched]
        out = packed.packed_forces, self._border, self._workspace
        return [moved, begun, touched, self._friction.forces(self._data, self._motion, *out)]

    def norms(self, sums: Packed) -> list[Bound]:
        return [Bound(add_norm_of_soil, self._held, self._border, sums)]

    def outgrown(self, progress: Packed) -> list[Bound]:
        return [Bound(find_outgrown, self._workspace, progress)]

    def tangent(self) -> list[Bound]:
        """Kernels that write the border's tangent, and add contact's."""
        out = self._packed.packed_at, self._packed.K, self._border, self._workspace
        cleared = Bound(clear_border, self._held, self._border)
        touched = Bound(add_touch_tangent, self._data, self._motion, *out)
        if self._friction is None:
            return [cleared, touched]
        return [cleared, touched, self._friction.tangent(self._data, self._motion, *out)]

    def account(self, energy: Packed) -> list[Bound]:
        """Kernels that find what contact took in the step."""
        then, taken = Packed(self._packed.placed.at), Packed(self._taken)
        return [Bound(write_touch_work, self._data, self._motion, then, self._workspace, taken)]

    def begin(self, before: State, step_to: float, guess: Array) -> None:
        if self._soil.outgrown:
            self._soil.rebuild(before)
        committed = self._top.committed
        accepted = np.asarray(self._top.points + committed)
        self._touch.surface.deformed[...] = accepted
        self._data.renew(self._contact.begun(self._touch))
        if self._friction is not None:
            self._friction.begin(before)
        if self._reached is not self._top.reached or self._has_moved(accepted):
            self._look([])
        self._motion.value.accepted[...] = accepted
        held, at = self._held.value, self._top.reached.dofs
        np.dot(held.stiffness, committed.ravel()[at], out=held.holding)
        self._moved[:] = self._top.own(guess)[at]
        self._prescribe_anew()

    def _prescribe_anew(self) -> None:
        """What is not reached does not move by itself."""
        if self._prescribed is not self._top.reached:
            self._system.renew_prescribed()
            self._prescribed = self._top.reached

    def leave_to_newton(self, before: State) -> bool:
        """Newton's method needs a matrix for what is reached and may touch now."""
        self._contact.rebuild(State.at_rest(before.t, self._system.numbering.size))
        return True

    @property
    def _slack(self) -> float:
        """How far soil may move before pairs are looked for anew [m]."""
        return SHARE * self._contact.around

    def _has_moved(self, accepted: Array) -> bool:
        return bool(np.abs(accepted - self._seen).max() > self._slack)

    def widen(self) -> None:
        """Reach and watch what the last trial touched."""
        found = self._found
        if found.met.any():
            self._soil.meet(np.flatnonzero(found.met))
            self._soil.rebuild(State.at_rest(0.0, self._top.offset + self._top.size))
        if found.found[FULL]:
            self._found = _workspace(2 * len(found.force), len(found.met), found.after.shape[1])
            self._workspace.renew(self._found)
            if self._friction is not None:
                self._friction.make_room(len(self._found.force))
        self._look([self._touch.axis._replace(q=self._touch.axis.q.copy())])

    def _look(self, tried: Sequence[Axis]) -> None:
        """Find the pairs that may touch near the accepted place, and those that were tried."""
        if self._reached is not self._top.reached:
            self._take(self._top.reached)
        line, settled = self._line, self._touch.surface.deformed
        accepted = self._contact.axis(line.trial(State.at_rest(0.0, self._top.offset + self._top.size)))
        low, high, pairs = self._contact.watch([accepted, *tried], settled)
        slack = self._slack
        self._watched.renew(Watched(pairs, low + slack, high - slack, float(settled[:, 2].max()) + slack))
        nodes = np.unique(self._touch.surface.facets[pairs.facets])
        self._motion.renew(self._motion_of(self._by_border(nodes), nodes))
        self._seen = settled.copy()

    def _by_border(self, nodes: IntArray) -> Array:
        """How nodes (k,) of the top follow the reached dofs (3 k, nb)."""
        reached, dofs = self._top.reached, (3 * nodes[:, None] + np.arange(3)).ravel()
        by = reached.compliance[dofs] @ reached.stiffness
        row = np.full(self._top.size, -1)
        row[reached.dofs] = np.arange(len(reached.dofs))
        own = np.flatnonzero(row[dofs] >= 0)
        by[own] = 0.0
        by[own, row[dofs[own]]] = 1.0
        return np.ascontiguousarray(by)

    def _take(self, reached: Reached) -> None:
        """Take other dofs."""
        held = _held(len(reached.dofs))
        held.stiffness[...] = reached.stiffness
        self._held.renew(held)
        self._dense.make_room(soil=len(reached.dofs))
        self._reached = reached

    @property
    def _moved(self) -> Array:
        """Increments (na,) of the reached dofs in the last trial."""
        return np.asarray(self._border.value.u[: len(self._held.value.holding)])

    def put_increments(self, weights: Weights, u: Array, v: Array, a: Array) -> None:
        dofs, moved = self._top.offset + self._top.reached.dofs, self._moved
        u[dofs] = moved
        v[dofs] += weights.shift_v * moved
        a[dofs] += weights.shift_a * moved
        rest = self._system.prescribed_dofs
        rest = rest[rest >= self._system.end_of_lines]
        v[rest] = a[rest] = 0.0

    @property
    def holds(self) -> bool:
        """Whether the soil has moved so little in the last trial that the pairs still are all that may touch."""
        return bool(np.abs(self._moved).max(initial=0.0) <= self._slack)

    def add_account(self, before: State, state: State, work: dict[str, Work]) -> Energy:
        work[self._soil.name] += self._soil.work(before, state)
        work[self._contact.name] += self._work_of_contact(before, state)
        stored = float(self._found.energy[0])
        if self._friction is not None:
            by_friction, turned = self._friction.account(self._found.near.area[: self._found.found[POINTS]])
            work[self._friction.part.name] += turned
            stored += by_friction
        return Energy(potential=stored) + self._soil.energy(state)

    def _work_of_contact(self, before: State, after: State) -> Work:
        """See `SurfaceContact.work`: without a history all is the time scheme's."""
        if self._contact.law.columns:
            return self._contact.work(before, after)
        first, last = self._stored.get(before.t), float(self._found.energy[0])
        if first is None:
            first = self._contact.energy(before).potential
        self._stored = {before.t: first, after.t: last}
        lost = float(self._taken[0]) - last + first
        return Work(dissipated=lost, by_scheme=lost)

    def forget_account(self) -> None:
        self._stored.clear()

    def state(self) -> Saved:
        """What contact has stored at the times known: found anew it would be the same but to round-off."""
        return {"times": np.array([*self._stored]), "stored": np.array([*self._stored.values()])}

    def restore(self, saved: Saved) -> None:
        self._stored = dict(zip(as_list(saved["times"]), as_list(saved["stored"]), strict=True))


def _held(count: int) -> SoilData:
    """For so many dofs."""
    return SoilData(np.zeros((count, count)), np.zeros(count))


def _workspace(count: int, nodes: int, columns: int) -> TouchWorkspace:
    """Workspace for so many points that touch, with histories of so many columns, on a top of so many nodes."""
    histories = np.zeros((count, columns)), np.zeros((count, columns))
    found, met = np.zeros(3, dtype=np.int64), np.zeros(nodes, dtype=np.bool_)
    forces = np.zeros(count), np.zeros(count), np.zeros((count, 3))
    return TouchWorkspace(points_workspace(count), *histories, *forces, found, met, np.zeros(1))
