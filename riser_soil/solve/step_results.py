"""Results of solved steps and accepted states: energy, work, mass, section forces and contact."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, Part, State, Work
from riser_soil.core.system import System
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart, LineParts, acting_on, joined
from riser_soil.riser.section_forces import (
    element_residual,
    nodal_residual,
    on_ends,
    placed,
    section_input,
    viscous_residual,
)
from riser_soil.solve.inverse_mass import InverseMass
from riser_soil.solve.step import Solution

if TYPE_CHECKING:
    from riser_soil.contact.contact import RiserContact


class StepResults:
    """Energy, work, mass and section forces of solved steps and accepted states, by the parts of a system; collective.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        self._acting: dict[Line, list[LinePart | LineParts]] = {}

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
        """Inverse of the mass of lines and bodies, and of soil with inertia."""
        return InverseMass(self.system)

    def bulk_forces(self, state: State) -> Forces:
        """Forces of groups I and F at an accepted state, those of group E zero."""
        forces = Forces.zeros(self.system.numbering.size)
        for part in self._bulk:
            part.residual(state, forces)
        return forces

    @cached_property
    def _bulk(self) -> list[Part | LineParts]:
        bulk = (part for part in self.system.model.parts if part.active and part.traits.groups != "E")
        return joined(bulk, accepted=True)

    def element_residual(self, line: Line, state: State) -> Array:
        """Residual of a line's elements (ne, 2 ndof) at an accepted state, see `riser.section_forces`; on the rank that
        has it, until the next call.
        """
        if line not in self._acting:
            self._acting[line] = joined(acting_on(line, self.system.model.parts))
        return element_residual(line, self._acting[line], state)

    def section_input(self, line: Line, state: State) -> Array:
        """Input of a line's section forces at an accepted state, see `SectionInput`; on the rank that has it."""
        acting = acting_on(line, self.system.model.parts)
        residual, viscous = self.element_residual(line, state), viscous_residual(line, acting, state)
        return section_input(line, placed(line, state), residual, viscous, self._on_ends(line, state))

    def _on_ends(self, line: Line, state: State) -> Array | None:
        """Loads on the two nodes at the line's ends, which are no section forces."""
        return on_ends(line, state, nodal_residual(line, acting_on(line, self.system.model.parts), state))

    def contact_results(self, contact: RiserContact, state: State) -> Array:
        """Results of a contact at an accepted state, see `ContactResults.within`; on the rank that evaluates it."""
        return contact.results(state)
