"""The solver of a stage's steps: Newton's method over its parts, or in time steps of a riser a compiled loop."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, State, Work
from riser_soil.core.system import System
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.solve.chain import is_chain
from riser_soil.solve.newton import Newton
from riser_soil.solve.riser_mass import InverseMass
from riser_soil.solve.solution import NewtonSettings, Solution, Step
from riser_soil.solve.time_scheme import GeneralizedAlpha, Scheme

if TYPE_CHECKING:
    from riser_soil.contact.contact import RiserContact


class StepSolver(Protocol):
    """Newton's method for the steps of a stage; see `Newton`."""

    settings: NewtonSettings
    iterations: int
    rests: bool

    def solve(self, step: Step) -> Solution: ...

    def commit(self, state: State) -> None:
        """Accept the state of the step solved last."""
        ...

    def turned_over(self, before: State, solution: Solution) -> tuple[Energy, dict[str, Work]]:
        """Energy stored at the end of the step solved last, from the accepted state `before`, and what each part turned
        over in it, those of one name together; collective.
        """
        ...

    @property
    def mass(self) -> InverseMass:
        """Inverse of the lines' mass."""
        ...

    def bulk_forces(self, state: State) -> Forces:
        """Forces of groups I and F at an accepted state, those of group E zero; collective."""
        ...

    def element_residual(self, line: Line, state: State) -> Array:
        """Of a line's elements (ne, 2 ndof) at an accepted state, see `section_forces`; on the rank that has it, until
        the next call.
        """
        ...

    def section_forces(self, line: Line, elements: Elements, state: State) -> Array:
        """Of a line at an accepted state, see `SectionForces.within`; on the rank that has it."""
        ...

    def contact_results(self, contact: RiserContact, state: State) -> Array:
        """Of a contact at an accepted state, see `ContactResults.within`; on the rank that evaluates it."""
        ...

    def nodal_residual(self, line: Line, state: State) -> Array | None:
        """Of what acts on a line's nodes (nn, ndof) without holding them at an accepted state, if anything; the
        same.
        """
        ...

    def require_stable(self, solution: Solution) -> None: ...

    def renew(self) -> None: ...

    def destroy(self) -> None: ...


def solver_of(system: System, scheme: Scheme, settings: NewtonSettings) -> StepSolver:
    """`Newton`; or, where it can be and SNES is not asked for, the compiled loop: on one rank for a riser alone, or on
    condensed soil, in time steps of Newmark's scheme or generalised-alpha.
    """
    if system.comm.size > 1 or settings.snes or not isinstance(scheme, GeneralizedAlpha):
        return Newton(system, settings)
    if is_chain(system):
        from riser_soil.solve.riser_newton import riser_newton

        return riser_newton(system, settings) or Newton(system, settings)
    if system.whole_soil is None:
        from riser_soil.solve.condensed_newton import condensed_newton

        return condensed_newton(system, settings) or Newton(system, settings)
    return Newton(system, settings)
