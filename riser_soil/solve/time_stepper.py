"""Time stepping: solve a step, balance its energy, commit it, keep the rates for the next one."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.communicator import any_of
from riser_soil.core.matrix import Patterns
from riser_soil.core.part import Energy, Forces, LineField, State, Work, local
from riser_soil.core.roles import MomentumCorrecting, Predictor, Renewing, Starting, with_role
from riser_soil.core.saved_state import Saved, Stateful, gathered, record_of, under, values_of, within
from riser_soil.core.system import System, total
from riser_soil.errors import SolveError
from riser_soil.solve.energy_gain import LARGEST, EnergyGain
from riser_soil.solve.extrapolation import GRADUAL, ROUGH, SMOOTH, Extrapolation
from riser_soil.solve.local_error import LocalError, committed_error
from riser_soil.solve.newton import Newton, balance_under_fixed_lines
from riser_soil.solve.step import NotConvergedError, Solution, Step
from riser_soil.solve.step_control import Control
from riser_soil.solve.time_scheme import CommittedStep, Scheme
from riser_soil.solve.updated_geometry import UpdatedGeometry

ENERGY_ROUND_OFF = 1e-9  # of the potential energy, whose zero is far away
EASY = 6  # Newton iterations up to which a step that was cut may grow again


@dataclass(frozen=True, eq=False)
class AcceptedStep:
    """A solved step and its energy balance [J]; cuts: failed attempts before it.

    turned: what each part, and "supports", dissipates and puts in. braking: what all forces, supports included, take
    out of the motion; in exact time integration the kinetic energy loses that much. ahead: of it, what end-of-step
    forces take beyond their mean over the step.
    """

    t: float
    dt: float
    solution: Solution
    cuts: int
    energy: Energy
    turned: dict[str, Work]
    braking: float
    ahead: float = 0.0

    @property
    def dissipated(self) -> float:
        return self._sums[0]

    @property
    def work(self) -> float:
        return self._sums[1]

    @cached_property
    def _sums(self) -> tuple[float, float]:
        dissipated = external = 0.0
        for work in self.turned.values():
            dissipated, external = dissipated + work.dissipated, external + work.external
        return dissipated, external


class TimeStepper:
    """Time stepper of a stage, from the state `before` that it starts with, or from a saved state.

    before: the accepted state that the next step starts from, its increments zero; its rates leave out what contact
    adds to them (see `time_scheme`). now: the same state as the riser moves; energy: stored in it [J].
    local_error: largest of a place in the last step [m], see `local_error`; 0 in statics.
    largest_gain: share of the energy in motion that a step may create, see `local_error`.
    first_guess (size,): beyond the guess of the steps until one is accepted, where it is known how they end.
    """

    def __init__(
        self,
        system: System,
        newton: Newton,
        scheme: Scheme,
        before: State | Saved,
        largest_gain: float = LARGEST,
        first_guess: Array | None = None,
    ) -> None:
        self.system, self.newton, self.scheme, self._largest_gain = system, newton, scheme, largest_gain
        self._mass = newton.accepted.mass if scheme.dynamic else None
        self._error: LocalError | None = None
        self.local_error = 0.0
        parts = system.model.parts
        self._predictors: list[Predictor] = [*system.model.lines, *with_role(parts, Predictor)]
        self._momentum_correcting: list[MomentumCorrecting] = with_role(parts, MomentumCorrecting)
        self._renewing: list[Renewing] = with_role(parts, Renewing)
        self._geometry = UpdatedGeometry(system)
        self._patterns_under_fixed_lines: Patterns = {}  # of the matrix in which lines are fixed
        if isinstance(before, State):
            self._begin(before)
        else:
            self.restore(before)
        self._first_guess = first_guess

    def _begin(self, before: State) -> None:
        self.before = self.now = before
        self.restart()
        if self.scheme.dynamic:
            self._start_rates(before)
        for part in with_role(self.system.model.parts, Starting):
            if part.active:
                part.begin_stage(self.before)
        self._begin_step()
        self._history = self.system.forces(self.before) if self._renews_history else None
        self.energy = self.system.energy(self.before)
        self._gain = EnergyGain(self.energy, self._largest_gain)

    def restart(self) -> None:
        """Start anew from the configuration that the parts hold now."""
        self._forces = self.system.forces(self.before)
        self._past, self._first_guess = self._new_predictor(), None

    def _new_predictor(self) -> Extrapolation:
        system = self.system
        return Extrapolation(system.numbering.size, SMOOTH if system.smooth else GRADUAL if system.gradual else ROUGH)

    def _start_rates(self, before: State) -> None:
        """Accelerations in balance with the forces at the start of a dynamic stage; prescribed rates."""
        assert self._mass is not None
        rest = State(before.t, before.u, before.v.copy(), np.zeros_like(before.a))
        self.system.prescribe(rest)
        forces = self.system.forces(rest)
        bulk, whole = (self._mass.accelerations(before.t, -f) for f in (forces.inertia + forces.force, total(forces)))
        fixed = self.system.prescribed
        self.before = State(before.t, rest.u, rest.v, np.where(fixed, rest.a, bulk))
        self.now = State(before.t, rest.u, rest.v, np.where(fixed, rest.a, whole))
        self._forces = self.system.forces(self.now)

    def depends_on(self, control: Control) -> bool:
        """Whether loads or supports change in the step to be tried; in statics shorter steps are easier only then.
        Collective.
        """
        end = replace(self.before, t=control.target)
        change = total(self.system.forces(end)) - total(self.system.forces(self.before))
        return any_of(self.system.comm, bool(np.any(change != 0.0))) or self.moves_supports(control)

    def moves_supports(self, control: Control) -> bool:
        """Whether supports move in the step to be tried; collective."""
        end = State(control.target, self.before.u.copy(), self.before.v.copy(), self.before.a.copy())
        self.system.prescribe(end)
        return any_of(self.system.comm, bool(np.any(end.u != 0.0)))

    def advance(self, control: Control, most_cuts: int | None = None) -> AcceptedStep:
        """Take one step, cut as often as it needs; SolveError when it can't be cut any more, or may not."""
        if control.judges_error and self._error is None:
            self._error = self._new_error()
        self._renew()
        cuts = 0
        while True:
            try:
                return self._attempt(control, cuts)
            except NotConvergedError as failure:
                self._geometry.place(self.before, self.before.u)
                cuts += 1
                if cuts - 1 == most_cuts or not control.cut():
                    raise SolveError(
                        f"no convergence at t = {control.target:.6g} with the smallest step {control.dt:.3g}: {failure}"
                    ) from failure

    def _attempt(self, control: Control, cuts: int) -> AcceptedStep:
        """A step that is solved, accounted for and acceptable; else NotConvergedError."""
        solution = self._solve(self.next_step(control))
        step = self._account(solution, control, cuts)
        self._reject_inaccurate(step, control)
        self._reject_energy_gain(step)
        return step

    def next_step(self, control: Control) -> Step:
        """The step to be solved next, its increments predicted."""
        t, dt = control.target, control.dt
        continued = self._past.increments(dt)
        self._geometry.place(self.before, continued)
        start = self._start(dt)
        history = self._history if start is self.before else self.system.forces(start)
        return Step(self.scheme, start, t, dt, history, self._predict(t, continued))

    def _new_error(self) -> LocalError:
        assert self._mass is not None
        return LocalError(self.system, self.scheme, self._mass)

    def _start(self, dt: float) -> State:
        """The accepted state as a step of size dt starts from it."""
        return self.before if self._error is None else self._error.start(self.before, dt)

    def _solve(self, step: Step) -> Solution:
        """By Newton's method; stable in statics."""
        solution = self._geometry.solve(self.newton, step)
        if not self.scheme.dynamic:
            self.newton.require_stable(solution)
        return solution

    def _predict(self, t: float, guess: Array) -> Array:
        """Increments of the motion of the last steps continued, as lines and contacts predict it better."""
        for owner in self._predictors:
            guess = owner.predict(State(t, guess, self.before.v, self.before.a))
        return guess if self._first_guess is None else guess + self._first_guess

    def _account(self, solution: Solution, control: Control, cuts: int) -> AcceptedStep:
        """Energy balance of the step: stored, dissipated and external."""
        energy, turned = self.newton.accepted.energy_exchanged(self.before, solution)
        start = self._forces if self._history is None else self._history
        supports, against, ahead = self.system.work_in_step(
            self._forces, start.force, solution.forces, solution.state.u, self.scheme.start_share
        )
        braking = against - supports - sum(work.inertial for work in turned.values())
        turned["supports"] = Work(external=supports)
        return AcceptedStep(control.target, control.dt, solution, cuts, energy, turned, braking, ahead)

    def _reject_energy_gain(self, step: AcceptedStep) -> None:
        """NotConvergedError for a dynamic step that creates energy, so that it is cut."""
        if not self.scheme.dynamic:
            return
        # Over an element's length the least force that counts does negligible work, as where a motion starts from rest.
        negligible = ENERGY_ROUND_OFF * abs(self.energy.potential) + self.newton.settings.floor * self.system.lever

        def rejection(now: Energy) -> str:
            return self._gain.rejection(self.energy, now, step.dissipated, step.work, negligible)

        if rejection(step.energy) and (reason := rejection(replace(step.energy, kinetic=self._kinetic(step)))):
            raise NotConvergedError(reason)

    def _kinetic(self, step: AcceptedStep) -> float:
        """Kinetic energy [J] after a step, not yet committed, as the riser moves: in the step's own energy contact has
        accelerated it as the bulk's forces do, so that it speeds up where it rests.
        """
        if self.system.smooth or self._mass is None:
            return step.energy.kinetic
        contact = self._mass.accelerations(self.before.t, -step.solution.forces.end)
        return self._mass.kinetic_energy(self.scheme.split_contact(step.solution.state, contact, step.dt))

    def _reject_inaccurate(self, step: AcceptedStep, control: Control) -> None:
        """NotConvergedError for a step whose local error is too large, so that it is cut."""
        if self._error is None:
            return
        solution = step.solution
        error = self._error.of(self._start(step.dt), self.now, solution.state, solution.forces, step.dt)
        if rejection := control.rejection(error):
            raise NotConvergedError(rejection)

    def commit(self, step: AcceptedStep, control: Control) -> None:
        """Accept the step and get ready for the next."""
        state, forces = step.solution.state, step.solution.forces
        self.newton.accepted.commit(state)
        start, states_before = self._start(step.dt), (self.before, self.now)
        self.before, self.now = self._rates_after(step)
        if self.scheme.dynamic:
            self.local_error = committed_error(
                self.system, self.scheme, states_before, (self.before, self.now), step.dt
            )
        if self._error is not None:
            self._error.accept(start, self.before, step.dt)
        self._begin_step()
        self._forces, self._history = forces, self._forces_after(step) if self._renews_history else None
        self._keep_energy(step)
        self._past.accept(state.u, step.dt)
        self._first_guess = None
        control.accept(easy=step.solution.iterations <= EASY)

    def _renew(self) -> None:
        """Go on with another discretisation of what is not a line, where a part asks for one. In statics the step takes
        up what that lacks of balance; lines that move would feel it.
        """
        system, clock = self.system, self.system.clock
        for part in self._renewing:
            since = time.perf_counter() - clock.total
            if not part.renew(self.before):
                continue
            if self.scheme.dynamic:
                arguments = system.comm, system.model, self.before.t, self.newton.settings, system.clock
                balance_under_fixed_lines(*arguments, self._patterns_under_fixed_lines)
                self.newton.renew()  # the balance has chosen patterns of its own
            part.lose(self.energy.total - system.energy(self.before).total)
            self._forces = system.forces(self.before)
            clock.add(part.name, since + clock.total)  # beside what others have counted meanwhile

    def _rates_after(self, step: AcceptedStep) -> tuple[State, State]:
        """The state just committed, increments zero: with the bulk's rates alone, and as the riser moves."""
        solved, forces = step.solution.state, step.solution.forces
        end = CommittedStep(self.system, self._mass, self._momentum_correcting, solved, forces, step.dt)
        return self.scheme.rates_after(end)

    def _begin_step(self) -> None:
        for part in self._momentum_correcting:
            part.begin(self.before)

    def _keep_energy(self, step: AcceptedStep) -> None:
        was, self.energy = self.energy, self._energy_after(step)
        self._gain.accept(was, self.energy, step.dissipated, step.work)

    def _energy_after(self, step: AcceptedStep) -> Energy:
        """Stored energy of the accepted state: the step's, but kinetic as the riser moves."""
        if self.now.v is step.solution.state.v:
            return step.energy
        assert self._mass is not None
        return Energy(self._mass.kinetic_energy(self.now), step.energy.strain, step.energy.potential)

    @property
    def _renews_history(self) -> bool:
        return self.scheme.renews_history(self.system.smooth)

    def _forces_after(self, step: AcceptedStep) -> Forces:
        """Bulk forces at the state just accepted, in its own axes: the step's, unless contact has changed the rates.
        Where nothing touches, group E has none.
        """
        if not self.system.smooth:
            return self.newton.accepted.bulk_forces(self.before)
        forces, u = step.solution.forces, step.solution.state.u
        turned = [line for line in self.system.model.lines if line.turns_axes]
        if not turned:
            return forces
        return Forces(_in_new_axes(turned, forces.inertia, u), _in_new_axes(turned, forces.force, u), forces.end)

    def state(self) -> Saved:
        """The accepted state with its forces and energy, and what the next step is foreseen and judged by."""
        owners: dict[str, Stateful | None] = {"predictor": self._past, "mass": self._mass, "error": self._error}
        owners["gain"] = self._gain
        owners["newton"] = self.newton
        records = {"before": self.before, "forces": self._forces, "history": self._history, "energy": self.energy}
        if self.now is not self.before:
            records["now"] = self.now
        saved = gathered({name: owner for name, owner in owners.items() if owner is not None})
        for name, record in records.items():
            saved |= under(name, values_of(record) if record is not None else {})
        return saved

    def restore(self, saved: Saved) -> None:
        """Parts and lines must have been restored, too."""
        self.before = record_of(State, within(saved, "before"))
        self.now = record_of(State, now) if (now := within(saved, "now")) else self.before
        self._forces = record_of(Forces, within(saved, "forces"))
        self._history = record_of(Forces, history) if (history := within(saved, "history")) else None
        self.energy = record_of(Energy, within(saved, "energy"))
        self._gain = EnergyGain(self.energy, self._largest_gain)
        self._gain.restore(within(saved, "gain"))
        self._past = self._new_predictor()
        self._past.restore(within(saved, "predictor"))
        if self._mass is not None:
            self._mass.restore(within(saved, "mass"))
        self.newton.restore(within(saved, "newton"))
        if error := within(saved, "error"):
            self._error = self._new_error()
            self._error.restore(error)


def _in_new_axes(lines: Sequence[LineField], conjugate: Array, increments: Array) -> Array:
    """Forces conjugate to the increments, with those of the lines in the axes that these turn to."""
    out = conjugate.copy()
    for line in lines:
        at = local(line)
        out[at] = line.in_new_axes(conjugate[at], increments[at])
    return out
