"""Newton's iteration by PETSc's SNES: residual and tangent are its callbacks.

The user's options, as -riser_soil_snes_monitor, go before all that is set here (`petsc_options`). Three things are the
project's own as long as these choose no others:

- the test: a residual is small beside the forces in play, which SNES's tolerances don't know;
- the line search: it goes backwards, too, where the energy climbs, which none of PETSc's does;
- the linear solvers: sections, kept factors, a riser that touches nothing, for which PETSc has none (`tangent_solver`).
"""

from __future__ import annotations

import numpy as np
from petsc4py import PETSc

from riser_soil.core.arrays import Array
from riser_soil.core.system import System
from riser_soil.solve.balance import Balance
from riser_soil.solve.convergence import CONVERGED, DIVERGED, ITERATING, NOT_FINITE, TOO_MANY
from riser_soil.solve.petsc_options import UserOptions
from riser_soil.solve.tangent_solver import TangentSolver

REASON = PETSc.SNES.ConvergedReason
REASONS = {
    ITERATING: REASON.ITERATING,
    CONVERGED: REASON.CONVERGED_FNORM_RELATIVE,
    DIVERGED: REASON.DIVERGED_DTOL,
    TOO_MANY: REASON.DIVERGED_MAX_IT,
    NOT_FINITE: REASON.DIVERGED_FNORM_NAN,
}


class SnesCallbacks:
    """What SNES calls for a balance, with its unknowns x and its residual f; collective."""

    def __init__(self, system: System, balance: Balance, tangents: TangentSolver, user: UserOptions) -> None:
        self._system, self._balance, self._tangents, self._user = system, balance, tangents, user
        self.x, self.f = system.matrix.mat.createVecs()
        self._before: Array = np.array(self.x.array_r)

    def register(self, snes: PETSc.SNES, line_search: bool) -> None:
        """Have SNES call these; line_search: whether steps are shortened."""
        snes.setFunction(self._function, self.f)
        snes.setJacobian(self._jacobian, self._system.matrix.mat)
        snes.setConvergenceTest(self._test)
        if line_search and not self._user.line_search:
            snes.setLineSearchPreCheck(self._shorten)  # before "basic", which takes all of what it leaves

    def _function(self, snes: PETSc.SNES, x: PETSc.Vec, f: PETSc.Vec) -> None:
        f.array_w[:] = self._balance.residual(np.array(x.array_r))

    def _jacobian(self, snes: PETSc.SNES, x: PETSc.Vec, jacobian: PETSc.Mat, p: PETSc.Mat) -> None:
        """Assemble the tangent and choose its solver. A tangent that is used again keeps its factors."""
        self._balance.tangent(np.array(x.array_r))
        snes.setKSP(self._tangents.next(self.f, self._balance))

    def _test(self, snes: PETSc.SNES, iteration: int, norms: tuple[float, float, float]) -> int:
        x = np.array(self.x.array_r)
        if self._user.line_search and iteration > 0 and norms[1] > 0.0:
            moved = self._system.sum([float(np.sum((x - self._before) ** 2))])[0] ** 0.5
            self._balance.note_step_length(moved / norms[1])
        self._before = x
        small = self._user.small(snes, iteration, *norms) if self._user.tolerances else None
        return int(REASONS[self._balance.judge(x, np.array(self.f.array_r), small)])

    def _shorten(self, x: PETSc.Vec, y: PETSc.Vec) -> bool:
        """Scale the step -y from x to the length that the line search finds; whether that changed it."""
        step = np.array(y.array_r)
        y.array_w[:] = shortened = self._balance.shortened(np.array(x.array_r), step)
        return shortened is not step
