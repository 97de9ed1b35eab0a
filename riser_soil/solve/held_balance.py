"""Balance of the soil under the lines while these are held, as after it has gone over to a new mesh."""

from __future__ import annotations

from contextlib import ExitStack

import numpy as np

from riser_soil.core.communicator import Communicator, destroyed_together
from riser_soil.core.part import Model, State
from riser_soil.core.system import System, Timer
from riser_soil.solve.newton import Newton
from riser_soil.solve.solution import NewtonSettings, NotConvergedError, Step
from riser_soil.solve.time_scheme import Static

INSTANT = Static(seconds=0.0)  # what flows under rate keeps its stress


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
