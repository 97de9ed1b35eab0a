"""The system of lines and bodies with what couples them: residual, tangent and solution by kernels.

Each line has a band; what couples lines, or has unknowns of its own, is a border beside the bands (`dense_border`).
Kernels are bound to their arguments once, so that an iteration is two calls.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.bound import Bound, Packed, in_turn
from riser_soil.core.part import Energy, State, Weights, Work
from riser_soil.solve import step_kernels as kernels
from riser_soil.solve.convergence import ITERATING, NOT_SOLVED, OUTGROWN, Convergence, StopLimits
from riser_soil.solve.newton_loop import iterate
from riser_soil.solve.packed_line import PackedLine

if TYPE_CHECKING:
    from riser_soil.solve.dense_border import DenseBorder


class Coupling:
    """Unknowns and coupling terms beside the lines, such as joints and condensed soil; this base has none.

    Methods that return kernels do so for one phase of a Newton iteration; they write to lines and border. smooth:
    whether nothing touches the lines; gradual: whether a tangent may be kept beside contact, see `System`; parts: whose
    forces are evaluated here.
    """

    smooth = gradual = True
    parts: Sequence[Any] = ()

    def begin(self, before: State, step_to: float, guess: Array) -> None:
        """Begin a step from an accepted state to a time [s], with a first guess (size,) of all local increments."""

    def leave_to_parts(self) -> bool:
        """Get the parts ready to solve a step that can't be solved here; whether they may."""
        return False

    def widen(self) -> None:
        """Make room for what the last trial has touched."""

    @property
    def holds(self) -> bool:
        """Whether the last trial lies within that room."""
        return True

    def forces(self) -> list[Bound]:
        """Kernels that add to the lines' residuals, and write that of the border."""
        return []

    def norms(self, sums: Packed) -> list[Bound]:
        """Kernels that add the border's residual to the norms."""
        return []

    def outgrown(self, failure: Packed) -> list[Bound]:
        """Kernels that write a failure (1,) where more is touched than there is room for."""
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
        """Kernels that write whether the border's residual is above its round-off, above (1,)."""
        return []

    def fill(self) -> list[Bound]:
        """Kernels that add to the lines' bands."""
        return []

    def account(self, energy: Packed) -> list[Bound]:
        """Kernels that account for a step, and add to the energy (3,)."""
        return []

    def put_increments(self, weights: Weights, u: Array, v: Array, a: Array) -> None:
        """Write the increments of dofs beside the lines, and add what rates follow from them, all local."""

    def add_account(self, before: State, state: State, work: dict[str, Work]) -> Energy:
        """Add what the border's parts have turned over in the step solved last; the energy stored beside the lines."""
        return Energy()


MakeCoupling = Callable[["DenseBorder", Sequence[PackedLine]], Coupling]


class LineSystem:
    """Residual, tangent and solution of lines and bodies with their couplings, by kernels, for Newton's loop.

    border: of the bands, None where nothing couples them. convergence: of the step. evaluate, write_tangent, correct:
    pieces of the loop, which are looked at alone, too. keep: keeps the history of the parts at the solution.
    """

    def __init__(
        self, lines: Sequence[PackedLine], couplings: Sequence[Coupling] = (), border: DenseBorder | None = None
    ) -> None:
        self.lines, self.couplings, self.border = lines, couplings, border
        self._norms, self._above = np.zeros(3), np.zeros(1, dtype=np.bool_)
        self._failure = np.zeros(1, dtype=np.int64)
        self._bind()
        self.energy = np.zeros(3)
        energy = Packed(self.energy)
        each = [kernel for line in lines for kernel in line.account(energy)]
        self._account = in_turn(Bound(kernels.set_zero, energy), *each, *self._kernels(lambda it: it.account(energy)))

    def _kernels(self, of: Callable[[Coupling], list[Bound]]) -> list[Bound]:
        """Kernels of all couplings."""
        return [kernel for each in self.couplings for kernel in of(each)]

    @property
    def smooth(self) -> bool:
        """Whether nothing beside the lines touches them."""
        return all(each.smooth for each in self.couplings)

    def _bind(self) -> None:
        """Bind the kernels of the loop to where they read and write."""
        lines, coupled, border = self.lines, self._kernels, self.border
        sums, norms, above, failure = map(Packed, (np.zeros(5), self._norms, self._above, self._failure))
        evaluate = [
            *(kernel for line in lines for kernel in line.evaluate()),
            *coupled(lambda it: it.forces()),
            Bound(kernels.set_zero, sums),
            *(kernel for line in lines for kernel in line.balance(sums)),
            *coupled(lambda it: it.norms(sums)),
            Bound(kernels.write_norms, sums, norms),
            Bound(kernels.set_zero, failure),
            *coupled(lambda it: it.outgrown(failure)),
        ]
        bulk, contact, fixed_rate_bulk, fixed_rate_contact = (
            [kernel for line in each for kernel in line]
            for each in zip(*(line.tangents(not self.smooth) for line in lines), strict=True)
        )
        joined = coupled(lambda it: it.bulk_tangent())
        contact += coupled(lambda it: it.tangent())
        move, schur, solve = (border.move_rows(), border.factorise(failure), border.solve()) if border else ([], [], [])
        fill = [*(line.fill() for line in lines), *coupled(lambda it: it.fill()), *move]
        factors = [*fill, *(line.factorise(failure) for line in lines), *schur]
        sizes = [line.write_sizes for line in lines]
        terms = [Bound(kernels.write_terms, line.packed_workspace, line.packed_dofs) for line in lines]
        looked = [Bound(kernels.find_above, line.packed_dofs, above) for line in lines]
        probe = [
            *fixed_rate_bulk, *joined, *fixed_rate_contact, *sizes, *terms, *coupled(lambda it: it.terms()),
            Bound(kernels.set_zero, above), *looked, *coupled(lambda it: it.above(above)),
        ]  # fmt: skip
        touch = [*contact, *factors] if contact else []
        improve = [*solve, *(line.improve() for line in lines)]
        self._look_for_tangles = in_turn(*(kernel for line in lines for kernel in line.look_for_tangles))
        self.evaluate, self._probe = in_turn(*evaluate), in_turn(*probe)
        self._update = in_turn(*bulk, *joined, *contact, *factors, *improve, until=failure)
        self._update_by_kept_tangent = in_turn(*touch, *improve, until=failure)
        self.write_tangent = in_turn(*bulk, *joined, *contact, *fill, *sizes)
        self.correct = in_turn(*factors, *improve)
        self.keep = in_turn(*(kernel for line in lines for kernel in line.keep()))

    def begin(self, state: State, past: Array, weights: Weights, limits: StopLimits) -> None:
        """Begin a step from a state of all local dofs.

        past (size,): share of the forces at the step's start. weights: of forces in the balance and of
        the trial's rates. limits: of Newton's iterations.
        """
        for line in self.lines:
            line.begin(state, past, weights)
        self.convergence = Convergence(limits)

    def solve(self) -> str:
        """Solve the step: how Newton's method ends."""
        ending = iterate(self)
        self._look_for_tangles()
        return ending

    def judge(self) -> str:
        """Evaluate the residual of the trial: how the method ends there; OUTGROWN where more touches the lines than
        there is room for.
        """
        self.evaluate()
        norm, untouched, in_play = as_list(self._norms)
        self.convergence.add(norm, untouched)
        if self._failure[0] != kernels.NONE:
            return OUTGROWN
        return self.convergence.ending(in_play, self._at_round_off)

    def _at_round_off(self) -> bool:
        """Whether all of the residual may be round-off; overwrites the tangent's workspace."""
        self._probe()
        return not self._above[0]

    def improve(self) -> str:
        """Newton update: increments -= K⁻¹ residual. A kept tangent is still in its workspace: a residual that may
        have been probed there has fallen by less than one that leaves it.
        """
        if self.convergence.keeps_tangent:
            self._update_by_kept_tangent()
        else:
            self._update()
        return ITERATING if self._failure[0] == kernels.NONE else NOT_SOLVED

    def account(self, before: State) -> None:
        """Compute the energy at the end of the step solved last, and the work in it."""
        for line in self.lines:
            line.move_start(before)
        self._account()
