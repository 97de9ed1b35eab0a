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
        """The same arrays as a matrix of PETSc."""
        from riser_soil.core.petsc_matrix import on_arrays

        return on_arrays(*self.csr(), symmetric=self._symmetric)

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
    """The same for blocks that are filled (m,), of as many values each, one block after the other."""
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
