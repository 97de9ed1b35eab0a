"""Geometry of a step of soil at large strain, by the updated Lagrangian formulation.

Strain, forces and areas of contact of a step are taken on one geometry, about which it is linear. With that of the
step's start the forces on the line would lag by a step. So it is the one to which the motion of the last steps would
lead if it continued, and then that of the solution, until both are one as far as the line can feel.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State
from riser_soil.core.roles import UpdatedLagrangian, with_role
from riser_soil.core.system import System
from riser_soil.solve.step import NotConvergedError, Solution, Step

if TYPE_CHECKING:
    from riser_soil.solve.newton import Newton

LAG = 1e-4  # of the largest force of the soil on a line, by which a solution may change one through its geometry
ROUGHLY = 1e-4  # of the forces in play, that the first solution may lack of balance
MOST_SOLUTIONS = 8


class UpdatedGeometry:
    """Geometry of the parts that are linear about one, step by step; without any, steps are solved as they are."""

    def __init__(self, system: System) -> None:
        self._system = system
        parts: list[UpdatedLagrangian] = with_role(system.model.parts, UpdatedLagrangian)
        self._parts = [part for part in parts if part.moves]

    def place(self, before: State, increments: Array) -> None:
        """Take the geometry that increments (size,) from an accepted state lead to; collective."""
        if self._parts:
            self._place(replace(before, u=increments))

    def _place(self, state: State) -> None:
        for part in self._parts:
            part.place(state)

    def solve(self, newton: Newton, step: Step) -> Solution:
        """Solve a step, at first roughly, and again on the geometry of the last solution, until that changes no force
        of the soil on a line by more than a share `LAG` of the largest; NotConvergedError if it doesn't settle.
        """
        if not self._parts:
            return newton.solve(step)
        rough = newton.solve(step, tolerance=ROUGHLY)
        self._place(rough.state)
        guess, norms = rough.state.u, rough.norms
        for _ in range(MOST_SOLUTIONS):
            found = newton.solve(replace(step, guess=guess), refined=True)
            before, state = self._forces_on_lines(found.state), replace(found.state)  # which the parts evaluate anew
            guess, norms = state.u, [*norms, *found.norms[1:]]
            self._place(state)
            if self._change(before, self._forces_on_lines(state)) <= LAG:
                return replace(found, state=state, norms=norms)
        raise NotConvergedError(
            f"the soil's geometry changes the forces on it by more than {LAG:g} of the largest, "
            f"{MOST_SOLUTIONS} times in a row"
        )

    def _forces_on_lines(self, state: State) -> Array:
        """Forces (parts, n) of each part of group E at a state on the n dofs of lines [N], moments over the lever."""
        lines, found = slice(self._system.end_of_lines), []
        for part in self._system.model.parts:
            if part.active and part.traits.groups == "E":
                forces = Forces.zeros(state.u.size)
                part.residual(state, forces)
                found.append(forces.end[lines] / self._system.levers[lines])
        return np.array(found)

    def _change(self, before: Array, after: Array) -> float:
        """Largest change of a force on a line, over the largest of the parts whose forces change; collective."""
        changed = (after != before).any(axis=1)
        forces = (after - before).sum(axis=0), before[changed].sum(axis=0)
        mine = [float(np.abs(f).max(initial=0.0)) for f in forces]
        change, largest = np.max(self._system.comm.allgather(mine), axis=0)
        return float(change / largest) if change > 0.0 else 0.0
