"""Numbering and assembly: no rows for prescribed dofs, sums over blocks, the same product on two ranks."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.matrix import Matrix, Patterns
from riser_soil.core.numbering import Numbering
from riser_soil.core.part import MatrixBlock
from tests.support.on_ranks import mpirun
from tests.support.toy_chain import Chain


def test_rows_are_the_free_dofs() -> None:
    numbering = Numbering(MPI.COMM_SELF, [Chain(np.arange(4.0), prescribed=True)])
    assert numbering.free == 3
    assert numbering.index.tolist() == [-1, 0, 1, 2]
    numbering.destroy()


def test_blocks_add_up_and_absent_dofs_drop_out() -> None:
    chain = Chain(np.arange(4.0), prescribed=True)
    numbering = Numbering(MPI.COMM_SELF, [chain])
    extra = MatrixBlock(np.array([[3, -1]]), np.array([[3, -1]]))
    matrix = Matrix(numbering, {"riser": chain.pairs(), "extra": extra}, symmetric=True)
    for _ in range(2):  # assembly starts anew each time
        matrix.values["riser"][...] = np.array([[1.0, -1.0], [-1.0, 1.0]])
        matrix.values["extra"][...] = 5.0
        matrix.assemble()
    dense = np.zeros((3, 3))
    for row in range(3):
        columns, values = matrix.mat.getRow(row)
        dense[row, columns] = values
    assert dense == pytest.approx(np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 6.0]]))
    matrix.destroy()
    numbering.destroy()


def test_of_a_batch_with_marks_the_filled_blocks_add_up_and_are_cleared() -> None:
    chain = Chain(np.arange(4.0), prescribed=True)
    numbering = Numbering(MPI.COMM_SELF, [chain])
    filled = np.zeros(3, dtype=bool)
    pairs = MatrixBlock(chain.pairs().rows, chain.pairs().cols, filled)
    matrix = Matrix(numbering, {"pairs": pairs}, symmetric=True)
    for block in (1, 2):
        matrix.clear()
        matrix.values["pairs"][block] = np.array([[1.0, -1.0], [-1.0, 1.0]])
        filled[block] = True
        matrix.assemble()
        expected = np.zeros((3, 3))
        expected[block - 1 : block + 1, block - 1 : block + 1] = [[1.0, -1.0], [-1.0, 1.0]]
        assert matrix.mat.getValues(range(3), range(3)) == pytest.approx(expected)
    matrix.destroy()
    numbering.destroy()


def test_a_batch_with_marks_may_be_empty() -> None:
    chain = Chain(np.arange(4.0), prescribed=True)
    numbering = Numbering(MPI.COMM_SELF, [chain])
    none = MatrixBlock(np.zeros((0, 2), dtype=np.int64), np.zeros((0, 2), dtype=np.int64), np.zeros(0, dtype=bool))
    matrix = Matrix(numbering, {"pairs": none}, symmetric=True)
    matrix.clear()
    matrix.assemble()
    assert matrix.mat.norm() == 0.0
    matrix.destroy()
    numbering.destroy()


def test_patterns_known_from_before_serve_as_long_as_they_are_of_the_same_entries() -> None:
    """Other candidates beside the same elements, then other free dofs: the matrix is as without what was known."""
    known: Patterns = {}
    for fixed, columns in ((True, [3, -1]), (True, [1, 2]), (False, [1, 2])):
        chain = Chain(np.arange(4.0), prescribed=fixed)
        numbering = Numbering(MPI.COMM_SELF, [chain])
        blocks = {"riser": chain.pairs(), "extra": MatrixBlock(np.array([[3, 1]]), np.array([columns]))}
        before, matrices = known.get("riser"), []
        for patterns in (known, None):
            matrix = Matrix(numbering, blocks, False, patterns)
            matrix.values["riser"][...] = np.array([[1.0, -1.0], [-1.0, 1.0]])
            matrix.values["extra"][...] = [[5.0, 6.0], [7.0, 8.0]]
            matrix.assemble()
            matrices.append([each.copy() for each in matrix.stored.csr()])
            matrix.destroy()
        for one, other in zip(*matrices, strict=True):
            assert np.array_equal(one, other)
        assert (known["riser"] is before) == (columns == [1, 2] and fixed)
        numbering.destroy()


def test_blocks_of_any_dofs_some_minus_what_the_system_has_add_up() -> None:
    """Against the sum over all entries; dofs that come twice in a block, too."""
    rng, n = np.random.default_rng(5), 12
    rows, cols = rng.integers(-1, n, (9, 4)), rng.integers(-1, n, (9, 3))
    values, minus = rng.uniform(-1.0, 1.0, (9, 4, 3)), rng.random(n) < 0.4
    numbering = Numbering(MPI.COMM_SELF, [Chain(np.arange(float(n)), prescribed=False)])
    numbering.sign = np.where(minus, -1.0, 1.0)
    matrix = Matrix(numbering, {"some": MatrixBlock(rows, cols)}, symmetric=False)
    matrix.values["some"][...] = values
    matrix.assemble()
    expected = np.zeros((n, n))
    for block, i, j in np.ndindex(values.shape):
        row, col = rows[block, i], cols[block, j]
        if min(row, col) >= 0:
            expected[row, col] += values[block, i, j] * numbering.sign[row] * numbering.sign[col]
    assert matrix.mat.getValues(range(n), range(n)) == pytest.approx(expected, abs=1e-15)
    indptr, indices, _ = matrix.stored.csr()
    assert all((np.diff(indices[a:b]) > 0).all() for a, b in pairwise(indptr))
    matrix.destroy()
    numbering.destroy()


def test_magnitudes_are_sums_of_absolute_values_over_the_blocks() -> None:
    """Where the blocks' own entries cancel one another, too; of absent dofs nothing, of prescribed ones their size."""
    chain = Chain(np.arange(4.0), prescribed=True)
    numbering = Numbering(MPI.COMM_SELF, [chain])
    extra = MatrixBlock(np.array([[3, -1]]), np.array([[3, -1]]))
    matrix = Matrix(numbering, {"riser": chain.pairs(), "extra": extra}, symmetric=True)
    matrix.values["riser"][...] = np.array([[1.0, -1.0], [-1.0, 1.0]])
    matrix.values["extra"][...] = -2.0
    sums = matrix.magnitudes(np.array([1.0, 10.0, 100.0, 1000.0]))
    assert sums == pytest.approx(np.array([11.0, 121.0, 1210.0, 1100.0 + 2000.0]))
    matrix.destroy()
    numbering.destroy()


ON_RANKS = '''
import numpy as np
from mpi4py import MPI
from riser_soil.core.matrix import Matrix
from riser_soil.core.numbering import Numbering
from tests.support.toy_chain import Chain

comm = MPI.COMM_WORLD
# All ranks hold the chain, the first one owns it, and every rank adds a share of every block.
chain = Chain(np.arange(40.0), prescribed=True, owner=comm.rank == 0)
numbering = Numbering(comm, [chain])
matrix = Matrix(numbering, {"pairs": chain.pairs()}, symmetric=True)
matrix.values["pairs"][...] = np.array([[1.0, -1.0], [-1.0, 1.0]]) / comm.size
matrix.assemble()
y = matrix.stored.times(np.sin(np.arange(numbering.first, numbering.first + numbering.owned)))
local = np.zeros(chain.size)
numbering.to_local(y, local)
x = numbering.add_to_global(local / comm.size)
matrix.add_to_diagonal(x)
square = comm.allreduce(float(x @ matrix.stored.diagonal()))
changed = comm.allreduce(float(x @ matrix.stored.times(x)))
if comm.rank == 0:
    print(" ".join(f"{v:.12e}" for v in np.concatenate([local, [square, changed]])))
'''


@pytest.mark.parametrize("ranks", [2, pytest.param(3, marks=pytest.mark.verify)])
def test_product_on_ranks(tmp_path: Path, ranks: int, capsys: pytest.CaptureFixture[str]) -> None:
    script = tmp_path / "on_ranks.py"
    script.write_text(ON_RANKS)
    exec(ON_RANKS, {})
    printed = capsys.readouterr().out, mpirun(ranks, str(script)).stdout
    alone, together = (np.array(each.split(), dtype=float) for each in printed)
    assert len(alone) == 42
    assert together == pytest.approx(alone, rel=1e-12)
