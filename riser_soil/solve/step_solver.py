"""The solver of a stage's steps: Newton's method, or a compiled loop, and the balance of soil under lines held."""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING, Protocol

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.communicator import Communicator, destroyed_together
from riser_soil.core.part import Energy, Forces, Model, State, Work
from riser_soil.core.system import System, Timer
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.solve.chain import is_chain
from riser_soil.solve.newton import Newton
from riser_soil.solve.riser_mass import InverseMass
from riser_soil.solve.solution import NewtonSettings, NotConvergedError, Solution, Step
from riser_soil.solve.time_scheme import GeneralizedAlpha, Scheme, Static

if TYPE_CHECKING:
    from riser_soil.contact.contact import RiserContact

INSTANT = Static(seconds=0.0)  # what flows under rate keeps its stress


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


def balance_held(comm: Communicator, model: Model, t: float, settings: NewtonSettings, clock: Timer) -> None:
    """Find what the parts of group E, soil and contact, balance at while no line moves, and commit it. Where that fails
    it is left to the next step. Collective.
    """
    parts = [part for part in model.parts if part.traits.groups == "E"]
    with ExitStack() as stack:
        for line in model.lines:
            stack.enter_context(line.held())
        system = System(comm, Model(model.lines, parts, model.others), clock)
        newton = Newton(system, settings)
        with destroyed_together(comm, newton, system):
            size = system.numbering.size
            try:
                found = newton.solve(Step(INSTANT, State.at_rest(t, size), t, 0.0, None, np.zeros(size))).state
            except NotConvergedError:
                return
            for part in parts:
                if part.active:
                    part.commit(found)
            for field in model.others:
                field.commit(found)
