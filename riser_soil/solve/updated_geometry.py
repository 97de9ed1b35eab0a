"""Geometry of a step of soil at large strain, by the updated Lagrangian formulation.

Strain, forces and areas of contact of a step are taken on one geometry, about which it is linear. With that of the
step's start the forces on the line would lag by a step. So it is the one to which the motion of the last steps would
lead if it continued, and where the solution is far off that, the solution's: the remaining error is of second order in
the step while the motion is smooth.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.roles import UpdatedLagrangian, with_role
from riser_soil.core.system import System
from riser_soil.solve.step import NotConvergedError, Solution, Step

if TYPE_CHECKING:
    from riser_soil.solve.newton import Newton

LAG = 1e-2  # of a facet's area, by which a solution may be off the geometry that it is solved on
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
        """Solve a step on the predicted geometry, then on that of the solution, while they are more than `LAG` apart;
        NotConvergedError if they don't come together. Forces are in balance on the last geometry, which stays.
        """
        solution = newton.solve(step)
        if not self._parts:
            return solution
        for _ in range(MOST_SOLUTIONS):
            if (lag := self._lag(solution.state)) <= LAG:
                return solution
            self._place(solution.state)
            again = newton.solve(replace(step, guess=solution.state.u), refined=True)
            solution = replace(again, iterations_before=solution.iterations)
        raise NotConvergedError(
            f"the soil's surface is off the geometry that its forces are computed on: a facet's area by {lag:.2g} of it"
        )

    def _lag(self, state: State) -> float:
        """Largest share by which a facet's area is off the geometry of its forces, of all parts; collective."""
        return max(self._system.comm.allgather(max(part.lag(state) for part in self._parts)))
