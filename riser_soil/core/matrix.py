"""The system matrix: sparsity pattern from the parts' blocks, and assembly of their values.

On one rank the blocks' values are added straight into the CSR array that PETSc works on. On several ranks each sums its
own first and sends what belongs to others in one exchange; PETSc's own sums, block by block, take several times that.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.numbering import Numbering
from riser_soil.core.part import MatrixBlock

AT_ONCE = 2048  # blocks whose entries are looked up together: all at once take several times the matrix' own memory


class Matrix:
    """PETSc matrix over the numbering's rows, with one value array of shape (m, nr, nc) for each block."""

    def __init__(self, numbering: Numbering, blocks: Mapping[str, MatrixBlock], symmetric: bool) -> None:
        self.values = {key: block.zeros() for key, block in blocks.items()}
        self._blocks, self._size = blocks, numbering.size
        rows = {key: _in_system(numbering, block.rows) for key, block in blocks.items()}
        cols = {key: _in_system(numbering, block.cols) for key, block in blocks.items()}
        keys = _merge(_keys(rows[k], cols[k], numbering.free) for k in blocks)
        self._exchange = None if numbering.comm.size == 1 else _Exchange(numbering, keys)
        if self._exchange is None:
            n = numbering.free
            keys = np.union1d(keys, np.arange(n) * (n + 1))
            self.mat = self._on_one_rank(keys, n)
        else:
            self.mat = self._exchange.mat
            self._data = np.zeros(len(keys) + 1)
        self._places = {key: _places(keys, rows[key], cols[key], numbering.free) for key in self.values}
        self.mat.setOption(PETSc.Mat.Option.NEW_NONZERO_LOCATION_ERR, True)
        if symmetric:
            self.mat.setOption(PETSc.Mat.Option.SYMMETRIC, True)
            self.mat.setOption(PETSc.Mat.Option.SYMMETRY_ETERNAL, True)

    def _on_one_rank(self, keys: IntArray, n: int) -> PETSc.Mat:
        self._data = np.zeros(len(keys) + 1)
        arrays = (*_csr(keys, 0, n, n), self._data[:-1])
        return PETSc.Mat().createAIJWithArrays((n, n), arrays, comm=PETSc.COMM_SELF)

    def clear(self) -> None:
        for key, values in self.values.items():
            filled = self._blocks[key].filled
            values[... if filled is None else filled] = 0.0
            if filled is not None:
                filled[:] = False

    def assemble(self) -> None:
        """Sum the blocks' values into the matrix."""
        self._data[:] = 0.0
        for key, values in self.values.items():
            filled = self._blocks[key].filled
            if filled is None:
                _add_at(self._data, self._places[key], values.reshape(-1))
                continue
            each = self._places[key].reshape(len(values), math.prod(values.shape[1:]))
            for block in np.flatnonzero(filled):
                _add_at(self._data, each[block], values[block].reshape(-1))
        if self._exchange is not None:
            self._exchange.put(self._data[:-1])
        self.mat.assemble()

    def magnitudes(self, sizes: Array) -> Array:
        """Sums (size,) over this rank's blocks of the entries' absolute values times sizes (size,) of their columns."""
        found, known = np.zeros(self._size + 1), np.append(sizes, 0.0)
        for key, block in self._blocks.items():
            np.add.at(found, block.rows, (np.abs(self.values[key]) @ known[block.cols][..., None])[..., 0])
        return found[:-1]

    def destroy(self) -> None:
        self.mat.destroy()


@njit
def _add_at(data: Array, places: IntArray, values: Array) -> None:
    for k in range(places.size):
        data[places[k]] += values[k]


def _in_system(numbering: Numbering, local: IntArray) -> IntArray:
    """System rows of local dof numbers; -1 for absent and prescribed ones."""
    rows = np.append(numbering.index, -1)[local]
    return np.ascontiguousarray(rows, dtype=PETSc.IntType)


def _keys(rows: IntArray, cols: IntArray, n: int) -> IntArray:
    """Sorted distinct entries row·n + col of a batch of blocks, found some of them at a time."""
    found = [_distinct(rows[some], cols[some], n) for some in _some_at_a_time(len(rows))]
    return np.unique(np.concatenate(found)) if found else np.empty(0, dtype=np.int64)


def _distinct(rows: IntArray, cols: IntArray, n: int) -> IntArray:
    keys, there = _entries(rows, cols, n)
    return np.unique(keys[there])


def _entries(rows: IntArray, cols: IntArray, n: int) -> tuple[IntArray, BoolArray]:
    """Entries row·n + col (m, nr, nc) of blocks, and which are there."""
    keys = rows.astype(np.int64)[:, :, None] * n + cols[:, None, :]
    return keys, (rows >= 0)[:, :, None] & (cols >= 0)[:, None, :]


def _some_at_a_time(blocks: int) -> Iterator[slice]:
    yield from (slice(first, first + AT_ONCE) for first in range(0, blocks, AT_ONCE))


def _merge(parts: Iterable[IntArray]) -> IntArray:
    merged: IntArray = np.empty(0, dtype=np.int64)
    for keys in parts:
        merged = np.union1d(merged, keys)
    return merged


def _csr(keys: IntArray, first: int, count: int, n: int) -> tuple[IntArray, IntArray]:
    rows = keys // n - first
    indptr = np.concatenate(([0], np.cumsum(np.bincount(rows, minlength=count))))
    return indptr.astype(PETSc.IntType), (keys % n).astype(PETSc.IntType)


def _places(keys: IntArray, rows: IntArray, cols: IntArray, n: int) -> IntArray:
    """Position of every block entry in the CSR values; absent entries go to a slot behind the last."""
    places = np.empty((*rows.shape, cols.shape[1]), dtype=np.int32)
    for some in _some_at_a_time(len(rows)):
        wanted, there = _entries(rows[some], cols[some], n)
        places[some] = np.where(there, np.searchsorted(keys, wanted), len(keys))
    return places.reshape(-1)


class _Exchange:
    """Sends the entries that the ranks have summed to those that own their rows. mat: the matrix that they make there.

    keys: sorted entries row n + col of this rank's blocks, whatever rank owns them.
    """

    def __init__(self, numbering: Numbering, keys: IntArray) -> None:
        self._comm, n, owned = numbering.comm, numbering.free, numbering.owned
        bounds = np.asarray(numbering.vector.getOwnershipRanges(), dtype=np.int64)
        self._sent = np.diff(np.searchsorted(keys, bounds * n))
        received = self._comm.alltoall(np.split(keys, np.cumsum(self._sent)[:-1]))
        first = bounds[self._comm.rank]
        mine = np.union1d(np.concatenate(received), np.arange(first, first + owned) * (n + 1))
        self._received = np.array([len(part) for part in received])
        self._places = np.searchsorted(mine, np.concatenate(received))
        self._values, self._arrived = np.zeros(len(mine)), np.zeros(len(self._places))
        self._csr = _csr(mine, int(first), owned, n)
        size = (owned, PETSc.DETERMINE)
        self.mat = PETSc.Mat().createAIJ((size, size), csr=self._csr, comm=self._comm)

    def put(self, data: Array) -> None:
        """Write this rank's sums (len(keys),) and the others' into the matrix; collective."""
        self._comm.Alltoallv([data, self._sent, MPI.DOUBLE], [self._arrived, self._received, MPI.DOUBLE])
        self._values[:] = 0.0
        _add_at(self._values, self._places, self._arrived)
        self.mat.setValuesCSR(*self._csr, self._values)
