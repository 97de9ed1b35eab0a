"""How far one step of a dynamic stage goes wrong: an estimate from the change of the accelerations.

While the acceleration changes linearly, Newmark's displacement misses (beta - 1/6) dt^2 (a(n+1) - a(n)) of the Taylor
series (Zienkiewicz & Xie, A simple error estimator and adaptive time stepping procedure for dynamic analysis,
Earthquake Engineering and Structural Dynamics 20, 1991), and its velocity (gamma - 1/2) dt (a(n+1) - a(n)), which is a
displacement too one step later. What contact adds to the accelerations counts with beta = 1/2 and gamma = 1 (see
`time_scheme`). Neither is filtered: an impact shorter than the step shows as an error of the order of the displacement
that it undoes.

Accelerations of generalised-alpha lag behind: a(n) belongs to the time t(n) - lag dt (see `GeneralizedAlpha.lag`).
Where steps change size, a(n) of the last step's lag is brought to the lag of the next, which keeps the second order
(compare Brüls & Arnold, The generalized-alpha scheme as a linear multistep integrator, Journal of Computational and
Nonlinear Dynamics 3, 2008).
"""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol, runtime_checkable

import numpy as np

from riser_soil.arrays import Array, IntArray
from riser_soil.mass import RiserMass
from riser_soil.newton import Solution
from riser_soil.part import State
from riser_soil.system import System
from riser_soil.time_scheme import Dynamic, GeneralizedAlpha

CONTACT = GeneralizedAlpha.newmark(0.5, 1.0)
SAME = 1e-9  # of a step: two steps that differ by round-off


@runtime_checkable
class Extended(Protocol):
    """A field with places; (nn, d) local numbers of their translations [m]."""

    @property
    def translation_dofs(self) -> IntArray: ...


class LocalError:
    """Local error of the steps of a stage, in the displacements of the riser [m]; collective."""

    def __init__(self, system: System, scheme: Dynamic, mass: RiserMass) -> None:
        self._system, self._scheme, self._mass = system, scheme, mass
        self._jerk: Array | None = None
        self._dt = 0.0

    def start(self, before: State, dt: float) -> State:
        """The accepted state as a step of size dt starts from it; the same object where nothing is to be done."""
        if self._jerk is None or self._scheme.lag == 0.0 or abs(dt - self._dt) < SAME * dt:
            return before
        return replace(before, a=before.a + self._scheme.lag * (self._dt - dt) * self._jerk)

    def accept(self, start: State, after: State, dt: float) -> None:
        """Keep how fast the accelerations changed in a step from `start` to the accepted state `after`."""
        self._jerk, self._dt = (after.a - start.a) / dt, dt
        self._jerk[self._system.held] = 0.0

    def of(self, start: State, moving: State, solution: Solution, dt: float) -> float:
        """Largest local error of a place [m] in a step from `start` that is solved, but not committed.

        moving: the state at the start as the riser moves, contact's share of the accelerations included.
        """
        missed = self._missed(start, moving, solution)
        missed[self._system.held] = 0.0
        riser = self._system.model.fields[0]
        assert isinstance(riser, Extended)
        largest = dt**2 * np.linalg.norm(missed[riser.translation_dofs], axis=1).max()
        return float(self._system.comm.bcast(largest))

    def _missed(self, start: State, moving: State, solution: Solution) -> Array:
        """Local error of the displacements, relative to dt^2 [m/s2]."""
        scheme, end = self._scheme, solution.state
        if self._system.riser_alone or not isinstance(scheme, GeneralizedAlpha):
            return scheme.error_constant * (end.a - start.a)
        contact = self._mass.accelerations(start.t, -solution.forces.end)
        bulk = end.a - contact / (2.0 * scheme.beta)
        change = contact - (moving.a - start.a)
        return scheme.error_constant * (bulk - start.a) + CONTACT.error_constant * change


def first_step(system: System, moving: State, tolerance: float) -> float:
    """Time [s] in which the accelerations at the start move the riser by the tolerance [m]; inf where it rests."""
    riser = system.model.fields[0]
    assert isinstance(riser, Extended)
    largest = system.comm.bcast(np.linalg.norm(moving.a[riser.translation_dofs], axis=1).max())
    return float(np.sqrt(2.0 * tolerance / largest)) if largest > 0.0 else float("inf")
