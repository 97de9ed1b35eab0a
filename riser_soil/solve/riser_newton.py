"""Newton's method for the time steps of a riser alone, compiled: `riser_loop` behind the interface of `Newton`."""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.bound import Bound, Packed, bound
from riser_soil.core.part import Energy, Forces, State, Work
from riser_soil.core.system import System
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart, overrides
from riser_soil.riser.placed_line import PlacedLine
from riser_soil.riser.section_forces import nodal_residual
from riser_soil.riser.sections import Elements
from riser_soil.solve.compiled_mass import AcceptedForces, CompiledMass, ElementForces, mass_of
from riser_soil.solve.newton_progress import CONVERGED, NAMES, StopLimits, largest_at
from riser_soil.solve.packed_riser import KernelParts, PackedRiser
from riser_soil.solve.solver import (
    NewtonSettings,
    NotConvergedError,
    Solution,
    Step,
    StepSolver,
    limits_of,
    reported,
)

if TYPE_CHECKING:
    from riser_soil.contact.contact import RiserContact

Numbered = Sequence[tuple[Any, tuple[Any, ...]]]  # parts of a line


def riser_newton(system: System, settings: NewtonSettings) -> RiserNewton | None:
    """The compiled loop over a riser alone, where all of its parts have kernels."""
    asked = [(part, part.kernel_data()) for part in system.model.parts if isinstance(part, LinePart)]
    with_data = [(part, data) for part, data in asked if data is not None]
    return RiserNewton(system, settings, with_data) if len(with_data) == len(system.model.parts) else None


class RiserNewton(StepSolver):
    """Solver of a riser's time steps. Create once a stage, by `riser_newton`; see `Newton`."""

    def __init__(self, system: System, settings: NewtonSettings, parts: Numbered) -> None:
        super().__init__(system, settings)
        (line,) = system.model.lines
        assert isinstance(line, Line)
        self._line, most = line, settings.max_iterations
        self._placed, self._parts = PlacedLine(line), KernelParts(parts)
        self._riser = PackedRiser(line, self._placed, self._parts, system.prescribed, system.levers, most)
        self._solved: State | None = None  # last, where no forces may have jumped since
        self._committed: Array | None = None  # the line's places, where its last step was solved here
        self._looked_at: State | None = None  # the accepted state whose forces were found last
        self._contacts: dict[RiserContact, tuple[Bound, Array]] = {}  # how they tell their results, and where to
        self._free = np.flatnonzero(~system.prescribed)
        self._nothing = np.zeros(line.size)
        self._no_work = {part.name: Work() for part, _ in parts}
        self._on_nodes = [part for part, _ in parts if overrides(part, "nodal_forces")]

    def solve(self, step: Step) -> Solution:
        """Solve a step or raise NotConvergedError."""
        since = time.perf_counter()
        self._solved = self._committed = self._looked_at = None
        self._parts.update(step.before.t, step.t)
        scheme = step.scheme
        self._riser.begin(self._guess(step), scheme.past(step.start), scheme.weights(step.dt), self._limits(step))
        outcome, taken = self._riser.solve()
        self.at_equilibrium = False
        self.iterations += taken
        norms: list[float] = as_list(self._riser.progress.norms[: taken + 1])
        self.system.clock.add("riser alone", since)
        if outcome != CONVERGED:
            raise NotConvergedError(self._reason(outcome, norms))
        if reason := self._line.folding(*self._riser.folding):
            raise NotConvergedError(reason)
        state = self._riser.solved(step.t, step.dt)
        self._solved = state if self.system.smooth else None
        return Solution(state, self._found(), norms)

    def commit(self, state: State) -> None:
        """Accept the state of the step solved last."""
        since = time.perf_counter()
        self._riser.keep()
        self.system.commit(state, self._parts.committed)
        self._committed = self._line.x
        self.system.clock.add("riser alone", since)

    @cached_property
    def mass(self) -> CompiledMass:
        """Inverse of the line's mass."""
        return mass_of(self._line, self._placed, self._parts, self.system.prescribed, self.system.levers)

    def bulk_forces(self, state: State) -> Forces:
        """Forces of groups I and F at an accepted state, those of group E zero."""
        return self.mass.bulk_forces(state)

    def element_residual(self, line: Line, state: State) -> Array:
        """Of the line's elements (ne, 2 ndof) at an accepted state; as solved where a step does not turn its axes."""
        known = self._has_solved(state) and not self._line.turns_axes
        return (self._at_solution if known else self._found_at(state)).residual()

    def section_forces(self, line: Line, elements: Elements, state: State) -> Array:
        """Of the line at an accepted state; of the one solved for last as the loop has found its forces."""
        found = self._at_solution if self._has_solved(state) else self._found_at(state)
        return found.section_forces(elements, state)

    def contact_results(self, contact: RiserContact, state: State) -> Array:
        """Of a contact at an accepted state: of the one committed last as the loop has found its forces."""
        if self._committed is not self._line.x:
            return contact.results(state)
        if contact not in self._contacts:
            self._contacts[contact] = self._bound_results(contact)
        put, found = self._contacts[contact]
        put()
        return found.copy()

    def _bound_results(self, contact: RiserContact) -> tuple[Bound, Array]:
        """A contact's results where the loop has left the line: what writes them, and where to."""
        from riser_soil.contact.contact import ContactResults, size_of, write_results

        data = next(data for part, data in self._parts.with_data if part is contact)
        sizes = self._line.nodes, contact.along.arc.size
        out = np.empty(size_of(*sizes))
        return bound(write_results, data, Packed(self._riser.at), Packed(ContactResults.within(out, *sizes))), out

    def _has_solved(self, state: State) -> bool:
        """Whether a state is that of the step solved last, whose forces the loop has left and nothing has changed."""
        solved = self._solved
        return solved is not None and self._accepted.whole and state.v is solved.v and state.a is solved.a

    def _found_at(self, state: State) -> ElementForces:
        if state is self._looked_at:
            return self._accepted.forces
        self._looked_at = state
        if self._parts.t != state.t or not self.system.smooth:  # contact has a new history since the step was solved
            self._parts.update(state.t, state.t)
        return self._accepted.found(state)

    @cached_property
    def _accepted(self) -> AcceptedForces:
        return AcceptedForces(self._line, self._placed, self._parts.with_data)

    @cached_property
    def _at_solution(self) -> ElementForces:
        return ElementForces(self._line, self._riser.at, self._riser.forces, self._parts.parts)

    def nodal_residual(self, line: Line, state: State) -> Array | None:
        """Of what acts on the line's nodes (nn, ndof) without holding them."""
        return nodal_residual(line, self._on_nodes, state) if self._on_nodes else None

    def energy_exchanged(self, before: State, solution: Solution) -> tuple[Energy, dict[str, Work]]:
        """Energy stored at the end of the step solved last, and what each part turned over in it."""
        since = time.perf_counter()
        work = dict(self._no_work)
        energy, rows = self._riser.account(before)
        self._parts.add_work(before, solution.state, as_list(rows), work)
        self.system.clock.add("riser alone", since)
        return Energy(*as_list(energy)), work

    def _guess(self, step: Step) -> State:
        """The first guess, with the rates of no increments but those that are prescribed."""
        still = step.scheme.trial(step.before, step.t, step.dt, self._nothing)
        state = State(step.t, step.guess.copy(), still.v, still.a)
        self._line.prescribe(step.t, state.u, state.v, state.a)
        return state

    def _limits(self, step: Step) -> StopLimits:
        """A smooth motion takes an iteration, which answers its load."""
        smooth, moves = self.system.smooth, bool(step.guess[self._free].any())
        return limits_of(self.settings, smooth, self.system.gradual, smooth or self.at_equilibrium or moves)

    def _found(self) -> Forces:
        """The forces of the last trial."""
        forces = self._riser.forces
        return Forces(forces.inertia.flatten(), forces.force.flatten(), forces.end.flatten())

    def _reason(self, outcome: int, norms: list[float]) -> str:
        residual = self._riser.dofs.residual.ravel() / self.system.levers
        return reported(NAMES[outcome], norms, self._place(residual))

    def _place(self, residual: Array) -> str:
        """The largest residual, in words."""
        if not np.isfinite(residual).all():
            return "the residual is not finite"
        k = int(np.argmax(np.abs(residual)))
        return largest_at(abs(residual[k]), self._line.describe(k))
