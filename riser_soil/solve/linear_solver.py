"""Exact linear solvers of PETSc: LU or Cholesky of MUMPS, banded LU where a serial system is a chain."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import ClassVar

import numpy as np
from petsc4py import PETSc

from riser_soil.core.arrays import Array
from riser_soil.core.banded import SingularError
from riser_soil.core.communicator import destroyed_together
from riser_soil.core.factor_memory import Workspace
from riser_soil.core.petsc_matrix import declare
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.solve.bordered_band import BorderedBand, bordered_chain
from riser_soil.solve.petsc_options import PREFIX

# MUMPS' controls for counting pivots, on several ranks too (13), null pivots (24).
COUNTING = {13: 1, 24: 1}
IN_LIBRARY = 76  # PETSc's code of an error in another library, here MUMPS
LARGE = 4000  # unknowns from which on kept factors are cheaper than new ones
NO_PIVOT = 1e-200  # whatever the units; by PETSc's default the stiffness of a riser a fingernail long is none


class LinearSystems:
    """How one system after the other is solved; collective.

    factorises: whether pivots may be counted, too. to_tolerance: whether each is solved as exactly as the KSP is told.
    options: PETSc's, where the user gives none of the name.
    """

    factorises: ClassVar[bool] = True
    to_tolerance: ClassVar[bool] = False
    options: ClassVar[Mapping[str, str]] = {}

    @property
    def reads_mat(self) -> bool:
        """Whether PETSc's own matrix is read, and not the rows that it is made of."""
        return True

    def serve(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        """Solve what this KSP is asked for; by the levers [m] moments count as forces."""
        raise NotImplementedError

    def failed(self, ksp: PETSc.KSP) -> tuple[str, bool]:
        """Drop what a failed solution has left; what to say of it, and whether another try may do."""
        self.forget()
        return "", False

    def renew(self) -> None:
        """Expect a matrix of another pattern."""
        self.forget()

    def forget(self) -> None:
        """Drop all that is kept."""

    def state(self) -> Saved:
        """What is kept, for a run that is to go on."""
        return {}

    def restore(self, saved: Saved) -> None:
        """Go on with that."""


def keeps_factors(system: System, asked: str) -> bool:
    """Whether factors are kept from one tangent to the next: as asked ("kept", "direct"), or where that is cheaper."""
    if system.is_chain or asked == "direct":
        return False
    return asked == "kept" or system.numbering.free >= LARGE


def factorise_directly(pc: PETSc.PC, system: System, workspace: Workspace) -> None:
    """Make a preconditioner an exact solver, symmetric where MUMPS is it and the system is."""
    if (chain := bordered_chain(system)) is not None:
        pc.setOperators(system.matrix.mat)
        BorderedBand(system.matrix.mat, chain).work_for(pc)
        return
    mumps = not system.is_chain
    _choose(pc, system, "cholesky" if mumps and system.symmetric else "lu", workspace.controls)


def raised(err: Exception) -> Exception:
    """What a callback has raised, which PETSc 3.18 lets pass and PETSc 3.22 makes an error of its own of."""
    cause = err.__cause__
    return cause if isinstance(err, PETSc.Error) and isinstance(cause, Exception) else err


def complaint(err: Exception) -> str:
    """What was said of a system that could not be solved, the same on all ranks; "" for all other errors."""
    err = raised(err)
    if isinstance(err, SingularError):
        return "the linear solver failed (the matrix is singular)"
    if not (isinstance(err, PETSc.Error) and err.ierr == IN_LIBRARY):
        return ""
    said = re.search(r"(?:in|during) (?:the )?(\w[\w ]*) phase.*INFOG\(1\)\s*=\s*(-?\d+)", str(err))
    where = f" in its {said[1]} phase: INFOG(1) = {said[2]}" if said else ""
    return f"the linear solver failed (MUMPS{where})"


@contextmanager
def exact_solver(system: System) -> Iterator[Callable[[Array], Array]]:
    """What the matrix makes of loads (owned,), factorised at once, as long as the block lasts; collective."""
    solver = PETSc.PC().create(system.comm)
    factorise_directly(solver, system, Workspace())
    solver.setUp()

    def solve(load: Array) -> Array:
        given, found = system.matrix.mat.createVecs()
        given.array_w[:] = load
        solver.apply(given, found)
        answer = np.array(found.array_r)
        for vector in (given, found):
            vector.destroy()
        return answer

    with destroyed_together(system.comm, solver.destroy):
        yield solve


def negative_pivots(system: System) -> int:
    """Negative pivots of the system's symmetric matrix: its number of negative eigenvalues; collective."""
    return _counted(system.matrix.mat)


def negative_pivots_behind(system: System, rows: int) -> int:
    """Those of its part behind this rank's first rows, and columns, which is coupled with none of these; collective."""
    mat, numbering = system.matrix.mat, system.numbering
    behind = np.arange(numbering.first + rows, numbering.first + numbering.owned, dtype=PETSc.IntType)
    at = PETSc.IS().createGeneral(behind, comm=mat.comm)
    part = mat.createSubMatrix(at, at)
    declare(part, symmetric=True)
    try:
        return _counted(part) if part.getSize()[0] else 0
    finally:
        for thing in (part, at):
            thing.destroy()


def _counted(mat: PETSc.Mat) -> int:
    """Negative pivots of a symmetric matrix, which is no chain's."""
    workspace = Workspace()
    while True:
        pc = PETSc.PC().create(mat.comm)
        try:
            pc.setOperators(mat)
            use_mumps(pc, "cholesky", workspace.controls | COUNTING, by_options=False)
            pc.setUp()
            if not workspace.grows_after(pc):
                return int(pc.getFactorMatrix().getInertia()[0])
        finally:
            pc.destroy()


def _choose(pc: PETSc.PC, system: System, kind: str, controls: Mapping[int, int]) -> None:
    pc.setOperators(system.matrix.mat)
    if system.is_chain:
        pc.setType(kind)
        pc.setFactorOrdering("natural")
        pc.setFactorPivot(zeropivot=NO_PIVOT)
        return
    use_mumps(pc, kind, controls)


def use_mumps(pc: PETSc.PC, kind: str, controls: Mapping[int, int], by_options: bool = True) -> None:
    """Let MUMPS factorise a preconditioner's operator. kind: "lu", or "cholesky": LDLᵀ of the upper triangle.
    by_options: whether the user's options of MUMPS (mat_mumps_icntl_14, ...) go before the controls.
    """
    pc.setType(kind)
    pc.setFactorSolverType("mumps")
    pc.setFactorSetUpSolverType()
    if by_options:
        pc.getFactorMatrix().setOptionsPrefix(PREFIX)
    for control, value in controls.items():
        pc.getFactorMatrix().setMumpsIcntl(control, value)


