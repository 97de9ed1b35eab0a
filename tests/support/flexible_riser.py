"""The 350 m flexible riser of da Silva et al. (CILAMCE 2017, section 3.1), hanging, by elements and by its
equations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_bvp

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser import shapes
from riser_soil.riser.beam import Beam
from riser_soil.riser.catenary import Catenary, catenary
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End
from riser_soil.riser.section_forces import SectionForces, element_residual
from riser_soil.riser.sections import Elements, Surroundings
from tests.support.dense_chain import solve
from tests.support.pipes import pipe
from tests.support.sections import section_forces

LENGTH, TOP = 350.0, np.array([150.0, 0.0, 150.0])
EI, EA = 20.96e3, 15.38e8
KIND = {"EA": EA, "GJ": 2.0e4, "outer_diameter": 0.26, "inner_diameter": 0.20, "mass": 57.5}
FLOODED = Surroundings(gravity=9.81, contents=1025.0, water=1025.0)


@dataclass(frozen=True, eq=False)
class Hanging:
    """Static solution."""

    line: Line
    sections: SectionForces
    iterations: int

    @property
    def H(self) -> float:
        return float(self.sections.end_force[1, 0])

    @property
    def largest_moment(self) -> float:
        return float(self.sections.bending_moment.max())

    @property
    def start_angle(self) -> float:
        """Degrees below the horizontal."""
        tangent = self.line.trial(State.at_rest(1.0, self.line.size)).turn.tangent[0, 0] @ self.line.basis.T
        return float(np.degrees(np.arctan2(-tangent[2], tangent[0])))


def properties(count: int, EI: float = EI) -> Elements:
    return pipe(LENGTH, count, FLOODED, EI=EI, **KIND)


def guess(e: Elements) -> Catenary:
    return catenary(e.arc, np.zeros(3), TOP, float(e.weight[0]), EA)


def hang(count: int, dimension: int = 2, EI: float = EI) -> Hanging:
    """Newton from the catenary."""
    e = properties(count, EI)
    layout = shapes.layout(e.arc, e.outer_diameter, shapes.straight(e.arc), guess(e).curve)
    line = Line(dimension, layout, End(True), End(True), prescribe_spin=True)
    beam = Beam(line, e)
    iterations = solve(line, [beam])
    state = State.at_rest(1.0, line.size)
    inside = section_forces(line, e, state, element_residual(line, [beam], state))
    return Hanging(line, inside, iterations)


def elastica_H() -> tuple[float, float]:
    """H and the vertical force at the start of the extensible elastica, from its boundary value problem.

    With force (H, V0 + w s) on the section and strain e = T/EA: x' = (1 + e) cos, z' = (1 + e) sin, EI theta'
    = M, M' = (1 + e) (H sin - V cos); both ends pinned. Lengths are over LENGTH, forces over w
    LENGTH.
    """
    e = properties(700)
    weight = float(e.weight[0]) * LENGTH
    answer, stiff, axial = guess(e), EI / (weight * LENGTH**2), EA / weight

    def slopes(s: Array, y: Array, p: Array) -> Array:
        cos, sin, V = np.cos(y[2]), np.sin(y[2]), p[1] + s
        stretch = 1.0 + (p[0] * cos + V * sin) / axial
        return np.stack([stretch * cos, stretch * sin, y[3] / stiff, stretch * (p[0] * sin - V * cos)])

    def ends(first: Array, last: Array, _: Array) -> Array:
        goal = TOP / LENGTH
        return np.array([first[0], first[1], first[3], last[0] - goal[0], last[1] - goal[2], last[3]])

    tangent = np.append(answer.curve.tangent[:, 0], answer.curve.tangent[-1:, 1], axis=0)
    theta = np.unwrap(np.arctan2(tangent[:, 2], tangent[:, 0]))
    y = np.stack([*(answer.curve.position[:, [0, 2]].T / LENGTH), theta, stiff * np.gradient(theta, e.arc / LENGTH)])
    forces = np.array([answer.H, -answer.tension[0] * abs(tangent[0, 2])]) / weight
    solution = solve_bvp(slopes, ends, e.arc / LENGTH, y, forces, tol=1e-10, max_nodes=200_000)
    assert solution.success, solution.message
    return float(solution.p[0] * weight), float(solution.p[1] * weight)
