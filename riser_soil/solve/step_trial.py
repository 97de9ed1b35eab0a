"""Trials of a step: states that follow from its unknowns, and their residuals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State, Weights
from riser_soil.core.roles import Limited
from riser_soil.core.system import System
from riser_soil.solve.step import NotConvergedError, Step
from riser_soil.solve.step_kernels import write_balance, write_rates
from riser_soil.solve.time_scheme import Scheme


class StepTrials:
    """Trials of one step; collective.

    weights: of its scheme. state: that was tried last, None before the first; balanced: where in the step its forces
    are evaluated; forces: as found last [N].
    """

    def __init__(self, system: System, step: Step) -> None:
        self._system, self.step, scheme = system, step, step.scheme
        self.weights, past = scheme.weights(step.dt), scheme.past(step.start)
        self._past = np.zeros_like(step.guess) if past is None else past
        self._still = still = scheme.trial(step.before, step.t, step.dt, np.zeros_like(step.guess))
        self._prescribed = replace(still, u=step.guess.copy(), v=still.v.copy(), a=still.a.copy())
        system.prescribe(self._prescribed)
        self.state: State | None = None
        self._known: State | None = None  # whose forces are known

    def of(self, x: Array) -> State:
        """State of the unknowns x; the same object while x stays the same, so that parts need not look twice."""
        found = np.zeros(self._system.numbering.size)
        self._system.numbering.to_local(x, found)
        u = self.with_prescribed(found)
        if self.state is None or (u != self.state.u).any():
            self.state = self._follow(u)
            self.balanced = self.step.scheme.balanced_at(self.step.before, self.state, self.step.dt)
        return self.state

    def _follow(self, u: Array) -> State:
        """State of the increments u: rates follow them by the scheme's shifts, but for the prescribed ones."""
        fixed, v, a, shifts = self._system.prescribed, np.empty_like(u), np.empty_like(u), self.weights
        write_rates(u, fixed, np.where(fixed, self._prescribed.v, self._still.v), shifts.shift_v, v)
        write_rates(u, fixed, np.where(fixed, self._prescribed.a, self._still.a), shifts.shift_a, a)
        return State(self.step.t, u, v, a, dt=self._still.dt)

    def with_prescribed(self, u: Array) -> Array:
        """Increments with those that are prescribed in the step."""
        out = u.copy()
        out[self._system.prescribed_dofs] = self._prescribed.u[self._system.prescribed_dofs]
        return out

    def residual(self, x: Array) -> Array:
        """Residual of the unknowns, both (owned,)."""
        self.of(x)
        return self._system.numbering.add_to_global(self._residual_at(self.balanced))

    def residual_of(self, u: Array) -> tuple[State, Array]:
        """State of the increments u, those of the prescribed dofs included, without rates of their own, and its local
        residual.
        """
        state = replace(self._still, u=u)
        return state, self._residual_at(state)

    def _residual_at(self, state: State) -> Array:
        if state is not self._known:
            self.forces: Forces = self._system.forces(state)
            self._known = state
        return balance_of(self.step.scheme, self.weights, self.forces, self._past)

    def renumbered(self) -> Array | None:
        """Unknowns of the state that was tried last, as the system numbers its dofs now; None where none was."""
        if self.state is None:
            return None
        x = self._system.numbering.to_global(self.state.u)
        self._system.prescribe(self._prescribed)
        self.state = None
        return x

    def require_admissible(self, limited: Sequence[Limited]) -> None:
        """Raise NotConvergedError where the state that was tried last is none of a line's or of these parts'."""
        assert self.state is not None
        before = self.step.before if self.step.scheme.dynamic else None
        reasons = [line.inadmissible(self.state, before) for line in self._system.model.lines]
        reasons += [part.inadmissible(self.state) for part in limited]
        for reason in filter(None, reasons):
            raise NotConvergedError(reason)


def balance_of(scheme: Scheme, weights: Weights, forces: Forces, past: Array) -> Array:
    """Local residual of forces where they are in balance, as the increments of the step change it. past (n,): see
    `Scheme.past`.
    """
    out = np.empty_like(past)
    write_balance((forces.inertia, forces.force, forces.end), weights.inertia, weights.force, past, out)
    return out if scheme.step_over_trial == 1.0 else scheme.step_over_trial * out
