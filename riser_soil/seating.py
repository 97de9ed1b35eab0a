"""Seating: the riser comes to rest on its cushion, before the soil is there to bear it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.core.communicator import destroyed_together
from riser_soil.core.part import Model, State
from riser_soil.core.system import System, Timer
from riser_soil.solve.dynamic_relaxation import relax
from riser_soil.solve.newton import Newton
from riser_soil.solve.solution import NewtonSettings, NotConvergedError, Step
from riser_soil.solve.time_scheme import Static


def seat(assembly: Assembly, model: Model, settings: NewtonSettings, clock: Timer) -> None:
    """Find the riser's equilibrium on the cushion at the load factor 0 and commit it; collective.

    By Newton's method, else by dynamic relaxation: SolveError where that finds none either.
    """
    absent = [*assembly.soil_parts, *assembly.on_soil]
    alone = Model(model.lines, [part for part in model.parts if not any(part is each for each in absent)])
    system = System(assembly.comm, alone, clock)
    newton = Newton(system, replace(settings, line_search=False))
    with destroyed_together(assembly.comm, newton.destroy, system.destroy):
        try:
            size = system.numbering.size
            solution = newton.solve(Step(Static(), State.at_rest(0.0, size), 0.0, 1.0, None, np.zeros(size)))
            newton.require_stable(solution)
            system.commit(solution.state)
        except NotConvergedError:
            relax(assembly.comm, alone, assembly.line, assembly.scales.weight, settings, clock, 0.0)
