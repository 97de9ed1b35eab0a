"""Norms of a residual and of the forces in play, and the round-off of a residual.

The residual of a stiff line or contact is a small difference of large numbers: some eps EA of a bar that has turned,
eps k z of a penalty k at a height z, eps EI phi/L^2 of an element that has turned by an angle phi. The coordinates x
that the forces follow from are known to a rounding each, so that a row i of the residual may be off by

    eps sum_j |K_ij| |x_j|,

summed over the elements, their tangents K at fixed rates: a bound of the error of a sum of products in floating point
(Higham, Accuracy and Stability of Numerical Algorithms, 2002, 3.1), here with a factor for the few roundings of each
term. Where that is above what is allowed, Newton's method ends because it can improve nothing more. A load or time
step that stops so is solved as far as its round-off allows; a larger floor for the residual would hide small loads on
long lines instead.
"""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.communicator import all_of
from riser_soil.core.compiled import njit
from riser_soil.core.part import Forces
from riser_soil.core.system import System

EPS = float(np.finfo(float).eps)
ROUND_OFF = 8.0 * EPS  # of the sum of sizes; residuals at round-off were observed up to 2 eps of it


@njit
def square_of(residual: Array, levers: Array, first: int, last: int) -> float:
    """Square of the norm [N] of some rows of a residual, moments over the lever."""
    square = 0.0
    for k in range(first, last):
        square += (residual[k] / levers[k]) ** 2
    return square


@njit
def squares_in_play(
    inertia: Array, force: Array, end: Array, levers: Array, fixed: BoolArray, lines: int
) -> tuple[float, float, float]:
    """Squares of the norms [N] of the forces in play: reactions, inertia, and contact on the lines, whose dofs are the
    first ones. Forces by group (n,), see `Forces`; fixed: what is prescribed.
    """
    reactions, moving, contact = 0.0, 0.0, 0.0
    for k in range(fixed.size):
        own, pressed = inertia[k] / levers[k], end[k] / levers[k]
        moving += own**2
        if k < lines:
            contact += pressed**2
        if fixed[k]:
            reactions += (own + force[k] / levers[k] + pressed) ** 2
    return reactions, moving, contact


class ResidualNorm:
    """Norms of a system's residuals and of the forces in play [N], as its dofs are numbered now; collective."""

    def __init__(self, system: System) -> None:
        self._system, self._levers = system, system.numbering.to_global(system.levers)

    def of(self, f: Array) -> float:
        """Norm of a residual, of this rank's rows (owned,)."""
        return math.sqrt(self._system.sum([square_of(f, self._levers, 0, f.size)])[0])

    def largest(self, f: Array) -> str:
        """Place of a residual's largest entry, of this rank's rows (owned,), in words."""
        return place_of_largest(self._system, f / self._levers, self._system.numbering.first)

    def in_play(self, forces: Forces) -> float:
        """Norm of the forces in play."""
        system, groups = self._system, (forces.inertia, forces.force, forces.end)
        mine = squares_in_play(*groups, system.levers, system.prescribed, system.end_of_lines)
        return math.sqrt(max(system.sum([*mine])))


def place_of_largest(system: System, residual: Array, first: int) -> str:
    """The row with the largest residual, in words; collective.

    residual: this rank's [N], moments over the lever; its rows begin with `first`.
    """
    values = np.abs(residual)
    if not all_of(system.comm, bool(np.isfinite(values).all())):
        return "the residual is not finite"
    k = int(np.argmax(values)) if len(values) else -1
    mine = (float(values[k]), first + k) if k >= 0 else (-1.0, -1)
    worst, row = max(system.comm.allgather(mine))
    return f"the largest residual, {worst:.3g} N, sits at the {system.describe(row)}"


@njit
def above_round_off(residual: Array, terms: Array) -> bool:
    """Whether some entry of a residual is above its round-off. terms: sums [N] of its terms' magnitudes."""
    above = False
    for k in range(residual.size):
        above |= abs(residual[k]) > ROUND_OFF * terms[k]
    return above
