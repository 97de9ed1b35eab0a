"""Base class of the solvers of a stage's steps: what is asked of accepted states, by the methods of the parts."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, State, Work
from riser_soil.core.system import System
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import acting_on
from riser_soil.riser.section_forces import element_residual, nodal_residual, section_vector, viscous_residual
from riser_soil.riser.sections import Elements
from riser_soil.solve.riser_mass import InverseMass, RiserMass
from riser_soil.solve.solution import NewtonSettings, Solution, Step

if TYPE_CHECKING:
    from riser_soil.contact.contact import RiserContact


class StepSolver:
    """Solver of a system's steps. Create once a stage.

    iterations: of all its steps, those that failed included. rests: whether the next step starts from the equilibrium
    of its own loads, so that a residual within round-off needs no iteration.
    """

    def __init__(self, system: System, settings: NewtonSettings) -> None:
        self.system, self.settings = system, settings
        self.iterations, self.rests = 0, False

    def solve(self, step: Step) -> Solution:
        """Solve a step or raise NotConvergedError; collective."""
        raise NotImplementedError

    def commit(self, state: State) -> None:
        """Accept the state of the step solved last."""
        self.system.commit(state)

    def turned_over(self, before: State, solution: Solution) -> tuple[Energy, dict[str, Work]]:
        """Energy stored at the end of the step solved last, from the accepted state `before`, and what each part turned
        over in it, those of one name together; collective.
        """
        return self.system.energy(solution.state), self.system.work(before, solution.state)

    @cached_property
    def mass(self) -> InverseMass:
        """Inverse of the lines' mass."""
        return RiserMass(self.system)

    def bulk_forces(self, state: State) -> Forces:
        """Forces of groups I and F at an accepted state, those of group E zero; collective."""
        return self.system.forces(state, "IF")

    def element_residual(self, line: Line, state: State) -> Array:
        """Of a line's elements (ne, 2 ndof) at an accepted state, see `section_forces`; on the rank that has it, until
        the next call.
        """
        return element_residual(line, acting_on(line, self.system.model.parts), state)

    def section_forces(self, line: Line, elements: Elements, state: State) -> Array:
        """Of a line at an accepted state, see `SectionForces.within`; on the rank that has it."""
        viscous = viscous_residual(line, acting_on(line, self.system.model.parts), state)
        return section_vector(line, elements, state, self.element_residual(line, state), viscous)

    def contact_results(self, contact: RiserContact, state: State) -> Array:
        """Of a contact at an accepted state, see `ContactResults.within`; on the rank that evaluates it."""
        return contact.results(state)

    def nodal_residual(self, line: Line, state: State) -> Array | None:
        """Of what acts on a line's nodes (nn, ndof) without holding them, if anything, at an accepted state."""
        return nodal_residual(line, acting_on(line, self.system.model.parts), state)

    def require_stable(self, solution: Solution) -> None:
        """Time steps need not be stable equilibria."""

    def renew(self) -> None:
        """Take a matrix of the pattern that the parts have now, if any can change."""

    def destroy(self) -> None:
        """Give back what the ranks hold together; collective."""
