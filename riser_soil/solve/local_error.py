"""Predictor of a step's increments, estimate of its local error, and energy gain: what steps make out of nothing.

While the acceleration changes linearly, Newmark's displacement misses (beta - 1/6) dt^2 (a(n+1) - a(n)) of the Taylor
series (Zienkiewicz & Xie, A simple error estimator and adaptive time stepping procedure for dynamic analysis,
Earthquake Engineering and Structural Dynamics 20, 1991), and its velocity (gamma - 1/2) dt (a(n+1) - a(n)), which is a
displacement too one step later. What contact adds to the accelerations counts with beta = 1/2 and gamma = 1 (see
`time_scheme`). Neither is filtered: an impact shorter than the step shows as an error of the order of the displacement
that it reverses.

Accelerations of generalised-alpha lag behind: a(n) belongs to the time t(n) - lag dt. Where stiff forces prescribe the
motion, as a riser's stiffness in tension does, the displacement is exact and the velocity takes what it misses instead:
it is off by -stiff_lag dt^2 da/dt. Where steps change size, both are brought from the last step's lag to that of the
next. The first keeps the second order; without the second, each change of size sets off an oscillation of the tension
from step to step (compare Brüls & Arnold, The generalized-alpha scheme as a linear multistep integrator, Journal of
Computational and Nonlinear Dynamics 3, 2008, on the first). It changes velocities by no more than the error of the
scheme.

Energy gain: what the steps of a dynamic stage make out of nothing, and the steps that are rejected for it.

A step that creates much energy at once is a root of the equations far from the motion that it continues, or too long.
Steps that follow a line through buckling or a snap may each create a little and never give it back: in the end the
line is torn by what the scheme has put in. So their sum counts, too, beside what has been turned over. Of a step there
counts what may have gone into motion, at most the kinetic energy: what a slow pipe seems to gain that is pressed into
soil in long steps is the error of its mean force, which moves nothing.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.part import Energy, Forces, State
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.solve.time_scheme import GeneralizedAlpha, InverseMass, Scheme

CONTACT = GeneralizedAlpha.newmark(0.5, 1.0)
FAR = 4.0  # times the last step: how far ahead its jerk is trusted
SAME = 1e-9  # of a step: two steps that differ by round-off
SMOOTH, GRADUAL, ROUGH = 4, 3, 1  # steps that a motion is continued from, at most
PARABOLA = 2
FALL = 0.5  # at most, of each term beyond the parabola to the one before
LARGEST = 0.2  # of the energy in motion: what a step may make out of nothing
SUM, SMALL = 0.25, 0.025  # of that share: of what was turned over, for the sum of steps; for a step that adds to it


class LocalError:
    """Local error of the steps of a stage, in the displacements of the riser [m]; collective."""

    def __init__(self, system: System, scheme: Scheme, mass: InverseMass) -> None:
        self._system, self._scheme, self._mass = system, scheme, mass
        self._jerk: Array | None = None
        self._dt = 0.0

    def start(self, before: State, dt: float) -> State:
        """The accepted state as a step of size dt starts from it; the same object where nothing is to be done."""
        scheme, last, to = self._scheme, self._dt, min(dt, FAR * self._dt)
        unlagged = scheme.lag == scheme.stiff_lag == 0.0
        if self._jerk is None or unlagged or abs(dt - last) < SAME * dt:
            return before
        v = before.v + scheme.stiff_lag * (last**2 - to**2) * self._jerk
        return replace(before, v=v, a=before.a + scheme.lag * (last - to) * self._jerk)

    def accept(self, start: State, after: State, dt: float) -> None:
        """Keep how fast the accelerations changed in a step from `start` to the accepted state `after`."""
        self._jerk, self._dt = (after.a - start.a) / dt, dt
        self._jerk[self._system.prescribed_dofs] = 0.0

    def state(self) -> Saved:
        return {} if self._jerk is None else {"jerk": self._jerk, "dt": np.array(self._dt)}

    def restore(self, saved: Saved) -> None:
        self._jerk, self._dt = saved.get("jerk"), float(saved.get("dt", 0.0))

    def of(self, start: State, moving: State, end: State, forces: Forces, dt: float) -> float:
        """Largest local error of a place [m] in a step from `start` to an end that is not committed, with its forces.

        moving: the state at the start as the riser moves, contact's share of the accelerations included.
        """
        missed = self._missed(start, moving, end, forces.end)
        missed[self._system.prescribed_dofs] = 0.0
        return dt**2 * _farthest(self._system, missed)

    def _missed(self, start: State, moving: State, end: State, touching: Array) -> Array:
        """Local error of the displacements, relative to dt^2 [m/s2]; touching (size,): contact's residual."""
        scheme = self._scheme
        if self._system.smooth:
            return scheme.error_constant * (end.a - start.a)
        contact = self._mass.accelerations(start.t, -touching)
        bulk = scheme.split_contact(end, contact, 0.0).a
        change = contact - (moving.a - start.a)
        return scheme.error_constant * (bulk - start.a) + CONTACT.error_constant * change


def committed_error(
    system: System, scheme: Scheme, start: tuple[State, State], ended: tuple[State, State], dt: float
) -> float:
    """Largest local error of a place [m] in a step just committed, on the rank that holds the riser: `LocalError.of`
    without solving for accelerations.

    start, ended: the states with the bulk's rates alone, and as the riser moves, before and after the step.
    """
    changed = (state.a for pair in (start, ended) for state in pair)
    missed = _missed(*changed, scheme.error_constant, CONTACT.error_constant, system.prescribed_dofs)
    return dt**2 * _largest(system, missed)


def first_step(system: System, moving: State, tolerance: float) -> float:
    """Time [s] in which the accelerations at the start move the riser by the tolerance [m]; inf where it rests."""
    largest = _farthest(system, moving.a)
    return float(np.sqrt(2.0 * tolerance / largest)) if largest > 0.0 else float("inf")


def _farthest(system: System, values: Array) -> float:
    """Largest norm of a translation of the lines among local values; the same on all ranks."""
    return float(system.comm.bcast(_largest(system, values)))


def _largest(system: System, values: Array) -> float:
    """The same of this rank's values."""
    return max(float(_longest(values, line.translation_dofs)) for line in system.model.lines)


@njit
def _missed(
    start: Array, moving: Array, after: Array, now: Array, bulk: float, contact: float, prescribed: IntArray
) -> Array:
    """What accelerations miss, with constants for the bulk's and for contact's; nothing where they are prescribed."""
    out = np.empty(after.size)
    for i in range(after.size):
        out[i] = bulk * (after[i] - start[i]) + contact * ((now[i] - after[i]) - (moving[i] - start[i]))
    for i in prescribed:
        out[i] = 0.0
    return out


@njit
def _longest(values: Array, dofs: IntArray) -> float:
    """Largest norm of vectors whose dofs are the rows (n, d)."""
    largest = 0.0
    for n in range(dofs.shape[0]):
        square = 0.0
        for i in range(dofs.shape[1]):
            square += values[dofs[n, i]] ** 2
        if not square <= largest:  # nor where it is not a number
            largest = square
    return math.sqrt(largest)


class Extrapolation:
    """Polynomial extrapolation through the ends of the last steps, by Newton's divided differences of the increments'
    sums.

    The first difference is the mean rate of the last step [1/s], the second half its change [1/s2]. Beyond them only
    terms that fall fast are taken: those of what is rough, such as short waves in the riser or a gust, don't.

    most: steps that it continues, which is SMOOTH without contact and GRADUAL on clay. An impact ends what went before:
    with a penalty's contact the last rate alone is the better guess, ROUGH.
    """

    def __init__(self, size: int, most: int) -> None:
        self._most = most
        self._differences: Array = np.zeros((0, size))
        self._steps: Array = np.zeros(0)

    def increments(self, dt: float) -> Array:
        """The increments of a step of dt to come; nothing moves before a first step was accepted."""
        found: Array = _extrapolated(self._differences, self._steps, dt)
        return found

    def accept(self, increments: Array, dt: float) -> None:
        """Continue from a step of dt that has been taken."""
        self._differences, self._steps = _accepted(self._differences, self._steps, increments, dt, self._most)

    def state(self) -> Saved:
        return {"differences": self._differences, "steps": self._steps}

    def restore(self, saved: Saved) -> None:
        self._differences, self._steps = saved["differences"], saved["steps"]


@njit
def _extrapolated(differences: Array, steps: Array, dt: float) -> Array:
    total, largest = np.zeros(differences.shape[1]), math.inf
    factor = span = dt
    for order in range(differences.shape[0]):
        size = 0.0
        for i in range(total.size):
            size = max(size, abs(factor * differences[order, i]))
        if order >= PARABOLA and size > FALL * largest:
            break
        for i in range(total.size):
            total[i] += factor * differences[order, i]
        largest, span = size, span + steps[order]
        factor *= span
    return total


@njit
def _accepted(differences: Array, steps: Array, increments: Array, dt: float, most: int) -> tuple[Array, Array]:
    """Differences (k, n) and sizes of the steps (k,) with a further one, at most so many."""
    kept = min(differences.shape[0] + 1, most)
    found, sizes = np.empty((kept, increments.size)), np.empty(kept)
    sizes[0], span = dt, dt
    for i in range(increments.size):
        found[0, i] = increments[i] / dt
    for order in range(1, kept):
        span += steps[order - 1]
        sizes[order] = steps[order - 1]
        for i in range(increments.size):
            found[order, i] = (found[order - 1, i] - differences[order - 1, i]) / span
    return found, sizes


class EnergyGain:
    """The sum of what steps have made out of nothing since it was last balanced [J]; start: energy at the start.

    largest: share of the energy in motion that a step may make. turned: the most that was stored, or put in or
    dissipated in all [J].
    """

    def __init__(self, start: Energy, largest: float = LARGEST) -> None:
        self._largest = largest
        self._sum = self._work = self._dissipated = 0.0
        self._turned = max(start.kinetic, start.strain)

    def rejection(self, was: Energy, now: Energy, dissipated: float, work: float, negligible: float) -> str:
        """Why a step from one energy to another that makes as much as it does is not accepted; "" for a good one."""
        appeared = _appeared(was, now, dissipated, work)
        in_motion = was.kinetic + was.strain + max(0.0, was.potential - now.potential) + abs(work)
        if appeared > self._largest * in_motion + negligible:
            return f"the step's solution makes {appeared:.3g} J out of nothing, beside {in_motion:.3g} J in motion"
        adds, turned = SMALL * self._largest * in_motion, max(self._turned, in_motion)
        moving = _into_motion(was, now, appeared)
        made = self._sum + moving
        if moving > adds + negligible and made > SUM * self._largest * turned:
            return f"the steps' solutions make {made:.3g} J out of nothing, beside {turned:.3g} J exchanged"
        return ""

    def accept(self, was: Energy, now: Energy, dissipated: float, work: float) -> None:
        """Count an accepted step."""
        self._sum = max(0.0, self._sum + _into_motion(was, now, _appeared(was, now, dissipated, work)))
        self._work += work
        self._dissipated += dissipated
        self._turned = max(self._turned, now.kinetic, now.strain, abs(self._dissipated), abs(self._work))

    def state(self) -> Saved:
        return {"sums": np.array([self._sum, self._work, self._dissipated, self._turned])}

    def restore(self, saved: Saved) -> None:
        self._sum, self._work, self._dissipated, self._turned = map(float, saved["sums"])


def _appeared(was: Energy, now: Energy, dissipated: float, work: float) -> float:
    return now.total - was.total + dissipated - work


def _into_motion(was: Energy, now: Energy, appeared: float) -> float:
    return min(appeared, was.kinetic + now.kinetic)
