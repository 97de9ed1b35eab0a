"""Direct solver for soil in sections: static condensation of each on the rank that has it, down to what it touches.

Sections are coupled with each other and with the riser by contact alone. Condensation leaves the few unknowns of their
surface that touch now, their borders (`section_factors`). The Schur complements on these and the riser are one small
sparse system, which the first rank solves. A section whose tangent stays as it was, as far from the touchdown zone,
keeps its factors. A load is solved for in three steps: forward elimination in each section, the system of the borders
and the riser, back substitution in each section.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, cast

import numpy as np
from petsc4py import PETSc
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import SuperLU, splu

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.banded import SingularError
from riser_soil.core.communicator import Communicator, all_of, largest_of
from riser_soil.core.factor_memory import Workspace
from riser_soil.core.part import local
from riser_soil.core.system import System
from riser_soil.solve.direct_solver import factorise_directly
from riser_soil.solve.linear_solver import LinearSolver
from riser_soil.solve.python_context import PythonContext
from riser_soil.solve.section_factors import Entries, SectionFactors, coupled_apart, entries_between

if TYPE_CHECKING:
    from riser_soil.soil.field import SoilField

THRESHOLD = 0.1  # of the largest entry of its column, that a pivot on the diagonal may have


def sections_of(system: System) -> SoilField | None:
    """The soil, where its unknowns are the system's and it consists of sections; else None."""
    soil = system.whole_soil
    return None if getattr(soil, "section", None) is None else cast("SoilField", soil)


class SectionSolver(PythonContext, LinearSolver):
    """Linear solver of a system with soil in sections, and the context of its preconditioner; collective."""

    def __init__(self, system: System, soil: SoilField, workspace: Workspace) -> None:
        self._system, self._soil, self._workspace = system, soil, workspace
        self._as_a_whole = False
        self._section: IntArray | None = None  # of each row of the system, on all ranks or none
        self._factors = SectionFactors((), 0, 0)
        self._borders: _BorderSystem | None = None

    @property
    def reads_mat(self) -> bool:
        return self._as_a_whole

    def attach(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        ksp.setType(PETSc.KSP.Type.PREONLY)
        if self._as_a_whole:
            factorise_directly(ksp.getPC(), self._system, self._workspace)
        else:
            self.work_for(ksp.getPC())

    def setUp(self, pc: PETSc.PC) -> None:
        """Factorise a new tangent, called by PETSc; SingularError where an interior has no inverse."""
        comm, csr, first = self._system.comm, self._system.matrix.stored.csr(), self._system.numbering.first
        mine = slice(first, first + len(csr[0]) - 1)
        if self._section is None:
            self._section = _section_of_rows(self._system, self._soil)
            self._factors = SectionFactors(_runs(self._section[mine]), len(csr[0]) - 1, first)
        coupled = largest_of(comm, coupled_apart(*csr, first, self._section)) > 0
        if not all_of(comm, self._factors.factorise(csr, coupled[mine])):
            raise SingularError
        border = coupled | (self._section < 0)  # rows of borders and riser
        number = np.where(border, np.cumsum(border) - 1, -1)
        self._border_rows = np.flatnonzero(border[mine])
        parts = [entries_between(*csr, first, number), *self._factors.schur_entries(number[mine])]
        self._borders = _BorderSystem(comm, _joined(parts), int(np.count_nonzero(border)))

    def apply(self, pc: PETSc.PC, load: PETSc.Vec, solution: PETSc.Vec) -> None:
        """Solve for a load: forward elimination, the system of the borders and the riser, back substitution."""
        assert self._borders is not None
        x = np.array(load.array_r)
        self._factors.forward_eliminate(x)
        x[self._border_rows] = self._borders.solve(x[self._border_rows])
        self._factors.back_substitute(x)
        solution.array_w[:] = x

    def failed(self, ksp: PETSc.KSP) -> tuple[str, bool]:
        """No message, and whether another try may do: by factors of the whole matrix, until its pattern changes."""
        again = not self._as_a_whole or self._workspace.grows_after(ksp.getPC())
        self._as_a_whole = True
        return "", again

    def renew(self) -> None:
        """Expect a matrix of another pattern."""
        self._as_a_whole = False
        self.forget()

    def forget(self) -> None:
        """Drop all factors."""
        self._section, self._borders = None, None
        self._factors = SectionFactors((), 0, 0)


class _BorderSystem:
    """The system of n rows of all borders and the riser, which the first rank factorises and solves; collective.

    mine: this rank's entries; those in one place are summed. SingularError on all ranks where it can't be factorised.
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
        """Solution in this rank's rows by their load; rows are numbered one rank after the other; collective."""
        loads = self._comm.gather(mine)
        if self._factors is None:
            return self._comm.scatter(None)
        ends = np.cumsum([len(load) for load in loads])[:-1]
        return self._comm.scatter(np.split(self._factors.solve(np.concatenate(loads)), ends))


def _factorised(matrix: coo_matrix) -> SuperLU | None:
    """Factors of a matrix, None where it is singular."""
    try:
        return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=THRESHOLD)
    except RuntimeError:
        return None


def _section_of_rows(system: System, soil: SoilField) -> IntArray:
    """Number (n,) of the section that each row of the system belongs to, -1 for the others; collective."""
    numbering = system.numbering
    assert soil.section is not None
    index, sections = numbering.index[local(soil)], np.full(numbering.free, -1)
    mine = soil.owned & (index >= 0)
    sections[index[mine]] = soil.section[mine]
    return largest_of(system.comm, sections)


def _runs(section: IntArray) -> list[slice]:
    """Rows of each section, from the sections' numbers of rows (n,)."""
    starts = np.flatnonzero(np.diff(section, prepend=-1, append=-1))
    return [slice(int(a), int(b)) for a, b in pairwise(starts) if section[a] >= 0]


def _joined(parts: Sequence[Entries]) -> Entries:
    rows, columns, values = (np.concatenate(part) for part in zip(*parts, strict=True))
    return rows, columns, values
