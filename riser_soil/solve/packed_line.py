"""A line or a body in the line solver: kernels of its parts, and the workspace of a step."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, as_list
from riser_soil.core.bound import Bound, Packed, bound
from riser_soil.core.part import State, Weights, Work
from riser_soil.riser.bound_parts import BoundParts, KernelData, has_history, has_work
from riser_soil.riser.configuration import Configuration, write_folded, write_magnitudes
from riser_soil.riser.line_part import CompiledPart, LineParts, overrides
from riser_soil.riser.placed_line import LineTrials, TrialConfiguration
from riser_soil.solve import step_kernels as kernels
from riser_soil.solve.step_kernels import Dofs, StepData, matrix_workspace


class PackedLine:
    """A line or a body and its parts, whose arrays it shares; at, step, forces, dofs, workspace: what the loop writes
    to, at being the trial configuration.

    parts: that act on it; committed: those whose history no kernel keeps. prescribed, levers (size,): of its dofs;
    weights: of the step. solution: increments and rates of the step, and groups: forces by group, as vectors (size,).
    """

    def __init__(self, parts: LineParts, prescribed: BoolArray, levers: Array) -> None:
        self.line = line = parts.line
        self.parts, self._trials, shape = parts, line.once(LineTrials), (line.nodes, line.ndof)
        self.step = StepData(*_zeros(6, shape))
        self._trial = TrialConfiguration(line, self._trials.base, self.step.u, self.step.v, self.step.a)
        self._kernels = BoundParts(self._trial.at, parts.data)
        self.at, self.forces = self._kernels.at, self._kernels.forces
        self.workspace = matrix_workspace(*shape)
        self._start = _flat(self.step.u, self.step.v0, self.step.a0, self.step.past)
        self.solution = _flat(self.step.u, self.step.v, self.step.a)
        self.groups = _flat(self.forces.inertia, self.forces.force, self.forces.end)
        self.dofs = Dofs(prescribed.reshape(shape), levers.reshape(shape), *_zeros(3, shape))
        self.weights, self._maps = self._trial.weights, self._trial.maps
        self._weights_at_fixed_rates = Packed(Weights.of_statics())
        self.packed_at, self.packed_forces = self._kernels.packed_at, self._kernels.packed_forces
        self.packed_step, self.packed_dofs, self.packed_workspace = map(Packed, (self.step, self.dofs, self.workspace))
        self.K = Packed(self.workspace.K)
        self._touching = [part.kernel_data() for part in parts.parts if "E" in part.traits.groups]
        self._folded = np.zeros(2, dtype=np.int64)
        folded = bound(write_folded, self.at, self._trials.base.packed, Packed(self._folded))
        self.look_for_tangles = [folded] if line.nodes > 1 else []
        self.write_sizes = bound(write_magnitudes, self.at, Packed(self.dofs.sizes))
        without = (part for part in parts.parts if not has_history(part.kernel_data()))
        self.committed = [part for part in without if _by_method(part, "commit")]
        turning = ((part, has_work(part.kernel_data())) for part in parts.parts)
        self._turning = [(part, kernel) for part, kernel in turning if kernel or _by_method(part, "work")]

    def evaluate(self) -> list[Bound]:
        """Kernels that place the trial and find the forces there."""
        follow = Bound(kernels.follow, self.packed_step, self.weights, self.packed_dofs)
        return [follow, self._trial.place, *self._kernels.find_forces()]

    def balance(self, sums: Packed) -> list[Bound]:
        """Kernels that write the residual of the evaluated forces, and add to its norms."""
        forces, dofs = self.packed_forces, self.packed_dofs
        return [
            self._kernels.collect(),
            Bound(kernels.combine, forces, self.packed_step, self.weights, dofs),
            Bound(kernels.add_norms, forces, dofs, sums),
        ]

    def tangents(self, contact: bool) -> tuple[list[Bound], list[Bound], list[Bound], list[Bound]]:
        """Kernels that write the tangent but for contact's share, and that add this; the same of both at fixed rates.
        contact: whether something beside the line's own parts touches it.
        """
        others = [each for each in self._kernels.data if all(each is not one for one in self._touching)]
        touched = contact or len(self._touching) > 0
        bulk = Packed(np.empty_like(self.workspace.K)) if touched else self.K
        begun = [Bound(kernels.begin_with, bulk, self.K)] if touched else []

        def contacts(weights: Packed) -> list[Bound]:
            return [*begun, *self._kernels.tangent(self._touching, self._maps, weights, self.K)]

        moving, at_fixed_rates = self.weights, self._weights_at_fixed_rates
        return (
            *(self._bulk(others, moving, bulk), contacts(moving)),
            *(self._bulk(others, at_fixed_rates, bulk), contacts(at_fixed_rates)),
        )

    def _bulk(self, parts: Sequence[KernelData], weights: Packed, K: Packed) -> list[Bound]:
        return [
            self._kernels.write_maps(self._maps, weights),
            Bound(kernels.set_zero, K),
            *self._kernels.tangent(parts, self._maps, weights, K),
            *self._kernels.turning(weights, K),
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
        """The kernel that subtracts the band's solution from the increments."""
        return Bound(kernels.improve, self.packed_workspace, self.packed_step, self.packed_dofs)

    def account(self, energy: Packed) -> list[Bound]:
        """Kernels of energy (3,), which they add to, and of the rows `work` of the parts that have a kernel for it."""
        self.work = np.zeros((sum(map(has_work, self._kernels.data)), 4))
        turned_over = self._kernels.work(self._trials.then.at, self.work)
        return [Bound(kernels.set_zero, Packed(self.work)), *self._kernels.energy(energy), *turned_over]

    def keep(self) -> list[Bound]:
        """Kernels that keep the history of the parts at the solution."""
        return self._kernels.keep()

    @property
    def begun(self) -> Configuration:
        """The line's configuration where the step began, as `move_start` has placed it."""
        return self._trials.then.at

    def write_residual(self, out: Array) -> Bound:
        """The kernel that writes the residual of the elements (ne, 2 ndof) by the forces evaluated last."""
        return self._kernels.write_residual(out)

    def move_start(self, before: State) -> None:
        """Place the line where the step began, for `account`."""
        self._trials.then.move(before)

    def add_work(self, before: State, after: State, work: dict[str, Work]) -> None:
        """Add what the parts turn over in a step that is accounted for, by name."""
        compiled = iter(as_list(self.work))
        for part, kernel in self._turning:
            work[part.name] += Work(*next(compiled)) if kernel else part.work(before, after)

    def begin(self, state: State, past: Array, weights: Weights) -> None:
        """Begin a step; arguments as of `LineSystem.begin`."""
        self._trials.base.update()
        at, (u, v, a, earlier) = self.line.part, self._start
        u[:], v[:], a[:], earlier[:] = state.u[at], state.v[at], state.a[at], past[at]
        if self._trial.weigh(weights):
            self._weights_at_fixed_rates.renew(self.weights.value._replace(shift_v=0.0, shift_a=0.0))

    @property
    def folding(self) -> tuple[int, int]:
        """First elements that are folded, and that swing too far, in the last trial: `Line.folding`."""
        folded, swung = as_list(self._folded)
        return folded, swung


def _by_method(part: CompiledPart, method: str) -> bool:
    """Whether a part has a method of its own, in the place of one that calls kernels."""
    return overrides(part, method) and getattr(type(part), method) is not getattr(CompiledPart, method)


def _flat(*arrays: Array) -> list[Array]:
    """Views of arrays as vectors."""
    return [each.ravel() for each in arrays]


def _zeros(n: int, shape: tuple[int, ...]) -> list[Array]:
    return [np.zeros(shape) for _ in range(n)]
