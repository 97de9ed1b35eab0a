"""SNES from step to step: made for the matrix of a system, and anew with another one or after a failure."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack

import numpy as np
from petsc4py import PETSc

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.solve.balance import Balance, Loop
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.petsc_options import PREFIX, UserOptions, as_text, defaults, refuse_unread, set_from_options
from riser_soil.solve.snes import REASON, REASONS, SnesCallbacks
from riser_soil.solve.tangent_solver import TangentSolver

UNLIMITED = 10**6  # iterations: the balance says when there are too many


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
        self._callbacks = callbacks = SnesCallbacks(self._system, self._balance, self._tangents, self._user)
        self._x, self._f = callbacks.x, callbacks.f
        self._snes = snes = PETSc.SNES().create(self._system.comm)
        snes.setOptionsPrefix(PREFIX)
        snes.setType(PETSc.SNES.Type.NEWTONLS)
        snes.setTolerances(rtol=0.0, atol=0.0, stol=0.0, max_it=self._settings.max_iterations)
        callbacks.register(snes, self._settings.line_search)
        self._tangents.attach(snes.getKSP())
        set_from_options(snes, {"snes_linesearch_type": "basic", **self.linear.options})
        snes.setErrorIfNotConverged(False)  # a step that fails is cut
        self.max_iterations = snes.max_it

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
        del self._balance, self._callbacks  # which refer to this: all are freed now, not by a later garbage collection


def _ending(reason: int) -> str:
    """How SNES has ended, in the words of `convergence`; failures by PETSc's name."""
    names_of = {number: name for name, number in REASONS.items()}
    names = (name for name, value in vars(REASON).items() if value == reason and name.startswith("DIV"))
    return names_of.get(reason) or next(names, str(reason)).lower()
