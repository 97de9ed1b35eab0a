"""Direct solver for soil in sections: each is eliminated by itself, on the rank that has it, down to what it touches.

Sections are coupled with each other and with the riser by contact alone. What is left of them are the few unknowns of
their surface that touch now; these and the riser are one small sparse system, which the first rank solves. A section
whose tangent stays as it was, as far from the touchdown zone, keeps its factors.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, cast

import numpy as np
from petsc4py import PETSc
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.linalg import SuperLU, splu

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.communicator import Communicator, all_of, largest_of
from riser_soil.core.factor_memory import Workspace
from riser_soil.core.part import local
from riser_soil.core.system import System
from riser_soil.solve.banded_solvers import PythonContext
from riser_soil.solve.chain import SingularError
from riser_soil.solve.linear_solver import LinearSystems, factorise_directly
from riser_soil.solve.section_factors import Csr, SectionFactors, coupled_apart

if TYPE_CHECKING:
    from riser_soil.soil.field import SoilField

THRESHOLD = 0.1  # of the largest entry of its column, that a pivot on the diagonal may have
Entries = tuple[IntArray, IntArray, Array]


def sections_of(system: System) -> SoilField | None:
    """The soil, where it is solved for as a whole and falls apart into sections."""
    soil = system.whole_soil
    return None if getattr(soil, "section", None) is None else cast("SoilField", soil)


class SectionSolver(PythonContext, LinearSystems):
    """Linear solver of a system with soil in sections, and the context of its preconditioner; collective."""

    def __init__(self, system: System, soil: SoilField, workspace: Workspace) -> None:
        self._system, self._soil, self._workspace = system, soil, workspace
        self._by_rows_exchanged = False
        self._section: IntArray | None = None  # of each row of the system, on all ranks or none
        self._sections: list[SectionFactors] = []
        self._rest: _Rest | None = None

    def serve(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        ksp.setType(PETSc.KSP.Type.PREONLY)
        if self._by_rows_exchanged:
            factorise_directly(ksp.getPC(), self._system, self._workspace)
        else:
            self.work_for(ksp.getPC())

    def setUp(self, pc: PETSc.PC) -> None:
        """Called by PETSc for each new tangent; SingularError where pivots want exchange."""
        comm, csr, first = self._system.comm, self._system.matrix.stored.csr(), self._system.numbering.first
        mine = slice(first, first + len(csr[0]) - 1)
        if self._section is None:
            self._section = _section_of_rows(self._system, self._soil)
            self._sections = [SectionFactors(csr, at, first) for at in _runs(self._section[mine])]
        coupled = largest_of(comm, coupled_apart(*csr, first, self._section)) > 0
        sound = [section.take(csr, coupled[mine]) for section in self._sections]
        if not all_of(comm, all(sound)):
            raise SingularError
        left = coupled | (self._section < 0)
        self._left, number = np.flatnonzero(left[mine]), np.cumsum(left) - 1
        own = _between(csr, self._left, left, number, first)
        touched = [section for section in self._sections if section.border.size]
        taken = [_taken_off(number[first + section.border], section.schur) for section in touched]
        self._rest = _Rest(comm, _joined([own, *taken]), int(np.count_nonzero(left)))

    def apply(self, pc: PETSc.PC, load: PETSc.Vec, found: PETSc.Vec) -> None:
        """Solve."""
        assert self._rest is not None
        x = np.array(load.array_r)
        for section in self._sections:
            section.eliminate(x)
        x[self._left] = self._rest.solve(x[self._left])
        for section in self._sections:
            section.insert(x)
        found.array_w[:] = x

    def failed(self, ksp: PETSc.KSP) -> tuple[str, bool]:
        """A solver that exchanges rows tries next, as long as the pattern stays."""
        again = not self._by_rows_exchanged or self._workspace.grows_after(ksp.getPC())
        self._by_rows_exchanged = True
        return "", again

    def renew(self) -> None:
        """Expect a matrix of another pattern."""
        self._by_rows_exchanged = False
        self.forget()

    def forget(self) -> None:
        """Drop all factors."""
        self._section, self._sections, self._rest = None, [], None


class _Rest:
    """The system of n rows that is left, of the entries that the ranks have of it: those of one place are summed. The
    first rank solves it. SingularError on all ranks where that can't be done; collective.
    """

    def __init__(self, comm: Communicator, mine: Entries, n: int) -> None:
        self._comm, self._factors = comm, None
        parts = comm.gather(mine)
        if comm.rank == 0:
            rows, columns, values = _joined(parts)
            self._factors = _factorised(coo_matrix((values, (rows, columns)), shape=(n, n)))
        if not comm.bcast(comm.rank > 0 or self._factors is not None):
            raise SingularError

    def solve(self, mine: Array) -> Array:
        """Of loads of this rank's rows, which come one rank after the other; collective."""
        loads = self._comm.gather(mine)
        if self._factors is None:
            return self._comm.scatter(None)
        ends = np.cumsum([len(load) for load in loads])[:-1]
        return self._comm.scatter(np.split(self._factors.solve(np.concatenate(loads)), ends))


def _factorised(matrix: coo_matrix) -> SuperLU | None:
    """None where it is singular."""
    try:
        return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=THRESHOLD)
    except RuntimeError:
        return None


def _section_of_rows(system: System, soil: SoilField) -> IntArray:
    """Number (n,) of the section of each row of the system, one after the other; -1 for the others; collective."""
    numbering = system.numbering
    assert soil.section is not None
    index, found = numbering.index[local(soil)], np.full(numbering.free, -1)
    mine = soil.owned & (index >= 0)
    found[index[mine]] = soil.section[mine]
    return largest_of(system.comm, found)


def _runs(section: IntArray) -> list[slice]:
    """Rows of each section, of rows (n,) of which these are the numbers."""
    starts = np.flatnonzero(np.diff(section, prepend=-1, append=-1))
    return [slice(int(a), int(b)) for a, b in pairwise(starts) if section[a] >= 0]


def _between(csr: Csr, rows: IntArray, left: BoolArray, number: IntArray, first: int) -> Entries:
    """Entries of some of a rank's rows in the columns that are left, by their numbers among these."""
    indptr, indices, values = csr
    some = csr_matrix((values, indices, indptr), shape=(len(indptr) - 1, len(left)))[rows].tocoo()
    there = left[some.col] & (some.data != 0.0)
    return number[first + rows[some.row[there]]], number[some.col[there]], some.data[there]


def _taken_off(border: IntArray, schur: Array) -> Entries:
    """Minus a dense block of these rows and columns."""
    m = len(border)
    return np.repeat(border, m), np.tile(border, m), -schur.ravel()


def _joined(parts: Sequence[Entries]) -> Entries:
    rows, columns, values = (np.concatenate(part) for part in zip(*parts, strict=True))
    return rows, columns, values
