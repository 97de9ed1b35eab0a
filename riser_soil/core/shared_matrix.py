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
    """Sends the entries that the ranks have summed to those that own their rows.

    keys: sorted entries row n + col of this rank's blocks, whatever rank owns them.
    """

    def __init__(self, numbering: Numbering, keys: IntArray, symmetric: bool) -> None:
        comm: Any = numbering.comm
        self._comm = comm
        n, owned, first = numbering.free, numbering.owned, numbering.first
        self._sent = np.diff(np.searchsorted(keys, numbering.bounds * n))
        received = self._comm.alltoall(np.split(keys, np.cumsum(self._sent)[:-1]))
        on_diagonal = np.arange(first, first + owned) * (n + 1)
        mine = np.union1d(np.concatenate(received), on_diagonal)
        self._received = np.array([len(part) for part in received])
        self._places = np.searchsorted(mine, np.concatenate(received))
        self._diagonal = np.searchsorted(mine, on_diagonal)
        self._values, self._arrived = np.zeros(len(mine)), np.zeros(len(self._places))
        indptr, indices = csr_pattern(mine, first, owned, n)
        self._pattern = indptr.astype(PETSc.IntType), indices.astype(PETSc.IntType)
        size = (owned, PETSc.DETERMINE)
        self._mat = PETSc.Mat().createAIJ((size, size), csr=self._pattern, comm=self._comm)
        declare(self._mat, symmetric)
        self._is_written = True

    @property
    def mat(self) -> PETSc.Mat:
        """The matrix as PETSc has it, always the same one, with the present values; collective."""
        self.write()
        return self._mat

    def write(self) -> None:
        """Give PETSc the present values, if it lacks them; collective."""
        if not self._is_written:
            self._mat.setValuesCSR(*self._pattern, self._values)
            self._mat.assemble()
            self._is_written = True

    def put(self, data: Array) -> None:
        """Take this rank's sums (len(keys),) and the others'; collective."""
        self._comm.Alltoallv([data, self._sent, MPI.DOUBLE], [self._arrived, self._received, MPI.DOUBLE])
        self._values[:] = 0.0
        add_at(self._values, self._places, self._arrived)
        self._changed()

    def _changed(self) -> None:
        """PETSc gets the values when they are asked for; that they are others it knows at once."""
        self._is_written = False
        self._mat.stateIncrease()

    def csr(self) -> tuple[IntArray, IntArray, Array]:
        """Starts of this rank's rows, columns, values."""
        return *self._pattern, self._values

    def diagonal(self) -> Array:
        """A copy of it in this rank's rows."""
        return self._values[self._diagonal]

    def set_diagonal(self, values: Array) -> None:
        """Replace its entries in this rank's rows; on all ranks."""
        self._values[self._diagonal] = values
        self._changed()

    def times(self, x: Array) -> Array:
        """Product with the unknowns; collective."""
        operand, product = self.mat.createVecs()
        operand.array_w[:] = x
        self.mat.mult(operand, product)
        values = np.array(product.array_r)
        for vector in (operand, product):
            vector.destroy()
        return values

    def destroy(self) -> None:
        self._mat.destroy()
