"""The system matrix: sparsity pattern from the parts' blocks, and assembly of their values.

On one rank the blocks' values are added straight into a CSR array (`csr_matrix`). On several ranks each sums its own
first and sends what belongs to others in one exchange (`shared_matrix`).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import reduce
from typing import TYPE_CHECKING, Any

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.csr_matrix import (
    CsrMatrix,
    add_at,
    add_filled_at,
    add_magnitudes,
    number_entries,
    union,
    write_places,
)
from riser_soil.core.numbering import Numbering
from riser_soil.core.part import MatrixBlock

if TYPE_CHECKING:
    from riser_soil.core.shared_matrix import SharedMatrix


class Matrix:
    """Matrix over the numbering's rows, with one value array of shape (m, nr, nc) for each block.

    known: patterns of a matrix before this one, which gets those of this one; None where there will be no other.
    stored: the sums. changes: how often they have changed, for those who keep factors.
    """

    def __init__(
        self, numbering: Numbering, blocks: Mapping[str, MatrixBlock], symmetric: bool, known: Patterns | None = None
    ) -> None:
        self.values = {key: block.zeros() for key, block in blocks.items()}
        self._blocks, self._size, n = blocks, numbering.size, numbering.free
        patterns = {} if known is None else known
        for key, block in blocks.items():
            patterns[key] = _pattern(numbering, block, patterns.get(key))
        diagonal = np.arange(n if numbering.comm.size == 1 else 0) * (n + 1)
        keys = reduce(union, (patterns[key].keys for key in blocks), diagonal)
        self._data, self.changes = np.zeros(len(keys) + 1), 0
        self._places = {key: patterns[key].places(keys) for key in blocks}
        self.stored = _store(numbering, keys, symmetric, self._data[:-1])

    @property
    def mat(self) -> Any:
        """The matrix as PETSc has it."""
        return self.stored.mat

    def write(self) -> None:
        """Write the present values to PETSc's matrix, unless it has them; collective."""
        self.stored.write()

    def clear(self) -> None:
        for key, values in self.values.items():
            filled = self._blocks[key].filled
            values[... if filled is None else filled] = 0.0
            if filled is not None:
                filled[:] = False

    def written(self, keys: Collection[str]) -> bool:
        """Whether parts of this rank have written to some of the batches since `clear`, or may have."""
        marks = [self._blocks[key].filled for key in keys]
        return any(filled is None or bool(filled.any()) for filled in marks)

    def assemble(self) -> None:
        """Sum the blocks' values into the matrix."""
        self._data[:] = 0.0
        for key, values in self.values.items():
            filled = self._blocks[key].filled
            if filled is None:
                add_at(self._data, self._places[key], values.reshape(-1))
            else:
                add_filled_at(self._data, self._places[key], values.reshape(-1), filled)
        self.stored.put(self._data[:-1])
        self.changes += 1

    def add_to_diagonal(self, values: Array) -> None:
        """Add to the entries on the diagonal of this rank's rows (owned,)."""
        self.stored.set_diagonal(self.stored.diagonal() + values)
        self.changes += 1

    def magnitudes(self, sizes: Array) -> Array:
        """Sums (size,) over this rank's blocks of the entries' absolute values times sizes (size,) of their columns."""
        sums = np.zeros(self._size)
        for key, block in self._blocks.items():
            add_magnitudes(self.values[key], block.rows, block.cols, sizes, sums)
        return sums

    def destroy(self) -> None:
        self.stored.destroy()


def _store(numbering: Numbering, keys: IntArray, symmetric: bool, data: Array) -> CsrMatrix | SharedMatrix:
    """data: the sums, which one rank alone stores in place."""
    if numbering.comm.size == 1:
        return CsrMatrix(keys, numbering.free, data, symmetric)
    from riser_soil.core.shared_matrix import SharedMatrix

    return SharedMatrix(numbering, keys, symmetric)


class BlockPattern:
    """Entries row n + col that a batch of blocks has in a system of n unknowns.

    rows (m, nr), cols (m, nc): of the system, -1 for none; minus: which of them are minus what the system has. keys:
    the distinct entries, sorted.
    """

    def __init__(self, rows: IntArray, cols: IntArray, minus: tuple[BoolArray, BoolArray], n: int) -> None:
        self._rows, self._cols, self._minus, self._n = rows, cols, minus, n
        numbers = np.empty((*rows.shape, cols.shape[1]), dtype=np.int32)
        self.keys = number_entries(rows, cols, minus, n, numbers)
        self._numbers = numbers.reshape(-1)

    def is_of(self, rows: IntArray, cols: IntArray, minus: tuple[BoolArray, BoolArray], n: int) -> bool:
        mine, others = (self._rows, self._cols, *self._minus), (rows, cols, *minus)
        return n == self._n and all(np.array_equal(a, b) for a, b in zip(mine, others, strict=True))

    def places(self, keys: IntArray) -> IntArray:
        """Position of every entry of the blocks among the system's entries, -1 less it where it is minus that; absent
        ones go to a slot behind the last.
        """
        out = np.empty_like(self._numbers)
        write_places(keys, self.keys, self._numbers, out)
        return out


Patterns = dict[str, BlockPattern]


def _pattern(numbering: Numbering, block: MatrixBlock, known: BlockPattern | None) -> BlockPattern:
    """Pattern of a batch of blocks: the known one if it is the same."""
    rows, cols = (_in_system(numbering, dofs) for dofs in (block.rows, block.cols))
    given = rows, cols, _is_minus(numbering, block), numbering.free
    return known if known is not None and known.is_of(*given) else BlockPattern(*given)


def _in_system(numbering: Numbering, local: IntArray) -> IntArray:
    """System rows of local dof numbers; -1 for absent and prescribed ones."""
    rows = np.append(numbering.index, -1)[local]
    return np.ascontiguousarray(rows, dtype=np.int32)


def _is_minus(numbering: Numbering, block: MatrixBlock) -> tuple[BoolArray, BoolArray]:
    """Which rows (m, nr) and columns (m, nc) of blocks are minus what the system has."""
    minus = np.append(numbering.sign < 0.0, False)
    return minus[block.rows], minus[block.cols]
