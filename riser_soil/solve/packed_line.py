"""Lines and bodies as kernel data, packed for the compiled loop: parts bound to kernels, and workspace."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from operator import attrgetter
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, as_list
from riser_soil.core.bound import Bound, Packed, bound, in_turn
from riser_soil.core.part import Energy, Forces, State, Weights, Work
from riser_soil.core.saved_state import Saved
from riser_soil.riser.configuration import (
    maps_for,
    place,
    workspace_for,
    write_folded,
    write_magnitudes,
    write_maps,
    write_turning,
)
from riser_soil.riser.line_part import CompiledPart, LinePart, LineTrials, overrides
from riser_soil.riser.moving_nodes import MovingNodes
from riser_soil.riser.part_kernels import (
    LineWeights,
    add_energy,
    add_forces,
    add_tangent,
    add_work,
    clear,
    collect,
    forces_at,
    keep,
    turn,
    weigh,
)
from riser_soil.riser.placed_line import PlacedLine
from riser_soil.solve import step_kernels as kernels
from riser_soil.solve.convergence import ITERATING, NOT_SOLVED, OUTGROWN, Convergence, StopLimits
from riser_soil.solve.newton_loop import iterate
from riser_soil.solve.step_kernels import Dofs, StepData, matrix_workspace

KernelData = tuple[Any, ...]


class KernelParts:
    """Parts with their kernel data; t: the time [s] that what depends on it was written for last; committed: parts
    whose history no kernel keeps.
    """

    def __init__(self, with_data: Sequence[tuple[Any, KernelData]]) -> None:
        self.with_data, self.t = with_data, math.nan
        self.parts: list[LinePart] = [part for part, _ in with_data]
        self.kernel_data = [held for _, held in with_data]
        self._renewed = [part for part in self.parts if overrides(part, "renew_kernel_data")]
        turning = [(part, type(held) in add_work.kernels) for part, held in with_data]
        self.committed = [part for part, held in with_data if type(held) not in keep.kernels]
        self._turning = [(part, kernel) for part, kernel in turning if kernel or _by_method(part)]
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
        """Kernel data of the parts with forces in some of the groups."""
        return [held for part, held in self.with_data if set(part.traits.groups) & set(groups)]

    def add_work(self, before: State, after: State, rows: list[list[float]], work: dict[str, Work]) -> None:
        """Add what the parts turn over in a step, by name; rows: of those that have kernels for it."""
        compiled = iter(rows)
        for part, kernel in self._turning:
            work[part.name] += Work(*next(compiled)) if kernel else part.work(before, after)


def _by_method(part: LinePart) -> bool:
    """Whether a part without a kernel for it says what it turns over."""
    return overrides(part, "work") and type(part).work is not CompiledPart.work


class PackedLine:
    """A line or a body and its parts, whose arrays it shares; placed: where it is accepted; at, step, forces, dofs,
    workspace: what the loop writes to, at being the trial configuration.

    parts: that act on it; prescribed, levers (size,): of its dofs; weights: `LineWeights` of the step, for all lines.
    """

    def __init__(
        self, line: MovingNodes, parts: KernelParts, prescribed: BoolArray, levers: Array, weights: Packed
    ) -> None:
        self.line, self.parts, self.placed, shape = line, parts, PlacedLine(line), (line.nodes, line.ndof)
        self.step, self.at = StepData(*_zeros(6, shape)), workspace_for(line)
        self.forces = forces_at(self.at)
        self.workspace = matrix_workspace(*shape, line.dimension)
        self._start = [values.ravel() for values in (self.step.u, self.step.v0, self.step.a0, self.step.past)]
        self.dofs = Dofs(prescribed.reshape(shape), levers.reshape(shape), *_zeros(3, shape))
        self.weights, self._maps = weights, Packed(maps_for(line))
        written = self.at, self.step, self.forces, self.dofs, self.workspace
        self.packed_at, self.packed_step, self.packed_forces, self.packed_dofs, self.packed_workspace = map(
            Packed, written
        )
        self.K = Packed(self.workspace.K)
        self._touching = parts.in_groups("E")
        self._folded = np.zeros(2, dtype=np.int64)
        folded = bound(write_folded, self.at, self.placed.base, Packed(self._folded))
        self.look_for_tangles = [folded] if line.nodes > 1 else []
        self.write_sizes = bound(write_magnitudes, self.at, Packed(self.dofs.sizes))
        kept = (bound(keep, each, self.packed_at) for each in parts.kernel_data if type(each) in keep.kernels)
        self.keep = in_turn(*kept)

    def evaluate(self) -> list[Bound]:
        """Kernels that place the trial and find the forces there."""
        now, step, forces = self.packed_at, self.packed_step, self.packed_forces
        return [
            Bound(kernels.follow, step, self._maps, self.packed_dofs),
            bound(place, self.at, self.placed.base, *map(Packed, (self.step.u, self.step.v, self.step.a))),
            Bound(clear, forces),
            *(bound(add_forces, each, now, forces) for each in self.parts.kernel_data),
        ]

    def balance(self, sums: Packed) -> list[Bound]:
        """Kernels that write the residual of the forces found, and add to its norms."""
        forces, dofs = self.packed_forces, self.packed_dofs
        return [
            Bound(collect, self.packed_at, forces),
            Bound(kernels.combine, forces, self.packed_step, self.weights, dofs),
            Bound(kernels.add_norms, forces, dofs, sums),
        ]

    def tangents(self, contact: bool) -> tuple[list[Bound], list[Bound], list[Bound], list[Bound]]:
        """Kernels that write the tangent but for contact's share, and that add this; the same of both at held rates.
        contact: whether something beside the line's own parts touches it.
        """
        others = [each for each in self.parts.kernel_data if all(each is not one for one in self._touching)]
        touched = contact or len(self._touching) > 0
        bulk, held = Packed(np.empty_like(self.workspace.K)) if touched else self.K, Packed(self._maps.value)
        begun = [Bound(kernels.begin_with, bulk, self.K)] if touched else []

        def contacts(maps: Packed) -> list[Bound]:
            given = self.packed_at, maps, self.weights, self.K
            return [*begun, *(bound(add_tangent, each, *given) for each in self._touching)]

        moving = self._bulk(others, self._maps, bulk), contacts(self._maps)
        return *moving, self._bulk(others, held, bulk), contacts(held)

    def _bulk(self, parts: Sequence[KernelData], maps: Packed, K: Packed) -> list[Bound]:
        now, forces, weights = self.packed_at, self.packed_forces, self.weights
        conjugate, turning = Packed(self.workspace.conjugate), Packed(self.workspace.turning)
        return [
            bound(write_maps, self.at, maps),
            Bound(kernels.set_zero, K),
            *(bound(add_tangent, each, now, maps, weights, K) for each in parts),
            Bound(weigh, forces, weights, conjugate),
            bound(write_turning, self.at, conjugate, turning),
            Bound(turn, now, turning, K),
        ]

    def terms_of(self, tangent: Sequence[Bound]) -> list[Bound]:
        """Kernels that add a share of the tangent to the terms of the residual, and leave this share alone in K.
        tangent: those that add it to K.
        """
        own = Bound(kernels.add_terms, self.packed_workspace, self.packed_dofs)
        return [Bound(kernels.set_zero, self.K), *tangent, own]

    def fill(self) -> Bound:
        """The kernel that writes the band."""
        return Bound(kernels.fill, self.packed_workspace, self.packed_dofs)

    def factorise(self, failure: Packed) -> Bound:
        """The kernel that factorises the band."""
        return Bound(kernels.factorise, self.packed_workspace, failure)

    def improve(self) -> Bound:
        """The kernel that takes the band's answer off the increments."""
        return Bound(kernels.improve, self.packed_workspace, self.packed_step, self.packed_dofs)

    def account(self, energy: Packed) -> list[Bound]:
        """Kernels of energy (3,), which they add to, and of the rows `work` of the parts that turn some over."""
        data = self.parts.kernel_data
        turning = [each for each in data if type(each) in add_work.kernels]
        self.work = np.zeros((len(turning), 4))
        then, now = Packed(self.placed.at), self.packed_at
        return [
            Bound(kernels.set_zero, Packed(self.work)),
            *(bound(add_energy, each, now, energy) for each in data),
            *(bound(add_work, each, then, now, Packed(row)) for each, row in zip(turning, self.work, strict=True)),
        ]

    def begin(self, state: State, past: Array | None, weights: Weights) -> None:
        """Begin a step. state, past: as of `PackedSystem`, of this line's dofs."""
        self.placed.update()
        u, v, a, earlier = self._start
        u[:], v[:], a[:], earlier[:] = state.u, state.v, state.a, 0.0 if past is None else past
        maps = self._maps.value
        if (maps.shift_v, maps.shift_a) != (weights.shift_v, weights.shift_a):
            self._maps.renew(maps._replace(shift_v=weights.shift_v, shift_a=weights.shift_a))

    @property
    def folding(self) -> tuple[int, int]:
        """First elements that are folded, and that swing too far, in the last trial: `Line.folding`."""
        folded, swung = as_list(self._folded)
        return folded, swung


def _zeros(n: int, shape: tuple[int, ...]) -> list[Array]:
    return [np.zeros(shape) for _ in range(n)]


class LoopBorder:
    """What stands beside the lines, couples them or has unknowns of its own: here nothing; kernels are bound to what
    they take.

    smooth: whether nothing touches the lines; gradual: whether a tangent may be kept beside contact, see `System`;
    parts: whose forces are evaluated here.
    """

    smooth = gradual = True
    parts: Sequence[Any] = ()

    def begin(self, before: State, step_to: float, guess: Array) -> None:
        """Begin a step from an accepted state to a time [s], with a first guess (size,) of all local increments."""

    def leave_to_newton(self, before: State) -> bool:
        """Whether a step from an accepted state that can't be solved here may be `Newton`'s, for which all is ready."""
        return False

    def widen(self) -> None:
        """Take in what the last trial has outgrown."""

    @property
    def holds(self) -> bool:
        """Whether the last trial is one of what was taken in."""
        return True

    def forces(self) -> list[Bound]:
        """Kernels that add to the lines' residuals, and write that of the border."""
        return []

    def norms(self, sums: Packed) -> list[Bound]:
        """Kernels that add the border's residual to the norms."""
        return []

    def outgrown(self, failure: Packed) -> list[Bound]:
        """Kernels that tell where more is wanted of what stands beside the lines."""
        return []

    def bulk_tangent(self) -> list[Bound]:
        """Kernels that write the border's share of the tangent but for contact's."""
        return []

    def tangent(self) -> list[Bound]:
        """Kernels that add contact's share to the lines' tangents, and write that of the border."""
        return []

    def terms(self) -> list[Bound]:
        """Kernels that add to the terms that the lines' residuals are made of, and write the border's, see
        `step_kernels.write_terms`. The tangents of contact need not outlive them.
        """
        return []

    def above(self, above: Packed) -> list[Bound]:
        """Kernels that tell where something in the border's residual can be told from its round-off, above (1,)."""
        return []

    def fill(self) -> list[Bound]:
        """Kernels that add to the lines' bands."""
        return []

    def factorise(self, failure: Packed) -> list[Bound]:
        """Kernels that factorise what couples the lines, whose bands are factorised."""
        return []

    def couple(self) -> list[Bound]:
        """Kernels that take what the border answers off the lines' residuals."""
        return []

    def account(self, energy: Packed) -> list[Bound]:
        """Kernels that account for a step, and add to the energy (3,)."""
        return []

    def put_increments(self, weights: Weights, u: Array, v: Array, a: Array) -> None:
        """Write the increments of dofs beside the lines, and add what rates follow from them, all local."""

    def add_bulk_forces(self, state: State, forces: Forces) -> None:
        """Add the border's forces of groups I and F at an accepted state."""

    def add_account(self, before: State, state: State, work: dict[str, Work]) -> Energy:
        """Add what the border's parts have turned over in the step solved last; the energy stored beside the lines."""
        return Energy()

    def forget_account(self) -> None:
        """A step was solved elsewhere."""

    def state(self) -> Saved:
        return {}

    def restore(self, saved: Saved) -> None:
        """Nothing is kept."""


class PackedSystem:
    """Residual, tangent and solution of lines and bodies with what stands beside them, by kernels, for Newton's loop.

    weights: as the lines have them; convergence: of the step. evaluate, write_tangent, renew_contact, correct: pieces
    of the loop, which are looked at alone, too.
    """

    def __init__(self, lines: Sequence[PackedLine], beside: Sequence[LoopBorder], weights: Packed) -> None:
        self.lines, self.beside, self._weights = lines, beside, weights
        self._sums, self._above = np.zeros(5), np.zeros(1, dtype=np.bool_)
        self._failure = np.zeros(1, dtype=np.int64)
        self._bind()
        self.energy = np.zeros(3)
        energy = Packed(self.energy)
        each = [kernel for line in lines for kernel in line.account(energy)]
        self._account = in_turn(Bound(kernels.set_zero, energy), *each, *self._kernels(lambda it: it.account(energy)))

    def _kernels(self, of: Callable[[LoopBorder], list[Bound]]) -> list[Bound]:
        """Of all that stands beside the lines."""
        return [kernel for each in self.beside for kernel in of(each)]

    def all_beside(self, holds: Callable[[LoopBorder], bool]) -> bool:
        """Whether something holds of all that stands beside the lines."""
        return all(map(holds, self.beside))

    def _bind(self) -> None:
        """Bind the kernels of the loop to where they read and write."""
        lines, beside, smooth = self.lines, self._kernels, self.all_beside(attrgetter("smooth"))
        sums, above, failure = map(Packed, (self._sums, self._above, self._failure))
        evaluate = [
            *(kernel for line in lines for kernel in line.evaluate()),
            *beside(lambda it: it.forces()),
            Bound(kernels.set_zero, sums),
            *(kernel for line in lines for kernel in line.balance(sums)),
            *beside(lambda it: it.norms(sums)),
            Bound(kernels.set_zero, failure),
            *beside(lambda it: it.outgrown(failure)),
        ]
        bulk, contact, held_bulk, held_contact = (
            [kernel for line in each for kernel in line]
            for each in zip(*(line.tangents(not smooth) for line in lines), strict=True)
        )
        joined = beside(lambda it: it.bulk_tangent())
        contact += beside(lambda it: it.tangent())
        fill = [*(line.fill() for line in lines), *beside(lambda it: it.fill())]
        factors = [*fill, *(line.factorise(failure) for line in lines), *beside(lambda it: it.factorise(failure))]
        sizes = [line.write_sizes for line in lines]
        terms = [Bound(kernels.write_terms, line.packed_workspace, line.packed_dofs) for line in lines]
        looked = [Bound(kernels.find_above, line.packed_dofs, above) for line in lines]
        probe = [
            *held_bulk, *joined, *held_contact, *sizes, *terms, *beside(lambda it: it.terms()),
            Bound(kernels.set_zero, above), *looked, *beside(lambda it: it.above(above)),
        ]  # fmt: skip
        renew = [*bulk, *joined, *contact, *factors]
        touch = [*contact, *factors] if contact else []
        improve = [*beside(lambda it: it.couple()), *(line.improve() for line in lines)]
        self._look_for_tangles = in_turn(*(kernel for line in lines for kernel in line.look_for_tangles))
        self.evaluate, self._probe = in_turn(*evaluate), in_turn(*probe)
        self._renew, self.renew_contact, self._improve = in_turn(*renew), in_turn(*touch), in_turn(*improve)
        self.write_tangent = in_turn(*bulk, *joined, *contact, *fill, *sizes)
        self.correct = in_turn(*factors, *improve)

    def begin(self, state: State, past: Array | None, weights: Weights, limits: StopLimits) -> None:
        """Begin a step.

        state: the first guess, and the rates of no increments but those that are prescribed; past: see `time_scheme`;
        both of all local dofs.
        """
        for line in self.lines:
            at = line.line.part
            own = State(state.t, state.u[at], state.v[at], state.a[at])
            line.begin(own, None if past is None else past[at], weights)
        given = LineWeights(weights.inertia, weights.force)
        if given != self._weights.value:
            self._weights.renew(given)
        self.convergence = Convergence(limits)

    def solve(self) -> str:
        """Solve the step: how Newton's method ends."""
        ending = iterate(self)
        self._look_for_tangles()
        return ending

    def judge(self) -> str:
        """Find the residual of the trial: how the method ends there, OUTGROWN where more touches the lines than there
        is room for.
        """
        self.evaluate()
        own, apart, *in_play = as_list(self._sums)
        self.convergence.add(math.sqrt(own), math.sqrt(apart))
        if self._failure[0] != kernels.NONE:
            return OUTGROWN
        return self.convergence.ending(math.sqrt(max(in_play)), self._at_round_off)

    def _at_round_off(self) -> bool:
        """Whether nothing in the residual can be told from its round-off; the tangent's workspace is lost."""
        self._probe()
        return not self._above[0]

    def improve(self) -> str:
        """Take the tangent's answer off the increments. A kept tangent is still in its workspace: a residual that may
        have been probed there has fallen by less than one that leaves it.
        """
        if self.convergence.keeps_tangent:
            self.renew_contact()
        else:
            self._renew()
        if self._failure[0] != kernels.NONE:
            return NOT_SOLVED
        self._improve()
        return ITERATING

    def account(self, before: State) -> None:
        """Find the energy at the end of the step solved last, and the work in it."""
        for line in self.lines:
            line.placed.move(before)
        self._account()
