"""Time integration schemes: Newmark, generalised-alpha, midpoint rule, and statics.

One code path for statics, Newmark, generalised-alpha and the midpoint rule. With bulk forces I + F and end-of-step
forces E (contact, quasi-static soil), the residual of a step from n to n + 1 is, but for the midpoint rule,

    R = W [(1 - am) I(n+1) + am I(n) + (1 - af) F(n+1) + af F(n)] + E(n+1),    W = 2 beta / (1 - am).

E is treated fully implicitly (Kane, Repetto, Ortiz & Marsden, Finite element analysis of nonsmooth contact, Computer
Methods in Applied Mechanics and Engineering 180, 1999): the acceleration that it causes counts with 2 beta = 1,
gamma = 1, whatever the bulk's beta and gamma are, so that impact takes energy out and never puts any in. W makes both
meet in one equation with a symmetric coupling to the soil.
Generalised-alpha: Chung & Hulbert (1993), eqs 17 and 25; alpha_m = alpha_f = 0 is Newmark's scheme.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.communicator import any_of
from riser_soil.core.compiled import njit
from riser_soil.core.part import Forces, State, Weights
from riser_soil.core.roles import MomentumCorrecting
from riser_soil.core.system import System, total
from riser_soil.solve.inverse_mass import InverseMass


@dataclass(eq=False)
class CommittedStep:
    """A step just committed, and what its scheme needs from the system there; collective.

    mass: None in statics. solved: its state, increments included; forces: in balance there [N]; dt [s]. state: the same
    with increments of zero, and rates as solved.
    """

    system: System
    mass: InverseMass | None
    correcting: Sequence[MomentumCorrecting]
    solved: State
    forces: Forces
    dt: float

    def __post_init__(self) -> None:
        self.state = State(self.solved.t, self.system.no_increments, self.solved.v, self.solved.a)

    @property
    def contact(self) -> Array | None:
        """Accelerations that contact causes [m/s2]; None where nothing touches."""
        system, end = self.system, self.forces.end
        touches = not system.smooth and any_of(system.comm, np.count_nonzero(end) > 0)
        return self._accelerations(-end) if touches else None

    def with_momentum(self, state: State) -> State:
        """The state with the rates that have the momentum of the step's end."""
        missing = np.zeros_like(state.v)
        for part in self.correcting:
            part.add_momentum_correction(state, missing)
        return State(state.t, state.u, state.v + self._accelerations(missing), state.a)

    def in_balance(self, state: State) -> State:
        """The state with the accelerations that its forces cause."""
        prescribed = np.where(self.system.prescribed, state.a, 0.0)
        forces = self.system.forces(State(state.t, state.u, state.v, prescribed))
        return State(state.t, state.u, state.v, prescribed + self._accelerations(-total(forces)))

    def _accelerations(self, force: Array) -> Array:
        assert self.mass is not None
        return self.mass.accelerations(self.solved.t, force)


class Scheme(Protocol):
    """Interface of the time integration schemes.

    dynamic: whether there are rates and inertia. step_over_trial: increments of the step over those of the state where
    forces are evaluated, by which the parts differentiate: 1 for generalised-alpha, 2 for the midpoint rule.
    """

    dynamic: bool
    step_over_trial: float

    @property
    def lag(self) -> float:
        """Accelerations belong to a time this share of their step before its end."""
        ...

    @property
    def stiff_lag(self) -> float:
        """Velocities of motions that stiff forces prescribe are off by minus this times dt^2 times the jerk."""
        ...

    @property
    def error_constant(self) -> float:
        """Local error in displacements, relative to dt^2 times the change of the accelerations; see `local_error`."""
        ...

    def renews_history(self, smooth: bool) -> bool:
        """Whether forces at the start of a step are not those at the end of the last, or enter the residual.

        smooth: whether no forces may jump, see `System`.
        """
        ...

    def split_contact(self, state: State, contact: Array, dt: float) -> State:
        """A solved state, contact's accelerations [m/s2] out of its bulk ones and in full in its rate."""
        ...

    def rates_after(self, end: CommittedStep) -> tuple[State, State]:
        """The state that the next step starts from, with the bulk's rates alone, and the same as the riser moves."""
        ...

    def weights(self, dt: float) -> Weights: ...

    def trial(self, before: State, t: float, dt: float, u: Array) -> State:
        """State at the end of the step for the increment u, taken as bulk motion alone."""
        ...

    def balanced_at(self, before: State, end: State, dt: float) -> State:
        """Where in the step forces are evaluated: at its end, or at another state that follows from the end."""
        ...

    def past(self, start: Forces | None) -> Array | None:
        """Contribution of the forces at the start of the step to the local residual."""
        ...

    @property
    def start_share(self) -> float:
        """Share of what there is at the step's start in its mean, of second order; the rest: where it is balanced."""
        ...


@dataclass(frozen=True)
class Static:
    """Equilibrium: no rates, no inertia. seconds: that a step takes; 0 is an instant, in which nothing flows."""

    seconds: float = math.inf
    dynamic, step_over_trial = False, 1.0
    lag = stiff_lag = error_constant = 0.0
    start_share = 0.5

    def renews_history(self, smooth: bool) -> bool:
        return False

    def split_contact(self, state: State, contact: Array, dt: float) -> State:
        return state

    def rates_after(self, end: CommittedStep) -> tuple[State, State]:
        return end.state, end.state

    def weights(self, dt: float) -> Weights:
        return Weights.of_statics()

    def trial(self, before: State, t: float, dt: float, u: Array) -> State:
        nothing = np.zeros_like(u)
        return State(t, u, nothing, nothing.copy(), dt=self.seconds)

    def balanced_at(self, before: State, end: State, dt: float) -> State:
        return end

    def past(self, start: Forces | None) -> Array | None:
        return None


@dataclass(frozen=True)
class GeneralizedAlpha:
    """Newmark's kinematics with weighted inertia (alpha_m) and weighted other bulk forces (alpha_f)."""

    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float
    dynamic, step_over_trial = True, 1.0
    start_share = 0.5

    @classmethod
    def newmark(cls, beta: float = 0.25, gamma: float = 0.5) -> GeneralizedAlpha:
        return cls(0.0, 0.0, beta, gamma)

    @classmethod
    def from_rho_inf(cls, rho_inf: float) -> GeneralizedAlpha:
        """Second order; rho_inf is the spectral radius at infinite frequency: 1 keeps all, 0 kills it at once."""
        alpha_m = (2.0 * rho_inf - 1.0) / (rho_inf + 1.0)
        alpha_f = rho_inf / (rho_inf + 1.0)
        return cls(alpha_m, alpha_f, 0.25 * (1.0 - alpha_m + alpha_f) ** 2, 0.5 - alpha_m + alpha_f)

    def renews_history(self, smooth: bool) -> bool:
        """Contact changes the rates after a step, and with them its forces."""
        return self.alpha_m != 0.0 or self.alpha_f != 0.0 or not smooth

    @property
    def bulk_weight(self) -> float:
        return 2.0 * self.beta / (1.0 - self.alpha_m)

    @property
    def lag(self) -> float:
        return self.alpha_f - self.alpha_m

    @property
    def stiff_lag(self) -> float:
        return self.beta - 0.5 * self.lag - 1.0 / 6.0

    @property
    def error_constant(self) -> float:
        return abs(self.stiff_lag) + abs(self.gamma - self.lag - 0.5)

    def weights(self, dt: float) -> Weights:
        bulk = self.bulk_weight
        return Weights(
            inertia=bulk * (1.0 - self.alpha_m),
            force=bulk * (1.0 - self.alpha_f),
            shift_v=self.gamma / (self.beta * dt),
            shift_a=1.0 / (self.beta * dt**2),
        )

    def trial(self, before: State, t: float, dt: float, u: Array) -> State:
        v, a = np.empty_like(u), np.empty_like(u)
        _write_rates(u, before.v, before.a, dt, self.beta, self.gamma, v, a)
        return State(t, u, v, a, dt=dt)

    def balanced_at(self, before: State, end: State, dt: float) -> State:
        return end

    def past(self, start: Forces | None) -> Array | None:
        if start is None:
            return None
        past = np.empty_like(start.force)
        _write_past(self.bulk_weight, self.alpha_m, start.inertia, self.alpha_f, start.force, past)
        return past

    def split_contact(self, state: State, contact: Array, dt: float) -> State:
        a = state.a - contact / (2.0 * self.beta)
        v = state.v + dt * (1.0 - self.gamma / (2.0 * self.beta)) * contact
        return State(state.t, state.u, v, a, dt=state.dt)

    def rates_after(self, end: CommittedStep) -> tuple[State, State]:
        if (contact := end.contact) is None:
            return end.state, end.state
        bulk = self.split_contact(end.state, contact, end.dt)
        return bulk, State(bulk.t, bulk.u, bulk.v, bulk.a + contact)


@njit
def _write_past(bulk: float, alpha_m: float, inertia: Array, alpha_f: float, force: Array, out: Array) -> None:
    """Write the share of the forces at a step's start in its residual."""
    for i in range(force.size):
        out[i] = bulk * (alpha_m * inertia[i] + alpha_f * force[i])


@njit
def _write_rates(
    u: Array, v: Array, a: Array, dt: float, beta: float, gamma: float, then: Array, change: Array
) -> None:
    """Write Newmark's velocities and accelerations after the increments u, from those before them."""
    for i in range(u.size):
        change[i] = (u[i] - dt * v[i]) / (beta * dt**2) - (0.5 / beta - 1.0) * a[i]
        then[i] = v[i] + dt * ((1.0 - gamma) * a[i] + gamma * change[i])


@dataclass(frozen=True)
class Midpoint:
    """The implicit midpoint rule: all forces in balance at the configuration half-way of the increments.

    Rates at the end follow from u = dt (v(n) + v(n+1))/2, as in Newmark's scheme with beta = 1/4 and gamma = 1/2. With
    inertia as in `riser.midpoint_inertia` linear and angular momentum are kept to round-off. Not for contact or
    quasi-static soil, whose forces belong to the end.
    """

    dynamic, step_over_trial = True, 2.0
    lag = stiff_lag = 0.0
    error_constant = 1.0 / 12.0
    start_share = 0.0

    def renews_history(self, smooth: bool) -> bool:
        return False

    def split_contact(self, state: State, contact: Array, dt: float) -> State:
        return state

    def rates_after(self, end: CommittedStep) -> tuple[State, State]:
        """With the momentum that inertia has kept, and accelerations of the end, as the balance is in the middle."""
        now = end.in_balance(end.with_momentum(end.state))
        return now, now

    def weights(self, dt: float) -> Weights:
        return Weights(inertia=1.0, force=1.0, shift_v=2.0 / dt, shift_a=4.0 / dt**2)

    def trial(self, before: State, t: float, dt: float, u: Array) -> State:
        v = 2.0 / dt * u - before.v
        return State(t, u, v, 2.0 / dt * (v - before.v) - before.a, dt=dt)

    def balanced_at(self, before: State, end: State, dt: float) -> State:
        return State(end.t - 0.5 * dt, 0.5 * end.u, end.u / dt, (end.v - before.v) / dt, dt=0.5 * dt)

    def past(self, start: Forces | None) -> Array | None:
        return None
