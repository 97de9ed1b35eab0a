"""Direct solver: factors of each tangent, a band with a dense border or by MUMPS; and the pivots that MUMPS counts."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

import numpy as np
from petsc4py import PETSc

from riser_soil.core.arrays import Array
from riser_soil.core.communicator import destroyed_together
from riser_soil.core.factor_memory import Workspace
from riser_soil.core.petsc_matrix import declare
from riser_soil.core.system import System
from riser_soil.solve.bordered_band import BorderedBand, band_of
from riser_soil.solve.linear_solver import LinearSolver
from riser_soil.solve.petsc_options import PREFIX
from riser_soil.solve.python_context import PythonContext

COUNTING = {13: 1, 24: 1}  # MUMPS' controls for counting pivots, on several ranks too (13), null pivots (24)


class DirectSolver(LinearSolver):
    """Each system is factorised."""

    def __init__(self, system: System, workspace: Workspace) -> None:
        self._system, self._workspace = system, workspace

    def attach(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        ksp.setType(PETSc.KSP.Type.PREONLY)
        factorise_directly(ksp.getPC(), self._system, self._workspace)

    def failed(self, ksp: PETSc.KSP) -> tuple[str, bool]:
        """Give the next factors more workspace where there was too little; no message, and whether that may do."""
        return "", self._workspace.grows_after(ksp.getPC())


class BandSolver(PythonContext):
    """Context of a preconditioner that is an exact solver, by a band with its border."""

    def __init__(self, band: BorderedBand) -> None:
        self._band = band

    def setUp(self, pc: PETSc.PC) -> None:
        """Factorise the present matrix, called by PETSc; SingularError where it can't be."""
        self._band.factorise()

    def apply(self, pc: PETSc.PC, load: PETSc.Vec, solution: PETSc.Vec) -> None:
        """Solve, called by PETSc."""
        solution.setArray(self._band.solve(load.getArray(readonly=True)))


def factorise_directly(pc: PETSc.PC, system: System, workspace: Workspace) -> None:
    """Make a preconditioner an exact solver: a band with its border, else MUMPS, symmetric where the system is."""
    pc.setOperators(system.matrix.mat)
    if (band := band_of(system)) is not None:
        BandSolver(band).work_for(pc)
    else:
        use_mumps(pc, "cholesky" if system.symmetric else "lu", workspace.controls)


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


@contextmanager
def exact_solver(system: System) -> Iterator[Callable[[Array], Array]]:
    """What the matrix makes of loads (owned,), factorised at once, as long as the block lasts; collective."""
    solver = PETSc.PC().create(system.comm)
    factorise_directly(solver, system, Workspace())
    solver.setUp()

    def solve(load: Array) -> Array:
        right, solution = system.matrix.mat.createVecs()
        right.array_w[:] = load
        solver.apply(right, solution)
        values = np.array(solution.array_r)
        for vector in (right, solution):
            vector.destroy()
        return values

    with destroyed_together(system.comm, solver.destroy):
        yield solve


def negative_pivots(system: System) -> int:
    """Negative pivots of the system's symmetric matrix: its number of negative eigenvalues; collective."""
    return _counted(system.matrix.mat)


def negative_pivots_behind(system: System, rows: int) -> int:
    """Negative pivots of what lies behind this rank's first rows and columns, and is coupled with none of these;
    collective.
    """
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
