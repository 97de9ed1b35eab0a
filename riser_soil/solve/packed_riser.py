"""A riser alone as kernel data, packed for the compiled loop: parts bound to kernels, workspace for what is solved."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, as_list
from riser_soil.core.bound import Bound, Packed, bound, calls, in_turn
from riser_soil.core.part import State, Weights, Work
from riser_soil.riser.configuration import (
    maps_for,
    place,
    workspace_for,
    write_folded,
    write_magnitudes,
    write_maps,
    write_turning,
)
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import CompiledPart, LinePart, LineTrials, overrides
from riser_soil.riser.part_kernels import (
    LineWeights,
    add_energy,
    add_forces,
    add_tangent,
    add_work,
    clear,
    collect,
    forces_of,
    keep,
    turn,
    weigh,
)
from riser_soil.riser.placed_line import PlacedLine
from riser_soil.solve import riser_loop as loop
from riser_soil.solve.newton_progress import CONVERGED, OUTGROWN, StopLimits
from riser_soil.solve.riser_loop import Dofs, NewtonProgress, StepData, matrix_workspace

KernelData = tuple[Any, ...]


class PackedRiser:
    """A line and its parts, whose arrays it shares; at, step, forces, dofs, workspace, progress: what the loop writes
    to.

    placed: the line where it is accepted; parts: that act on it; prescribed, levers (size,): of the line's dofs; most:
    iterations of a step; border: what stands beside them.
    """

    def __init__(
        self,
        line: Line,
        placed: PlacedLine,
        parts: KernelParts,
        prescribed: BoolArray,
        levers: Array,
        most: int,
        border: LoopBorder | None = None,
    ) -> None:
        self._line, self._placed, shape = line, placed, (line.nodes, line.ndof)
        self.step, self.forces = StepData(*_zeros(6, shape)), forces_of(line)
        self.workspace = matrix_workspace(*shape, line.dimension)
        self._start = [values.ravel() for values in (self.step.u, self.step.v0, self.step.a0, self.step.past)]
        self.dofs = Dofs(prescribed.reshape(shape), levers.reshape(shape), *_zeros(3, shape))
        self.progress = NewtonProgress(np.zeros(most + 1), np.zeros(most + 1), np.zeros(2, dtype=np.int64))
        self._maps, self._weights = Packed(maps_for(line)), Packed(LineWeights(0.0, 0.0))
        self._weighed = Weights(0.0, 0.0, 0.0, 0.0)  # as in both
        self._limits = Packed(StopLimits(0.0, 0.0, 0.0, most, 0, False))
        self._border = LoopBorder() if border is None else border
        self._bind(parts.kernel_data, parts.in_groups("E"))
        self._bind_account(parts.kernel_data)

    def _bind(self, data: Sequence[KernelData], touching: Sequence[KernelData]) -> None:
        """Bind the kernels of the loop to where they read and write. touching: whose tangent may jump."""
        at, border = workspace_for(self._line), self._border
        self.at = at
        written = self.step, self.forces, self.dofs, self.workspace, self.progress
        now, step, forces, dofs, workspace, progress = map(Packed, (at, *written))
        conjugate, turning = Packed(self.workspace.conjugate), Packed(self.workspace.turning)
        maps, weights, limits, K = self._maps, self._weights, self._limits, Packed(self.workspace.K)
        evaluate = [
            Bound(loop.follow, step, maps, dofs),
            bound(place, at, self._placed.base, *map(Packed, (self.step.u, self.step.v, self.step.a))),
            Bound(clear, forces),
            *(bound(add_forces, each, now, forces) for each in data),
            *border.forces(now, forces),
            Bound(collect, now, forces),
            Bound(loop.combine, forces, step, weights, dofs),
            border.judge(forces, dofs, limits, progress),
        ]

        others = [each for each in data if all(each is not one for one in touching)]
        contact = len(touching) > 0 or not border.smooth
        bulk = Packed(np.empty_like(self.workspace.K)) if contact else K

        def bulk_tangent(maps: Packed) -> list[Bound]:
            return [
                bound(write_maps, at, maps),
                Bound(loop.clear_tangent, bulk),
                *(bound(add_tangent, each, now, maps, weights, bulk) for each in others),
                Bound(weigh, forces, weights, conjugate),
                bound(write_turning, at, conjugate, turning),
                Bound(turn, now, turning, bulk),
            ]

        def contact_tangent(maps: Packed) -> list[Bound]:
            added = (bound(add_tangent, each, now, maps, weights, K) for each in touching)
            return [Bound(loop.begin_with, bulk, K), *added, *border.tangent(now, K)] if contact else []

        held = Packed(maps.value)  # without shifts
        write_sizes = bound(write_magnitudes, at, Packed(self.dofs.sizes))
        judged = Bound(loop.judge_round_off, workspace, dofs, progress)
        probe = [*bulk_tangent(held), *contact_tangent(held), write_sizes, judged]
        factors = [Bound(loop.fill, workspace, dofs), border.factorise(workspace, dofs, progress)]
        renew = [*bulk_tangent(maps), *contact_tangent(maps), *factors]
        touch = [*contact_tangent(maps), *factors] if contact else []
        each = evaluate, probe if border.knows_round_off else [], renew, touch, [border.improve(workspace, step, dofs)]
        tables = (Packed(calls(*kernels)) for kernels in each)
        self._folded = np.zeros(2, dtype=np.int64)
        solve = Bound(loop.solve_step, *tables, limits, progress)
        self._solve = in_turn(solve, bound(write_folded, at, self._placed.base, Packed(self._folded)))
        self.evaluate, self.write_tangent = in_turn(*evaluate), in_turn(*renew[:-1], write_sizes)
        self.renew_contact = in_turn(*touch)
        self.keep = in_turn(*(bound(keep, each, now) for each in data if type(each) in keep.kernels))

    def _bind_account(self, data: Sequence[KernelData]) -> None:
        """Bind the kernels of energy and work."""
        turning = [each for each in data if type(each) in add_work.kernels]
        self._energy, self._work = np.zeros(3), np.zeros((len(turning), 4))
        then, now, energy = map(Packed, (self._placed.at, self.at, self._energy))
        rows = [Packed(row) for row in self._work]
        self._account = in_turn(
            Bound(loop.clear_account, energy, Packed(self._work)),
            *(bound(add_energy, each, now, energy) for each in data),
            *(bound(add_work, each, then, now, row) for each, row in zip(turning, rows, strict=True)),
            *self._border.account(then, now),
        )

    def begin(self, state: State, past: Array | None, weights: Weights, limits: StopLimits) -> None:
        """Begin a step.

        state: the first guess, and the rates of no increments but those that are prescribed; past: see `time_scheme`.
        """
        self._placed.update()
        u, v, a, earlier = self._start
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
    def folding(self) -> tuple[int, int]:
        """First elements that are folded, and that swing too far, in the last trial: `Line.folding`."""
        folded, swung = as_list(self._folded)
        return folded, swung

    def solve(self) -> tuple[int, int]:
        """Solve the step: the outcome, see `riser_loop`, and the number of iterations."""
        self._solve()
        outcome, taken = as_list(self.progress.ending)
        return outcome, taken

    @property
    def converged(self) -> bool:
        """Whether the step solved last is in balance."""
        return bool(self.progress.ending[0] == CONVERGED)

    @property
    def outgrown(self) -> bool:
        """Whether it wants more of what stands beside the line."""
        return bool(self.progress.ending[0] == OUTGROWN)

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


class KernelParts:
    """Parts with their kernel data; t: the time [s] that what depends on it was written for last; committed: parts
    whose history no kernel keeps.
    """

    def __init__(self, with_data: Sequence[tuple[Any, KernelData]]) -> None:
        self.with_data, self.t = with_data, math.nan
        self.parts: list[LinePart] = [part for part, _ in with_data]
        self.kernel_data = [held for _, held in with_data]
        self._renewed = [part for part in self.parts if overrides(part, "renew_kernel_data")]
        kernels = [(part, type(held) in add_work.kernels) for part, held in with_data]
        self.committed = [part for part, held in with_data if type(held) not in keep.kernels]
        self._turning = [(part, kernel) for part, kernel in kernels if kernel or _by_method(part)]
        self._trials = {part.line.once(LineTrials) for part in self.parts}

    def update(self, start: float, end: float) -> None:
        """Write what depends on the time into the kernel data, for a step between two times."""
        for trials in self._trials:
            trials.forget()
        for part in self._renewed:
            part.renew_kernel_data(start, end)
        self.t = end

    def update_to(self, t: float) -> None:
        if self.t != t:
            self.update(t, t)

    def in_groups(self, groups: str) -> list[KernelData]:
        """Numbers of the parts with forces in some of the groups."""
        return [held for part, held in self.with_data if set(part.traits.groups) & set(groups)]

    def add_work(self, before: State, after: State, rows: list[list[float]], work: dict[str, Work]) -> None:
        """Add what the parts turn over in a step, by name; rows: of those that have kernels for it."""
        compiled = iter(rows)
        for part, kernel in self._turning:
            work[part.name] += Work(*next(compiled)) if kernel else part.work(before, after)


def _by_method(part: LinePart) -> bool:
    """Whether a part without a kernel for it says what it turns over."""
    return overrides(part, "work") and type(part).work is not CompiledPart.work


class LoopBorder:
    """Nothing beside the line. One with unknowns of its own overrides all of this; kernels are bound to what they take.

    knows_round_off: whether a residual can be told from its round-off by `riser_loop.judge_round_off`; smooth: whether
    nothing touches it.
    """

    knows_round_off = smooth = True

    def forces(self, at: Packed, forces: Packed) -> list[Bound]:
        """Kernels that add to the line's residual, and write that of the border."""
        return []

    def judge(self, forces: Packed, dofs: Packed, limits: Packed, progress: Packed) -> Bound:
        """The kernel that tells whether all of the residual is small enough."""
        return Bound(loop.judge, forces, dofs, limits, progress)

    def tangent(self, at: Packed, K: Packed) -> list[Bound]:
        """Kernels that add to the line's tangent, and write that of the border."""
        return []

    def factorise(self, workspace: Packed, dofs: Packed, progress: Packed) -> Bound:
        """The kernel that factorises the line's band and the border."""
        return Bound(loop.factorise, workspace, progress)

    def improve(self, workspace: Packed, step: Packed, dofs: Packed) -> Bound:
        """The kernel that takes the factors' answer off all increments."""
        return Bound(loop.improve, workspace, step, dofs)

    def account(self, then: Packed, now: Packed) -> list[Bound]:
        """Kernels that account for a step."""
        return []
