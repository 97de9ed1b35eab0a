"""The solver of a system's tangents, one after the other, by what a scene, the user's options and the state ask for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, ClassVar

import numpy as np
from petsc4py import PETSc

from riser_soil.core.banded import SingularError
from riser_soil.core.factor_memory import Workspace
from riser_soil.core.system import System
from riser_soil.solve.balance import Balance
from riser_soil.solve.bordered_band import band_of
from riser_soil.solve.convergence import NOT_SOLVED
from riser_soil.solve.direct_solver import DirectSolver
from riser_soil.solve.iterative_solver import IterativeSolver, solid_of
from riser_soil.solve.kept_factors import KeptFactors
from riser_soil.solve.linear_solver import LinearSolver, complaint, raised
from riser_soil.solve.petsc_options import UserOptions
from riser_soil.solve.riser_above_soil import RiserAboveSoil
from riser_soil.solve.section_solver import SectionSolver, sections_of

LARGE = 4000  # unknowns from which on kept factors are cheaper than new ones
ALONE = 1e-5  # share of the residual that the response of a tangent by itself may leave, beside Newton's iterations


def linear_solver(system: System, kind: str, by_options: bool) -> LinearSolver:
    """Linear solver of a kind: "direct", "kept", "iterative", or "auto", by which sections are solved one by one; a
    direct one where the system has nothing for its kind. by_options: PETSc's own, as the user's options name one.
    """
    comm: Any = system.comm
    if by_options:
        return PetscSolver()
    solid = solid_of(system) if kind == "iterative" else None
    if solid is not None:
        return IterativeSolver(system, solid)
    sections = sections_of(system) if kind == "auto" else None
    if sections is not None:
        return SectionSolver(system, sections, Workspace())
    if _keeps_factors(system, kind):
        return KeptFactors(comm, system.symmetric, Workspace())
    return DirectSolver(system, Workspace())


def _keeps_factors(system: System, kind: str) -> bool:
    """Whether factors are kept from one tangent to the next: by "kept", or "auto" where that is cheaper."""
    if kind == "direct" or band_of(system) is not None:
        return False
    return kind == "kept" or system.numbering.free >= LARGE


class PetscSolver(LinearSolver):
    """A linear solver by the user's options; what they leave open is done by LU of MUMPS."""

    to_tolerance: ClassVar[bool] = True
    options: ClassVar[Mapping[str, str]] = {"pc_factor_mat_solver_type": "mumps"}

    def attach(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        ksp.setType(PETSc.KSP.Type.PREONLY)
        ksp.getPC().setType(PETSc.PC.Type.LU)


class TangentSolver:
    """The KSP of a system's tangents and, where nothing touches whole soil, that of the riser alone in its place.

    solver: of tangents of all rows; used: whether it has been chosen; again: whether what failed last may be tried once
    more.
    """

    def __init__(self, system: System, kind: str, user: UserOptions) -> None:
        self._system, self._user, self.used, self.again = system, user, False, False
        self.solver = linear_solver(system, kind, user.linear_solver)

    def attach(self, ksp: PETSc.KSP) -> None:
        """Set a KSP up for the matrix that the system has now."""
        system, self._ksp = self._system, ksp
        self._levers = system.matrix.mat.createVecLeft()
        self._levers.array_w[:] = system.numbering.to_global(system.levers)
        self.solver.attach(ksp, self._levers)
        self._alone: tuple[RiserAboveSoil, PETSc.KSP] | None = None
        if system.whole_soil is not None and not self._user.linear_solver:
            self._alone = RiserAboveSoil(system), PETSc.KSP().create(system.comm)
            self._alone[0].attach(self._alone[1], self._levers)

    def next(self, f: PETSc.Vec, balance: Balance) -> PETSc.KSP:
        """The solver of the present tangent for the residual of an iteration."""
        ksp = self._choose(f, balance)
        if self.solver.to_tolerance:
            self._tighten(balance.linear_tolerance())
        return ksp

    def solve(self, f: PETSc.Vec, x: PETSc.Vec, balance: Balance) -> bool:
        """Write x = K⁻¹ f by the present tangent, outside Newton's iterations; whether that could be solved."""
        ksp = self._choose(f, balance)
        ksp.setOperators(self._system.matrix.mat)
        self._tighten(ALONE)
        ksp.solve(f, x)
        return bool(ksp.reason >= 0)

    def failure(self, solved: Callable[[], bool]) -> str:
        """Call what says whether it could solve its linear systems: why it could not, else ""; all other errors pass.
        What has failed leaves no factors: MUMPS would refuse all that comes after it.
        """
        said, self.again = "", False
        try:
            if solved():
                return ""
        except (PETSc.Error, SingularError) as err:
            said = complaint(err)
            if not said:
                raise raised(err) from None
        why, self.again = self.solver.failed(self._ksp)
        return said or why or NOT_SOLVED

    def _choose(self, f: PETSc.Vec, balance: Balance) -> PETSc.KSP:
        """The solver of the present tangent for a residual, however exact it is to be."""
        if self.solver.reads_mat or self._user.any:
            self._system.matrix.write()
        if self._alone is not None:
            above_soil, ksp = self._alone
            if above_soil.suits(np.array(f.array_r), balance.negligible()):
                return ksp
        self.used = True
        return self._ksp

    def _tighten(self, tolerance: float) -> None:
        """Solve to a tolerance from now on, where the user gives none."""
        if not self._user.linear_tolerance:
            self._ksp.setTolerances(rtol=tolerance)

    def drop(self) -> None:
        """Destroy what belongs to the present matrix, factors on all ranks at once: MUMPS waits for the others."""
        for ksp in (self._ksp, *(() if self._alone is None else self._alone[1:])):
            ksp.reset()
            ksp.destroy()
        self._levers.destroy()
        self._alone = None  # which keeps the matrix
