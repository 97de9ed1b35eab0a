"""Estimate of the local error of time steps, and what it corrects where steps change size.

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
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.part import Forces, State
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.solve.inverse_mass import InverseMass
from riser_soil.solve.time_scheme import GeneralizedAlpha, Scheme

CONTACT = GeneralizedAlpha.newmark(0.5, 1.0)
FAR = 4.0  # times the last step: how far ahead its jerk is trusted
SAME = 1e-9  # of a step: two steps that differ by round-off


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
    """Largest norm of a translation of the lines among this rank's values."""
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
