"""Progress of Newton's method: norms, tests of an iteration, line search along a step, round-off of the residual.

Where contact opens or soil is near its limit, a Newton step may lead far beyond the equilibrium. With the residual r as
the slope of an energy, g(a) = r(x + a d)·d falls to zero where the energy is least along the step d; g(0) < 0. A full
step is taken where it does not go far beyond that, else the zero is bracketed by false position, the slope at the end
that stays counting half each time (after the Illinois method, so that neither end stays for long).

Where soil flows its tangent all but vanishes, and increments are of any length, metres or kilometres. After such an
iteration, in which the residual has grown or only a short part of the step was taken, the tangent gets a share of the
elastic one, ten times as much each time, which bounds the increments as the damping of Levenberg and Marquardt does. As
the residual falls it is taken back, so that Newton's method ends with its own tangent. Where the residual crawls under
the elastic tangent alone, the step is given up: hundreds of iterations would not do.

Round-off of the residual: where Newton's method ends because nothing is left that it could improve.

The residual of a stiff line or contact is a small difference of large numbers: some eps EA of a bar that has turned,
eps k z of a penalty k at a height z, eps EI phi/L^2 of an element that has turned by an angle phi. The coordinates x
that the forces follow from are known to a rounding each, so that a row i of the residual can't be told from

    eps sum_j |K_ij| |x_j|,

summed over the elements, their tangents K at held rates: a bound of the error of a sum of products in floating point
(Higham, Accuracy and Stability of Numerical Algorithms, 2002, 3.1), here with a factor for the few roundings of each
term. Where that is above what is allowed, the norms of the residual stay as they are. A load or time step that stops so
is solved as far as it can be told; a larger floor for the residual would hide small loads on long lines instead.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.communicator import all_of
from riser_soil.core.compiled import njit
from riser_soil.core.part import Forces
from riser_soil.core.roles import Yielding
from riser_soil.core.system import System

GOING_ON, CONVERGED, NOT_FINITE, SINGULAR, DIVERGED, TOO_MANY, OUTGROWN = range(7)
NAMES = (  # of these outcomes, failures by PETSc's names
    "iterating",
    "converged",
    "diverged_fnorm_nan",
    "diverged_linear_solve",
    "diverged_dtol",
    "diverged_max_it",
    "outgrown",
)
DIVERGES = 1e6  # times the first norm

FAR = 0.5  # of the slope at the start: up to this slope beyond the zero the full step is taken
NEAR = 0.25  # of the slope at the start: near enough to zero
MOST = 10  # evaluations of the slope within the step
STALLED = 0.5  # the norm of a residual that falls by less in each of two iterations stays as it is
EPS = float(np.finfo(float).eps)
ROUND_OFF = 8.0 * EPS  # of the sum of sizes; residuals that stayed were found at up to 2 eps of it


FIRST_SHARE, MORE = 1e-4, 10.0  # of the elastic tangent, and how much more or less of it the next iteration has
SHORT, FALLEN = 0.3, 0.7  # part of a step that is short; share of the residual left where it falls
CRAWLS, IN_A_ROW = 0.9, 4  # share left where it falls in vain; so many times


class ElasticShare:
    """The share of the elastic tangent in that of parts that yield; see the module's text.

    length: part of the last step that was taken; crawled: how often in a row all of the elastic tangent has left most
    of the residual.
    """

    def __init__(self, parts: Sequence[Yielding]) -> None:
        self._parts, self._share, self.length, self.crawled = parts, 0.0, 1.0, 0

    def reset(self) -> None:
        """None, as where a step begins."""
        self.length, self.crawled = 1.0, 0
        self._give(0.0)

    def adapt(self, norm: float, before: float) -> None:
        """For the tangent after an iteration, by the norms of the residual then and before."""
        if not self._parts:
            return
        self.crawled = self.crawled + 1 if self._share == 1.0 and CRAWLS * before < norm <= before else 0
        if self.length < SHORT or norm > before:
            self._give(min(1.0, max(MORE * self._share, FIRST_SHARE)))
        elif norm < FALLEN * before:
            self._give(self._share / MORE if self._share > FIRST_SHARE else 0.0)

    @property
    def in_vain(self) -> bool:
        """Whether no number of iterations would do."""
        return self.crawled >= IN_A_ROW

    def _give(self, share: float) -> None:
        if share != self._share:
            self._share = share
            for part in self._parts:
                part.mix_elastic(share)


def step_length(start: float, slope: Callable[[float], float]) -> float:
    """Part of a step to take, -1 to 1. start: slope at its beginning; slope: of the energy at a part of the step."""
    if start > 0.0:
        return -step_length(-start, lambda part: -slope(-part))
    end = slope(1.0)
    if end <= FAR * -start:
        return 1.0
    low, high, below, above = 0.0, 1.0, start, end
    for _ in range(MOST):
        part = _between(low, high, below, above)
        found = slope(part)
        if abs(found) <= NEAR * -start:
            break
        if found < 0.0:
            low, below, above = part, found, 0.5 * above
        else:
            high, above, below = part, found, 0.5 * below
    return part


def _between(low: float, high: float, below: float, above: float) -> float:
    """The secant's zero, kept from both ends by a twentieth; the middle where a slope is not finite."""
    middle = 0.5 * (low + high)
    if not math.isfinite(above - below):
        return middle
    part = low - below * (high - low) / (above - below)
    edge = 0.05 * (high - low)
    return min(max(part, low + edge), high - edge)


class NewtonProgress(NamedTuple):
    """norms (most + 1,): of the residuals [N] so far; apart (most + 1,): of their share at nodes that nothing touches;
    ending (2,): the outcome, and the iterations taken.
    """

    norms: Array
    apart: Array
    ending: IntArray


class StopLimits(NamedTuple):
    """When to stop, see `NewtonSettings`.

    reuse: an iteration that leaves less than this share of the residual leaves its tangent to the next, but contact's
    share, which is found anew, as contact has corners. most, least: iterations; answers_load: whether a residual below
    the floor counts as small before the first one.
    """

    tolerance: float
    floor: float
    reuse: float
    most: int
    least: int
    answers_load: bool


@njit
def verdict(norm: float, in_play: float, taken: int, limits: StopLimits) -> int:
    """What the norm [N] of the residual after so many iterations tells, beside that of the forces in play."""
    if not math.isfinite(norm):
        return NOT_FINITE
    if taken < limits.least:
        return GOING_ON
    small = norm <= limits.floor and (taken > 0 or limits.answers_load)
    return CONVERGED if small or norm <= limits.tolerance * in_play else GOING_ON


@njit
def diverges(norm: float, first: float, taken: int, limits: StopLimits) -> bool:
    """Whether a step that goes on does so in vain. first: its first norm [N]."""
    return taken >= max(4, limits.least) and norm > DIVERGES * first


@njit
def leaves_tangent(norm: float, before: float, apart: float, reuse: float) -> bool:
    """Whether an iteration leaves its tangent, but contact's share, to the next: where it has left little of the
    residual's norm before, or little of it where nothing touches, `apart` [N].
    """
    return norm < STALLED * before and min(norm / before, apart / norm) < reuse


@njit
def square_of(residual: Array, levers: Array, first: int, last: int) -> float:
    """Square of the norm [N] of some rows of a residual, moments over the lever."""
    found = 0.0
    for k in range(first, last):
        found += (residual[k] / levers[k]) ** 2
    return found


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
        """Where it is largest, in words."""
        return place_of_largest(self._system, f / self._levers, self._system.numbering.first)

    def in_play(self, forces: Forces) -> float:
        """Norm of the forces in play."""
        system, groups = self._system, (forces.inertia, forces.force, forces.end)
        mine = squares_in_play(*groups, system.levers, system.prescribed, system.end_of_lines)
        return math.sqrt(max(system.sum([*mine])))


def largest_at(residual: float, place: str) -> str:
    """The largest residual [N] and its place, in words."""
    return f"the largest residual, {residual:.3g} N, sits at the {place}"


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
    return largest_at(worst, system.describe(row))


@njit
def stalled(norms: Array) -> bool:
    """Whether the last two iterations have left the residual's norm as it is, of all its norms so far (n,)."""
    if norms.size < 3:
        return False
    return norms[-1] > STALLED * norms[-2] and norms[-2] > STALLED * norms[-3]


@njit
def above_round_off(residual: Array, terms: Array) -> bool:
    """Whether something in a residual can be told from its round-off. terms: sizes [N] of what it is the sum of."""
    above = False
    for k in range(residual.size):
        above |= abs(residual[k]) > ROUND_OFF * terms[k]
    return above
