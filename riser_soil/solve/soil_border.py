"""Condensed soil beside lines in the line solver: its reached dofs are in the border, and contact couples both.

Pairs of an element and a facet that may touch are those of boxes around the elements, as long as these stay within;
which dofs are reached is chosen in `soil.condensed`. Where either choice proves too narrow, the step begins anew with
wider ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from riser_soil.contact.condensed_contact import CondensedContact
from riser_soil.contact.on_condensed_soil import FULL, SUPPORTED, UNREACHED, UNWATCHED, TopMotion, Touched
from riser_soil.contact.soil_contact import SoilContact
from riser_soil.contact.soil_friction import SoilFriction
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.compiled import njit
from riser_soil.core.part import Energy, Part, State, Weights, Work
from riser_soil.core.system import System
from riser_soil.riser.part_kernels import Border
from riser_soil.soil.condensed import CondensedSoil, Reached
from riser_soil.solve.dense_border import DenseBorder
from riser_soil.solve.line_system import Coupling, MakeCoupling
from riser_soil.solve.packed_line import PackedLine
from riser_soil.solve.residual_norm import above_round_off
from riser_soil.solve.step_kernels import TOO_NARROW


class SoilData(NamedTuple):
    """Condensed soil: stiffness (nb, nb) [N/m] of its reached dofs; how far these were moved as accepted (nb,) [m],
    and the forces (nb,) [N] that hold them there. terms (nb,): see `step_kernels.write_terms`.
    """

    stiffness: Array
    accepted: Array
    holding: Array
    terms: Array


@njit
def move_top(deformed: Array, top: TopMotion, border: Border) -> None:
    """Write where the watched nodes are."""
    moved = np.dot(top.by, border.u[: top.by.shape[1]])
    for k in range(top.nodes.size):
        for i in range(3):
            deformed[top.nodes[k], i] = top.accepted[top.nodes[k], i] + moved[3 * k + i]


@njit
def begin_border(soil: SoilData, border: Border) -> None:
    """Write the residual of the soil's own forces."""
    forces = np.dot(soil.stiffness, border.u[: soil.holding.size])
    for i in range(forces.size):
        border.residual[i] = soil.holding[i] + forces[i]


@njit
def add_norm_of_soil(soil: SoilData, border: Border, sums: Array) -> None:
    """Add the squares of the soil's residual to the first of the norms' sums."""
    for i in range(soil.holding.size):
        sums[0] += border.residual[i] * border.residual[i]


@njit
def find_outgrown(touched: Touched, failure: IntArray) -> None:
    """Whether something touches what is not watched or not reached."""
    if touched.counts[UNWATCHED] or touched.counts[FULL] or touched.newly_loaded.any():
        failure[0] = TOO_NARROW


@njit
def clear_border(soil: SoilData, border: Border) -> None:
    """Write the soil's own tangent."""
    count = soil.holding.size
    for i in range(count):
        for j in range(count):
            border.corner[i, j] = soil.stiffness[i, j]
    ndof = border.right.shape[0] // border.coupled.size
    for n in range(border.coupled.size):
        if border.coupled[n]:
            for i in range(n * ndof, (n + 1) * ndof):
                for j in range(border.corner.shape[0]):
                    border.right[i, j] = border.below[i, j] = 0.0
            border.coupled[n] = False


@njit
def add_terms(soil: SoilData, border: Border, sizes: Array, terms: Array) -> None:
    """Add what the soil's coordinates contribute to the terms (nn, ndof) of the line's residual, and write those of the
    soil's. sizes (nn, ndof): of the line's coordinates.
    """
    n, ndof = sizes.shape
    moved = np.abs(soil.accepted + border.u[: soil.accepted.size])
    for j in range(moved.size):
        soil.terms[j] = np.dot(np.abs(border.corner[j, : moved.size]), moved)
    for k in range(n):
        if border.coupled[k]:
            for i in range(ndof):
                for j in range(moved.size):
                    terms[k, i] += abs(border.right[k * ndof + i, j]) * moved[j]
                    soil.terms[j] += abs(border.below[k * ndof + i, j]) * sizes[k, i]


@njit
def find_above(soil: SoilData, border: Border, above: BoolArray) -> None:
    """Set above (1,) where some entry of the soil's residual is above its round-off."""
    above[0] |= above_round_off(border.residual[: soil.holding.size], soil.terms)


def border_on_soil(system: System, beside: Sequence[Part]) -> MakeCoupling | None:
    """A maker of the border of lines on condensed soil, one of which touches it; None where a part has no kernels."""
    contact = next((part for part in beside if isinstance(part, SoilContact)), None)
    soil = next((part for part in beside if isinstance(part, CondensedSoil)), None)
    friction = next((part for part in beside if isinstance(part, SoilFriction)), None)
    if contact is None or soil is None or any(part not in (contact, soil, friction) for part in beside):
        return None
    return partial(SoilBorder, system, CondensedContact(contact, friction), soil)


class SoilBorder(Coupling):
    """The soil's reached dofs with what touches it; their kernels, bound to where they read and write."""

    smooth = gradual = False

    def __init__(
        self,
        system: System,
        touching: CondensedContact,
        soil: CondensedSoil,
        dense: DenseBorder,
        lines: Sequence[PackedLine],
    ) -> None:
        packed = next(packed for packed in lines if packed.line is touching.contact.line)
        self._system, self._packed, self._touching, self._soil = system, packed, touching, soil
        self._top, self.parts = soil.top, (*touching.parts, soil)
        self._motion = Packed(self._motion_of(np.empty(0, dtype=np.int64)))
        self._dense, self._border, self._data = dense, dense.of[packed], Packed(_soil_data(0))
        self._watched_at: Array = np.empty((0, 3))  # places of the top when the pairs were chosen
        self._reached: Reached | None = None  # for which the border has room
        self._prescribed: Reached = soil.top.reached  # when the system last prescribed the other dofs

    def _motion_of(self, nodes: IntArray) -> TopMotion:
        """How nodes (k,) of the top follow the reached dofs, from their present places."""
        top, reached = self._top, self._top.reached
        rows = np.full(top.size, SUPPORTED, dtype=np.int64)
        rows[top.unreached] = UNREACHED
        rows[reached.dofs] = np.arange(len(reached.dofs))
        dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
        by = np.ascontiguousarray(reached.compliance[dofs] @ reached.stiffness)
        own = np.flatnonzero(rows[dofs] >= 0)
        by[own] = 0.0
        by[own, rows[dofs[own]]] = 1.0
        return TopMotion(nodes, by, self._touching.deformed.copy(), rows.reshape(-1, 3))

    def forces(self) -> list[Bound]:
        """Kernels that add the border's residual, and contact's."""
        packed, border = self._packed, self._border
        return [
            Bound(move_top, Packed(self._touching.deformed), self._motion, border),
            Bound(begin_border, self._data, border),
            *self._touching.forces(self._motion, packed.packed_at, packed.packed_forces, border),
        ]

    def norms(self, sums: Packed) -> list[Bound]:
        return [Bound(add_norm_of_soil, self._data, self._border, sums)]

    def outgrown(self, failure: Packed) -> list[Bound]:
        return [Bound(find_outgrown, Packed(self._touching.touched), failure)]

    def tangent(self) -> list[Bound]:
        """Kernels that write the border's tangent, and add contact's."""
        cleared, packed = Bound(clear_border, self._data, self._border), self._packed
        return [cleared, *self._touching.tangent(self._motion, packed.packed_at, packed.K, self._border)]

    def terms(self) -> list[Bound]:
        packed = self._packed
        coordinates = Packed(packed.dofs.sizes), Packed(packed.dofs.terms)
        return [*packed.terms_of(self.tangent()), Bound(add_terms, self._data, self._border, *coordinates)]

    def above(self, above: Packed) -> list[Bound]:
        return [Bound(find_above, self._data, self._border, above)]

    def begin(self, before: State, step_to: float, guess: Array) -> None:
        if self._soil.outgrown:
            self._soil.rebuild(before)
        committed = self._top.committed
        accepted = np.asarray(self._top.points + committed)
        self._touching.deformed[...] = accepted
        self._touching.begin()
        if self._reached is not self._top.reached or self._has_moved(accepted):
            self._watch(tried=False)
        self._motion.value.accepted[...] = accepted
        data, at = self._data.value, self._top.reached.dofs
        data.accepted[...] = committed.ravel()[at]
        np.dot(data.stiffness, data.accepted, out=data.holding)
        self._moved[:] = self._top.own(guess)[at]
        self._prescribe_anew()

    def _prescribe_anew(self) -> None:
        """Prescribe the dofs that are not reached now, as these follow the others."""
        if self._prescribed is not self._top.reached:
            self._system.renew_prescribed()
            self._prescribed = self._top.reached

    def leave_to_parts(self) -> bool:
        """Give the matrix of Newton's method over the parts the dofs that are reached and the pairs that may touch."""
        self._touching.contact.rebuild(self._touching.contact.accepted)
        return True

    def _has_moved(self, accepted: Array) -> bool:
        return bool(np.abs(accepted - self._watched_at).max() > self._touching.slack)

    def widen(self) -> None:
        """Reach and watch what the last trial touched."""
        if (newly_loaded := np.flatnonzero(self._touching.touched.newly_loaded)).size:
            self._soil.note_newly_loaded(newly_loaded)
            self._soil.rebuild(self._touching.contact.accepted)
        self._watch(tried=True)

    def _watch(self, tried: bool) -> None:
        """Watch what may touch near the accepted place and, if `tried`, near the last trial's."""
        if self._reached is not self._top.reached:
            self._reach(self._top.reached)
        nodes = self._touching.look(tried)
        self._motion.renew(self._motion_of(nodes))
        self._watched_at = self._touching.deformed.copy()

    def _reach(self, reached: Reached) -> None:
        """Make room for other reached dofs."""
        data = _soil_data(len(reached.dofs))
        data.stiffness[...] = reached.stiffness
        self._data.renew(data)
        self._dense.make_room(len(reached.dofs))
        self._reached = reached

    @property
    def _moved(self) -> Array:
        """Increments (na,) of the reached dofs in the last trial."""
        return np.asarray(self._border.value.u[: len(self._data.value.holding)])

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
        return bool(np.abs(self._moved).max(initial=0.0) <= self._touching.slack)

    def add_account(self, before: State, state: State, work: dict[str, Work]) -> Energy:
        self._touching.end(state)
        energy = Energy()
        for part in self.parts:
            work[part.name] += part.work(before, state)
            energy += part.energy(state)
        return energy


def _soil_data(count: int) -> SoilData:
    """Workspace for so many reached dofs."""
    return SoilData(np.zeros((count, count)), *np.zeros((3, count)))
