"""Newton's iteration by PETSc's SNES: of riser and soil, of several ranks, and where a scene asks for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from petsc4py import PETSc

from riser_soil.core.arrays import Array
from riser_soil.core.factor_memory import Workspace
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.solve.chain import (
    CONVERGED,
    DIVERGED,
    ITERATING,
    LOOSE,
    NOT_FINITE,
    NOT_SOLVED,
    OUTGROWN,
    TOO_MANY,
    Balance,
    Loop,
)
from riser_soil.solve.iterative_solver import IterativeSolver, solid_of
from riser_soil.solve.kept_factors import KeptFactors
from riser_soil.solve.linear_solver import (
    PREFIX,
    LinearSystems,
    RiserAboveSoil,
    SingularError,
    complaint,
    defaults,
    factorise_directly,
    keeps_factors,
)
from riser_soil.solve.section_solver import SectionSolver, sections_of
from riser_soil.solve.solver import NewtonSettings

REASON = PETSc.SNES.ConvergedReason
REASONS = {
    ITERATING: REASON.ITERATING,
    CONVERGED: REASON.CONVERGED_FNORM_RELATIVE,
    OUTGROWN: REASON.CONVERGED_ITS,
    DIVERGED: REASON.DIVERGED_DTOL,
    TOO_MANY: REASON.DIVERGED_MAX_IT,
    NOT_FINITE: REASON.DIVERGED_FNORM_NAN,
}


class SnesLoop(Loop):
    """SNES with the project's tests and linear solvers. Its symbolic factorisation is reused throughout."""

    def __init__(self, system: System, settings: NewtonSettings, balance: Balance) -> None:
        self._system, self._settings, self._balance = system, settings, balance
        self.again = False
        self.linear = linear_systems(system, settings.linear)
        self.factorises = self.linear.factorises
        self._make()

    def _make(self) -> None:
        owned, comm = self._system.numbering.owned, self._system.comm
        self._x, self._f, self._levers = (PETSc.Vec().createMPI((owned, PETSc.DETERMINE), comm=comm) for _ in range(3))
        self._levers.array_w[:] = self._system.numbering.to_global(self._system.levers)
        self._alone: RiserAboveSoil | None = None
        if self._system.whole_soil is not None:
            self._alone = RiserAboveSoil(self._system)
        self._snes = self._create()

    def _create(self) -> PETSc.SNES:
        snes = PETSc.SNES().create(self._system.comm)
        snes.setType(PETSc.SNES.Type.NEWTONLS)
        snes.setFunction(self._function, self._f)
        snes.setJacobian(self._jacobian, self._system.matrix.mat)
        snes.setConvergenceTest(self._test)
        snes.setTolerances(max_it=self._settings.max_iterations)
        if self._settings.line_search:
            snes.setLineSearchPreCheck(self._shorten)
        self._coupled = snes.getKSP()
        self.linear.serve(self._coupled, self._levers)
        snes.setOptionsPrefix(PREFIX)
        with defaults({"snes_linesearch_type": "basic"}):
            snes.setFromOptions()
        self._uncoupled: PETSc.KSP | None = None
        if self._alone is not None:
            self._uncoupled = PETSc.KSP().create(self._system.comm)
            self._alone.serve(self._uncoupled)
        return snes

    def _choose(self, f: PETSc.Vec) -> PETSc.KSP:
        """The solver of the present tangent and a residual, which SNES gets."""
        if self._alone is None:
            return self._coupled
        alone = self._alone.suits(np.array(f.array_r), self._balance.negligible())
        chosen = self._uncoupled if alone else self._coupled
        self._snes.setKSP(chosen)
        return chosen

    def iterate(self, x: Array, most: int) -> str:
        """By SNES."""
        self._snes.setTolerances(max_it=most)
        self._x.array_w[:] = x
        unsolved = REASON.DIVERGED_LINEAR_SOLVE
        failure = self._failing(lambda: self._snes.solve(None, self._x), lambda: self._snes.reason == unsolved)
        return failure or _ending(self._snes.reason)

    def respond(self, f: Array) -> tuple[str, Array]:
        """By the linear solver that SNES has."""
        self._f.array_w[:] = f
        solver = self._choose(self._f)
        failure = self._failing(lambda: self._respond(solver), lambda: solver.reason < 0)
        return failure, np.array(self._x.array_r)

    def _respond(self, solver: PETSc.KSP) -> None:
        solver.setOperators(self._system.matrix.mat)
        solver.setTolerances(rtol=LOOSE)
        solver.solve(self._f, self._x)

    def _failing(self, solve: Callable[[], None], unsolved: Callable[[], bool]) -> str:
        """Call a solver; why its linear systems could not be solved, else "". No factors outlive a failed
        factorisation: MUMPS would refuse all that comes after it.
        """
        complained, self.again = "", False
        try:
            solve()
        except (PETSc.Error, SingularError) as err:
            complained = complaint(err)
            if not complained:
                raise
        if not complained and not unsolved():
            return ""
        why, self.again = self.linear.failed(self._coupled)
        self._drop()
        self._snes = self._create()
        return complained or why or NOT_SOLVED

    def _function(self, snes: PETSc.SNES, x: PETSc.Vec, f: PETSc.Vec) -> None:
        f.array_w[:] = self._balance.residual(np.array(x.array_r))

    def _jacobian(self, snes: PETSc.SNES, x: PETSc.Vec, jacobian: PETSc.Mat, p: PETSc.Mat) -> None:
        """The convergence test has assembled it; a matrix that it has left as it was keeps its factors."""
        if self.linear.reads_mat:
            self._system.matrix.write()

    def _test(self, snes: PETSc.SNES, iteration: int, norms: tuple[float, float, float]) -> int:
        ending = self._balance.judge(np.array(self._x.array_r), np.array(self._f.array_r))
        if ending == ITERATING:
            self._choose(self._f)
        if self.linear.to_tolerance:
            self._coupled.setTolerances(rtol=self._balance.linear_tolerance())
        return int(REASONS[ending])

    def _shorten(self, x: PETSc.Vec, y: PETSc.Vec) -> bool:
        """Scale the step -y from x to the length that the line search finds; whether that changed it."""
        step = np.array(y.array_r)
        y.array_w[:] = shortened = self._balance.shortened(np.array(x.array_r), step)
        return shortened is not step

    def renew(self) -> None:
        """Make all anew for the matrix that the system has now."""
        self.linear.renew()
        self._make()

    def state(self) -> Saved:
        return self.linear.state()

    def restore(self, saved: Saved) -> None:
        self.linear.restore(saved)

    def destroy(self) -> None:
        self.release()
        self.linear.forget()
        del self._balance  # which refers to this: what both hold is freed now, not some time later

    def release(self) -> None:
        """Let go of the matrix, in whose place another is to come."""
        self._drop()
        for thing in (self._x, self._f, self._levers):
            thing.destroy()
        self._alone = None  # which keeps the matrix

    def _drop(self) -> None:
        """Destroy SNES, its factors first and on all ranks at once: MUMPS waits for the others. SNES itself may be held
        longer by frames that an exception keeps, as numba's do on the rank that compiles a kernel.
        """
        for thing in (self._snes, self._coupled, self._uncoupled):
            if thing is not None:
                thing.reset()
                thing.destroy()


def _ending(reason: int) -> str:
    """How SNES has ended, in the words of `chain`; failures by PETSc's name."""
    known = {number: name for name, number in REASONS.items()}
    names = (name for name, value in vars(REASON).items() if value == reason and name.startswith("DIV"))
    return known.get(reason) or next(names, str(reason)).lower()


def linear_systems(system: System, asked: str) -> LinearSystems:
    """As asked: "direct", "kept", "iterative", or "auto", which takes sections by themselves; what there is nothing for
    is solved directly.
    """
    comm: Any = system.comm
    solid = solid_of(system) if asked == "iterative" else None
    if solid is not None:
        return IterativeSolver(system, solid)
    sections = sections_of(system) if asked == "auto" else None
    if sections is not None:
        return SectionSolver(system, sections, Workspace())
    if keeps_factors(system, asked):
        return KeptFactors(comm, system.symmetric, Workspace())
    return DirectSolver(system, Workspace())


class DirectSolver(LinearSystems):
    """Each system is factorised."""

    def __init__(self, system: System, workspace: Workspace) -> None:
        self._system, self._workspace = system, workspace

    def serve(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        ksp.setType(PETSc.KSP.Type.PREONLY)
        factorise_directly(ksp.getPC(), self._system, self._workspace)

    def failed(self, ksp: PETSc.KSP) -> tuple[str, bool]:
        """Where factors found too little workspace, the next get more."""
        return "", self._workspace.grows_after(ksp.getPC())
