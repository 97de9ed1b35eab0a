"""Linear solver of PETSc: its banded LU where a serial system is a chain, MUMPS otherwise.

A chain on few other dofs that all couple is solved by its band: LU with a dense border.

    [B  U] [x]   [f]
    [V  D] [y] = [g]

B is factorised by its band, and the Schur complement D - V inv(B) U densely, both with partial pivoting. Few rows of U
and columns of V, the touched ones, are not zero: it costs the band's solutions for so many unit vectors. Where the
whole is positive definite, so is B, and of no larger condition: eliminating it first is as stable as any order.
Source: Golub & Van Loan, Matrix Computations (2013), 4.3 and 3.4.

The riser of a coupled system solved by itself, where nothing touches the soil and the soil is in balance.

The tangent then has a block of the riser and one of the soil and nothing beside them, and the soil's right-hand side is
zero: so is its increment, and the riser's is that of its own band. No block is left out that is not zero, and what the
soil's rows have left of a residual counts in Newton's test as ever.
"""

from __future__ import annotations

import atexit
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import ClassVar

import numpy as np
from petsc4py import PETSc
from scipy.linalg.lapack import dgetrf, dgetrs

from riser_soil.core import banded
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.banded import SingularError
from riser_soil.core.communicator import all_of, destroyed_together
from riser_soil.core.compiled import njit
from riser_soil.core.factor_memory import Workspace
from riser_soil.core.petsc_matrix import declare
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.solve.chain import ChainFactors
from riser_soil.solve.petsc_options import PREFIX

# MUMPS' controls for counting pivots, on several ranks too (13), null pivots (24).
COUNTING = {13: 1, 24: 1}
IN_LIBRARY = 76  # PETSc's code of an error in another library, here MUMPS
LARGE = 4000  # unknowns from which on kept factors are cheaper than new ones
WIDEST = 32  # entries beside the diagonal up to which a matrix is a chain's
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
    if (chain := _bordered_chain(system)) is not None:
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


def _bordered_chain(system: System) -> int | None:
    """Rows of a serial system that are a chain's, the first ones, where all the others couple with each other."""
    if system.comm.size > 1 or system.is_chain or len(system.model.lines) > 1:
        return None
    at = slice(0, sum(line.size for line in system.model.lines))
    chain, rows = int(np.count_nonzero(system.numbering.index[at] >= 0)), system.numbering.free
    indptr, indices, _ = system.matrix.mat.getValuesCSR()
    coupled = np.count_nonzero(indices[indptr[chain] :] >= chain)
    if coupled < (rows - chain) ** 2 or bandwidth(system.matrix.mat, chain) > WIDEST:
        return None
    return chain


class PythonContext:
    """Context of a KSP or preconditioner of type python. in_use: all whose object is not destroyed."""

    in_use: ClassVar[dict[PythonContext, PETSc.KSP | PETSc.PC]] = {}

    def work_for(self, thing: PETSc.KSP | PETSc.PC) -> None:
        """Be what this object calls."""
        PythonContext.in_use[self] = thing
        thing.setType("python")
        thing.setPythonContext(self)

    def reset(self, thing: PETSc.KSP | PETSc.PC) -> None:
        """Called as the object is destroyed."""
        PythonContext.in_use.pop(self, None)


@atexit.register
def let_go() -> None:
    """Part all objects from their contexts here."""
    while PythonContext.in_use:
        _, thing = PythonContext.in_use.popitem()
        if thing:  # one that was destroyed without being reset is null
            thing.setType("none" if isinstance(thing, PETSc.PC) else "preonly")


class BorderedBand(PythonContext):
    """PETSc's preconditioner of type python for such matrices: an exact solver. chain: rows of B, the first ones."""

    def __init__(self, matrix: PETSc.Mat, chain: int) -> None:
        self._indptr, self._indices, _ = matrix.getValuesCSR()
        border = matrix.getSize()[0] - chain
        self._band, self._wide = banded.workspace(chain, bandwidth(matrix, chain))
        self._pivots = np.zeros(chain, dtype=np.int64)
        self._right, self._below, self._corner = (
            np.zeros(shape) for shape in ((chain, border), (border, chain), (border, border))
        )

    def setUp(self, pc: PETSc.PC) -> None:
        """Factorise the present matrix; SingularError where it can't be."""
        values = pc.getOperators()[1].getValuesCSR()[2]
        parts = self._band, self._right, self._below, self._corner
        self._touched = np.flatnonzero(_spread(self._indptr, self._indices, values, *parts))
        if not banded.factorise(self._band, self._pivots, self._wide):
            raise SingularError
        between = banded.inverse_at(self._band, self._pivots, self._touched, self._wide)
        self._by_chain = np.ascontiguousarray(self._below[:, self._touched])
        self._by_border = np.ascontiguousarray(self._right[self._touched])
        schur = self._corner - self._by_chain @ (between @ self._by_border)
        if schur.size:
            schur, self._exchanged, singular = dgetrf(schur)
            if singular:
                raise SingularError
        self._schur = schur

    def apply(self, pc: PETSc.PC, load: PETSc.Vec, found: PETSc.Vec) -> None:
        """Solve."""
        x, chain = load.getArray(readonly=True).copy(), len(self._pivots)
        if self._schur.size:
            inner = x[:chain].copy()
            banded.solve(self._band, self._pivots, inner, self._wide)
            x[chain:] -= self._by_chain @ inner[self._touched]
            x[chain:] = dgetrs(self._schur, self._exchanged, x[chain:])[0]
            x[self._touched] -= self._by_border @ x[chain:]
        banded.solve(self._band, self._pivots, x[:chain], self._wide)
        found.setArray(x)


def bandwidth(matrix: PETSc.Mat, chain: int) -> int:
    """Largest distance from the diagonal of an entry among the first rows and columns of a serial matrix."""
    indptr, indices, _ = matrix.getValuesCSR()
    rows = np.repeat(np.arange(len(indptr) - 1), np.diff(indptr))
    inner = (rows < chain) & (indices < chain)
    return int(np.abs(rows[inner] - indices[inner]).max(initial=0))


@njit
def _spread(
    indptr: IntArray, indices: IntArray, values: Array, band: Array, right: Array, below: Array, corner: Array
) -> BoolArray:
    """Write the values of a CSR matrix to its four parts; which rows of the chain the border touches. band: as `banded`
    has it.
    """
    chain, middle = right.shape[0], (band.shape[1] - 1) // 3
    touched = np.zeros(chain, np.bool_)
    for part in (band, right, below, corner):
        part[...] = 0.0
    for i in range(indptr.size - 1):
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
            if i < chain and j < chain:
                band[i, j - i + middle] = values[k]
            elif i < chain:
                right[i, j - chain] = values[k]
                touched[i] |= values[k] != 0.0
            elif j < chain:
                below[i - chain, j] = values[k]
                touched[j] |= values[k] != 0.0
            else:
                corner[i - chain, j - chain] = values[k]
    return touched


class RiserAboveSoil(PythonContext):
    """Linear solver of such systems; collective."""

    def __init__(self, system: System) -> None:
        self._system, self._rows = system, system.line_rows
        self._factors = ChainFactors(system.matrix, self._rows)

    def serve(self, ksp: PETSc.KSP) -> None:
        """Solve what this KSP is asked for."""
        self.work_for(ksp)
        ksp.getPC().setType(PETSc.PC.Type.NONE)

    def suits(self, f: Array, negligible: float) -> bool:
        """Whether the tangent couples the riser with nothing, all other rows of a residual f (owned,) have no more than
        what is negligible [N], and the riser's own band has an inverse; the same on all ranks.
        """
        rest = f[self._rows :]
        coupled, squares = self._system.sum([float(self._system.couples), float(rest @ rest)])
        if coupled > 0.0 or not squares <= negligible**2:
            return False
        return all_of(self._system.comm, self._factorised())

    def _factorised(self) -> bool:
        try:
            if self._rows > 0:
                self._factors.factorise()
        except SingularError:
            return False
        return True

    def solve(self, ksp: PETSc.KSP, b: PETSc.Vec, x: PETSc.Vec) -> None:
        """Called by PETSc."""
        found = np.zeros(x.getLocalSize())
        if self._rows > 0:
            found[: self._rows] = self._factors.solve(np.array(b.array_r[: self._rows]))
        x.array_w[:] = found
        ksp.setConvergedReason(PETSc.KSP.ConvergedReason.CONVERGED_RTOL)
