"""Direct solver for soil in sections: against dense solutions, with factors that are kept, and where pivots fail."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from petsc4py import PETSc
from scipy.sparse import csr_matrix

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.banded import SingularError
from riser_soil.core.factor_memory import Workspace
from riser_soil.solve.section_solver import SectionSolver

RISER, SECTIONS, EACH, WIDTH = 6, 3, 40, 5  # rows of the riser, sections, rows of one, entries beside its diagonal
ROWS = RISER + SECTIONS * EACH
TOUCHED = np.array([RISER + 17, RISER + 20, RISER + EACH + 12])  # rows of the first two sections


def matrix() -> Array:
    """Not symmetric, positive definite; contact couples the riser and two sections with each other."""
    random = np.random.default_rng(3)
    i, j = np.indices((ROWS, ROWS))
    number = np.maximum((i - RISER) // EACH, -1)
    near = (number == number.T) & (np.abs(i - j) <= WIDTH)
    out = np.where(near, random.uniform(-1.0, 1.0, size=(ROWS, ROWS)), 0.0) + 2.0 * WIDTH * np.eye(ROWS)
    contact = np.concatenate([np.arange(2, 5), TOUCHED])
    out[np.ix_(contact, contact)] += random.uniform(-1.0, 1.0, size=(len(contact), len(contact)))
    return out


class Solver:
    """Solves matrices of one pattern, one after the other."""

    def __init__(self, entries: Array) -> None:
        self._pattern = csr_matrix(entries != 0.0)
        soil: Any = SimpleNamespace(
            section=np.repeat(np.arange(SECTIONS), EACH),
            owned=np.ones(SECTIONS * EACH, dtype=bool),
            offset=RISER,
            size=SECTIONS * EACH,
        )
        numbering = SimpleNamespace(first=0, free=ROWS, index=np.arange(ROWS))
        matrix = SimpleNamespace(stored=SimpleNamespace(csr=lambda: self._csr))
        system: Any = SimpleNamespace(comm=MPI.COMM_SELF, matrix=matrix, numbering=numbering)
        self.solver = SectionSolver(system, soil, Workspace())
        self._pc: Any = None

    def solution(self, entries: Array, load: Array) -> Array:
        rows = np.repeat(np.arange(ROWS), np.diff(self._pattern.indptr))
        self._csr = self._pattern.indptr, self._pattern.indices, entries[rows, self._pattern.indices]
        given, solution = (PETSc.Vec().createWithArray(a, comm=PETSc.COMM_SELF) for a in (load.copy(), np.zeros(ROWS)))
        self.solver.setUp(self._pc)
        self.solver.apply(self._pc, given, solution)
        return np.array(solution.array_r)

    @property
    def renewed(self) -> list[bool]:
        """Which sections the last tangent gave new factors."""
        return as_list(self.solver._factors.bands.renewed)


LOAD = np.random.default_rng(4).normal(size=ROWS)


def require_solved(entries: Array, x: Array) -> None:
    np.testing.assert_allclose(x, np.linalg.solve(entries, LOAD), rtol=0.0, atol=1e-12 * np.abs(x).max())


def test_it_solves() -> None:
    entries = matrix()
    require_solved(entries, Solver(entries).solution(entries, LOAD))


@pytest.mark.parametrize("row", [0, EACH - 1, EACH // 2])
def test_a_section_whose_entries_change_gets_new_factors_and_the_others_keep_theirs(row: int) -> None:
    entries = matrix()
    solver = Solver(entries)
    solver.solution(entries, LOAD)
    entries[RISER + EACH + row, RISER + EACH + row] *= 1.5
    require_solved(entries, solver.solution(entries, LOAD))
    assert solver.renewed == [False, True, False]


def test_contact_that_changes_keeps_all_factors() -> None:
    """Factors are kept as long as contact touches the same rows."""
    entries = matrix()
    solver = Solver(entries)
    solver.solution(entries, LOAD)
    entries[np.ix_(TOUCHED, TOUCHED)] *= 1.3
    entries[3, TOUCHED] *= 0.7
    require_solved(entries, solver.solution(entries, LOAD))
    assert solver.renewed == [False] * SECTIONS


def test_places_of_contact_that_are_empty_make_no_band_wider() -> None:
    """Nodes of the surface far from each other have a place together, as each may touch the same element."""
    entries = matrix()
    solver, far = Solver(entries + np.eye(ROWS, k=EACH - 1) + np.eye(ROWS, k=1 - EACH)), RISER + EACH - 1
    require_solved(entries, solver.solution(entries, LOAD))
    narrow = solver.solver._factors.bands.width.size
    entries[RISER, far] = entries[far, RISER] = 0.1
    require_solved(entries, solver.solution(entries, LOAD))
    assert narrow == WIDTH < solver.solver._factors.bands.width.size


@pytest.mark.parametrize(
    "one_way", [(slice(None, RISER), slice(RISER, None)), (slice(RISER, None), slice(None, RISER))]
)
def test_rows_that_touch_no_more_and_again_change_sides(one_way: tuple[slice, slice]) -> None:
    """Those that the riser only acts on, or that only act on it, are coupled, too."""
    entries = matrix()
    solver = Solver(entries)
    apart = entries.copy()
    apart[np.ix_(TOUCHED[:1], [2, 3, 4, *TOUCHED[2:]])] = apart[np.ix_([2, 3, 4, *TOUCHED[2:]], TOUCHED[:1])] = 0.0
    acting = entries.copy()
    acting[one_way] = 0.0
    for each in (apart, entries, acting, apart):
        require_solved(each, solver.solution(each, LOAD))


def test_nothing_touches() -> None:
    entries = matrix()
    solver = Solver(entries)
    entries[:RISER, RISER:] = entries[RISER:, :RISER] = 0.0
    entries[TOUCHED[2], TOUCHED[:2]] = entries[TOUCHED[:2], TOUCHED[2]] = 0.0
    require_solved(entries, solver.solution(entries, LOAD))


@pytest.mark.parametrize("row", [2, RISER + 3, RISER + 17])
def test_a_singular_matrix_is_reported(row: int) -> None:
    """In the riser, in a section and in its border."""
    entries = matrix()
    solver = Solver(entries)
    entries[row] = 0.0
    with pytest.raises(SingularError):
        solver.solution(entries, LOAD)


def test_rows_of_a_section_are_exchanged_where_a_pivot_is_none() -> None:
    entries = matrix()
    entries[RISER, RISER] = 0.0
    assert np.linalg.cond(entries) < 1e3
    require_solved(entries, Solver(entries).solution(entries, LOAD))


def test_an_interior_without_an_inverse_is_reported_and_others_after_it_are_solved() -> None:
    """The whole matrix has one: what touches couples a row that nothing in the interior holds."""
    entries = matrix()
    solver, spoilt = Solver(entries), entries.copy()
    alone = spoilt[RISER, TOUCHED[0]], spoilt[TOUCHED[0], RISER] = 3.0, 3.0
    spoilt[RISER], spoilt[:, RISER] = 0.0, 0.0
    spoilt[RISER, TOUCHED[0]], spoilt[TOUCHED[0], RISER] = alone
    assert np.linalg.cond(spoilt) < 1e3
    with pytest.raises(SingularError):
        solver.solution(spoilt, LOAD)
    require_solved(entries, solver.solution(entries, LOAD))
