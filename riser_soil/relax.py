"""Dynamic relaxation: pseudo-time steps through an artificial drag, until equilibrium needs none.

Used when Newton's method finds no equilibrium from the shape that a static stage starts with, and reported when used.
The way there is none that the riser takes: the ground remembers nothing of it but its end.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from mpi4py import MPI

from riser_soil.errors import SolveError
from riser_soil.newton import Newton, NewtonSettings, NotConvergedError, Solution, Step, UnstableError
from riser_soil.part import Model, State
from riser_soil.riser.line import Line
from riser_soil.riser.relaxation import Relaxation
from riser_soil.roles import Remembering
from riser_soil.system import Clock, System
from riser_soil.time_scheme import Static

FREE_FALL = 0.1  # the first step lets the riser fall by about this many element lengths
STIFFEST = 1e8  # drag over the first
MOST_STEPS = 2000
NUDGE = 1e-4  # element lengths
MOST_ATTEMPTS = 50  # at an equilibrium without drag
QUICK = 6  # Newton iterations up to which the drag is lowered
NEARLY_THERE = 1e-2  # largest increment, in element lengths, from which equilibrium without drag is tried


def relax(
    comm: MPI.Intracomm, model: Model, line: Line, weight: float, settings: NewtonSettings, clock: Clock, t: float
) -> int:
    """Bring the line to equilibrium at the load factor t and commit it; the number of Newton iterations spent.

    weight: typical force per length [N/m]. Raises SolveError when no equilibrium is found.
    """
    part = Relaxation(line, weight / (FREE_FALL * line.length.min()))
    system = System(comm, Model(model.fields, [*model.parts, part]), clock)
    newton = Newton(system, settings)
    try:
        return _descend(system, newton, part, line, t)
    finally:
        newton.destroy()
        system.destroy()


@dataclass
class Attempts:
    """At an equilibrium without drag. After n failures for want of stability the next comes n steps later."""

    failures: int = 0
    wait: int = 0

    def due(self) -> bool:
        self.wait -= 1
        return self.wait <= 0

    def count(self, failure: NotConvergedError) -> None:
        self.failures += 1
        self.wait = self.failures if isinstance(failure, UnstableError) else 0
        if self.failures == MOST_ATTEMPTS:
            raise SolveError(f"dynamic relaxation ends in no stable equilibrium: {failure}") from failure


def _descend(system: System, newton: Newton, part: Relaxation, line: Line, t: float) -> int:
    stiffest, iterations, moved, attempts = part.drag * STIFFEST, 0, np.inf, Attempts()
    for _ in range(MOST_STEPS):
        if moved < NEARLY_THERE * line.length.min() and attempts.due():
            found = _without_drag(system, newton, part, line, t, attempts)
            if found is not None:
                return iterations + found.iterations
        try:
            solution = _step(system, newton, part, t, part.drag)
        except NotConvergedError as failure:
            part.drag *= 8.0
            if part.drag > stiffest:
                raise SolveError(f"dynamic relaxation fails even in tiny pseudo-time steps: {failure}") from failure
            continue
        iterations += solution.iterations
        moved = _largest_increment(system, line, solution)
        part.drag *= 0.4 if solution.iterations <= QUICK else 1.0
    raise SolveError(f"dynamic relaxation finds no equilibrium in {MOST_STEPS} pseudo-time steps")


def _without_drag(
    system: System, newton: Newton, part: Relaxation, line: Line, t: float, attempts: Attempts
) -> Solution | None:
    """An equilibrium where there is a stable one; nudged off where it is not."""
    try:
        return _step(system, newton, part, t, drag=0.0)
    except NotConvergedError as failure:
        attempts.count(failure)
        if isinstance(failure, UnstableError):
            _nudge(system, line, t)
    return None


def _step(system: System, newton: Newton, part: Relaxation, t: float, drag: float) -> Solution:
    """A pseudo-time step with the given drag, committed.

    It must end in an equilibrium that is stable, with the drag where there is one: a longer step would not follow a
    riser that falls away from an unstable one, but return to it.
    """
    usual, part.drag = part.drag, drag
    size = system.numbering.size
    step = Step(Static(), State.at_rest(t, size), t, 0.0, None, np.zeros(size))
    try:
        solution = newton.solve(step)
        newton.require_stable(step, solution)
    finally:
        part.drag = usual
    if drag > 0.0:
        _pass_through(system, solution.state)
    else:
        system.commit(solution.state)
    return solution


def _pass_through(system: System, state: State) -> None:
    """Commit a state that is none of the stage's, so that its forces leave no trace."""
    remembering = [part for part in system.model.parts if isinstance(part, Remembering)]
    kept = [part.memory for part in remembering]
    system.commit(state)
    for part, memory in zip(remembering, kept, strict=True):
        part.memory = memory


def _nudge(system: System, line: Line, t: float) -> None:
    """Move the free nodes off a symmetric shape, by little and always in the same way, and commit."""
    state = State.at_rest(t, system.numbering.size)
    moves = np.random.default_rng(1).uniform(-NUDGE, NUDGE, (line.nodes, line.dimension)) * line.length.min()
    line.nodal(state.u)[:, : line.dimension] = moves
    state.u[system.held] = 0.0
    _pass_through(system, state)


def _largest_increment(system: System, line: Line, solution: Solution) -> float:
    """Longest translation [m] of the step, the same on all ranks, as every rank holds the riser."""
    return float(np.abs(line.nodal(solution.state.u)[:, : line.dimension]).max())
