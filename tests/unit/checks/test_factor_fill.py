"""Fill of the soil's factor, foretold: counted by hand, and beside MUMPS on grids of nodes like a block's."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sparse
from petsc4py import PETSc

from riser_soil.checks.factor_fill import entries, factor_memory, operations


@pytest.mark.parametrize(
    ("sides", "counted"),
    [
        ((2.0, 2.0, 2.0), 24**2 / 2),  # eight nodes of three unknowns, all together
        ((5.0, 2.0, 2.0), 12**2 / 2 + 2 * (24**2 / 2 + 24 * 12)),  # a plane of four nodes between two such pieces
        ((2.0, 2.0, 5.0), 12**2 / 2 + 2 * (24**2 / 2 + 24 * 12)),
    ],
)
def test_small_grids_are_counted_by_hand(sides: tuple[float, float, float], counted: float) -> None:
    assert entries(*sides) == pytest.approx(counted, rel=1e-12)


@pytest.mark.parametrize(
    ("sides", "counted"),
    [
        ((2.0, 2.0, 2.0), 24**3 / 3),
        ((5.0, 2.0, 2.0), 12**3 / 3 + 2 * (24**3 / 3 + 24**2 * 12 + 24 * 12**2)),  # of each piece beside the plane
    ],
)
def test_operations_on_small_grids_are_counted_by_hand(sides: tuple[float, float, float], counted: float) -> None:
    """s unknowns with b beside them: s of them dense, and s columns of b rows that they change."""
    assert operations(*sides) == pytest.approx(counted, rel=1e-12)


def grid_matrix(sides: tuple[int, int, int]) -> PETSc.Mat:
    """Three unknowns a node, each with those of its node and of all that share a hexahedron with it."""
    x, y, z = (sparse.diags([1.0, 1.0, 1.0], [-1, 0, 1], shape=(n, n)) for n in sides)
    pattern = sparse.kron(sparse.kron(sparse.kron(x, y), z), np.ones((3, 3)))
    full = sparse.csr_matrix(100.0 * sparse.identity(pattern.shape[0]) - pattern)
    return PETSc.Mat().createAIJ(full.shape, csr=(full.indptr, full.indices, full.data), comm=PETSc.COMM_SELF)


@pytest.mark.parametrize("sides", [(33, 18, 8), (18, 16, 18), (110, 10, 8)])
@pytest.mark.parametrize("symmetric", [True, False])
def test_memory_is_that_of_mumps_within_a_quarter(sides: tuple[int, int, int], symmetric: bool) -> None:
    """A slab, nearly a cube, and a strip."""
    matrix, solver = grid_matrix(sides), PETSc.PC().create(PETSc.COMM_SELF)
    solver.setOperators(matrix)
    solver.setType("cholesky" if symmetric else "lu")
    solver.setFactorSolverType("mumps")
    solver.setUp()
    memory = 1e6 * solver.getFactorMatrix().getMumpsInfog(22)
    x, y, z = sides
    assert factor_memory((float(x), float(y), float(z)), 3.0 * x * y * z, symmetric) == pytest.approx(memory, rel=0.25)
    if symmetric:  # entries by MUMPS' ordering are 1.4 times as many, and operations go with their power of 3/2
        work = solver.getFactorMatrix().getMumpsRinfog(3)
        assert 1.0 / 1.5 < work / (1.4**1.5 * operations(x, y, z)) < 1.5
    solver.destroy()
    matrix.destroy()
