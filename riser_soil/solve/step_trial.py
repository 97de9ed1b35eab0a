"""Trial of a step: the state that it begins with, those that follow from its unknowns, and its end.

The unknowns are the increments to where the step is balanced: its end, or by the midpoint rule its middle.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State
from riser_soil.core.system import System
from riser_soil.solve.step import Step
from riser_soil.solve.step_kernels import write_balance, write_rates


class StepTrial:
    """Trial of one step of a system, all arrays local.

    weights: of its scheme; past: see `Scheme.past`. begun: where the step is balanced by its first guess, prescribed
    increments included, with the rates of no increments but those that are prescribed.
    """

    def __init__(self, system: System, step: Step) -> None:
        self._system, self.step, scheme = system, step, step.scheme
        self.weights, past = scheme.weights(step.dt), scheme.past(step.start)
        self.past = np.zeros(step.guess.size) if past is None else past
        self.begun = self._begun()

    @property
    def _ratio(self) -> float:
        return self.step.scheme.step_over_trial

    def _begun(self) -> State:
        step, scheme = self.step, self.step.scheme
        begun = scheme.trial(step.before, step.t, step.dt, np.zeros(step.guess.size))
        begun.u[:] = step.guess
        self._system.prescribe(begun)
        if self._ratio == 1.0:
            return begun
        alone = replace(begun, u=np.where(self._system.prescribed, begun.u, 0.0))
        return replace(scheme.balanced_at(step.before, alone, step.dt), u=begun.u / self._ratio)

    def begin_anew(self) -> None:
        """The system prescribes other dofs."""
        self.begun = self._begun()

    @cached_property
    def still(self) -> State:
        """Without increments, and without prescribed rates."""
        step, scheme = self.step, self.step.scheme
        end = scheme.trial(step.before, step.t, step.dt, np.zeros(step.guess.size))
        return scheme.balanced_at(step.before, end, step.dt)

    def with_prescribed(self, u: Array) -> Array:
        """Increments with those that are prescribed in the step."""
        out, at = u.copy(), self._system.prescribed_dofs
        out[at] = self.begun.u[at]
        return out

    def state_at(self, u: Array) -> State:
        """State of the increments u: rates follow them by the scheme's shifts, but for the prescribed ones."""
        fixed, v, a = self._system.prescribed, np.empty_like(u), np.empty_like(u)
        write_rates(u, fixed, self.begun.v, self.weights.shift_v, v)
        write_rates(u, fixed, self.begun.a, self.weights.shift_a, a)
        return State(self.begun.t, u, v, a, dt=self.begun.dt)

    def end_of(self, state: State) -> State:
        """The step's end, where it is balanced at a state."""
        if self._ratio == 1.0:
            return state
        step = self.step
        end = step.scheme.trial(step.before, step.t, step.dt, self._ratio * state.u)
        self._system.prescribe(end)
        return end

    def balance(self, forces: Forces) -> Array:
        """Local residual of the forces where the step is balanced."""
        out = np.empty_like(self.past)
        groups = forces.inertia, forces.force, forces.end
        write_balance(groups, self.weights.inertia, self.weights.force, self.past, out)
        return out
