"""The system matrix: sparsity pattern from the parts' blocks, and assembly of their values.

On one rank the blocks' values are added straight into the CSR array that PETSc works on; on several ranks PETSc sends
entries to their owners.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.numbering import Numbering
from riser_soil.core.part import MatrixBlock


class Matrix:
    """PETSc matrix over the numbering's rows, with one value array of shape (m, nr, nc) for each block."""

    def __init__(self, numbering: Numbering, blocks: Mapping[str, MatrixBlock], symmetric: bool) -> None:
        self.values = {key: block.zeros() for key, block in blocks.items()}
        self._blocks, self._size = blocks, numbering.size
        self._rows = {key: _in_system(numbering, block.rows) for key, block in blocks.items()}
        self._cols = {key: _in_system(numbering, block.cols) for key, block in blocks.items()}
        keys = _merge(_keys(self._rows[k], self._cols[k], numbering.free) for k in blocks)
        self._serial = numbering.comm.size == 1
        if self._serial:
            self._create_serial(keys, numbering.free)
        else:
            self._create_distributed(keys, numbering)
        self.mat.setOption(PETSc.Mat.Option.NEW_NONZERO_LOCATION_ERR, True)
        if symmetric:
            self.mat.setOption(PETSc.Mat.Option.SYMMETRIC, True)
            self.mat.setOption(PETSc.Mat.Option.SYMMETRY_ETERNAL, True)

    def _create_serial(self, keys: IntArray, n: int) -> None:
        keys = np.union1d(keys, np.arange(n) * (n + 1))
        indptr, indices = _csr(keys, 0, n, n)
        self._data = np.zeros(len(keys) + 1)
        self._places = {
            key: _places(keys, self._rows[key], self._cols[key], n) for key in self.values
        }
        self.mat = PETSc.Mat().createAIJWithArrays(
            (n, n), (indptr, indices, self._data[:-1]), comm=PETSc.COMM_SELF
        )

    def _create_distributed(self, keys: IntArray, numbering: Numbering) -> None:
        n, owned = numbering.free, numbering.owned
        first = numbering.vector.getOwnershipRange()[0]
        diagonal = np.arange(first, first + owned) * (n + 1)
        keys = np.union1d(_send_to_owners(numbering, keys, n), diagonal)
        size = (owned, PETSc.DETERMINE)
        self.mat = PETSc.Mat().createAIJ((size, size), csr=_csr(keys, first, owned, n), comm=numbering.comm)

    def clear(self) -> None:
        for values in self.values.values():
            values[...] = 0.0

    def assemble(self) -> None:
        """Sum the blocks' values into the matrix."""
        if self._serial:
            self._data[:] = 0.0
            for key, values in self.values.items():
                _add_at(self._data, self._places[key], values.reshape(-1))
        else:
            self.mat.zeroEntries()
            for key, values in self.values.items():
                self.mat.setValuesRCV(self._rows[key], self._cols[key], values, addv=True)
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
    """Sorted distinct entries row·n + col of a batch of blocks."""
    keys = rows.astype(np.int64)[:, :, None] * n + cols[:, None, :]
    kept = keys[(rows >= 0)[:, :, None] & (cols >= 0)[:, None, :]]
    return np.unique(kept)


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
    wanted = rows.astype(np.int64)[:, :, None] * n + cols[:, None, :]
    places = np.searchsorted(keys, wanted)
    places[~((rows >= 0)[:, :, None] & (cols >= 0)[:, None, :])] = len(keys)
    return places.reshape(-1).astype(np.int32)


def _send_to_owners(numbering: Numbering, keys: IntArray, n: int) -> IntArray:
    """Entries of this rank's rows, contributed by all ranks."""
    comm: MPI.Intracomm = numbering.comm
    bounds = numbering.vector.getOwnershipRanges()
    cuts = np.searchsorted(keys, np.asarray(bounds, dtype=np.int64) * n)
    received = comm.alltoall([keys[cuts[r] : cuts[r + 1]] for r in range(comm.size)])
    return np.unique(np.concatenate(received))
