"""The system matrix of one rank: compressed sparse rows (CSR) in arrays, which PETSc works on where it is asked for."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import njit


class CsrMatrix:
    """Square matrix of n rows. keys: sorted entries row n + col, all of the diagonal among them; data: their values."""

    def __init__(self, keys: IntArray, n: int, data: Array, symmetric: bool) -> None:
        self._indptr, self._indices = csr_pattern(keys, 0, n, n)
        self._diagonal = np.searchsorted(keys, np.arange(n) * (n + 1))
        self._data, self._symmetric = data, symmetric

    @cached_property
    def mat(self) -> Any:
        """The matrix as one of PETSc on the same arrays."""
        from riser_soil.core.petsc_matrix import on_arrays

        return on_arrays(*self.csr(), symmetric=self._symmetric)

    def write(self) -> None:
        """PETSc works on the same arrays."""

    def put(self, data: Array) -> None:
        """The sums are here already."""
        self._changed()

    def _changed(self) -> None:
        if "mat" in self.__dict__:
            self.mat.assemble()

    def csr(self) -> tuple[IntArray, IntArray, Array]:
        """Starts of rows, columns, values."""
        return self._indptr, self._indices, self._data

    def diagonal(self) -> Array:
        """A copy of it (n,)."""
        return self._data[self._diagonal]

    def set_diagonal(self, values: Array) -> None:
        """Replace its entries (n,)."""
        self._data[self._diagonal] = values
        self._changed()

    def times(self, x: Array) -> Array:
        """Product with x (n,)."""
        rows = np.repeat(np.arange(len(x)), np.diff(self._indptr))
        return np.asarray(np.bincount(rows, self._data * x[self._indices], minlength=len(x)), dtype=float)

    def destroy(self) -> None:
        if "mat" in self.__dict__:
            self.__dict__.pop("mat").destroy()


def csr_pattern(keys: IntArray, first: int, count: int, n: int) -> tuple[IntArray, IntArray]:
    """Starts of `count` rows from `first` on and columns, of n, of sorted entries row n + col."""
    rows = keys // n - first if n else keys
    indptr = np.concatenate(([0], np.cumsum(np.bincount(rows, minlength=count))))
    return indptr.astype(np.int32), (keys % n if n else keys).astype(np.int32)


def union(a: IntArray, b: IntArray) -> IntArray:
    """Numbers in one of two arrays or both, each array sorted and without doubles, as is what comes of them."""
    both = np.sort(np.concatenate([a, b]), kind="stable")  # which merges what is sorted
    new = np.ones(both.size, dtype=bool)
    new[1:] = both[1:] != both[:-1]
    return np.asarray(both[new])


def number_entries(
    rows: IntArray, cols: IntArray, minus: tuple[BoolArray, BoolArray], n: int, numbers: IntArray
) -> IntArray:
    """Sorted distinct entries row n + col that blocks have in a system of n unknowns. Written are the blocks' numbers
    (m, nr, nc) among these, -1 less it where an entry is minus what is there; absent ones get how many there are.

    rows (m, nr), cols (m, nc): of the system, -1 for none; minus: which of them are minus what the system has.
    """
    places = np.argsort(rows, axis=None, kind="stable")
    begin = np.searchsorted(rows.ravel()[places], np.arange(n + 1))
    keys, unknown = np.empty(numbers.size, dtype=np.int64), np.full((2, n), -1)
    numbers[...] = -1
    count = _write_entries(begin, places, cols, numbers, keys, *unknown)
    numbers[numbers < 0] = count
    opposite = (minus[0][:, :, None] != minus[1][:, None, :]) & (numbers < count)
    np.subtract(-1, numbers, out=numbers, where=opposite)
    return keys[:count].copy()


@njit
def _write_entries(
    begin: IntArray, places: IntArray, cols: IntArray, numbers: IntArray, keys: IntArray, last: IntArray, at: IntArray
) -> int:
    """Write sorted distinct entries, and the blocks' numbers among these; how many there are.

    places: b nr + i of row i of block b, those in row r of the system from begin[r] to begin[r + 1]. last (n,): the
    last row that has each column, at (n,): the number of its entry there.
    """
    n, nr, count = last.size, numbers.shape[1], 0
    for r in range(n):
        first = count
        for k in range(begin[r], begin[r + 1]):
            for j in range(cols.shape[1]):
                c = cols[places[k] // nr, j]
                if c >= 0 and last[c] != r:
                    last[c], keys[count] = r, c
                    count += 1
        for i in range(first + 1, count):  # sorting by insertion
            k, c = i, keys[i]
            while k > first and keys[k - 1] > c:
                keys[k] = keys[k - 1]
                k -= 1
            keys[k] = c
        for k in range(first, count):
            at[keys[k]] = k
            keys[k] += r * n
        for k in range(begin[r], begin[r + 1]):
            for j in range(cols.shape[1]):
                c = cols[places[k] // nr, j]
                if c >= 0:
                    numbers[places[k] // nr, places[k] % nr, j] = at[c]
    return count


def write_places(keys: IntArray, own: IntArray, numbers: IntArray, out: IntArray) -> None:
    """Write the places (n,) that entries have among all keys, which hold all their own: numbers among these, -1 less it
    where an entry is minus what is there. Both sorted. Where there are as many as these, the entry is absent; it gets
    the place behind the last.
    """
    at = np.append(np.searchsorted(keys, own), keys.size)
    out[:] = np.where(numbers >= 0, at[numbers], -1 - at[-1 - numbers])


@njit
def add_at(data: Array, places: IntArray, values: Array) -> None:
    """Add values to those at places, which may be the same; at -1 - place they are subtracted."""
    for k in range(places.size):
        if places[k] >= 0:
            data[places[k]] += values[k]
        else:
            data[-1 - places[k]] -= values[k]


@njit
def add_filled_at(data: Array, places: IntArray, values: Array, filled: BoolArray) -> None:
    """Add values of blocks, as many each, one block after the other, to those at places, where `filled` (m,) says so;
    at -1 - place they are subtracted.
    """
    size = values.size // max(filled.size, 1)
    for block in np.flatnonzero(filled):
        first, last = block * size, (block + 1) * size
        add_at(data, places[first:last], values[first:last])


@njit
def add_magnitudes(values: Array, rows: IntArray, cols: IntArray, sizes: Array, out: Array) -> None:
    """Add to each row the absolute values of its entries in blocks (m, nr, nc), times the sizes of their columns.

    rows (m, nr), cols (m, nc): see `MatrixBlock`.
    """
    for e in range(values.shape[0]):
        for i in range(values.shape[1]):
            for j in range(values.shape[2]):
                if rows[e, i] >= 0 and cols[e, j] >= 0:
                    out[rows[e, i]] += abs(values[e, i, j]) * sizes[cols[e, j]]
