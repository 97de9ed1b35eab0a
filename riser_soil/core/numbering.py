"""Global numbering of the free dofs of all fields, and exchange between the system's unknowns and local arrays.

Every rank holds local arrays over its fields' entries: owned ones, copies of other ranks' (ghosts), and second views of
the same dof (the soil's surface), in a mirror also of minus that dof. Prescribed entries have no number: the system
holds no row that it doesn't solve for. The system's unknowns, and all that has its rows, are arrays over the rows that
this rank owns.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.communicator import Communicator, largest_of
from riser_soil.core.part import Field


class Numbering:
    """Numbers of local entries in the monolithic system.

    size: entries of a local array. free: rows of the system, all ranks. owned: rows that this rank owns.
    index (size,): row of each local entry, -1 where prescribed. sign (size,): -1. of entries that are minus what their
    row has, else 1. bounds (ranks + 1,): the ranks' first rows, and `free`.
    """

    def __init__(self, comm: Communicator, fields: Sequence[Field]) -> None:
        self.comm = comm
        self.size = _set_offsets(fields)
        index, self.owned = _number(comm, fields, self.size)
        self.index: IntArray = index
        self.sign: Array = np.concatenate([_sign(field) for field in fields])
        self.bounds: IntArray = np.cumsum([0, *comm.allgather(self.owned)])
        self.free = int(self.bounds[-1])
        self.first = first = int(self.bounds[comm.rank])
        self._free_local = np.flatnonzero(index >= 0)
        self._rows, self._signs = index[self._free_local], self.sign[self._free_local]
        self._owned_local = np.flatnonzero((index >= first) & (index < first + self.owned) & (self.sign > 0.0))
        self._owned_rows = index[self._owned_local] - first
        self._scatter = None
        if comm.size > 1:
            from riser_soil.core.petsc_matrix import Scatter

            self._scatter = Scatter(comm, self.owned, self._rows)

    def zeros(self) -> Array:
        """Zero in this rank's rows (owned,)."""
        return np.zeros(self.owned)

    def to_global(self, values: Array) -> Array:
        """The free entries of a local array, the same wherever ranks share a dof, as the system's unknowns (owned,)."""
        out = self.zeros()
        out[self._owned_rows] = values[self._owned_local]
        return out

    def to_local(self, x: Array, out: Array) -> None:
        """Copy the system's unknowns (owned,) into the free entries of a local array; collective."""
        out[self._free_local] = self._signs * (x[self._rows] if self._scatter is None else self._scatter.from_all(x))

    def add_to_global(self, values: Array) -> Array:
        """Sums (owned,) of local contributions in their rows; entries of prescribed dofs stay behind; collective."""
        return self._summed(self._signs * values[self._free_local])

    def sizes_to_global(self, sizes: Array) -> Array:
        """Sums (owned,) of local sizes, which have no sign, in their rows; entries of prescribed dofs stay behind;
        collective.
        """
        return self._summed(sizes[self._free_local])

    def _summed(self, mine: Array) -> Array:
        if self._scatter is not None:
            return self._scatter.summed(mine)
        return np.asarray(np.bincount(self._rows, mine, minlength=self.owned), dtype=float)

    def destroy(self) -> None:
        if self._scatter is not None:
            self._scatter.destroy()


def _sign(field: Field) -> Array:
    sign: Array = getattr(field, "sign", np.ones(field.size))
    return sign


def _set_offsets(fields: Sequence[Field]) -> int:
    size = 0
    for field in fields:
        field.offset = size
        size += field.size
    return size


def _number(comm: Communicator, fields: Sequence[Field], size: int) -> tuple[IntArray, int]:
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


def _rows_of_space(comm: Communicator, members: Sequence[tuple[Field, int]]) -> IntArray:
    """Row of every dof of a space, known to all ranks: the owners' numbers, spread by one reduction."""
    largest = max((int(f.global_index.max()) for f, _ in members if f.size), default=-1)
    table = np.full(max(comm.allgather(largest)) + 1, -1, dtype=np.int64)
    for field, start in members:
        mine = field.global_index[field.owned & ~field.prescribed]
        table[mine] = start + np.arange(len(mine))
    return largest_of(comm, table)
