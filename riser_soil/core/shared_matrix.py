"""The system matrix of several ranks: PETSc's, filled in one exchange. PETSc's own sums take several times that."""

from __future__ import annotations

from typing import Any

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.csr_matrix import add_at, csr_pattern
from riser_soil.core.numbering import Numbering
from riser_soil.core.petsc_matrix import declare


class SharedMatrix:
    """Sends the entries that the ranks have summed to those that own their rows. mat: the matrix that they make there.

    keys: sorted entries row n + col of this rank's blocks, whatever rank owns them.
    """

    def __init__(self, numbering: Numbering, keys: IntArray, symmetric: bool) -> None:
        comm: Any = numbering.comm
        self._comm = comm
        n, owned, first = numbering.free, numbering.owned, numbering.first
        self._sent = np.diff(np.searchsorted(keys, numbering.bounds * n))
        received = self._comm.alltoall(np.split(keys, np.cumsum(self._sent)[:-1]))
        mine = np.union1d(np.concatenate(received), np.arange(first, first + owned) * (n + 1))
        self._received = np.array([len(part) for part in received])
        self._places = np.searchsorted(mine, np.concatenate(received))
        self._values, self._arrived = np.zeros(len(mine)), np.zeros(len(self._places))
        indptr, indices = csr_pattern(mine, first, owned, n)
        self._pattern = indptr.astype(PETSc.IntType), indices.astype(PETSc.IntType)
        size = (owned, PETSc.DETERMINE)
        self.mat = PETSc.Mat().createAIJ((size, size), csr=self._pattern, comm=self._comm)
        declare(self.mat, symmetric)

    def put(self, data: Array) -> None:
        """Write this rank's sums (len(keys),) and the others' into the matrix; collective."""
        self._comm.Alltoallv([data, self._sent, MPI.DOUBLE], [self._arrived, self._received, MPI.DOUBLE])
        self._values[:] = 0.0
        add_at(self._values, self._places, self._arrived)
        self.mat.setValuesCSR(*self._pattern, self._values)
        self.mat.assemble()

    def csr(self) -> tuple[IntArray, IntArray, Array]:
        """Starts of this rank's rows, columns, values."""
        indptr, indices, values = self.mat.getValuesCSR()
        return indptr, indices, values

    def diagonal(self) -> Array:
        """A copy of it in this rank's rows."""
        found = self.mat.getDiagonal()
        values = np.array(found.array_r)
        found.destroy()
        return values

    def set_diagonal(self, values: Array) -> None:
        """Replace its entries in this rank's rows; collective."""
        given = self.mat.createVecRight()
        given.array_w[:] = values
        self.mat.setDiagonal(given)
        given.destroy()

    def times(self, x: Array) -> Array:
        """Product with the unknowns; collective."""
        given, found = self.mat.createVecs()
        given.array_w[:] = x
        self.mat.mult(given, found)
        values = np.array(found.array_r)
        for vector in (given, found):
            vector.destroy()
        return values

    def destroy(self) -> None:
        self.mat.destroy()
