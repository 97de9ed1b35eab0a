"""Newton's method for the time steps of a riser alone, compiled: `riser_loop` behind the interface of `Newton`."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.held import hold
from riser_soil.core.part import Energy, Forces, Part, State, Work
from riser_soil.core.system import System
from riser_soil.riser.configuration import Maps, base_of, room_for
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart, overrides
from riser_soil.riser.part_kernels import add_work, forces_of
from riser_soil.solve import banded, riser_loop
from riser_soil.solve.solution import NewtonSettings, NotConvergedError, Solution, Step, largest_at, told
from riser_soil.solve.time_scheme import GeneralizedAlpha, Scheme

WHY = {
    riser_loop.NOT_FINITE: "diverged_fnorm_nan",
    riser_loop.SINGULAR: "diverged_linear_solve",
    riser_loop.DIVERGED: "diverged_dtol",
    riser_loop.TOO_MANY: "diverged_max_it",
}


def runs_compiled(system: System, scheme: Scheme) -> bool:
    """Whether the steps of a stage can be solved by the compiled loop: a riser alone, all of whose parts have kernels,
    on one rank, in time steps of Newmark's scheme or generalised-alpha.
    """
    model = system.model
    if system.comm.size > 1 or len(model.fields) > 1 or not isinstance(scheme, GeneralizedAlpha):
        return False
    return isinstance(model.lines[0], Line) and all(_numbers(part) is not None for part in model.parts)


def _numbers(part: Part) -> tuple[Any, ...] | None:
    return part.numbers() if isinstance(part, LinePart) else None


class RiserNewton:
    """Solver of a riser's time steps. Create once a stage; see `Newton`."""

    def __init__(self, system: System, settings: NewtonSettings) -> None:
        self.system, self.settings = system, settings
        self.iterations, self.rests = 0, False
        (line,) = system.model.lines
        assert isinstance(line, Line)
        self._line, self._shape = line, (line.nodes, line.ndof)
        parts = [part for part in system.model.parts if isinstance(part, LinePart)]
        self._renewed = [part for part in parts if overrides(part, "renew_numbers")]
        self._riser = riser_of(line, parts, system.prescribed, system.levers)
        self._held = hold(self._riser)
        kernels = [type(numbers) in add_work.kernels for numbers in self._riser.parts]
        both = zip(parts, kernels, strict=True)
        self._turning = [(part, kernel) for part, kernel in both if kernel or overrides(part, "work")]
        self._norms = np.empty(settings.max_iterations + 1)

    def solve(self, step: Step) -> Solution:
        """Solve a step or raise NotConvergedError."""
        since = time.perf_counter()
        for part in self._renewed:
            part.renew_numbers(step.t)
        numbers = self._step_numbers(step)
        base, limits = base_of(self._line), self._limits(step)
        outcome, taken = riser_loop.solve_step(self._held, base, numbers, limits, self._norms)
        self.rests = False
        self.iterations += taken
        norms = [float(norm) for norm in self._norms[: taken + 1]]
        self.system.clock.add("riser alone", since)
        if outcome != riser_loop.CONVERGED:
            raise NotConvergedError(self._reason(outcome, norms))
        state = State(step.t, numbers.u.ravel(), numbers.v.ravel(), numbers.a.ravel())
        if reason := self._line.inadmissible(state):
            raise NotConvergedError(reason)
        return Solution(state, self._found(), norms)

    def turned_over(self, before: State, solution: Solution) -> tuple[Energy, dict[str, Work]]:
        """Energy stored at the end of the step solved last, and what each part turned over in it."""
        since = time.perf_counter()
        work = {part.name: Work() for part in self.system.model.parts}
        energy, rows = np.empty(3), np.empty((len(self._riser.turning), 4))
        rates = (values.reshape(self._shape) for values in (before.v, before.a))
        riser_loop.account(self._held, base_of(self._line), *rates, energy, rows)
        compiled = iter(rows.tolist())
        for part, kernel in self._turning:
            work[part.name] += Work(*next(compiled)) if kernel else part.work(before, solution.state)
        self.system.clock.add("riser alone", since)
        return Energy(*energy.tolist()), work

    def _step_numbers(self, step: Step) -> riser_loop.StepNumbers:
        scheme = step.scheme
        weights, past = scheme.weights(step.dt), scheme.past(step.start)
        still = scheme.trial(step.before, step.t, step.dt, np.zeros_like(step.guess))
        state = State(step.t, step.guess.copy(), still.v, still.a)
        self.system.prescribe(state)
        u, v0, a0 = (values.reshape(self._shape) for values in (state.u, state.v, state.a))
        v, a = np.empty(self._shape), np.empty(self._shape)
        before = self._riser.room.nothing if past is None else past.reshape(self._shape)
        shifts = weights.shift_v, weights.shift_a
        return riser_loop.StepNumbers(weights.inertia, weights.force, *shifts, u, v0, a0, v, a, before)

    def _limits(self, step: Step) -> riser_loop.StopLimits:
        """As in `Newton`: without contact the guess continues a smooth motion, whose tangent can be reused."""
        system, settings, smooth = self.system, self.settings, self.system.smooth
        return riser_loop.StopLimits(
            settings.tolerance,
            settings.floor,
            settings.reuse if smooth else 0.0,
            settings.max_iterations,
            max(settings.least_iterations, int(smooth)),
            self.rests or bool(np.any(step.guess[~system.prescribed])),
        )

    def _found(self) -> Forces:
        """The forces of the last trial."""
        forces = self._riser.forces
        return Forces(*(group.ravel().copy() for group in (forces.inertia, forces.force, forces.end)))

    def _reason(self, outcome: int, norms: list[float]) -> str:
        residual = np.where(self.system.prescribed, 0.0, self._riser.residual.ravel()) / self.system.levers
        return told(WHY[outcome], norms, self._place(residual))

    def _place(self, residual: Array) -> str:
        """The largest residual, in words."""
        if not np.isfinite(residual).all():
            return "the residual is not finite"
        k = int(np.argmax(np.abs(residual)))
        return largest_at(abs(residual[k]), self._line.describe(k))

    def require_stable(self, solution: Solution) -> None:
        """Time steps need not be stable equilibria."""

    def renew(self) -> None:
        """The matrix has places for all that a riser's tangent can hold."""

    def destroy(self) -> None:
        """There is nothing to give back."""


def riser_of(line: Line, parts: Sequence[LinePart], prescribed: BoolArray, levers: Array) -> riser_loop.HeldRiser:
    """A line and its parts in numbers, with room for the loop's work; prescribed and levers (size,): of its dofs."""
    shape, numbers = (line.nodes, line.ndof), [part.numbers() for part in parts]
    assert None not in numbers
    return riser_loop.HeldRiser(
        tuple(numbers),
        tuple(kept for kept in numbers if type(kept) in add_work.kernels),
        room_for(line),
        room_for(line),
        forces_of(line),
        _tangent_room(line),
        prescribed.reshape(shape),
        ~prescribed.reshape(shape),
        levers.reshape(shape),
        *(np.zeros(shape) for _ in range(3)),
    )


def _tangent_room(line: Line) -> riser_loop.TangentRoom:
    ne, d, r, n = line.length.size, line.dimension, line.frames.dofs, line.ndof
    maps = Maps(np.empty((ne, 2, d, r)), np.empty((ne, 2, d, r)), 0.0, 0.0)
    matrix, band = banded.room(line.size, 2 * n - 1)
    return riser_loop.TangentRoom(
        maps,
        np.empty((ne, 2 * n, 2 * n)),
        np.empty((ne, 2, d)),
        np.empty((ne, 2, r, r)),
        matrix,
        np.empty(line.size, dtype=np.int64),
        band,
        np.zeros((line.nodes, n)),
    )
