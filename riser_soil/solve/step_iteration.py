"""Newton's method for a step over the parts of a system: residual, tangent and the rules of convergence.

The loop of lines and bodies (`band_loop`) and PETSc's SNES (`snes_loop`) call them.
"""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.communicator import any_of
from riser_soil.core.part import Forces, State, Weights
from riser_soil.core.roles import Adaptive, Limited, Yielding, with_role
from riser_soil.core.saved_state import Saved, under, within
from riser_soil.core.system import System
from riser_soil.solve.balance import Loop, OutgrownError
from riser_soil.solve.band_loop import band_loop
from riser_soil.solve.convergence import CONVERGED, ITERATING, OUTGROWN, TOO_MANY, Convergence
from riser_soil.solve.elastic_share import ElasticShare
from riser_soil.solve.line_search import step_length
from riser_soil.solve.newton_settings import NewtonSettings, limits_of
from riser_soil.solve.residual_norm import ResidualNorm, above_round_off
from riser_soil.solve.stability import PivotCounter, prescribe_free_turns, unstable_modes
from riser_soil.solve.step import NotConvergedError, Solution, Step, failure_text
from riser_soil.solve.step_trial import StepTrial

TIGHT, LOOSEST = 1e-10, 1e-2  # shares of the residual that a linear system solved by iterations may leave
BELOW = 0.1  # what it may leave, of what Newton's method is expected to leave, or may
PROBE = 1e-6  # of the prescribed motion, along which the slope of the residual is taken
STATIC = Weights.of_statics()
PATIENCE, LONGEST = 10, 4  # iterations in which a static residual halves that goes on; times as many at most


class StepIteration:
    """Newton's method over the parts. Create once a stage; the symbolic factorisation is reused throughout.

    iterations: of all its steps, those that failed included.
    """

    def __init__(self, system: System, settings: NewtonSettings) -> None:
        self.system, self.settings, self.iterations = system, settings, 0
        self._trial: StepTrial | None = None
        self._state: State | None = None  # of the unknowns that were tried last
        self._forces_at: State | None = None  # the state of the forces evaluated last
        self._adaptive: list[Adaptive] = with_role(system.model.parts, Adaptive)
        self._limited: list[Limited] = with_role(system.model.parts, Limited)
        self._elastic = ElasticShare(with_role(system.model.parts, Yielding))
        self.loop = self._new_loop()
        self._pivots = PivotCounter(system)
        self._make_vectors()

    def _new_loop(self) -> Loop:
        loop = None if self.settings.snes else band_loop(self.system, self.settings.max_iterations, self)
        if loop is not None:
            return loop
        from riser_soil.solve.snes_loop import SnesLoop

        return SnesLoop(self.system, self.settings, self)

    def _make_vectors(self) -> None:
        numbering = self.system.numbering
        self._x, self._f, self._norm = numbering.zeros(), numbering.zeros(), ResidualNorm(self.system)

    def solve(self, step: Step, at_equilibrium: bool, refined: bool = False) -> Solution:
        """Solve a step or raise NotConvergedError; at_equilibrium, refined: see `Newton`. Collective."""
        self._begin(step, at_equilibrium)
        if self.settings.linear_start and not refined and (self._moves or not self._continues()):
            self._start_linearly()
        if failure := self._iterate():
            raise NotConvergedError(failure)
        end = self._step.end_of(self._at(self._x))
        self._require_admissible(end)
        return Solution(end, self._forces, self._convergence.norms)

    @property
    def _step(self) -> StepTrial:
        """The step that is being solved."""
        assert self._trial is not None
        return self._trial

    def _at(self, x: Array) -> State:
        """State of the unknowns x; the same object while x stays the same, so that parts need not look twice."""
        increments = np.zeros(self.system.numbering.size)
        self.system.numbering.to_local(x, increments)
        u = self._step.with_prescribed(increments)
        if self._state is None or (u != self._state.u).any():
            self._state = self._step.state_at(u)
        return self._state

    def _balance(self, state: State) -> Array:
        """Local residual at a state."""
        if state is not self._forces_at:
            self._forces, self._forces_at = self.system.forces(state), state
        return self._step.balance(self._forces)

    def _require_admissible(self, end: State) -> None:
        """Raise NotConvergedError where the step's end is none of a line's states or of the parts' with limits."""
        step = self._step.step
        before = step.before if step.scheme.dynamic else None
        reasons = [line.inadmissible(end, before) for line in self.system.model.lines]
        reasons += [part.inadmissible(end) for part in self._limited]
        for reason in filter(None, reasons):
            raise NotConvergedError(reason)

    @property
    def _moves(self) -> bool:
        """Whether the step is one in time."""
        return self._step.weights.inertia > 0.0

    def _continues(self) -> bool:
        """Whether a static step goes on as those before: its guess leaves less out of balance than its loads put there.

        A motion that is prescribed puts nothing there but through the stretch of the elements beside it.
        """
        guess, add = self._step.begun.u, self.system.numbering.add_to_global
        going_on, still = (self._norm_of(add(self._balance(self._unmoved(u)))) for u in (guess, np.zeros_like(guess)))
        return going_on < still

    def _unmoved(self, u: Array) -> State:
        """State of the increments u, those of the prescribed dofs included, without rates of their own."""
        return replace(self._step.still, u=u)

    def _start_linearly(self) -> None:
        """First iteration by the tangent where the step starts: the linear response to its loads and prescribed motion,
        or in statics the guess with the response to what that lacks.

        An end that is moved alone stretches the element beside it by far, and its false tension spoils what follows. In
        a time step on soil the motion continued presses the pipe far into it, or off it.
        """
        still = np.zeros(self.system.numbering.size)
        probed = self._balance(self._unmoved(PROBE * self._step.with_prescribed(still)))
        start = self._unmoved(still)
        residual = self._balance(start)
        self._assemble(start)
        while self._outgrown():
            self._renew(start)
            self._assemble(start)
        self._convergence.first = 1
        self._convergence.add(self._respond_to(residual + (probed - residual) / PROBE, still))
        if not self._moves and any_of(self.system.comm, bool(self._step.step.guess.any())):
            self._prefer_guess(self._step.begun.u)

    def _prefer_guess(self, guess: Array) -> None:
        """Take the guess, with the tangent's response, where it is nearer to balance than the linear response alone: in
        what flows on as before, it knows which points yield.
        """
        linear = self._x
        by_linear = self._norm_of(self.residual(linear))
        norm = self._respond_to(self._balance(self._unmoved(guess)), guess)
        if self._norm_of(self.residual(self._x)) < by_linear:
            self._convergence.norms[-1] = norm
        else:
            self._x = linear

    def _respond_to(self, residual: Array, at: Array) -> float:
        """Take the tangent's response to a residual at increments; the residual's norm [N]."""
        norm = self._norm_of(self.system.numbering.add_to_global(residual))
        while failure := self._timed_respond(self.system.numbering.to_global(at)):
            if not self.loop.again:
                raise NotConvergedError(self._reason(failure))
        return norm

    def _norm_of(self, f: Array) -> float:
        """Norm of a residual (owned,) [N], which is looked at from now on; collective."""
        self._f = f
        return self._norm.of(f)

    def _timed_respond(self, at: Array) -> str:
        """Take the response of the tangent to the residual at unknowns: "", or why there is none."""
        began, counted = time.perf_counter(), self.system.clock.total
        failure, response = self.loop.respond(self._f)
        self._x = at - response
        self.system.clock.add("linear_solve", began + self.system.clock.total - counted)
        return failure

    def _iterate(self) -> str:
        """Iterate, from wherever the pattern was outgrown with a wider one, from wherever factors found too little
        room with more, and on where a static residual still falls; "" where that converges, else why not.
        """
        while True:
            ending = self._run()
            if ending == OUTGROWN:
                self._renew(self._at(self._x))
            elif ending == TOO_MANY and not self._elastic.in_vain and self._still_falls():
                self._convergence.most += self.loop.max_iterations
            elif not self.loop.again:
                self.iterations += self._convergence.iterations
                self._elastic.reset()
                return "" if ending == CONVERGED else self._reason(ending)
            self._convergence.norms.pop()

    def _run(self) -> str:
        """Iterate until that converges, the pattern is outgrown or it fails: how it ends."""
        began, counted = time.perf_counter(), self.system.clock.total
        try:
            ending = self.loop.iterate(self._x)
        except OutgrownError:
            ending = OUTGROWN
        self.system.clock.add("linear_solve", began + self.system.clock.total - counted)
        return ending

    def _still_falls(self) -> bool:
        """Whether a static step nears its end, if slowly, as where stiff ground opens and closes point after point."""
        norms, limit = self._convergence.norms, LONGEST * self.loop.max_iterations
        before, lately = norms[:-PATIENCE], norms[-PATIENCE:]
        return not self._moves and self._convergence.most < limit and min(lately) < 0.5 * min(before, default=0.0)

    def unstable_modes(self, state: State, forces: Forces | None = None, doubtful: bool = False) -> int:
        """Negative pivots at a static state; its forces may be known. doubtful: with those that may be. Without factors
        there are none, and nothing is judged. Collective.
        """
        if not self.loop.factorises:
            return 0
        scale = self._norm.in_play(self.system.forces(state) if forces is None else forces)
        negative = unstable_modes(self._pivots, state, STATIC, scale, doubtful)
        while self._outgrown():
            self._renew(state)
            negative = unstable_modes(self._pivots, state, STATIC, scale, doubtful)
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
        self.loop.release()
        self.system.renew_pattern()
        self._make_vectors()
        if self._trial is not None:
            self._trial.begin_anew()
        if self._state is not None:
            self._x, self._state = self.system.numbering.to_global(self._state.u), None
        self.loop.renew()

    def _begin(self, step: Step, at_equilibrium: bool) -> None:
        self._trial, self._state, self._forces_at = StepTrial(self.system, step), None, None
        self._x = self.system.numbering.to_global(self._trial.begun.u)
        guessed = any_of(self.system.comm, bool(self._x.any()))
        near = self.system.smooth and self._moves
        done_at_start = at_equilibrium or guessed  # else a load as small as round-off moves the riser, too
        limits = limits_of(self.settings, near, False, done_at_start, step.scheme.step_over_trial)
        self._convergence = Convergence(limits)
        self._convergence.most = self.loop.max_iterations

    def residual(self, x: Array) -> Array:
        """Residual of the unknowns, both (owned,); collective."""
        return self.system.numbering.add_to_global(self._balance(self._at(x)))

    def shortened(self, x: Array, y: Array) -> Array:
        """The step -y from x, whose residual is known, to the length that the line search finds: a part of y."""
        if not self.settings.line_search:
            return y

        def along(f: Array) -> float:
            return -self.system.sum([float(f @ y)])[0]

        self.note_step_length(step_length(along(self._f), lambda part: along(self.residual(x - part * y))))
        return self._elastic.length * y

    def note_step_length(self, part: float) -> None:
        """Record the part of a step that a line search has chosen."""
        self._elastic.length = part

    def _assemble(self, state: State) -> None:
        self.system.assemble(state, self._step.weights)
        if self._step.weights.inertia == 0.0:
            prescribe_free_turns(self.system, state, self._tolerated)

    def _outgrown(self) -> bool:
        """Whether something in the tangent assembled last had no place in the pattern; collective."""
        if not self._adaptive:
            return False
        return any_of(self.system.comm, any(part.outgrown for part in self._adaptive))

    def tangent(self, x: Array) -> None:
        """Assemble the tangent of the next iteration, unless that of the previous one can be reused; OutgrownError
        where it lacks places.
        """
        if self._convergence.keeps_tangent:
            return
        self._assemble(self._at(x))
        if self._outgrown():
            raise OutgrownError

    def judge(self, x: Array, f: Array, small: bool | None = None) -> str:
        """How the iteration ends at unknowns with the residual f, else ITERATING; OutgrownError where forces act
        that the tangent has no places for. The unknowns judged last are the solution. small: whether the residual is,
        by tolerances beside the settings'; None where these decide. Collective.
        """
        self._x, self._f = x, f
        self._convergence.add(self._norm.of(f))
        ending = self._convergence.ending(self._norm.in_play(self._forces), self._at_round_off, small)
        if ending == CONVERGED and self._outgrown():
            raise OutgrownError
        return self._yields() if ending == ITERATING else ending

    def _yields(self) -> str:
        """Adapt the share of the elastic tangent in the next one, where that is to be new; TOO_MANY where it is all of
        it in vain.
        """
        convergence = self._convergence
        if not convergence.keeps_tangent and convergence.iterations > max(convergence.first, 1):
            self._elastic.adapt(*convergence.norms[:-3:-1])
        return TOO_MANY if self._elastic.in_vain else ITERATING

    def _at_round_off(self) -> bool:
        """Whether all of the residual may be round-off; collective. Overwrites the matrix."""
        magnitudes = self.system.magnitudes(self._at(self._x), self._step.weights)
        sizes = self.system.numbering.sizes_to_global(magnitudes)
        return not any_of(self.system.comm, bool(above_round_off(self._f, sizes)))

    def linear_tolerance(self) -> float:
        """Share of the residual that the next linear system may leave.

        A fall by a factor f promises a next one by f² (Eisenstat & Walker, SIAM J. Sci. Comput. 17, 1996, choice 2,
        from memory); the linear residual stays below that, or below Newton's tolerance.
        """
        convergence = self._convergence
        norm = convergence.norms[-1]
        before = convergence.norms[-2] if convergence.iterations > convergence.first else 0.0
        if not 0.0 < norm < before:
            return LOOSEST
        enough = self._tolerated / norm
        return min(max(BELOW * (norm / before) ** 2, BELOW * enough, TIGHT), LOOSEST)

    @property
    def _tolerated(self) -> float:
        """Norm of the residual [N] that the settings count as small beside the forces in play; collective."""
        ratio = self._step.step.scheme.step_over_trial  # of their balance over that of a trial, see `limits_of`
        return self.settings.tolerance / ratio * self._norm.in_play(self._forces)

    def negligible(self) -> float:
        """Residual [N] that need not be reduced: it is below Newton's tolerance; collective."""
        return BELOW * self._tolerated

    def _reason(self, why: str) -> str:
        """Message why the step did not converge, with the place where it is most out of balance."""
        return failure_text(why, self._convergence.norms, self._norm.largest(self._f))

    def state(self) -> Saved:
        """State of the linear solver."""
        return under("linear", self.loop.state())

    def restore(self, saved: Saved) -> None:
        self.loop.restore(within(saved, "linear"))

    def destroy(self) -> None:
        self.loop.destroy()
