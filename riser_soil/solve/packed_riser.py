"""A riser alone in numbers, packed for the compiled loop: parts bound to their kernels, and room for what is solved."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil.core import banded
from riser_soil.core.arrays import Array, BoolArray, listed
from riser_soil.core.bound import Bound, calls, in_turn
from riser_soil.core.packed import Packed
from riser_soil.core.part import State, Weights
from riser_soil.riser.configuration import (
    maps_for,
    place,
    put_magnitudes,
    put_maps,
    put_tangled,
    put_turning,
    room_for,
)
from riser_soil.riser.line import Line
from riser_soil.riser.part_kernels import (
    LineWeights,
    add_energy,
    add_forces,
    add_tangent,
    add_work,
    bound,
    clear,
    collect,
    forces_of,
    keep,
    turn,
    weigh,
)
from riser_soil.riser.placed_line import PlacedLine
from riser_soil.solve import riser_loop as loop
from riser_soil.solve.loop_border import LoopBorder
from riser_soil.solve.numbered_parts import NumberedParts, Numbers
from riser_soil.solve.riser_loop import Dofs, MatrixRoom, NewtonProgress, StepNumbers, StopLimits


class PackedRiser:
    """A line and its parts, whose arrays it shares; at, step, forces, dofs, room, progress: what the loop writes to.

    placed: the line where it is accepted; parts: that act on it; prescribed, levers (size,): of the line's dofs; most:
    iterations of a step; border: what stands beside them.
    """

    def __init__(
        self,
        line: Line,
        placed: PlacedLine,
        parts: NumberedParts,
        prescribed: BoolArray,
        levers: Array,
        most: int,
        border: LoopBorder | None = None,
    ) -> None:
        self._line, self._placed, shape = line, placed, (line.nodes, line.ndof)
        self.step, self.forces, self.room = StepNumbers(*_zeros(6, shape)), forces_of(line), matrix_room(line)
        self._begun = [values.ravel() for values in (self.step.u, self.step.v0, self.step.a0, self.step.past)]
        self.dofs = Dofs(prescribed.reshape(shape), levers.reshape(shape), *_zeros(3, shape))
        self.progress = NewtonProgress(np.zeros(most + 1), np.zeros(most + 1), np.zeros(2, dtype=np.int64))
        self._maps, self._weights = Packed(maps_for(line)), Packed(LineWeights(0.0, 0.0))
        self._weighed = Weights(0.0, 0.0, 0.0, 0.0)  # as in both
        self._limits = Packed(StopLimits(0.0, 0.0, 0.0, most, 0, False))
        self._border = LoopBorder() if border is None else border
        self._bind(parts.numbers, parts.in_groups("E"))
        self._bind_account(parts.numbers)

    def _bind(self, numbers: Sequence[Numbers], touching: Sequence[Numbers]) -> None:
        """Bind the kernels of the loop to where they read and write. touching: whose tangent may jump."""
        at, border = room_for(self._line), self._border
        self.at = at
        written = self.step, self.forces, self.dofs, self.room, self.progress
        now, step, forces, dofs, room, progress = map(Packed, (at, *written))
        maps, weights, limits, K = self._maps, self._weights, self._limits, Packed(self.room.K)
        evaluate = [
            Bound(loop.follow, step, maps, dofs),
            bound(place, at, self._placed.base, *map(Packed, (self.step.u, self.step.v, self.step.a))),
            Bound(clear, forces),
            *(bound(add_forces, each, now, forces) for each in numbers),
            *border.forces(now, forces),
            Bound(collect, now, forces),
            Bound(loop.combine, forces, step, weights, dofs),
            border.judge(forces, dofs, limits, progress),
        ]

        others = [each for each in numbers if all(each is not one for one in touching)]
        contact = len(touching) > 0 or not border.smooth
        bulk = Packed(np.empty_like(self.room.K)) if contact else K

        def bulk_tangent(maps: Packed) -> list[Bound]:
            return [
                bound(put_maps, at, maps),
                Bound(loop.clear_tangent, bulk),
                *(bound(add_tangent, each, now, maps, weights, bulk) for each in others),
                Bound(weigh, forces, weights, room),
                bound(put_turning, at, Packed(self.room.conjugate), Packed(self.room.turning)),
                Bound(turn, room, bulk),
            ]

        def contact_tangent(maps: Packed) -> list[Bound]:
            added = (bound(add_tangent, each, now, maps, weights, K) for each in touching)
            return [Bound(loop.begin_with, bulk, K), *added, *border.tangent(now, K)] if contact else []

        held = Packed(maps.value)  # without shifts
        put_sizes = bound(put_magnitudes, at, Packed(self.dofs.sizes))
        judged = Bound(loop.judge_round_off, room, dofs, progress)
        probe = [*bulk_tangent(held), *contact_tangent(held), put_sizes, judged]
        factors = [Bound(loop.fill, room, dofs), border.factorise(room, dofs, progress)]
        renew = [*bulk_tangent(maps), *contact_tangent(maps), *factors]
        touch = [*contact_tangent(maps), *factors] if contact else []
        each = evaluate, probe if border.knows_round_off else [], renew, touch, [border.improve(room, step, dofs)]
        tables = (Packed(calls(*kernels)) for kernels in each)
        self._tangled = np.zeros(2, dtype=np.int64)
        solve = Bound(loop.solve_step, *tables, limits, progress)
        self._solve = in_turn(solve, bound(put_tangled, at, self._placed.base, Packed(self._tangled)))
        self.evaluate, self.put_tangent = in_turn(*evaluate), in_turn(*renew[:-1], put_sizes)
        self.renew_contact = in_turn(*touch)
        self.keep = in_turn(*(bound(keep, each, now) for each in numbers if type(each) in keep.kernels))

    def _bind_account(self, numbers: Sequence[Numbers]) -> None:
        """Bind the kernels of energy and work."""
        turning = [each for each in numbers if type(each) in add_work.kernels]
        self._energy, self._work = np.zeros(3), np.zeros((len(turning), 4))
        then, now, energy = map(Packed, (self._placed.at, self.at, self._energy))
        rows = [Packed(row) for row in self._work]
        self._account = in_turn(
            Bound(loop.clear_account, energy, Packed(self._work)),
            *(bound(add_energy, each, now, energy) for each in numbers),
            *(bound(add_work, each, then, now, row) for each, row in zip(turning, rows, strict=True)),
            *self._border.account(then, now),
        )

    def begin(self, state: State, past: Array | None, weights: Weights, limits: StopLimits) -> None:
        """Begin a step.

        state: the first guess, and the rates of no increments but those that are prescribed; past: see `time_scheme`.
        """
        self._placed.bring()
        u, v, a, earlier = self._begun
        u[:], v[:], a[:], earlier[:] = state.u, state.v, state.a, 0.0 if past is None else past
        if weights != self._weighed:
            self._weigh(weights)
        if limits != self._limits.value:
            self._limits.renew(limits)

    def _weigh(self, weights: Weights) -> None:
        maps, self._weighed = self._maps, weights
        maps.renew(maps.value._replace(shift_v=weights.shift_v, shift_a=weights.shift_a))
        self._weights.renew(LineWeights(weights.inertia, weights.force))

    @property
    def tangled(self) -> tuple[int, int]:
        """First elements that are folded, and that swing too far, in the last trial: `Line.tangled`."""
        folded, swung = listed(self._tangled)
        return folded, swung

    def solve(self) -> tuple[int, int]:
        """Solve the step: the outcome, see `riser_loop`, and the number of iterations."""
        self._solve()
        outcome, taken = listed(self.progress.ending)
        return outcome, taken

    def solved(self, t: float, dt: float) -> State:
        """The state of the step solved last."""
        return State(t, self.step.u.flatten(), self.step.v.flatten(), self.step.a.flatten(), dt=dt)

    def account(self, before: State) -> tuple[Array, Array]:
        """Energy (3,) at the end of the step solved last, and work (parts that have kernels for it, 4) in it."""
        self._placed.move(before)
        self._account()
        return self._energy, self._work


def _zeros(n: int, shape: tuple[int, ...]) -> list[Array]:
    return [np.zeros(shape) for _ in range(n)]


def matrix_room(line: Line) -> MatrixRoom:
    """Room for the tangent of a line."""
    ne, d, r, n = line.length.size, line.dimension, line.frames.dofs, line.ndof
    matrix, band = banded.room(line.size, 2 * n - 1)
    return MatrixRoom(
        np.empty((ne, 2 * n, 2 * n)),
        np.empty((ne, 2, d)),
        np.empty((ne, 2, r, r)),
        matrix,
        np.empty(line.size, dtype=np.int64),
        band,
    )
