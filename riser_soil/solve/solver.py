"""A step for Newton's method, its trials and solution; the method's settings, how it fails; what solutions tell."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Literal

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, State, Weights, Work
from riser_soil.core.roles import Limited
from riser_soil.core.system import System
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import acting_on
from riser_soil.riser.section_forces import element_residual, nodal_residual, section_vector, viscous_residual
from riser_soil.riser.sections import Elements
from riser_soil.solve.convergence import StopLimits
from riser_soil.solve.riser_mass import RiserMass
from riser_soil.solve.step_kernels import write_balance, write_rates
from riser_soil.solve.time_scheme import InverseMass, Scheme, Static

if TYPE_CHECKING:
    from riser_soil.contact.contact import RiserContact


REUSE = 0.1
BESIDE_CLAY = 0.02  # the same of the tangent of all else beside clay, whose curves take most of the iterations


class NotConvergedError(Exception):
    """A step that Newton could not solve; its text says why and where the residual sits."""


class UnstableError(NotConvergedError):
    """An unstable equilibrium, from which the riser would buckle or swing away: `solution`."""

    def __init__(self, text: str, solution: Solution) -> None:
        super().__init__(text)
        self.solution = solution


def reported(why: str, norms: list[float], place: str) -> str:
    """Why a step failed, the last of its residual's norms [N], and where the residual sits."""
    last = ", ".join(f"{norm:.3g}" for norm in norms[-3:])
    return f"{why} after {max(len(norms) - 1, 0)} iterations (last residual norms {last} N); {place}"


@dataclass(frozen=True)
class NewtonSettings:
    """tolerance: of the residual's norm, relative to the norm of the forces in play, moments over the
    system's lever.

    floor [N]: the norm that counts as zero, for round-off of a scene whose forces all vanish.
    reuse: an iteration that leaves less than this share of the residual leaves its factorised tangent to the next of
    the same step (Shamanskii's method), as long as each leaves less than this share: two or three such iterations cost
    less than one with its own tangent. Only in time steps without contact, which start near their end: contact has
    corners, and an equilibrium may be far away. Beside clay the line solver reuses the tangent of all else, see
    `convergence.StopLimits`. least_iterations: before a residual counts as small.
    line_search: shorten steps that lead far beyond the least energy, see `line_search`. linear_start: begin a step
    with the linear response to it, instead of the guess. linear: "direct" factorises each tangent, "kept" keeps
    factors as preconditioners, see `kept_factors`, "iterative" does without those of the soil, see `iterative_solver`,
    "auto" keeps factors in large systems. snes: let PETSc's SNES solve a riser alone, too. petsc_options: names without
    prefix and values, see `petsc_options`. has_soil: whether the scene has soil, be it in systems after this one.
    """

    tolerance: float
    max_iterations: int
    floor: float
    reuse: float = REUSE
    least_iterations: int = 0
    line_search: bool = False
    linear_start: bool = False
    linear: Literal["auto", "kept", "direct", "iterative"] = "auto"
    snes: bool = False
    petsc_options: tuple[tuple[str, bool | int | float | str | None], ...] = ()
    has_soil: bool = False


@lru_cache(maxsize=8)
def limits_of(settings: NewtonSettings, starts_near: bool, gradual: bool, answers_load: bool) -> StopLimits:
    """starts_near: whether the guess continues a smooth motion, as in time steps without contact. The tangent can be
    reused, and one iteration is a must: a motion that continues by its first guess alone would keep its errors.
    gradual: see `System`.
    """
    beside = BESIDE_CLAY if gradual else 0.0
    return StopLimits(
        settings.tolerance,
        settings.floor,
        settings.reuse if starts_near else beside,
        settings.max_iterations,
        max(settings.least_iterations, int(starts_near)),
        answers_load,
    )


@dataclass(frozen=True, eq=False)
class Step:
    """One step to solve: from the accepted state `before` to time t."""

    scheme: Scheme
    before: State
    t: float
    dt: float
    start: Forces | None
    guess: Array

    @classmethod
    def static(cls, before: State, seconds: float = math.inf) -> Step:
        """One to equilibrium from an accepted state; seconds: see `Static`."""
        return cls(Static(seconds), before, before.t, 0.0, None, np.zeros(before.u.size))


@dataclass(frozen=True, eq=False)
class Solution:
    """A converged step: the state at its end, the forces in balance by group, the residual norms [N]."""

    state: State
    forces: Forces
    norms: list[float] = field(default_factory=list)

    @property
    def iterations(self) -> int:
        return len(self.norms) - 1


class StepResults:
    """Energy, work, mass and section forces of solved steps and accepted states, by the parts of a system; collective.
    """

    def __init__(self, system: System) -> None:
        self.system = system

    def commit(self, state: State) -> None:
        """Accept the state of the step solved last."""
        self.system.commit(state)

    def energy_exchanged(self, before: State, solution: Solution) -> tuple[Energy, dict[str, Work]]:
        """Energy stored at the end of the step solved last, from the accepted state `before`, and what each part turned
        over in it, those of one name together.
        """
        return self.system.energy(solution.state), self.system.work(before, solution.state)

    @cached_property
    def mass(self) -> InverseMass:
        """Inverse of the lines' mass."""
        return RiserMass(self.system)

    def bulk_forces(self, state: State) -> Forces:
        """Forces of groups I and F at an accepted state, those of group E zero."""
        return self.system.forces(state, "IF")

    def element_residual(self, line: Line, state: State) -> Array:
        """Residual of a line's elements (ne, 2 ndof) at an accepted state, see `section_forces`; on the rank that has
        it, until the next call.
        """
        return element_residual(line, acting_on(line, self.system.model.parts), state)

    def section_forces(self, line: Line, elements: Elements, state: State) -> Array:
        """Section forces of a line at an accepted state, see `SectionForces.within`; on the rank that has it."""
        viscous = viscous_residual(line, acting_on(line, self.system.model.parts), state)
        return section_vector(line, elements, state, self.element_residual(line, state), viscous)

    def contact_results(self, contact: RiserContact, state: State) -> Array:
        """Results of a contact at an accepted state, see `ContactResults.within`; on the rank that evaluates it."""
        return contact.results(state)

    def nodal_residual(self, line: Line, state: State) -> Array | None:
        """Residual (nn, ndof) at an accepted state of what acts on a line's nodes without holding them, if anything."""
        return nodal_residual(line, acting_on(line, self.system.model.parts), state)


class StepTrials:
    """Trials of one step; collective.

    weights: of its scheme. state: that was tried last, None before the first; balanced: where in the step its forces
    are evaluated; forces: as found last [N].
    """

    def __init__(self, system: System, step: Step) -> None:
        self._system, self.step, scheme = system, step, step.scheme
        self.weights, past = scheme.weights(step.dt), scheme.past(step.start)
        self._past = np.zeros_like(step.guess) if past is None else past
        self._still = still = scheme.trial(step.before, step.t, step.dt, np.zeros_like(step.guess))
        self._prescribed = replace(still, u=step.guess.copy(), v=still.v.copy(), a=still.a.copy())
        system.prescribe(self._prescribed)
        self.state: State | None = None
        self._known: State | None = None  # whose forces are known

    def of(self, x: Array) -> State:
        """State of the unknowns x; the same object while x stays the same, so that parts need not look twice."""
        found = np.zeros(self._system.numbering.size)
        self._system.numbering.to_local(x, found)
        u = self.with_prescribed(found)
        if self.state is None or (u != self.state.u).any():
            self.state = self._follow(u)
            self.balanced = self.step.scheme.balanced_at(self.step.before, self.state, self.step.dt)
        return self.state

    def _follow(self, u: Array) -> State:
        """State of the increments u: rates follow them by the scheme's shifts, but for the prescribed ones."""
        fixed, v, a, shifts = self._system.prescribed, np.empty_like(u), np.empty_like(u), self.weights
        write_rates(u, fixed, np.where(fixed, self._prescribed.v, self._still.v), shifts.shift_v, v)
        write_rates(u, fixed, np.where(fixed, self._prescribed.a, self._still.a), shifts.shift_a, a)
        return State(self.step.t, u, v, a, dt=self._still.dt)

    def with_prescribed(self, u: Array) -> Array:
        """Increments with those that are prescribed in the step."""
        out = u.copy()
        out[self._system.prescribed_dofs] = self._prescribed.u[self._system.prescribed_dofs]
        return out

    def residual(self, x: Array) -> Array:
        """Residual of the unknowns, both (owned,)."""
        self.of(x)
        return self._system.numbering.add_to_global(self._residual_at(self.balanced))

    def residual_of(self, u: Array) -> tuple[State, Array]:
        """State of the increments u, those of the prescribed dofs included, without rates of their own, and its local
        residual.
        """
        state = replace(self._still, u=u)
        return state, self._residual_at(state)

    def _residual_at(self, state: State) -> Array:
        if state is not self._known:
            self.forces: Forces = self._system.forces(state)
            self._known = state
        return balance_of(self.step.scheme, self.weights, self.forces, self._past)

    def renumbered(self) -> Array | None:
        """Unknowns of the state that was tried last, as the system numbers its dofs now; None where none was."""
        if self.state is None:
            return None
        x = self._system.numbering.to_global(self.state.u)
        self._system.prescribe(self._prescribed)
        self.state = None
        return x

    def require_admissible(self, limited: Sequence[Limited]) -> None:
        """Raise NotConvergedError where the state that was tried last is none of a line's or of these parts'."""
        assert self.state is not None
        before = self.step.before if self.step.scheme.dynamic else None
        reasons = [line.inadmissible(self.state, before) for line in self._system.model.lines]
        reasons += [part.inadmissible(self.state) for part in limited]
        for reason in filter(None, reasons):
            raise NotConvergedError(reason)


def balance_of(scheme: Scheme, weights: Weights, forces: Forces, past: Array) -> Array:
    """Local residual of forces where they are in balance, as the increments of the step change it. past (n,): see
    `Scheme.past`.
    """
    out = np.empty_like(past)
    write_balance((forces.inertia, forces.force, forces.end), weights.inertia, weights.force, past, out)
    return out if scheme.step_over_trial == 1.0 else scheme.step_over_trial * out
