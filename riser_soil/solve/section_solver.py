"""Direct solver for soil in sections: each is eliminated by itself, on the rank that has it, down to what it touches.

Sections are coupled with each other and with the riser by contact alone. What is left of them are the few unknowns of
their surface that touch now; these and the riser are one small sparse system, which the first rank solves. A section
whose tangent stays as it was, as far from the touchdown zone, keeps its factors.

One section's matrix is a band with a border of those few unknowns that touch the riser.

    [B  U] [x]   [f]
    [V  D] [y] = [g]

Elimination in B = L R leaves L⁻¹ U in the place of U, V R⁻¹ in that of V, and takes their product off D, which is a
share of the system of all borders and the riser. Nothing is exchanged: soil that bears its weight has positive pivots
in any order. A pivot that has lost all its digits is told, and a solver that exchanges rows has to do. Numbers that are
left of the first coupled row stay zero and are passed over. Source: Golub & Van Loan, Matrix Computations (2013), 4.3.
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
from riser_soil.core.banded import SingularError
from riser_soil.core.communicator import Communicator, all_of, largest_of
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.factor_memory import Workspace
from riser_soil.core.part import local
from riser_soil.core.rows import add_multiple
from riser_soil.core.system import System
from riser_soil.solve.linear_solver import LinearSystems, PythonContext, factorise_directly

if TYPE_CHECKING:
    from riser_soil.soil.field import SoilField


Csr = tuple[IntArray, IntArray, Array]

LOST = 1e-12  # of an entry on the diagonal: a pivot below that
AT_ONCE = fixed(8)  # numbers of a row; rows are filled up with zeros to a multiple of it


class SectionFactors:
    """Of a section, whose rows are those `at` some place among its rank's; before: rows of the ranks before that.

    border (m,): those of the rank's rows that are the section's border; schur (m, m): what the interior takes off its
    matrix. Both are as of the last `take`.
    """

    def __init__(self, at: slice, before: int) -> None:
        self.at, self._before = at, before
        self._known: Array = np.empty(0)
        self._outside: BoolArray = np.empty(0, dtype=bool)

    def take(self, csr: Csr, coupled: BoolArray) -> bool:
        """Factorise the matrix of the values in these rows, where they have changed; whether that can be done.
        coupled: which of the rank's rows are so with others than their section's.
        """
        place, outside = (*csr[:2], self.at.start, self._before), coupled[self.at]
        if np.array_equal(outside, self._outside) and _same(*place, csr[2], self._known, outside):
            return True
        number = np.where(outside, -np.cumsum(outside, dtype=np.int64), np.cumsum(~outside, dtype=np.int64) - 1)
        self._inner, self.border = (self.at.start + np.flatnonzero(which) for which in (~outside, outside))
        n, m = len(self._inner), len(self.border)
        self._width = int(_bandwidth(*place, csr[2], number))
        self._band = np.zeros((n + self._width, 1 + self._width + _filled_up(self._width)))
        self._right, self._below = (np.zeros((n + self._width, _filled_up(m))) for _ in range(2))
        _spread(*place, csr[2], number, self._width, self._band, self._right, self._below)
        self._start = _first_coupled(self._right, self._below, n)
        self._known, self._outside = np.empty(0), outside.copy()
        if not _eliminate(self._band, self._right, self._below, n, self._width, self._start):
            return False
        self.schur = self._below[self._start : n, :m].T @ self._right[self._start : n, :m]
        self._known = csr[2][csr[0][self.at.start] : csr[0][self.at.stop]].copy()
        return True

    def eliminate(self, x: Array) -> None:
        """Take a load (owned,) of the rank's rows on, the interior's share off its border."""
        inner = x[self._inner]
        _forward(self._band, inner, self._width)
        x[self._inner] = inner
        x[self.border] -= inner[self._start :] @ self._below[self._start : len(inner), : len(self.border)]

    def insert(self, x: Array) -> None:
        """Solve for the interior, as the border is solved for."""
        inner = x[self._inner]
        inner[self._start :] -= self._right[self._start : len(inner), : len(self.border)] @ x[self.border]
        _backward(self._band, inner, self._width)
        x[self._inner] = inner


def _filled_up(count: int) -> int:
    return -(-count // len(AT_ONCE)) * len(AT_ONCE)


@njit
def coupled_apart(indptr: IntArray, indices: IntArray, values: Array, first: int, section: IntArray) -> IntArray:
    """1 for rows of the system (n,) that one of this rank's entries, which is not zero, couples with another section's
    or with none's; else 0. first: of this rank's rows; section (n,): of each row, -1 for none.
    """
    found = np.zeros(section.size, np.int64)
    for i in range(indptr.size - 1):
        own = section[first + i]
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
            if section[j] != own and values[k] != 0.0:
                found[first + i] = found[j] = 1
    return found


@njit
def _bandwidth(
    indptr: IntArray, indices: IntArray, first: int, before: int, values: Array, number: IntArray
) -> int:
    """Of the interior's entries that are not zero: contact has places for more. number: as of `_spread`."""
    b = 0
    for i in range(number.size):
        for k in range(indptr[first + i], indptr[first + i + 1]):
            at = indices[k] - before - first
            if number[i] >= 0 and 0 <= at < number.size and number[at] >= 0 and values[k] != 0.0:
                b = max(b, abs(number[i] - number[at]))
    return b


@njit
def _same(
    indptr: IntArray, indices: IntArray, first: int, before: int, values: Array, known: Array, outside: BoolArray
) -> bool:
    """Whether the interior's entries, and those between it and the border, are the ones that are known."""
    if known.size == 0:
        return False
    start = indptr[first]
    for i in range(outside.size):
        for k in range(indptr[first + i], indptr[first + i + 1]):
            if values[k] != known[k - start]:
                j = indices[k] - before - first
                if 0 <= j < outside.size and not (outside[i] and outside[j]):
                    return False
    return True


@njit
def _spread(
    indptr: IntArray,
    indices: IntArray,
    first: int,
    before: int,
    values: Array,
    number: IntArray,
    b: int,
    band: Array,
    right: Array,
    below: Array,
) -> None:
    """Write the values of CSR rows to their parts. number: of each row in the interior, in the border -1 less it."""
    for i in range(number.size):
        for k in range(indptr[first + i], indptr[first + i + 1]):
            at = indices[k] - before - first
            if not 0 <= at < number.size:
                continue
            row, column = number[i], number[at]
            if values[k] == 0.0:
                continue
            if row >= 0 and column >= 0:
                band[row, b + column - row] = values[k]
            elif row >= 0:
                right[row, -1 - column] = values[k]
            elif column >= 0:
                below[column, -1 - row] = values[k]


@njit
def _first_coupled(right: Array, below: Array, n: int) -> int:
    """Row of the interior from which on the border is coupled."""
    for k in range(n):
        if right[k].any() or below[k].any():
            return k
    return n


@njit
def _eliminate(band: Array, right: Array, below: Array, n: int, b: int, start: int) -> bool:
    """Factorise in place; whether all pivots are sound. band: entry (i, j) at [i, b + j - i], the rows filled up; the
    inverse of a pivot takes its place. start: the first row that is coupled with the border.
    """
    step, width, m = len(AT_ONCE), band.shape[1], right.shape[1]
    sound = band[:n, b] * LOST
    for k in range(n):
        if not band[k, b] > sound[k]:
            return False
        inverse = 1.0 / band[k, b]
        band[k, b] = inverse
        for i in range(1, b + 1):
            factor = band[k + i, b - i] * inverse
            band[k + i, b - i] = factor
            if factor == 0.0:
                continue
            to, own = (k + i) * width + b - i + 1, k * width + b + 1
            for j in range(0, b, step):
                add_multiple(band, to + j, -factor, band, own + j, AT_ONCE)
            if k >= start:
                for j in range(0, m, step):
                    add_multiple(right, (k + i) * m + j, -factor, right, k * m + j, AT_ONCE)
        if k < start:
            continue
        for j in range(m):
            below[k, j] *= inverse
        for i in range(1, b + 1):
            factor = band[k, b + i]
            if factor != 0.0:
                for j in range(0, m, step):
                    add_multiple(below, (k + i) * m + j, -factor, below, k * m + j, AT_ONCE)
    return True


@njit
def _forward(band: Array, x: Array, b: int) -> None:
    """Solve with the left factor, in place."""
    for k in range(x.size):
        first = max(b - k, 0)
        x[k] -= _product(band, k, first, x, k - b + first, b - first)


@njit
def _backward(band: Array, x: Array, b: int) -> None:
    """Solve with the right factor, in place."""
    for k in range(x.size - 1, -1, -1):
        x[k] = (x[k] - _product(band, k, b + 1, x, k + 1, min(b, x.size - 1 - k))) * band[k, b]


@njit
def _product(band: Array, k: int, first: int, x: Array, start: int, count: int) -> float:
    """Of so many numbers of a row with those of x, from a place on each, in four sums that needn't wait for another."""
    s0 = s1 = s2 = s3 = 0.0
    j = 0
    while j + 4 <= count:
        s0 += band[k, first + j] * x[start + j]
        s1 += band[k, first + j + 1] * x[start + j + 1]
        s2 += band[k, first + j + 2] * x[start + j + 2]
        s3 += band[k, first + j + 3] * x[start + j + 3]
        j += 4
    while j < count:
        s0 += band[k, first + j] * x[start + j]
        j += 1
    return (s0 + s1) + (s2 + s3)


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
            self._sections = [SectionFactors(at, first) for at in _runs(self._section[mine])]
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
