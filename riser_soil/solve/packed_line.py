"""A line or a body as kernel data: its parts bound to kernels, and the workspace of a step."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, as_list
from riser_soil.core.bound import Bound, Packed, bound, in_turn
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
from riser_soil.riser.line_part import CompiledPart, LinePart, LineTrials, overrides
from riser_soil.riser.moving_nodes import MovingNodes
from riser_soil.riser.part_kernels import (
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
        """Begin a step. state, past: as of `LineSystem`, of this line's dofs."""
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
