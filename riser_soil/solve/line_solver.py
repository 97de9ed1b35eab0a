"""Solver of time steps of lines and bodies on one rank: Newton's method over kernels, see `packed_line`.

A step that it can't solve on condensed soil, as where contact opens so that steps want shortening, is solved over the
parts of the system instead (`step_iteration`).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.part import Energy, Forces, Part, State, Work
from riser_soil.core.system import System
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LineParts, joined
from riser_soil.riser.moving_nodes import MovingNodes
from riser_soil.solve.convergence import CONVERGED, OUTGROWN, StopLimits
from riser_soil.solve.line_results import LineResults
from riser_soil.solve.line_system import LineSystem, MakeCoupling
from riser_soil.solve.newton_settings import NewtonSettings, limits_of
from riser_soil.solve.packed_line import PackedLine
from riser_soil.solve.residual_norm import place_of_largest
from riser_soil.solve.step import Solution, Step, failure_text
from riser_soil.solve.step_results import StepResults
from riser_soil.solve.step_trial import StepTrial

if TYPE_CHECKING:
    from riser_soil.contact.contact import RiserContact

MOST_STARTS = 8  # times that a step is begun with other pairs or dofs before it is given up


def line_solver(system: System) -> LineSolver | None:
    """The solver of lines and bodies, joined or not, one of them on condensed soil or none; None where one of
    their parts has no kernels.
    """
    fields, parts = system.model.lines, joined(system.model.parts)
    of_line = {part.line: part for part in parts if isinstance(part, LineParts)}
    make = _system_with(system, [part for part in parts if not isinstance(part, LineParts)])
    if make is None:
        return None
    lines = list[PackedLine]()
    for field in fields:
        if not isinstance(field, MovingNodes):
            return None
        own, at = of_line.get(field) or LineParts(field, []), field.part
        lines.append(PackedLine(own, system.prescribed[at], system.levers[at]))
    return LineSolver(system, make(lines))


def _system_with(system: System, parts: Sequence[Part]) -> Callable[[Sequence[PackedLine]], LineSystem] | None:
    """What makes the system of the lines, by the parts that act on more than one of them or on soil; None where these
    have no kernels.
    """
    if not parts:
        return LineSystem
    on_soil = [part for part in parts if part.traits.groups == "E"]
    between = [part for part in parts if part.traits.groups != "E"]
    makers: list[MakeCoupling | None] = []
    if system.model.others:
        from riser_soil.solve.soil_border import border_on_soil

        makers.append(border_on_soil(system, on_soil))
    elif on_soil:
        return None
    if between:
        from riser_soil.solve.joint_border import joint_border

        makers.append(joint_border(between))
    couplings = [coupling for coupling in makers if coupling is not None]
    if len(couplings) < len(makers):
        return None
    from riser_soil.solve.dense_border import DenseBorder

    def make(lines: Sequence[PackedLine]) -> LineSystem:
        border = DenseBorder(lines)
        return LineSystem(lines, [coupling(border, lines) for coupling in couplings], border)

    return make


class LineSolver(StepResults):
    """Solver of time steps of lines and bodies, and what is known of them then. Create once a stage, by `line_solver`.

    iterations: of all its steps, those that failed included.
    """

    def __init__(self, system: System, packed: LineSystem) -> None:
        super().__init__(system)
        self.iterations = 0
        self.packed, self._lines, self._couplings = packed, packed.lines, packed.couplings
        self._solved: State | None = None  # by this solver
        self._no_work = {part.name: Work() for part in system.model.parts}
        self._committed = [part for packed in self._lines for part in packed.committed]
        self._committed += [part for each in self._couplings for part in each.parts]
        self._results: dict[Line, LineResults] = {}
        if packed.smooth:
            fields = [(packed, packed.line) for packed in self._lines]
            self._results = {
                line: LineResults(packed, line, system.smooth) for packed, line in fields if isinstance(line, Line)
            }

    def solve(self, step: Step, settings: NewtonSettings, at_equilibrium: bool) -> Solution | str:
        """Solve a step; why that can't be done where it can't. at_equilibrium: see `Newton`."""
        since = time.perf_counter()
        trial = StepTrial(self.system, step)
        for line in self._lines:
            line.parts.renew(step.before.t, trial.begun.t)
        for results in self._results.values():
            results.forget()
        failure, norms = self._iterate(trial, self._limits(step, settings, at_equilibrium))
        solution = None if failure else Solution(self._end(trial), self._forces(), norms)
        # The last trial is the step's end, but of a scheme that balances forces elsewhere.
        self._solved = solution.state if solution is not None and step.scheme.step_over_trial == 1.0 else None
        if self._solved is not None:
            for results in self._results.values():
                results.solved(self._solved)
        self.system.clock.add("line solver", since)
        return failure if solution is None else solution

    def leave_to_parts(self) -> bool:
        """Get the parts ready to solve a step that could not be solved here; whether they may."""
        ready = [each.leave_to_parts() for each in self._couplings]
        return any(ready)

    def _iterate(self, trial: StepTrial, limits: StopLimits) -> tuple[str, list[float]]:
        """Why the step is not solved, "" where it is; norms of the residual on the way."""
        for _ in range(MOST_STARTS):
            for each in self._couplings:
                each.begin(trial.step.before, trial.begun.t, trial.begun.u)
            self.packed.begin(trial.begun, trial.past, trial.weights, limits)
            ending, convergence = self.packed.solve(), self.packed.convergence
            self.iterations += convergence.iterations
            if ending == CONVERGED:
                holds = all(each.holds for each in self._couplings)
                return self._tangle(trial) or ("" if holds else OUTGROWN), convergence.norms
            if ending != OUTGROWN:
                break
            for each in self._couplings:
                each.widen()
        return failure_text(ending, convergence.norms, self._place()), convergence.norms

    def _limits(self, step: Step, settings: NewtonSettings, at_equilibrium: bool) -> StopLimits:
        """When Newton's iterations stop. A smooth motion takes an iteration at least, which reduces its load."""
        gradual = self.system.gradual and all(each.gradual for each in self._couplings)
        smooth = self.system.smooth
        done_at_start = smooth or at_equilibrium or self._moves_freely(step.guess)
        return limits_of(settings, smooth, gradual, done_at_start, step.scheme.step_over_trial)

    def _moves_freely(self, increments: Array) -> bool:
        """Whether increments are of more than prescribed dofs."""
        return np.count_nonzero(increments) > np.count_nonzero(increments[self.system.prescribed_dofs])

    def _tangle(self, trial: StepTrial) -> str:
        """Why the solution is not an admissible state of a line; "" where it is."""
        end = None if trial.step.scheme.step_over_trial == 1.0 else self._end(trial)
        for packed in self._lines:
            if isinstance(line := packed.line, Line):
                reason = line.folding(*packed.folding) if end is None else line.inadmissible(end, trial.step.before)
                if reason:
                    return reason
        return ""

    def _end(self, trial: StepTrial) -> State:
        """The solution at the step's end."""
        u, v, a = np.zeros(self.system.numbering.size), trial.begun.v.copy(), trial.begun.a.copy()
        for packed in self._lines:
            at = packed.line.part
            u[at], v[at], a[at] = packed.solution
        for each in self._couplings:
            each.put_increments(trial.weights, u, v, a)
        return trial.end_of(State(trial.begun.t, u, v, a, dt=trial.begun.dt))

    def _forces(self) -> Forces:
        """Forces of the last trial; on the free dofs of soil they are in balance."""
        forces = Forces.zeros(self.system.numbering.size)
        for packed in self._lines:
            at = packed.line.part
            forces.inertia[at], forces.force[at], forces.end[at] = packed.groups
        return forces

    def commit(self, state: State) -> None:
        """Accept the state of the step solved last."""
        if state is not self._solved:
            self.system.commit(state)
            return
        since = time.perf_counter()
        self.packed.keep()
        self.system.commit(state, self._committed)
        for results in self._results.values():
            results.commit()
        self.system.clock.add("line solver", since)

    def element_residual(self, line: Line, state: State) -> Array:
        of_line = self._results.get(line)
        residual = None if of_line is None else of_line.element_residual(state)
        return super().element_residual(line, state) if residual is None else residual

    def section_input(self, line: Line, state: State) -> Array:
        of_line = self._results.get(line)
        section_forces = None if of_line is None else of_line.section_input(state, lambda: self._on_ends(line, state))
        return super().section_input(line, state) if section_forces is None else section_forces

    def contact_results(self, contact: RiserContact, state: State) -> Array:
        of_line = self._results.get(contact.line)
        results = None if of_line is None else of_line.contact_results(contact)
        return super().contact_results(contact, state) if results is None else results

    def energy_exchanged(self, before: State, solution: Solution) -> tuple[Energy, dict[str, Work]]:
        """Energy stored at the end of the step solved last, and what each part turned over in it."""
        if solution.state is not self._solved:
            return super().energy_exchanged(before, solution)
        since = time.perf_counter()
        work = dict(self._no_work)
        self.packed.account(before)
        for packed in self._lines:
            packed.add_work(before, solution.state, work)
        energy = Energy(*as_list(self.packed.energy))
        for each in self._couplings:
            energy += each.add_account(before, solution.state, work)
        self.system.clock.add("line solver", since)
        return energy, work

    def _place(self) -> str:
        """The largest residual, in words."""
        system = self.system
        residual = np.zeros(system.numbering.size)
        for packed in self._lines:
            residual[packed.line.part] = packed.dofs.residual.ravel() / packed.dofs.levers.ravel()
        return place_of_largest(system, system.numbering.to_global(residual), system.numbering.first)
