"""Fill of the soil's factor, foretold: counted by hand, and beside MUMPS on grids of nodes like a block's."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sparse
from petsc4py import PETSc

from riser_soil.checks.estimate import entries, factor_memory


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
    taken = 1e6 * solver.getFactorMatrix().getMumpsInfog(22)
    x, y, z = sides
    assert factor_memory((float(x), float(y), float(z)), 3.0 * x * y * z, symmetric) == pytest.approx(taken, rel=0.25)
    solver.destroy()
    matrix.destroy()
