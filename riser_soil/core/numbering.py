"""Global numbering of the free dofs of all fields, and exchange between global vectors and local arrays.

Every rank holds local arrays over its fields' entries: owned ones, copies of other ranks' (ghosts), and second views of
the same dof (the soil's surface). Prescribed entries have no number: the system holds no row that it doesn't solve for.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Field


class Numbering:
    """Numbers of local entries in the monolithic system.

    size: entries of a local array. free: rows of the system, all ranks. owned: rows that this rank owns.
    index (size,): row of each local entry, -1 where prescribed.
    """

    def __init__(self, comm: MPI.Intracomm, fields: Sequence[Field]) -> None:
        self.comm = comm
        self.size = _set_offsets(fields)
        index, self.owned = _number(comm, fields, self.size)
        self.index: IntArray = index
        self.free: int = comm.allreduce(self.owned)
        self._free_local = np.flatnonzero(index >= 0)
        self.vector = PETSc.Vec().createMPI((self.owned, PETSc.DETERMINE), comm=comm)
        self._local = PETSc.Vec().createSeq(len(self._free_local))
        rows = PETSc.IS().createGeneral(index[self._free_local].astype(PETSc.IntType), comm=PETSc.COMM_SELF)
        self._scatter = PETSc.Scatter().create(self.vector, rows, self._local, None)
        rows.destroy()
        first, last = self.vector.getOwnershipRange()
        self._owned_local = np.flatnonzero((index >= first) & (index < last))
        self._owned_rows = index[self._owned_local] - first

    def to_global(self, values: Array, out: PETSc.Vec) -> None:
        """Copy the free entries of a local array, the same wherever ranks share a dof, to the system's unknowns."""
        out.array_w[self._owned_rows] = values[self._owned_local]

    def to_local(self, x: PETSc.Vec, out: Array) -> None:
        """Copy the system's unknowns into the free entries of a local array."""
        self._scatter.scatter(x, self._local, PETSc.InsertMode.INSERT, PETSc.ScatterMode.FORWARD)
        out[self._free_local] = self._local.array_r

    def add_to_global(self, values: Array, out: PETSc.Vec) -> None:
        """Sum local contributions into their rows; entries of prescribed dofs stay behind."""
        out.set(0.0)
        self._local.array_w[:] = values[self._free_local]
        self._scatter.scatter(self._local, out, PETSc.InsertMode.ADD, PETSc.ScatterMode.REVERSE)

    def destroy(self) -> None:
        for thing in (self._scatter, self._local, self.vector):
            thing.destroy()


def _set_offsets(fields: Sequence[Field]) -> int:
    size = 0
    for field in fields:
        field.offset = size
        size += field.size
    return size


def _number(comm: MPI.Intracomm, fields: Sequence[Field], size: int) -> tuple[IntArray, int]:
    """Rows of all local entries; owned free entries are numbered field by field, rank by rank."""
    counts = [int(np.count_nonzero(f.owned & ~f.prescribed)) for f in fields]
    first = comm.exscan(sum(counts)) or 0
    starts = first + np.concatenate(([0], np.cumsum(counts)))
    index = np.full(size, -1, dtype=np.int64)
    for space in dict.fromkeys(f.space for f in fields):
        members = [(f, start) for f, start in zip(fields, starts, strict=False) if f.space == space]
        table = _rows_of_space(comm, members)
        for field, _ in members:
            index[field.offset : field.offset + field.size] = table[field.global_index]
    return index, sum(counts)


def _rows_of_space(comm: MPI.Intracomm, members: Sequence[tuple[Field, int]]) -> IntArray:
    """Row of every dof of a space, known to all ranks: the owners' numbers, spread by one reduction."""
    largest = max((int(f.global_index.max()) for f, _ in members if f.size), default=-1)
    table = np.full(comm.allreduce(largest, MPI.MAX) + 1, -1, dtype=np.int64)
    for field, start in members:
        mine = field.global_index[field.owned & ~field.prescribed]
        table[mine] = start + np.arange(len(mine))
    comm.Allreduce(MPI.IN_PLACE, table, MPI.MAX)
    return table
