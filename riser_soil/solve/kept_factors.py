"""Kept factors: those of an earlier tangent are the preconditioner of GMRES on the present one.

From one iteration of Newton's method on soil to the next only what yields and what touches changes, and a solve with
factors costs a small share of a factorisation, the less the larger the system. The factors are LDLᵀ of the tangent's
upper triangle: half the work of LU, and exact where the tangent is symmetric. They are kept as long as that lowers the
mean cost of the solves since they were made, their making included. No clock decides, but GMRES' iterations and MUMPS'
own counts of its work, so that a run can be repeated to the last bit.
"""

from __future__ import annotations

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.factor_memory import Room
from riser_soil.core.saved_state import Saved
from riser_soil.solve.linear_solver import use_mumps

FEWEST = 10  # iterations that GMRES may take in any case
PER_ENTRY = 36.0  # operations of a factorisation that take as long as a solve for one entry of its factors: 32 to 40


class KeptFactors:
    """Linear solver of a system's tangents, one after the other; collective.

    symmetric: whether the tangents are. room: for fill-in; it grows where it was too little. factorisations,
    iterations: how many there were, the latter of GMRES. worth: iterations that cost as much as a factorisation.
    """

    def __init__(self, comm: MPI.Intracomm, symmetric: bool, room: Room) -> None:
        self._comm, self._symmetric, self._room = comm, symmetric, room
        self.factorisations = self.iterations = 0
        self.worth = 0.0
        self._whole = False  # whether the factors are LU of all the tangent, as those of its upper triangle did not do
        self._krylov: PETSc.KSP | None = None
        self._factored: PETSc.Mat | None = None
        self._outgrown = False
        self.forget()

    def serve(self, ksp: PETSc.KSP) -> None:
        """Solve what this KSP is asked for, to its relative tolerance."""
        ksp.setType(PETSc.KSP.Type.PYTHON)
        ksp.setPythonContext(self)
        ksp.getPC().setType(PETSc.PC.Type.NONE)

    def solve(self, ksp: PETSc.KSP, b: PETSc.Vec, x: PETSc.Vec) -> None:
        """With the kept factors, or where these don't do with new ones of the same kind, or of all the tangent."""
        matrix, _ = ksp.getOperators()
        reason = -1 if self._stale else self._iterate(matrix, ksp.rtol, b, x)
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
        """PETSc's reason to end, below 0 without convergence. Factors are stale once a solve costs more than the mean.
        """
        assert self._krylov is not None
        self._krylov.setOperators(matrix, self._factored)
        self._krylov.setTolerances(rtol=tolerance, atol=0.0, max_it=self._most)
        self._krylov.solve(b, x)
        taken = self._krylov.getIterationNumber()
        self.iterations += taken
        self._spent, self._solves = self._spent + taken, self._solves + 1
        self._stale = taken * self._solves > self._spent
        return int(self._krylov.reason)

    @property
    def _most(self) -> int:
        """Iterations beyond which it would have been cheaper to factorise."""
        return max(FEWEST, int(self.worth))

    def _factorise(self, matrix: PETSc.Mat) -> None:
        """Those of a matrix whose pattern was factorised before reuse the symbolic factorisation."""
        if self._factored is None or self._outgrown:
            self.forget()
            self._keep(matrix.copy())
        else:
            matrix.copy(self._factored, PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
        krylov = self._set_up(matrix)
        while self._room.grows_after(krylov.getPC()):
            self.forget()
            self._keep(matrix.copy())
            krylov = self._set_up(matrix)
        self._weigh()
        self.factorisations += 1

    def _set_up(self, matrix: PETSc.Mat) -> PETSc.KSP:
        assert self._krylov is not None
        self._krylov.setOperators(matrix, self._factored)
        self._krylov.setUp()
        return self._krylov

    def _keep(self, factored: PETSc.Mat) -> None:
        """Become the solver with the factors of a matrix, once they are made."""
        self._factored, self._outgrown = factored, False
        self._krylov = PETSc.KSP().create(self._comm)
        self._krylov.setType(PETSc.KSP.Type.GMRES)
        self._krylov.setPCSide(PETSc.PC.Side.RIGHT)
        self._krylov.setOperators(factored)
        use_mumps(self._krylov.getPC(), "lu" if self._whole else "cholesky", self._room.controls)

    def _weigh(self) -> None:
        assert self._krylov is not None
        factors = self._krylov.getPC().getFactorMatrix()
        entries = factors.getMumpsInfog(29)
        entries = entries if entries >= 0 else -1_000_000 * entries  # MUMPS counts many in millions
        self.worth = factors.getMumpsRinfog(3) / (PER_ENTRY * max(entries, 1))
        self._krylov.setGMRESRestart(self._most)

    def renew(self) -> None:
        """Expect a matrix of another pattern; the factors are kept."""
        self._outgrown = True

    def forget(self) -> None:
        """Drop the factors."""
        for thing in (self._krylov, self._factored):
            if thing is not None:
                thing.destroy()
        self._krylov = self._factored = None
        self._spent, self._solves, self._stale = 0.0, 0, True

    def state(self) -> Saved:
        """The matrix that the factors are of, and what they have cost."""
        saved: Saved = {"whole": np.array(self._whole)}
        if self._factored is None or self._stale:
            return saved
        rows = dict(zip(("starts", "columns", "values"), self._factored.getValuesCSR(), strict=True))
        kept = {"worth": self.worth, "spent": self._spent, "solves": self._solves, "outgrown": self._outgrown}
        return saved | rows | {name: np.array(value) for name, value in kept.items()}

    def restore(self, saved: Saved) -> None:
        self._whole = bool(saved["whole"])
        self.forget()
        if "values" not in saved:
            return
        rows = (len(saved["starts"]) - 1, PETSc.DETERMINE)
        csr = tuple(saved[name] for name in ("starts", "columns", "values"))
        self._keep(PETSc.Mat().createAIJ((rows, rows), csr=csr, comm=self._comm))
        self.worth, self._spent, self._solves = (saved[name].item() for name in ("worth", "spent", "solves"))
        self._outgrown, self._stale = bool(saved["outgrown"]), False
        assert self._krylov is not None
        self._krylov.setGMRESRestart(self._most)
