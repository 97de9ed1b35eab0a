"""Newton's method for the time steps of a riser on condensed soil, compiled: the loop over a riser with a border.

A step that it can't solve, as where contact opens so that steps want shortening, is solved by `Newton`.
"""

from __future__ import annotations

import time
from functools import cached_property

import numpy as np

from riser_soil.contact.surface_contact import SurfaceContact
from riser_soil.core.arrays import Array, as_list
from riser_soil.core.part import Energy, Forces, State, Work
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.placed_line import PlacedLine
from riser_soil.soil.condensed import CondensedSoil
from riser_soil.solve.compiled_mass import CompiledMass, mass_of
from riser_soil.solve.newton import Newton
from riser_soil.solve.packed_riser import KernelParts, PackedRiser
from riser_soil.solve.soil_border import SoilBorder
from riser_soil.solve.solver import NewtonSettings, Solution, Step, StepSolver, limits_of

MOST_STARTS = 8  # times that a step is begun with other pairs or dofs before it is left to `Newton`


def condensed_newton(system: System, settings: NewtonSettings) -> CondensedNewton | None:
    """The compiled loop over a riser on condensed soil, where all other parts have kernels and contact no history."""
    contact = next((part for part in system.model.parts if isinstance(part, SurfaceContact)), None)
    soil = next((part for part in system.model.parts if isinstance(part, CondensedSoil)), None)
    if contact is None or soil is None or (touch := contact.touch_data()) is None:
        return None
    rest = [part for part in system.model.parts if part is not contact and part is not soil]
    asked = [(part, part.kernel_data()) for part in rest if isinstance(part, LinePart)]
    with_data = [(part, data) for part, data in asked if data is not None]
    if len(with_data) < len(rest):
        return None
    border = SoilBorder(contact.line, contact, soil, touch)
    return CondensedNewton(system, settings, KernelParts(with_data), contact, soil, border)


class CondensedNewton(StepSolver):
    """Solver of time steps of a riser on condensed soil. Create once a stage, by `condensed_newton`; see `Newton`."""

    def __init__(
        self,
        system: System,
        settings: NewtonSettings,
        parts: KernelParts,
        contact: SurfaceContact,
        soil: CondensedSoil,
        border: SoilBorder,
    ) -> None:
        super().__init__(system, settings)
        self._newton = Newton(system, settings)
        self._contact, self._soil, self._border, self._parts = contact, soil, border, parts
        (line,) = system.model.lines
        assert isinstance(line, Line)
        self._line, self._at, most = line, slice(0, line.size), settings.max_iterations
        given = system.prescribed[self._at], system.levers[self._at], most
        self._placed = PlacedLine(line)
        self._riser = PackedRiser(line, self._placed, parts, *given, border)
        self._nothing = np.zeros(system.numbering.size)
        self._reached = soil.top.reached  # as the system has it
        self._solved: State | None = None  # by the compiled loop
        self._stored = dict[float, float]()  # contact's energy [J] by the time of states

    def solve(self, step: Step) -> Solution:
        """Solve a step or raise NotConvergedError."""
        since = time.perf_counter()
        self._parts.update(step.before.t, step.t)
        still = step.scheme.trial(step.before, step.t, step.dt, self._nothing)
        norms = self._norms(step, still)
        self.system.clock.add("riser and soil", since)
        found = self._by_newton(step) if norms is None else Solution(self._state(step, still), self._forces(), norms)
        self._solved, self.at_equilibrium = None if norms is None else found.state, False
        return found

    def _norms(self, step: Step, still: State) -> list[float] | None:
        """Norms of the residual on the way to balance; None where the loop does not get there. still: the step without
        increments.
        """
        at, scheme, past = self._at, step.scheme, step.scheme.past(step.start)
        guess = State(step.t, step.guess[at].copy(), still.v[at], still.a[at])
        self._line.prescribe(step.t, guess.u, guess.v, guess.a)
        guessed = bool(step.guess[~self.system.prescribed].any())
        limits = limits_of(self.settings, False, False, self.at_equilibrium or guessed)  # as in `Newton`
        for _ in range(MOST_STARTS):
            self._border.begin(step.before, step.guess)
            self._prescribe_anew()
            self._riser.begin(guess, None if past is None else past[at], scheme.weights(step.dt), limits)
            _, taken = self._riser.solve()
            self.iterations += taken
            if self._riser.converged and self._border.holds and not self._line.folding(*self._riser.folding):
                return as_list(self._riser.progress.norms[: taken + 1])
            if not self._riser.outgrown:
                return None
            self._border.widen()
        return None

    def _prescribe_anew(self) -> None:
        """What is not reached does not move by itself."""
        if self._reached is not self._soil.top.reached:
            self.system.renew_prescribed()
            self._reached = self._soil.top.reached

    def _by_newton(self, step: Step) -> Solution:
        """With a matrix for what is reached and may touch now."""
        self._contact.rebuild(State.at_rest(step.before.t, len(self._nothing)))
        self._newton.renew()
        self._newton.at_equilibrium, before = self.at_equilibrium, self._newton.iterations
        try:
            return self._newton.solve(step)
        finally:
            self.iterations += self._newton.iterations - before

    def _state(self, step: Step, still: State) -> State:
        """The state found."""
        line, weights = self._riser.solved(step.t, step.dt), step.scheme.weights(step.dt)
        dofs, moved = self._border.increments
        u, v, a = self._nothing.copy(), still.v, still.a
        u[self._at], v[self._at], a[self._at], u[dofs] = line.u, line.v, line.a, moved
        v[dofs] += weights.shift_v * moved
        a[dofs] += weights.shift_a * moved
        rest = self.system.prescribed.copy()
        rest[self._at] = False
        v[rest] = a[rest] = 0.0
        return State(step.t, u, v, a, dt=step.dt)

    def _forces(self) -> Forces:
        """Those of the last trial; on the soil's free dofs they are in balance."""
        found = self._riser.forces
        return self._padded(found.inertia, found.force, found.end)

    def _padded(self, *groups: Array) -> Forces:
        """Forces on the line (nn, ndof) among those of all local dofs."""
        forces = Forces.zeros(len(self._nothing))
        for whole, group in zip((forces.inertia, forces.force, forces.end), groups, strict=True):
            whole[self._at] = group.ravel()
        return forces

    @cached_property
    def _mass_of_line(self) -> CompiledMass:
        given = self.system.prescribed[self._at], self.system.levers[self._at]
        return mass_of(self._line, self._placed, self._parts, *given)

    @cached_property
    def mass(self) -> MassAmongOthers:
        """Inverse of the line's mass."""
        return MassAmongOthers(self._at, self._mass_of_line)

    def bulk_forces(self, state: State) -> Forces:
        """Forces of groups I and F at an accepted state, those of group E zero."""
        found = self._mass_of_line.bulk_forces(of_line(state, self._at))
        return self._padded(found.inertia, found.force, found.end)

    def energy_exchanged(self, before: State, solution: Solution) -> tuple[Energy, dict[str, Work]]:
        """Energy stored at the end of the step solved last, and what each part turned over in it."""
        if solution.state is not self._solved:
            self._stored.clear()
            return self._newton.energy_exchanged(before, solution)
        since = time.perf_counter()
        work = {part.name: Work() for part in self.system.model.parts}
        stored, rows = self._riser.account(of_line(before, self._at))
        self._parts.add_work(before, solution.state, as_list(rows), work)
        work[self._soil.name] += self._soil.work(before, solution.state)
        work[self._contact.name] += self._work_of_contact(before, solution.state.t)
        potential = Energy(potential=self._border.potential)
        self.system.clock.add("riser and soil", since)
        return Energy(*as_list(stored)) + potential + self._soil.energy(solution.state), work

    def _work_of_contact(self, before: State, t: float) -> Work:
        """See `SurfaceContact.work`: without a history all is the time scheme's."""
        first, last = self._stored.get(before.t), self._border.potential
        if first is None:
            first = self._contact.energy(before).potential
        self._stored = {before.t: first, t: last}
        lost = self._border.taken - last + first
        return Work(dissipated=lost, by_scheme=lost)

    def state(self) -> Saved:
        """What contact has stored at the times known: found anew it would be the same but to round-off."""
        return {"times": np.array([*self._stored]), "stored": np.array([*self._stored.values()])}

    def restore(self, saved: Saved) -> None:
        self._stored = dict(zip(as_list(saved["times"]), as_list(saved["stored"]), strict=True))

    def renew(self) -> None:
        self._newton.renew()

    def destroy(self) -> None:
        self._newton.destroy()


class MassAmongOthers:
    """A line's mass among dofs that have none. at: the line's slice of local arrays."""

    def __init__(self, at: slice, mass: CompiledMass) -> None:
        self._at, self._mass = at, mass

    def accelerations(self, t: float, force: Array) -> Array:
        out = np.zeros_like(force)
        out[self._at] = self._mass.accelerations(t, force[self._at])
        return out

    def kinetic_energy(self, state: State) -> float:
        return self._mass.kinetic_energy(of_line(state, self._at))

    def state(self) -> Saved:
        return self._mass.state()

    def restore(self, saved: Saved) -> None:
        self._mass.restore(saved)


def of_line(state: State, at: slice) -> State:
    """A state of the line's dofs alone."""
    return State(state.t, state.u[at], state.v[at], state.a[at], dt=state.dt)
