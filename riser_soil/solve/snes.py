"""Newton's iteration by PETSc's SNES: of riser and soil, of several ranks, and where a scene asks for it.

SNES iterates; residual and tangent are its callbacks, and the user's options, as -riser_soil_snes_monitor, go before
all that is set here (`petsc_options`). Three things are the project's own as long as these choose no others:

- the test: a residual is small beside the forces in play, which SNES's tolerances don't know;
- the line search: it goes backwards, too, where the energy climbs, which none of PETSc's does;
- the linear solvers: sections, kept factors, a riser that touches nothing, for which PETSc has none (`tangent_solver`).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack

import numpy as np
from petsc4py import PETSc

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.solve.convergence import CONVERGED, DIVERGED, ITERATING, NOT_FINITE, TOO_MANY
from riser_soil.solve.newton_loop import Balance, Loop
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.petsc_options import PREFIX, UserOptions, as_text, defaults, refuse_unread, set_from_options
from riser_soil.solve.tangent_solver import TangentSolver

REASON = PETSc.SNES.ConvergedReason
UNLIMITED = 10**6  # iterations: the balance says when there are too many
REASONS = {
    ITERATING: REASON.ITERATING,
    CONVERGED: REASON.CONVERGED_FNORM_RELATIVE,
    DIVERGED: REASON.DIVERGED_DTOL,
    TOO_MANY: REASON.DIVERGED_MAX_IT,
    NOT_FINITE: REASON.DIVERGED_FNORM_NAN,
}


class SnesLoop(Loop):
    """SNES over the balance of a system. Its symbolic factorisation is reused throughout."""

    def __init__(self, system: System, settings: NewtonSettings, balance: Balance) -> None:
        self._system, self._settings, self._balance = system, settings, balance
        with ExitStack() as stack:
            stack.enter_context(defaults(as_text(settings.petsc_options)))
            self._user = user = UserOptions.now()
            self._tangents = TangentSolver(system, settings.linear, user)
            before_soil = settings.has_soil and not system.model.others  # whose solvers read options, too
            self._all_read = before_soil or not user.any
            self.linear, self.factorises = self._tangents.solver, self._tangents.solver.factorises
            self._create()
            self._options = stack.pop_all()

    def _create(self) -> None:
        self._x, self._f = self._system.matrix.mat.createVecs()
        self._before: Array = np.array(self._x.array_r)
        self._snes = snes = PETSc.SNES().create(self._system.comm)
        snes.setOptionsPrefix(PREFIX)
        snes.setType(PETSc.SNES.Type.NEWTONLS)
        snes.setFunction(self._function, self._f)
        snes.setJacobian(self._jacobian, self._system.matrix.mat)
        snes.setConvergenceTest(self._test)
        snes.setTolerances(rtol=0.0, atol=0.0, stol=0.0, max_it=self._settings.max_iterations)
        if self._settings.line_search and not self._user.line_search:
            snes.setLineSearchPreCheck(self._shorten)  # before "basic", which takes all of what it leaves
        self._tangents.attach(snes.getKSP())
        set_from_options(snes, {"snes_linesearch_type": "basic", **self.linear.options})
        snes.setErrorIfNotConverged(False)  # a step that fails is cut
        self.max_iterations = snes.max_it

    def _function(self, snes: PETSc.SNES, x: PETSc.Vec, f: PETSc.Vec) -> None:
        f.array_w[:] = self._balance.residual(np.array(x.array_r))

    def _jacobian(self, snes: PETSc.SNES, x: PETSc.Vec, jacobian: PETSc.Mat, p: PETSc.Mat) -> None:
        """Assemble the tangent and choose its solver. A tangent that is used again keeps its factors."""
        self._balance.tangent(np.array(x.array_r))
        snes.setKSP(self._tangents.next(self._f, self._balance))

    def _test(self, snes: PETSc.SNES, iteration: int, norms: tuple[float, float, float]) -> int:
        x = np.array(self._x.array_r)
        if self._user.line_search and iteration > 0 and norms[1] > 0.0:
            moved = self._system.sum([float(np.sum((x - self._before) ** 2))])[0] ** 0.5
            self._balance.note_step_length(moved / norms[1])
        self._before = x
        small = self._user.small(snes, iteration, *norms) if self._user.tolerances else None
        return int(REASONS[self._balance.judge(x, np.array(self._f.array_r), small)])

    def _shorten(self, x: PETSc.Vec, y: PETSc.Vec) -> bool:
        """Scale the step -y from x to the length that the line search finds; whether that changed it."""
        step = np.array(y.array_r)
        y.array_w[:] = shortened = self._balance.shortened(np.array(x.array_r), step)
        return shortened is not step

    def iterate(self, x: Array) -> str:
        self._x.array_w[:] = x
        self._snes.setTolerances(max_it=UNLIMITED)
        if failure := self._failure(self._solve):
            return failure
        if self._tangents.used and not self._all_read:
            refuse_unread(self._snes)
            self._all_read = True
        return _ending(self._snes.reason)

    def _solve(self) -> bool:
        """Let SNES iterate; whether it could solve all its linear systems."""
        self._snes.solve(None, self._x)
        return bool(self._snes.reason != REASON.DIVERGED_LINEAR_SOLVE)

    def respond(self, f: Array) -> tuple[str, Array]:
        self._f.array_w[:] = f
        failure = self._failure(lambda: self._tangents.solve(self._f, self._x, self._balance))
        return failure, np.array(self._x.array_r)

    def _failure(self, solved: Callable[[], bool]) -> str:
        """Why linear systems could not be solved, "" where they could; after a failure all is made anew."""
        failure = self._tangents.failure(solved)
        if failure:
            self.release()
            self._create()
        return failure

    @property
    def again(self) -> bool:
        return self._tangents.again

    def renew(self) -> None:
        """Make all anew for the matrix that the system has now."""
        self.linear.renew()
        self._create()

    def release(self) -> None:
        """Free the matrix, which another one is to replace. Factors go first and on all ranks at once; SNES itself may
        live longer in the frames of an exception, such as numba's on the rank that compiles a kernel.
        """
        self._tangents.drop()
        self._snes.reset()
        for thing in (self._snes, self._x, self._f):
            thing.destroy()

    def state(self) -> Saved:
        return self.linear.state()

    def restore(self, saved: Saved) -> None:
        self.linear.restore(saved)

    def destroy(self) -> None:
        self.release()
        self.linear.forget()
        self._options.close()
        del self._balance  # which refers to this: both are freed now, not by a later garbage collection


def _ending(reason: int) -> str:
    """How SNES has ended, in the words of `convergence`; failures by PETSc's name."""
    names_of = {number: name for name, number in REASONS.items()}
    names = (name for name, value in vars(REASON).items() if value == reason and name.startswith("DIV"))
    return names_of.get(reason) or next(names, str(reason)).lower()
