"""Kept factors: those of an earlier tangent are the preconditioner of Krylov iterations on the present one.

From one iteration of Newton's method on soil to the next only what yields and what touches changes, and a solve with
factors costs a small share of a factorisation, the less the larger the system. The factors are LDLᵀ of the tangent's
upper triangle: half the work of LU, and exact where the tangent is symmetric. They are kept as long as that lowers the
mean cost of the solves since they were made, their making included; a solve that by its first iterations would take
more of them than a factorisation costs is not waited for. No clock decides, but the number of iterations and MUMPS' own
counts of its work, so that a run can be repeated to the last bit.

The iterations are generalised conjugate residuals (Eisenstat, Elman & Schultz, SIAM J. Numer. Anal. 20, 1983, from
memory): those of GMRES, but in the norm that Newton's method judges by, with moments over the lever.
"""

from __future__ import annotations

import math
from typing import ClassVar

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.factor_memory import Workspace
from riser_soil.core.saved_state import Saved
from riser_soil.solve.direct_solver import use_mumps
from riser_soil.solve.linear_solver import LinearSolver
from riser_soil.solve.python_context import PythonContext

FEWEST = 10  # iterations that a solve may take in any case, where new factors want some, too
FIRST_RATE = 3  # iterations of a solve before their rate predicts how many it needs
FASTER = 1.3  # how many times fewer they may be than by that rate, as conjugate residuals get faster
PER_ENTRY = 36.0  # operations of a factorisation that take as long as a solve for one entry of its factors: 32 to 40
SOLVED = PETSc.KSP.ConvergedReason.CONVERGED_RTOL
TOO_LONG = PETSc.KSP.ConvergedReason.DIVERGED_MAX_IT
BROKEN = PETSc.KSP.ConvergedReason.DIVERGED_BREAKDOWN


class KeptFactors(PythonContext, LinearSolver):
    """Linear solver of a system's tangents, one after the other; collective.

    symmetric: whether the tangents are. workspace: for fill-in; it grows where it was too little. factorisations,
    iterations: how many there were, the latter of the Krylov method. worth: iterations that cost as much as a
    factorisation.
    """

    to_tolerance: ClassVar[bool] = True

    def __init__(self, comm: MPI.Intracomm, symmetric: bool, workspace: Workspace) -> None:
        self._comm, self._symmetric, self._workspace = comm, symmetric, workspace
        self.factorisations = self.iterations = 0
        self.worth = 0.0
        self._whole = False  # whether the factors are LU of all the tangent, as those of its upper triangle did not do
        self._factors: PETSc.PC | None = None
        self._factored: PETSc.Mat | None = None
        self._outgrown = False
        self.forget()

    def attach(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        """Set a KSP up; it solves to its relative tolerance in the norm of residuals over the levers."""
        self._levers = levers
        self.work_for(ksp)
        ksp.getPC().setType(PETSc.PC.Type.NONE)

    def solve(self, ksp: PETSc.KSP, b: PETSc.Vec, x: PETSc.Vec) -> None:
        """With the kept factors, or where these don't do with new ones of the same kind, or of all the tangent."""
        matrix, _ = ksp.getOperators()
        reason = BROKEN if self._stale else self._iterate(matrix, ksp.rtol, b, x)
        if reason < 0:
            reason = self._solve_anew(matrix, ksp.rtol, b, x)
        if reason < 0 and not (self._whole or self._symmetric):
            self._whole = self._outgrown = True
            reason = self._solve_anew(matrix, ksp.rtol, b, x)
        ksp.setConvergedReason(reason)

    def _solve_anew(self, matrix: PETSc.Mat, tolerance: float, b: PETSc.Vec, x: PETSc.Vec) -> int:
        self._factorise(matrix)
        self._spent, self._solves = self.worth, 0
        return self._iterate(matrix, tolerance, b, x)

    def _iterate(self, matrix: PETSc.Mat, tolerance: float, b: PETSc.Vec, x: PETSc.Vec) -> int:
        """Why it ended, below 0 without convergence. Factors are stale once a solve costs more than the mean."""
        assert self._factors is not None
        directions = _Directions(matrix, self._factors, self._levers)
        reason = directions.descend(b, x, tolerance, self._most)
        iterations = directions.count
        directions.destroy()
        self.iterations += iterations
        self._spent, self._solves = self._spent + iterations, self._solves + 1
        self._stale = iterations * self._solves > self._spent
        return reason

    @property
    def _most(self) -> int:
        """Iterations beyond which it would have been cheaper to factorise."""
        return max(1 if self._symmetric else FEWEST, int(self.worth))

    def _factorise(self, matrix: PETSc.Mat) -> None:
        """A matrix whose pattern was factorised before reuses the symbolic factorisation."""
        if self._factored is None or self._outgrown:
            self.forget()
            self._prepare(matrix.copy())
        else:
            matrix.copy(self._factored, PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
        assert self._factors is not None
        self._factors.setUp()
        while self._workspace.grows_after(self._factors):
            self.forget()
            self._prepare(matrix.copy())
            self._factors.setUp()
        self._weigh()
        self.factorisations += 1

    def _prepare(self, factored: PETSc.Mat) -> None:
        """Get ready for the factors of a matrix, which are made when they are first needed."""
        self._factored, self._outgrown = factored, False
        self._factors = PETSc.PC().create(self._comm)
        self._factors.setOperators(factored)
        use_mumps(self._factors, "lu" if self._whole else "cholesky", self._workspace.controls)

    def _weigh(self) -> None:
        assert self._factors is not None
        made = self._factors.getFactorMatrix()
        entries = made.getMumpsInfog(29)
        entries = entries if entries >= 0 else -1_000_000 * entries  # MUMPS counts many in millions
        self.worth = made.getMumpsRinfog(3) / (PER_ENTRY * max(entries, 1))

    def renew(self) -> None:
        """Expect a matrix of another pattern; the factors are kept."""
        self._outgrown = True

    def forget(self) -> None:
        """Drop the factors."""
        for thing in (self._factors, self._factored):
            if thing is not None:
                thing.destroy()
        self._factors = self._factored = None
        self._spent, self._solves, self._stale = 0.0, 0, True

    def state(self) -> Saved:
        """The matrix that the factors are of, and what they have cost."""
        saved: Saved = {"whole": np.array(self._whole)}
        if self._factored is None or self._stale:
            return saved
        rows = dict(zip(("starts", "columns", "values"), self._factored.getValuesCSR(), strict=True))
        costs = {"worth": self.worth, "spent": self._spent, "solves": self._solves, "outgrown": self._outgrown}
        return saved | rows | {name: np.array(value) for name, value in costs.items()}

    def restore(self, saved: Saved) -> None:
        self._whole = bool(saved["whole"])
        self.forget()
        if "values" not in saved:
            return
        rows = (len(saved["starts"]) - 1, PETSc.DETERMINE)
        csr = tuple(saved[name] for name in ("starts", "columns", "values"))
        self._prepare(PETSc.Mat().createAIJ((rows, rows), csr=csr, comm=self._comm))
        self.worth, self._spent, self._solves = (saved[name].item() for name in ("worth", "spent", "solves"))
        self._outgrown, self._stale = bool(saved["outgrown"]), False


class _Directions:
    """Steps z of a solve with what A z over the levers is, orthonormal."""

    def __init__(self, matrix: PETSc.Mat, factors: PETSc.PC, levers: PETSc.Vec) -> None:
        self._matrix, self._factors, self._levers = matrix, factors, levers
        self._pairs = list[tuple[PETSc.Vec, PETSc.Vec]]()

    @property
    def count(self) -> int:
        return len(self._pairs)

    def descend(self, b: PETSc.Vec, x: PETSc.Vec, tolerance: float, most: int) -> int:
        """Iterate from x = 0 until the residual over the levers has fallen to a share of b's; why it ended."""
        x.set(0.0)
        rest, whole = b.copy(), b.duplicate()
        rest.pointwiseDivide(b, self._levers)
        first = rest.norm()
        reason = SOLVED
        while (norm := rest.norm()) > tolerance * first and reason == SOLVED:
            whole.pointwiseMult(rest, self._levers)
            reason = self._add(whole) if self._needed(norm / first, tolerance) <= most else TOO_LONG
            if reason == SOLVED:
                z, q = self._pairs[-1]
                part = q.dot(rest)
                x.axpy(part, z)
                rest.axpy(-part, q)
        rest.destroy()
        whole.destroy()
        return int(reason)

    def _needed(self, share: float, tolerance: float) -> float:
        """Iterations that the solve needs at least, by the rate at which its residual has fallen to this share."""
        if self.count < FIRST_RATE or share >= 1.0:
            return self.count + 1.0
        return max(self.count + 1.0, self.count * math.log(tolerance) / math.log(share) / FASTER)

    def _add(self, residual: PETSc.Vec) -> int:
        """The step that the factors give for a residual, without what the others have done."""
        z, q = residual.duplicate(), residual.duplicate()
        self._pairs.append((z, q))
        self._factors.apply(residual, z)
        self._matrix.mult(z, q)
        q.pointwiseDivide(q, self._levers)
        for before, product in self._pairs[:-1]:
            part = product.dot(q)
            z.axpy(-part, before)
            q.axpy(-part, product)
        size = q.norm()
        if not (math.isfinite(size) and size > 0.0):
            return int(BROKEN)
        z.scale(1.0 / size)
        q.scale(1.0 / size)
        return int(SOLVED)

    def destroy(self) -> None:
        for pair in self._pairs:
            for vector in pair:
                vector.destroy()
