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


@njit
def union(a: IntArray, b: IntArray) -> IntArray:
    """Numbers in one of two arrays or both, each array sorted and without doubles, as is what comes of them."""
    out = np.empty(a.size + b.size, np.int64)
    i = j = count = 0
    while i < a.size or j < b.size:
        first, second = i < a.size, j < b.size
        if first and second:
            first, second = a[i] <= b[j], b[j] <= a[i]
        out[count] = a[i] if first else b[j]
        i, j, count = i + first, j + second, count + 1
    return out[:count].copy()


@njit
def number_entries(
    rows: IntArray, cols: IntArray, minus: tuple[BoolArray, BoolArray], n: int, numbers: IntArray
) -> IntArray:
    """Sorted distinct entries row n + col that blocks have in a system of n unknowns. Written are the blocks' numbers
    (m, nr, nc) among these, -1 less it where an entry is minus what is there; absent ones get how many there are.

    rows (m, nr), cols (m, nc): of the system, -1 for none; minus: which of them are minus what the system has.
    """
    begin, places = _blocks_by_row(rows, n)
    begun, found, column = np.zeros(n + 1, np.int64), np.full(n, -1), np.empty(n, np.int64)
    for r in range(n):
        begun[r + 1] = begun[r] + _columns_of_row(r, begin, places, cols, found, column, rows.shape[1])
    numbers[...] = begun[n]
    keys = np.empty(begun[n], np.int64)
    found[:] = -1
    for r in range(n):
        count = _columns_of_row(r, begin, places, cols, found, column, rows.shape[1])
        own = column[:count].copy()
        _sort(own)
        for k in range(count):
            keys[begun[r] + k], column[own[k]] = r * n + own[k], begun[r] + k
        for k in range(begin[r], begin[r + 1]):
            b, i = places[k] // rows.shape[1], places[k] % rows.shape[1]
            for j in range(cols.shape[1]):
                if cols[b, j] >= 0:
                    at = column[cols[b, j]]
                    numbers[b, i, j] = -1 - at if minus[0][b, i] != minus[1][b, j] else at
    return keys


@njit
def _sort(few: IntArray) -> None:
    """Sort by insertion, in place: numba takes seconds to compile its own sorting."""
    for i in range(1, few.size):
        k, value = i, few[i]
        while k > 0 and few[k - 1] > value:
            few[k] = few[k - 1]
            k -= 1
        few[k] = value


@njit
def _blocks_by_row(rows: IntArray, n: int) -> tuple[IntArray, IntArray]:
    """Where blocks have rows (m, nr) of n: places b nr + i, those of row r from begin[r] to begin[r + 1]."""
    m, nr = rows.shape
    begin = np.zeros(n + 1, np.int64)
    for b in range(m):
        for i in range(nr):
            if rows[b, i] >= 0:
                begin[rows[b, i] + 1] += 1
    begin = np.cumsum(begin)
    places, at = np.empty(begin[n], np.int64), begin[:-1].copy()
    for b in range(m):
        for i in range(nr):
            r = rows[b, i]
            if r >= 0:
                places[at[r]] = b * nr + i
                at[r] += 1
    return begin, places


@njit
def _columns_of_row(
    r: int, begin: IntArray, places: IntArray, cols: IntArray, found: IntArray, out: IntArray, nr: int
) -> int:
    """Write the distinct columns of a row; how many there are. found (n,): the last row in which each was found."""
    count = 0
    for k in range(begin[r], begin[r + 1]):
        for c in cols[places[k] // nr]:
            if c >= 0 and found[c] != r:
                found[c], out[count] = r, c
                count += 1
    return count


@njit
def write_places(keys: IntArray, own: IntArray, numbers: IntArray, out: IntArray) -> None:
    """Write the places (n,) that entries have among all keys, which hold all their own: numbers among these, -1 less it
    where an entry is minus what is there. Both sorted. Where there are as many as these, the entry is absent; it gets
    the place behind the last.
    """
    at, i = np.empty(own.size + 1, out.dtype), 0
    for k in range(own.size):
        while keys[i] != own[k]:
            i += 1
        at[k] = i
    at[own.size] = keys.size
    for k in range(numbers.size):
        out[k] = at[numbers[k]] if numbers[k] >= 0 else -1 - at[-1 - numbers[k]]


@njit
def add_at(data: Array, places: IntArray, values: Array) -> None:
    """Add values to those at places, which may be the same; at -1 - place they are taken off."""
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
