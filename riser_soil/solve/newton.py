"""Newton's method for one step, by PETSc's SNES."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from functools import cached_property

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, State, Work, local
from riser_soil.core.roles import Adaptive, with_role
from riser_soil.core.saved_state import Saved, under, within
from riser_soil.core.system import System
from riser_soil.solve.bordered_band import SingularError
from riser_soil.solve.failed_step import place_of_largest, reason_name
from riser_soil.solve.line_search import step_length
from riser_soil.solve.linear_solver import PREFIX, complaint, defaults
from riser_soil.solve.linear_systems import linear_systems
from riser_soil.solve.riser_mass import RiserMass
from riser_soil.solve.round_off import ROUND_OFF, stays
from riser_soil.solve.solution import NewtonSettings, NotConvergedError, Solution, Step, UnstableError, told
from riser_soil.solve.stability import prescribe_free_turns, unstable_modes
from riser_soil.solve.time_scheme import Static

CONVERGED = PETSc.SNES.ConvergedReason.CONVERGED_FNORM_RELATIVE
DIVERGED = PETSc.SNES.ConvergedReason.DIVERGED_DTOL
NOT_SOLVED = PETSc.SNES.ConvergedReason.DIVERGED_LINEAR_SOLVE
ITERATING = PETSc.SNES.ConvergedReason.ITERATING
OUTGROWN = PETSc.SNES.ConvergedReason.CONVERGED_ITS  # stops where the matrix' pattern lacks places
LOOSE, TIGHT = 1e-5, 1e-10  # shares of the residual that a linear system solved by iterations may leave
BELOW = 0.1  # what it may leave, of what Newton's method is expected to leave, or may
PROBE = 1e-6  # of the prescribed motion, along which the slope of the residual is taken
STATIC = Static().weights(0.0)


class Newton:
    """Solver of a system's steps. Create once a stage; the symbolic factorisation is reused throughout.

    iterations: of all its steps, those that failed included. rests: whether the next step starts from the equilibrium
    of its own loads, so that a residual within round-off needs no iteration.
    """

    def __init__(self, system: System, settings: NewtonSettings) -> None:
        self.system, self.settings = system, settings
        self.iterations, self.rests = 0, False
        self._state: State | None = None
        self._known: State | None = None  # whose forces are known
        self._try_again = False
        self._make_vectors()
        self._adaptive: list[Adaptive] = with_role(system.model.parts, Adaptive)
        self.linear = linear_systems(system, settings.linear)
        self._snes = self._create()

    def _make_vectors(self) -> None:
        numbering = self.system.numbering
        self._x, self._f, self._levers = (numbering.vector.duplicate() for _ in range(3))
        numbering.to_global(self.system.levers, self._levers)

    def _create(self) -> PETSc.SNES:
        snes = PETSc.SNES().create(self.system.comm)
        snes.setType(PETSc.SNES.Type.NEWTONLS)
        snes.setFunction(self._function, self._f)
        snes.setJacobian(self._jacobian, self.system.matrix.mat)
        snes.setConvergenceTest(self._test)
        snes.setTolerances(max_it=self.settings.max_iterations)
        if self.settings.line_search:
            snes.setLineSearchPreCheck(self._shorten)
        self.linear.serve(snes.getKSP(), self._levers)
        snes.setOptionsPrefix(PREFIX)
        with defaults({"snes_linesearch_type": "basic"}):
            snes.setFromOptions()
        return snes

    def solve(self, step: Step) -> Solution:
        """Solve a step or raise NotConvergedError; collective."""
        self._begin(step)
        if self.settings.linear_start and self._weights.inertia == 0.0 and not self._continues():
            self._start_linearly()
        if failure := self._iterate():
            raise NotConvergedError(failure)
        state = self._trial(self._x)
        self.require_admissible(state)
        return Solution(state, self._forces, self._norms)

    @cached_property
    def mass(self) -> RiserMass:
        """Inverse of the lines' mass."""
        return RiserMass(self.system)

    def bulk_forces(self, state: State) -> Forces:
        """Forces of groups I and F at an accepted state, those of group E zero; collective."""
        return self.system.forces(state, "IF")

    def _continues(self) -> bool:
        """Whether a static step goes on as those before: its guess leaves less out of balance than its loads put there.

        A motion that is prescribed puts nothing there but through the stretch of the elements beside it.
        """
        still = np.zeros_like(self._step.guess)
        return self._out_of_balance(self._with_prescribed(self._step.guess)) < self._out_of_balance(still)

    def _start_linearly(self) -> None:
        """First iteration of a static step: the linear response to its loads and prescribed motion where it starts.

        An end that is moved alone stretches the element beside it by far, and its false tension spoils what follows.
        """
        still = np.zeros_like(self._step.guess)
        _, probed = self._balance(PROBE * self._with_prescribed(still))
        start, residual = self._balance(still)
        self._assemble(start)
        while self._outgrown():
            self._renew(start)
            self._assemble(start)
        self.system.numbering.add_to_global(residual + (probed - residual) / PROBE, self._f)
        self._norms.append(self._norm())
        self._first = 1
        while failure := self._failing(self._respond, lambda: self._snes.getKSP().reason < 0):
            if not self._try_again:
                raise NotConvergedError(failure)
        self._x.scale(-1.0)

    def _respond(self) -> None:
        """Solve the linear system of the tangent and the residual."""
        solver = self._snes.getKSP()
        solver.setOperators(self.system.matrix.mat)
        solver.setTolerances(rtol=LOOSE)
        solver.solve(self._f, self._x)

    def _with_prescribed(self, u: Array) -> Array:
        """Increments with those that are prescribed in the step."""
        out = u.copy()
        out[self.system.prescribed_dofs] = self._prescribed.u[self.system.prescribed_dofs]
        return out

    def _out_of_balance(self, u: Array) -> float:
        """Norm of the residual of increments [N]; collective."""
        self.system.numbering.add_to_global(self._balance(u)[1], self._f)
        return self._norm()

    def _balance(self, u: Array) -> tuple[State, Array]:
        """State of the increments u, those of the prescribed dofs included, and its residual."""
        state = State(self._step.t, u, self._still.v, self._still.a)
        self._forces, self._known = self.system.forces(state), state
        return state, self._step.scheme.combine(self._forces, self._past)

    def _iterate(self) -> str:
        """Iterate, from wherever the pattern was outgrown with a wider one, and from wherever factors found too little
        room with more; "" where that converges, else why not.
        """
        while True:
            failure = self._run()
            if not (failure and self._try_again):
                if failure or self._snes.reason != OUTGROWN:
                    self.iterations += self._taken
                    return failure
                self._renew(self._balanced)
            self._norms.pop()

    def _run(self) -> str:
        """Iterate until that converges or the pattern is outgrown: "", else why it has failed."""
        self._snes.setTolerances(max_it=self.settings.max_iterations - self._taken)
        failure = self._failing(lambda: self._snes.solve(None, self._x), lambda: self._snes.reason == NOT_SOLVED)
        return failure or ("" if self._snes.reason > 0 else self._reason(self._snes.reason))

    def _failing(self, solve: Callable[[], None], unsolved: Callable[[], bool]) -> str:
        """Call a solver; why its linear systems could not be solved, else "". No factors outlive a failed
        factorisation: MUMPS would refuse all that comes after it.
        """
        began, counted, complained = time.perf_counter(), self.system.clock.total, ""
        self._try_again = False
        try:
            solve()
        except (PETSc.Error, SingularError) as err:
            complained = complaint(err)
            if not complained:
                raise
        self.system.clock.add("linear_solve", began + self.system.clock.total - counted)
        if not complained and not unsolved():
            return ""
        why, self._try_again = self.linear.failed(self._snes.getKSP())
        failure = self._reason(NOT_SOLVED, complained or why)
        self._snes.destroy()
        self._snes = self._create()
        return failure

    @property
    def _taken(self) -> int:
        """Iterations of the step so far; a residual that is not finite at its start is none."""
        return max(len(self._norms) - 1, 0)

    def turned_over(self, before: State, solution: Solution) -> tuple[Energy, dict[str, Work]]:
        """Energy stored at the end of a step solved from an accepted state, and what each part turned over in it;
        collective.
        """
        return self.system.energy(solution.state), self.system.work(before, solution.state)

    def require_admissible(self, state: State) -> None:
        """Raise NotConvergedError where a state in balance is none of the line."""
        for line in self.system.model.lines:
            if reason := line.inadmissible(state):
                raise NotConvergedError(reason)

    def require_stable(self, solution: Solution) -> None:
        """Raise UnstableError where a static solution is an unstable equilibrium, such as an unbuckled strut.

        Stable means that the tangent there has no negative pivot, see `stability`. Parts that follow the line are left
        out of it; where others lack symmetry too, such as moments in space, nothing is judged. Collective.
        """
        negative = self.unstable_modes(solution.state, solution.forces)
        if negative > 0:
            raise UnstableError(
                f"the equilibrium found is unstable (its tangent has {negative} negative pivot(s)): the riser would "
                "buckle or swing away from it; start from a shape nearer to the one that it takes",
                solution,
            )

    def unstable_modes(self, state: State, forces: Forces | None = None, doubtful: bool = False) -> int:
        """Negative pivots at a static state; its forces may be known. doubtful: with those that may be. Without factors
        there are none, and nothing is judged. Collective.
        """
        if not self.linear.factorises:
            return 0
        scale = self._scale(self.system.forces(state) if forces is None else forces)
        negative = unstable_modes(self.system, state, STATIC, scale, doubtful)
        while self._outgrown():
            self._renew(state)
            negative = unstable_modes(self.system, state, STATIC, scale, doubtful)
        return negative

    def _renew(self, state: State) -> None:
        """Take a matrix that has places for all that the tangent holds at a state."""
        for part in self._adaptive:
            if part.outgrown:
                part.rebuild(state)
        self.renew()

    def renew(self) -> None:
        """Take a matrix of the pattern that the parts have now, and of the dofs that they act on, if any can change."""
        if not self._adaptive:
            return
        self._release()
        self.linear.renew()
        self.system.renew_pattern()
        self._make_vectors()
        if self._state is not None:
            self.system.numbering.to_global(self._state.u, self._x)
            self.system.prescribe(self._prescribed)
            self._state = None
        self._snes = self._create()

    def _begin(self, step: Step) -> None:
        self._step, self._norms, self._first = step, list[float](), 0
        self._weights, self._past = step.scheme.weights(step.dt), step.scheme.past(step.start)
        self._still = step.scheme.trial(step.before, step.t, step.dt, np.zeros_like(step.guess))
        self._prescribed = State(step.t, *(x.copy() for x in (step.guess, self._still.v, self._still.a)))
        self.system.prescribe(self._prescribed)
        self._state = None
        self.system.numbering.to_global(step.guess, self._x)
        self._answers_load = self.rests or self._x.norm() > 0.0  # one like round-off has an answer, too
        self.rests = False

    def _trial(self, x: PETSc.Vec) -> State:
        """State of the unknowns x; the same object while x stays the same, so that parts need not look twice."""
        found = np.zeros(self.system.numbering.size)
        self.system.numbering.to_local(x, found)
        u = self._with_prescribed(found)
        if self._state is None or (u != self._state.u).any():
            self._state = self._follow(u)
            self._balanced = self._step.scheme.balanced_at(self._step.before, self._state, self._step.dt)
        return self._state

    def _follow(self, u: Array) -> State:
        """State of the increments u: rates follow them by the scheme's shifts, but for the prescribed ones."""
        v = self._still.v + self._weights.shift_v * u
        a = self._still.a + self._weights.shift_a * u
        at = self.system.prescribed_dofs
        v[at], a[at] = self._prescribed.v[at], self._prescribed.a[at]
        return State(self._step.t, u, v, a)

    def _function(self, snes: PETSc.SNES, x: PETSc.Vec, f: PETSc.Vec) -> None:
        self._trial(x)
        if self._balanced is not self._known:
            self._forces, self._known = self.system.forces(self._balanced), self._balanced
        residual = self._step.scheme.combine(self._forces, self._past)
        self.system.numbering.add_to_global(residual, f)

    def _shorten(self, x: PETSc.Vec, y: PETSc.Vec) -> bool:
        """Scale the step -y from x to the length that the line search finds; whether that changed it."""
        tried, found = x.duplicate(), x.duplicate()

        def slope(part: float) -> float:
            x.copy(tried)
            tried.axpy(-part, y)
            self._function(self._snes, tried, found)
            return -float(found.dot(y))

        part = step_length(-float(self._f.dot(y)), slope)
        y.scale(part)
        for vector in (tried, found):
            vector.destroy()
        return part != 1.0

    def _jacobian(self, snes: PETSc.SNES, x: PETSc.Vec, jacobian: PETSc.Mat, p: PETSc.Mat) -> None:
        """The convergence test has assembled it; a matrix that it has left as it was keeps its factors."""

    def _assemble(self, state: State) -> None:
        self.system.assemble(state, self._weights)
        if self._weights.inertia == 0.0:
            prescribe_free_turns(self.system, state, self.settings.tolerance * self._scale(self._forces))

    def _outgrown(self) -> bool:
        """Whether something in the tangent assembled last had no place in the pattern; collective."""
        if not self._adaptive:
            return False
        return bool(self.system.comm.allreduce(any(part.outgrown for part in self._adaptive), MPI.LOR))

    def _reusable(self) -> bool:
        """Whether the tangent of the previous iteration can be reused."""
        if not self._starts_near or len(self._norms) < 2:
            return False
        return self._norms[-1] < self.settings.reuse * self._norms[-2]

    @property
    def _least_iterations(self) -> int:
        """A motion that continues by its first guess alone would keep its errors."""
        return max(self.settings.least_iterations, int(self._starts_near))

    @property
    def _starts_near(self) -> bool:
        """Whether the guess continues a smooth motion: time steps without contact."""
        return self.system.smooth and self._weights.inertia > 0.0

    def _test(self, snes: PETSc.SNES, iteration: int, norms: tuple[float, float, float]) -> int:
        reason = self._tested()
        return OUTGROWN if reason == CONVERGED and self._outgrown() else reason

    def _tested(self) -> int:
        norm = self._norm()
        self._norms.append(norm)
        if not np.isfinite(norm):
            return PETSc.SNES.ConvergedReason.DIVERGED_FNORM_NAN
        if self._taken < self._least_iterations:
            return self._next_tangent()
        if norm <= self.settings.tolerance * self._scale(self._forces):
            return CONVERGED
        if norm <= self.settings.floor and (self._taken > 0 or self._answers_load):
            return CONVERGED
        if stays(self._norms) and self._at_round_off():
            return CONVERGED
        if self._taken >= 4 and norm > 1e6 * self._norms[self._first]:
            return DIVERGED
        return self._next_tangent()

    def _at_round_off(self) -> bool:
        """Whether nothing in the residual can be told from its round-off; collective. Leaves another matrix behind."""
        self._trial(self._x)
        sizes = self._f.duplicate()
        self.system.numbering.add_to_global(self.system.magnitudes(self._balanced, self._weights), sizes)
        above = bool((np.abs(self._f.array_r) > ROUND_OFF * sizes.array_r).any())
        sizes.destroy()
        return not self.system.comm.allreduce(above, MPI.LOR)

    def _next_tangent(self) -> int:
        """Assemble that of the next iteration, if there is one with a tangent of its own; whether it has a place."""
        if self.linear.to_tolerance:
            self._snes.getKSP().setTolerances(rtol=self._linear_tolerance())
        if self._taken >= self.settings.max_iterations or self._reusable():
            return ITERATING
        self._trial(self._x)
        self._assemble(self._balanced)
        return OUTGROWN if self._outgrown() else ITERATING

    def _linear_tolerance(self) -> float:
        """Share of the residual that the next linear system may leave.

        A fall by a factor f promises a next one by f² (Eisenstat & Walker, SIAM J. Sci. Comput. 17, 1996, choice 2,
        from memory); what is left stays below that, or below Newton's tolerance.
        """
        norm, before = self._norms[-1], self._norms[-2] if self._taken > self._first else 0.0
        if not 0.0 < norm < before:
            return LOOSE
        enough = self.settings.tolerance * self._scale(self._forces) / norm
        return min(max(BELOW * (norm / before) ** 2, BELOW * enough, TIGHT), LOOSE)

    def _norm(self) -> float:
        """Norm of the residual [N]; collective."""
        return math.sqrt(self.system.sum([float(np.sum(self._weighed() ** 2))])[0])

    def _scale(self, forces: Forces) -> float:
        """Norm of the forces in play: reactions, inertia, contact on the lines."""
        system = self.system
        reactions = system.reactions(forces) / system.levers[system.prescribed_dofs]
        inertia = forces.inertia / system.levers
        contact = np.concatenate([(forces.end / system.levers)[local(line)] for line in system.model.lines])
        mine = [float(f @ f) for f in (reactions, inertia, contact)]
        return math.sqrt(max(system.sum(mine)))

    def _reason(self, reason: int, complained: str = "") -> str:
        """Why the step did not converge: PETSc's reason, or what the linear solver has complained of."""
        why = complained or reason_name(reason)
        place = place_of_largest(self.system, self._weighed(), self._f.getOwnershipRange()[0])
        return told(why, self._norms, place)

    def _weighed(self) -> Array:
        """This rank's residual [N], moments over the lever."""
        return np.asarray(self._f.array_r / self._levers.array_r)

    def state(self) -> Saved:
        """What is kept of linear systems."""
        return under("linear", self.linear.state())

    def restore(self, saved: Saved) -> None:
        self.linear.restore(within(saved, "linear"))

    def destroy(self) -> None:
        self._release()
        self.linear.forget()

    def _release(self) -> None:
        for thing in (self._snes, self._x, self._f, self._levers):
            thing.destroy()
