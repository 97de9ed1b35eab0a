"""A banded matrix with a dense border, against a dense solve."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from petsc4py import PETSc

from riser_soil.core.arrays import Array
from riser_soil.core.banded import SingularError
from riser_soil.solve.bordered_band import BorderedBand
from riser_soil.solve.direct_solver import BandSolver
from riser_soil.solve.linear_solver import complaint
from tests.support.said import line_with


def matrix(chain: int, border: int, band: int, touched: slice) -> Array:
    """Random, not symmetric; the first diagonal entry is zero, so that rows must be exchanged."""
    random = np.random.default_rng(7)
    n = chain + border
    out = random.normal(size=(n, n))
    i, j = np.indices((n, n))
    out[(i < chain) & (j < chain) & (abs(i - j) > band)] = 0.0
    away = np.ones(chain, dtype=bool)
    away[touched] = False
    out[:chain, chain:][away] = 0.0
    out[chain:, :chain][:, away] = 0.0
    out[0, 0] = 0.0
    return out


class Stored:
    """A matrix as the solver reads it."""

    def __init__(self, entries: Array) -> None:
        self.stored, self.changes, self.entries = self, 0, entries

    def csr(self) -> tuple[Array, Array, Array]:
        return _csr(self.entries)

    def scale(self, factor: float) -> None:
        self.entries, self.changes = factor * self.entries, self.changes + 1


def solver(entries: Array, chain: int, border: int) -> tuple[BorderedBand, Stored]:
    """Solver of the first rows."""
    matrix: Any = Stored(entries)
    return BorderedBand(matrix, np.arange(chain), np.arange(chain, chain + border)), matrix


def _csr(entries: Array) -> tuple[Array, Array, Array]:
    rows, columns = np.nonzero(entries)
    indptr = np.append(0, np.cumsum(np.bincount(rows, minlength=len(entries))))
    return indptr.astype(PETSc.IntType), columns.astype(PETSc.IntType), entries[rows, columns]


@pytest.mark.parametrize(
    ("chain", "border", "band", "touched"),
    [(30, 7, 3, slice(10, 15)), (30, 7, 3, slice(0, 30)), (12, 20, 2, slice(11, 12)), (15, 0, 2, slice(0, 0)),
     (40, 7, 5, slice(10, 15))],  # the last one has the width of a line in a plane
)
def test_it_solves(chain: int, border: int, band: int, touched: slice) -> None:
    entries = matrix(chain, border, band, touched)
    load = np.random.default_rng(8).normal(size=chain + border)
    factors, stored = solver(entries, chain, border)
    for scale in (1.0, 2.0):  # the factors are renewed with the matrix
        solution, expected = factors.solve(load), np.linalg.solve(scale * entries, load)
        assert np.abs(solution - expected).max() < 1e-9 * np.abs(expected).max()
        stored.scale(2.0)


def test_the_band_alone_is_solved() -> None:
    """The matrix has further rows, which don't count."""
    entries, load = matrix(30, 7, 3, slice(10, 15)), np.random.default_rng(8).normal(size=30)
    factors, _ = solver(entries, 30, 0)
    expected = np.linalg.solve(entries[:30, :30], load)
    assert np.abs(factors.solve(load) - expected).max() < 1e-9 * np.abs(expected).max()


def test_rows_of_the_border_may_lie_anywhere() -> None:
    """Those of band and border in another order of the system, as joined lines have them."""
    entries, load = matrix(30, 7, 3, slice(10, 15)), np.random.default_rng(8).normal(size=37)
    mixed = np.random.default_rng(9).permutation(37)
    given: Any = Stored(entries[np.ix_(mixed, mixed)])
    at = np.argsort(mixed)  # where each of the rows is now
    solution = BorderedBand(given, at[:30], at[30:]).solve(load[mixed])
    expected = np.linalg.solve(entries, load)[mixed]
    assert np.abs(solution - expected).max() < 1e-9 * np.abs(expected).max()


@pytest.mark.parametrize("border", [0, 7])
def test_negative_pivots_of_band_and_border_are_negative_eigenvalues(border: int) -> None:
    entries = matrix(30, border, 3, slice(10, 15))
    entries += entries.T
    entries[0, 0] = 1.0
    negative = int((np.linalg.eigvalsh(entries) < 0.0).sum())
    assert 5 < negative < len(entries) - 5
    units = 10.0 ** np.random.default_rng(3).uniform(-6.0, 6.0, size=len(entries))  # of rows, as of forces and moments
    for scale in (np.ones(len(entries)), units):
        factors, _ = solver(np.outer(scale, scale) * entries, 30, border)
        assert factors.negative_pivots() == negative


@pytest.mark.parametrize("row", [4, 33])
def test_a_singular_matrix_is_reported(row: int) -> None:
    """In the band, and in the border."""
    entries = matrix(30, 7, 3, slice(10, 15))
    entries[row] = 0.0
    factors, _ = solver(entries, 30, 7)
    size = np.arange(2, dtype=PETSc.IntType)
    mat = PETSc.Mat().createAIJ((1, 1), csr=(size, size[:1], np.ones(1)), comm=PETSc.COMM_SELF)
    pc = PETSc.PC().create(PETSc.COMM_SELF)
    pc.setOperators(mat)
    BandSolver(factors).work_for(pc)
    with pytest.raises((SingularError, PETSc.Error)) as failure:
        pc.setUp()
    line_with(complaint(failure.value), "linear solver failed", "matrix is singular")
    pc.destroy()
    mat.destroy()


def test_a_singular_matrix_is_reported_where_petsc_makes_an_error_of_its_own() -> None:
    err = PETSc.Error(-1)
    err.__cause__ = SingularError()
    line_with(complaint(err), "linear solver failed", "matrix is singular")



LEFT_OVER = """
import numpy as np
from petsc4py import PETSc
from riser_soil.solve.bordered_band import BorderedBand
from riser_soil.solve.direct_solver import BandSolver
from tests.unit.solve.test_bordered_band import Stored

class Solver:
    def __init__(self):
        size = np.arange(4, dtype=PETSc.IntType)
        mat = PETSc.Mat().createAIJ((3, 3), csr=(size, size[:3], np.full(3, 2.0)), comm=PETSc.COMM_SELF)
        self.snes, self.x, self.f = PETSc.SNES().create(PETSc.COMM_SELF), *mat.createVecs()
        self.snes.setFunction(self.function, self.f)
        self.snes.setJacobian(lambda *_: None, mat)
        self.snes.getKSP().setType("preonly")
        band = BorderedBand(Stored(2.0 * np.eye(3)), np.arange(2), np.array([2]))
        BandSolver(band).work_for(self.snes.getKSP().getPC())

    def function(self, snes, x, f):
        f.setArray(2.0 * x.getArray(readonly=True) - 6.0)

solver = Solver()
solver.snes.solve(None, solver.x)
print(*solver.x.getArray(readonly=True))
%s
"""


@pytest.mark.parametrize(
    ("end", "in_use"),
    [("", 1), pytest.param("del solver", 1, marks=pytest.mark.verify), ("solver.snes.destroy()", 0)],
)
def test_python_ends_well_with_solvers_left_over(end: str, in_use: int) -> None:
    """Nothing is kept of solvers that were destroyed."""
    counted = f"{end}\nprint(len(BandSolver.in_use))"
    done = subprocess.run([sys.executable, "-c", LEFT_OVER % counted], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.split()) == (0, ["3.0", "3.0", "3.0", str(in_use)]), done.stderr
