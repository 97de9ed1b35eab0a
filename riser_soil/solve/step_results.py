"""Results of solved steps and accepted states: energy, work, mass, section forces and contact."""

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
from riser_soil.solve.riser_mass import RiserMass
from riser_soil.solve.step import Solution
from riser_soil.solve.time_scheme import InverseMass

if TYPE_CHECKING:
    from riser_soil.contact.contact import RiserContact


class StepResults:
    """Energy, work, mass and section forces of solved steps and accepted states, by the parts of a system; collective.
    """

    def __init__(self, system: System) -> None:
        self.system = system

    def commit(self, state: State) -> None:
        """Accept the state of the step solved last."""
        self.system.commit(state)

    def energy_exchanged(self, before: State, solution: Solution) -> tuple[Energy, dict[str, Work]]:
        """Energy stored at the end of the step solved last, from the accepted state `before`, and what each part turned
        over in it, those of one name together.
        """
        return self.system.energy(solution.state), self.system.work(before, solution.state)

    @cached_property
    def mass(self) -> InverseMass:
        """Inverse of the lines' mass."""
        return RiserMass(self.system)

    def bulk_forces(self, state: State) -> Forces:
        """Forces of groups I and F at an accepted state, those of group E zero."""
        return self.system.forces(state, "IF")

    def element_residual(self, line: Line, state: State) -> Array:
        """Residual of a line's elements (ne, 2 ndof) at an accepted state, see `section_forces`; on the rank that has
        it, until the next call.
        """
        return element_residual(line, acting_on(line, self.system.model.parts), state)

    def section_forces(self, line: Line, elements: Elements, state: State) -> Array:
        """Section forces of a line at an accepted state, see `SectionForces.within`; on the rank that has it."""
        viscous = viscous_residual(line, acting_on(line, self.system.model.parts), state)
        return section_vector(line, elements, state, self.element_residual(line, state), viscous)

    def contact_results(self, contact: RiserContact, state: State) -> Array:
        """Results of a contact at an accepted state, see `ContactResults.within`; on the rank that evaluates it."""
        return contact.results(state)

    def nodal_residual(self, line: Line, state: State) -> Array | None:
        """Residual (nn, ndof) at an accepted state of what acts on a line's nodes without holding them, if anything."""
        return nodal_residual(line, acting_on(line, self.system.model.parts), state)
