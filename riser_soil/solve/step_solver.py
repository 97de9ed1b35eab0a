"""The solver of a stage's steps: Newton's method, or a compiled loop, and the balance of soil under lines held."""

from __future__ import annotations

from contextlib import ExitStack

import numpy as np

from riser_soil.core.communicator import Communicator, destroyed_together
from riser_soil.core.matrix import Patterns
from riser_soil.core.part import Model, State
from riser_soil.core.system import System, Timer
from riser_soil.solve.newton import Newton
from riser_soil.solve.solver import NewtonSettings, NotConvergedError, Step, StepSolver
from riser_soil.solve.time_scheme import Scheme, Static

INSTANT = Static(seconds=0.0)  # what flows under rate keeps its stress


def solver_of(system: System, scheme: Scheme, settings: NewtonSettings) -> StepSolver:
    """`Newton`; or, where it can be and SNES is not asked for, the compiled loop: on one rank for lines and bodies, or
    for a line on condensed soil, in time steps.
    """
    if system.comm.size > 1 or settings.snes or not scheme.dynamic:
        return Newton(system, settings)
    if system.whole_soil is None:
        from riser_soil.solve.compiled_newton import compiled_newton

        return compiled_newton(system, settings) or Newton(system, settings)
    return Newton(system, settings)


def balance_held(
    comm: Communicator, model: Model, t: float, settings: NewtonSettings, clock: Timer, known: Patterns | None = None
) -> None:
    """Find what the parts of group E, soil and contact, balance at while no line moves, and commit it. Where that fails
    it is left to the next step. known: see `Matrix`. Collective.
    """
    parts = [part for part in model.parts if part.traits.groups == "E"]
    with ExitStack() as stack:
        for line in model.lines:
            stack.enter_context(line.held())
        system = System(comm, Model(model.lines, parts, model.others), clock, known)
        newton = Newton(system, settings)
        with destroyed_together(comm, newton.destroy, system.destroy):
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
