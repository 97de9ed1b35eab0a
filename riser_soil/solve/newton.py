"""Newton's method for the steps of a stage, by kernels of lines or over the parts; soil's balance under fixed lines."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from typing import TYPE_CHECKING

from riser_soil.core.communicator import Communicator, destroyed_together
from riser_soil.core.matrix import Patterns
from riser_soil.core.part import Forces, Model, State
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System, Timer
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step import NotConvergedError, Solution, Step, UnstableError
from riser_soil.solve.step_iteration import StepIteration
from riser_soil.solve.step_results import StepResults

if TYPE_CHECKING:
    from riser_soil.solve.line_solver import LineSolver

BALANCED = 1e-4  # of the forces in play, that a balance under fixed lines may lack


class Newton:
    """Solver of a system's steps by Newton's method. Create once a stage; collective, as it compiles what is missing.

    Time steps of lines and bodies are the line solver's (`lines`) where it is given; what it leaves, and all other
    steps, are solved over the parts (`by_parts`). iterations: of all steps, those that failed included. at_equilibrium:
    whether the next step starts from that of its own loads, so that a residual within round-off needs no iteration.
    accepted: results of solutions and accepted states.
    """

    def __init__(self, system: System, settings: NewtonSettings, lines: LineSolver | None = None) -> None:
        self.system, self.settings, self.lines = system, settings, lines
        self.at_equilibrium = False
        self.accepted: StepResults = StepResults(system) if lines is None else lines
        self._by_parts = StepIteration(system, settings) if lines is None else None
        system.compile()

    @property
    def by_parts(self) -> StepIteration:
        """Made with the first step that the line solver leaves."""
        if self._by_parts is None:
            self._by_parts = StepIteration(self.system, self.settings)
        return self._by_parts

    @property
    def iterations(self) -> int:
        solvers = self.lines, self._by_parts
        return sum(solver.iterations for solver in solvers if solver is not None)

    def solve(self, step: Step, refined: bool = False) -> Solution:
        """Solve a step or raise NotConvergedError; refined: whether its guess is a solution on another geometry of the
        soil. Collective.
        """
        near, self.at_equilibrium = self.at_equilibrium, False
        if self.lines is None:
            return self.by_parts.solve(step, near, refined)
        result = self.lines.solve(step, self.settings, near)
        if isinstance(result, Solution):
            return result
        if not self.lines.leave_to_parts():
            raise NotConvergedError(result)
        self.by_parts.renew()
        return self.by_parts.solve(step, near)

    def require_stable(self, solution: Solution) -> None:
        """Raise UnstableError where a static solution is an unstable equilibrium, such as an unbuckled strut.

        Stable means that the tangent there has no negative pivot, see `stability`. Parts that follow the line are left
        out of it; where others lack symmetry too, such as moments in space, nothing is judged. Collective.
        """
        negative = self.by_parts.unstable_modes(solution.state, solution.forces)
        if negative > 0:
            raise UnstableError(
                f"the equilibrium found is unstable (its tangent has {negative} negative pivot(s)): the riser would "
                "buckle or swing away from it; start from a shape nearer to the one that it takes",
                solution,
            )

    def unstable_modes(self, state: State, forces: Forces | None = None, doubtful: bool = False) -> int:
        """Number of negative pivots of the tangent at a static state, which are its unstable modes; collective."""
        return self.by_parts.unstable_modes(state, forces, doubtful)

    def renew(self) -> None:
        """Take a matrix of the pattern that the parts have now, and of the dofs that they act on, if any can change."""
        if self._by_parts is not None:
            self._by_parts.renew()

    def state(self) -> Saved:
        """Factors and the like, without which a resumed run would differ by round-off; the line solver has none."""
        return self.by_parts.state() if self.lines is None else {}

    def restore(self, saved: Saved) -> None:
        if self.lines is None:
            self.by_parts.restore(saved)

    def destroy(self) -> None:
        """Free what all ranks share; collective."""
        if self._by_parts is not None:
            self._by_parts.destroy()


def solver_of(system: System, dynamic: bool, settings: NewtonSettings) -> Newton:
    """`Newton`, with the line solver where it can be and SNES is not asked for: on one rank for lines and bodies, or
    for a line on condensed soil, in time steps.
    """
    lines = None
    if system.comm.size == 1 and not settings.snes and dynamic and system.whole_soil is None:
        from riser_soil.solve.line_solver import line_solver

        lines = line_solver(system)
    return Newton(system, settings, lines)


def balance_under_fixed_lines(
    comm: Communicator, model: Model, t: float, settings: NewtonSettings, clock: Timer, patterns: Patterns | None = None
) -> None:
    """Solve for the equilibrium of the parts of group E, soil and contact, while no line moves, and commit it: to
    `BALANCED`, as the next step balances the rest, or all of it where this fails. patterns: of earlier matrices, see
    `Matrix`. Collective.
    """
    settings = replace(settings, tolerance=max(settings.tolerance, BALANCED))
    parts = [part for part in model.parts if part.traits.groups == "E"]
    with ExitStack() as stack:
        for line in model.lines:
            stack.enter_context(line.all_prescribed())
        system = System(comm, replace(model, parts=parts), clock, patterns)
        newton = Newton(system, settings)
        with destroyed_together(comm, newton.destroy, system.destroy):
            before = State.at_rest(t, system.numbering.size)
            try:
                state = newton.solve(Step.static(before, seconds=0.0)).state  # what flows under rate keeps its stress
            except NotConvergedError:
                return
            for part in parts:
                if part.active:
                    part.commit(state)
            for field in model.others:
                field.commit(state)
