"""Factors of the matrices of soil in sections: each is eliminated by itself, down to its few rows that touch the riser.

A section's matrix is a band, of its interior, with a border of those few unknowns that touch. The elimination is that
of `core.bordered`. What it subtracts from the border's matrix is the section's share in the system of all borders and
the riser (`section_solver`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from riser_soil.core import banded, bordered
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import njit

Csr = tuple[IntArray, IntArray, Array]
Entries = Csr  # rows, columns, values
Place = tuple[IntArray, IntArray, Array, int, int, int]  # of a section: CSR, rows before the rank's, first and last row


class Bands(NamedTuple):
    """Matrices of ns sections: at most n rows each, b entries beside the diagonal and m rows in the border.

    first (ns,): each section's first row among its rank's. number (rows,): number of each of the rank's rows within its
    section's interior, or -1 less its number within the border. counts (ns, 4): rows in all, in the interior, in the
    border, and of the interior coupled with the border. renewed (ns,): whether the last tangent changed the section.
    width (b,): of the band, as `banded` takes it. ab (ns, n + b, 3 b + 1), pivots (ns, n): factors of the interior, see
    `banded`. right, below (ns, n, m): what couples it with the border, see `bordered`, in its coupled rows (ns, n).
    schur (ns, m, m): -V B^-1 U, the section's Schur complement less D.
    """

    first: IntArray
    number: IntArray
    counts: IntArray
    renewed: BoolArray
    width: Array
    ab: Array
    pivots: IntArray
    right: Array
    below: Array
    rows: IntArray
    schur: Array


class SectionFactors:
    """Factors of the matrices of a rank's sections, which are kept from tangent to tangent.

    at: rows of each section among the rank's `rows`; before: rows of the ranks before it.
    """

    def __init__(self, at: Sequence[slice], rows: int, before: int) -> None:
        ns, none, whole = len(at), np.empty((len(at), 0, 0)), np.empty((len(at), 0), dtype=np.int64)
        counts = np.zeros((ns, 4), dtype=np.int64)
        counts[:, 0] = [each.stop - each.start for each in at]
        first, number = np.array([each.start for each in at], dtype=np.int64), np.zeros(rows, dtype=np.int64)
        renewed = np.zeros(ns, dtype=bool)
        self.bands = Bands(first, number, counts, renewed, np.empty(0), none, whole, none, none, whole, none)
        self._rows, self._before = int(counts[:, 0].max(initial=0)), before
        self._factorised, self._coupled = np.empty(0), np.zeros(rows, dtype=bool)  # values and coupled rows before

    def factorise(self, csr: Csr, coupled: BoolArray) -> bool:
        """Factorise the sections whose entries in the rank's rows have changed; whether all interiors have
        an inverse.

        coupled (rows,): whether a row is coupled with others than its section's.
        """
        before = self._factorised if self._factorised.size else np.full_like(csr[2], np.nan)
        width, border = renumber(*csr, self._before, before, self._coupled, coupled, self.bands)
        if not self.bands.ab.size or width > self.bands.width.size or border > self.bands.right.shape[2]:
            self._make_room(max(width, self.bands.width.size), max(border, self.bands.right.shape[2]))
        self._factorised, self._coupled = np.empty(0), coupled.copy()
        if not factorise_sections(*csr, self._before, self.bands):
            return False
        self._factorised = csr[2].copy()
        return True

    def _make_room(self, b: int, m: int) -> None:
        """Allocate for so many entries beside the diagonal and rows in a border."""
        ns, n = len(self.bands.counts), self._rows
        ab, right, below, schur = (np.zeros((ns, *size)) for size in ((n + b, 3 * b + 1), (n, m), (n, m), (m, m)))
        pivots, rows = (np.zeros((ns, n), dtype=np.int64) for _ in range(2))
        self.bands = Bands(*self.bands[:4], np.zeros(b), ab, pivots, right, below, rows, schur)
        self.bands.renewed[:] = True

    def schur_entries(self, number: IntArray) -> list[Entries]:
        """Entries of each section's Schur complement less D. number (rows,): of rows in the system of all borders."""
        entries, (first, inside, counts) = [], self.bands[:3]
        for s in np.flatnonzero(counts[:, 2]):
            rows = slice(first[s], first[s] + counts[s, 0])
            border, m = number[rows][inside[rows] < 0], counts[s, 2]
            entries.append((np.repeat(border, m), np.tile(border, m), self.bands.schur[s, :m, :m].ravel()))
        return entries

    def forward_eliminate(self, x: Array) -> None:
        """Condense a load x (rows,) of each section onto its border, in place."""
        forward_eliminate(self.bands, x)

    def back_substitute(self, x: Array) -> None:
        """Solve for the interiors, in place, when the borders' part of x (rows,) is solved for."""
        back_substitute(self.bands, x)


@njit
def coupled_apart(indptr: IntArray, indices: IntArray, values: Array, first: int, section: IntArray) -> IntArray:
    """1 for rows of the system (n,) that a non-zero entry of this rank couples to rows outside their section, else 0.

    first: first of this rank's rows; section (n,): section of each row, -1 for none.
    """
    coupled = np.zeros(section.size, np.int64)
    for i in range(indptr.size - 1):
        own = section[first + i]
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
            if section[j] != own and values[k] != 0.0:
                coupled[first + i] = coupled[j] = 1
    return coupled


@njit
def renumber(
    indptr: IntArray,
    indices: IntArray,
    values: Array,
    before: int,
    old_values: Array,
    old_coupled: BoolArray,
    coupled: BoolArray,
    bands: Bands,
) -> tuple[int, int]:
    """Find the sections that have changed and number their rows; their largest half bandwidth and rows in a border.

    old_values, old_coupled: values and coupled rows of the tangent before.
    """
    width, border = 0, 0
    for s in range(bands.first.size):
        first, last = bands.first[s], bands.first[s] + bands.counts[s, 0]
        place = indptr, indices, values, before, first, last
        bands.renewed[s] = not _same(place, old_values, old_coupled, coupled)
        if bands.renewed[s]:
            inner = outer = 0
            for i in range(first, last):
                bands.number[i] = -1 - outer if coupled[i] else inner
                inner, outer = inner + (not coupled[i]), outer + coupled[i]
            bands.counts[s, 1], bands.counts[s, 2] = inner, outer
            width, border = max(width, _bandwidth(place, bands.number)), max(border, outer)
    return width, border


@njit
def _same(place: Place, old_values: Array, old_coupled: BoolArray, coupled: BoolArray) -> bool:
    """Whether a section's entries are as they were, but for those between rows of its border."""
    indptr, indices, values, before, first, last = place
    for i in range(first, last):
        if old_coupled[i] != coupled[i]:
            return False
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k] - before
            if values[k] != old_values[k] and first <= j < last and not (coupled[i] and coupled[j]):
                return False
    return True


@njit
def _bandwidth(place: Place, number: IntArray) -> int:
    """Half bandwidth of the interior's non-zero entries: contact has places for more entries."""
    (indptr, indices, values, before, first, last), b = place, 0
    for i in range(first, last):
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k] - before
            if values[k] != 0.0 and first <= j < last and number[i] >= 0 and number[j] >= 0:
                b = max(b, abs(number[i] - number[j]))
    return b


@njit
def factorise_sections(indptr: IntArray, indices: IntArray, values: Array, before: int, bands: Bands) -> bool:
    """Factorise the sections whose matrices have changed; whether all interiors have an inverse."""
    for s in np.flatnonzero(bands.renewed):
        first, n = bands.first[s], bands.counts[s, 1]
        place = indptr, indices, values, before, first, first + bands.counts[s, 0]
        ab, right, below, schur = bands.ab[s], bands.right[s], bands.below[s], bands.schur[s]
        ab[...], right[...], below[...], schur[...] = 0.0, 0.0, 0.0, 0.0
        _write_blocks(place, bands.number, len(bands.width), ab, right, below)
        bands.counts[s, 3] = _find_coupled(right, below, n, bands.rows[s])
        if not banded.factorise(ab, bands.pivots[s, :n], bands.width):
            return False
        rows = bands.rows[s, : bands.counts[s, 3]]
        bordered.condense(ab, bands.pivots[s, :n], bands.width, rows, right, below, schur)
    return True


@njit
def _write_blocks(place: Place, number: IntArray, b: int, ab: Array, right: Array, below: Array) -> None:
    """Write a section's non-zero entries to its blocks: B to the band, U to the right, V below, turned over."""
    indptr, indices, values, before, first, last = place
    for i in range(first, last):
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k] - before
            if values[k] == 0.0 or not first <= j < last:
                continue
            row, column = number[i], number[j]
            if row >= 0 and column >= 0:
                ab[row, b + column - row] = values[k]
            elif row >= 0:
                right[row, -1 - column] = values[k]
            elif column >= 0:
                below[column, -1 - row] = values[k]


@njit
def _find_coupled(right: Array, below: Array, n: int, rows: IntArray) -> int:
    """Write the rows of the interior that are coupled with the border; how many they are."""
    count = 0
    for k in range(n):
        if right[k].any() or below[k].any():
            rows[count] = k
            count += 1
    return count


@njit
def forward_eliminate(bands: Bands, x: Array) -> None:
    """Condense the load x (rows,) of each section onto its border."""
    inner, border = np.empty(bands.right.shape[1]), np.empty(bands.right.shape[2])
    for s in range(bands.first.size):
        n, rows = bands.counts[s, 1], bands.rows[s, : bands.counts[s, 3]]
        if rows.size > 0 and _gather(bands, s, x, inner, border):
            factors = bands.ab[s], bands.pivots[s, :n], bands.width
            bordered.forward_eliminate(*factors, rows, bands.below[s], inner[:n], border)
            _scatter(bands, s, inner, border, x)


@njit
def back_substitute(bands: Bands, x: Array) -> None:
    """Solve for the interiors by their loads in x (rows,), when the borders' unknowns are there."""
    inner, border = np.empty(bands.right.shape[1]), np.empty(bands.right.shape[2])
    for s in range(bands.first.size):
        n, rows = bands.counts[s, 1], bands.rows[s, : bands.counts[s, 3]]
        if _gather(bands, s, x, inner, border):
            bordered.back_substitute(rows, bands.right[s], border, inner[:n])
            banded.solve(bands.ab[s], bands.pivots[s, :n], inner[:n], bands.width)
            _scatter(bands, s, inner, border, x)


@njit
def _gather(bands: Bands, s: int, x: Array, inner: Array, border: Array) -> bool:
    """Read a section's numbers from those of the rank's rows; whether any is not zero."""
    border[:] = 0.0
    some = False
    for i in range(bands.first[s], bands.first[s] + bands.counts[s, 0]):
        row = bands.number[i]
        some |= x[i] != 0.0
        if row >= 0:
            inner[row] = x[i]
        else:
            border[-1 - row] = x[i]
    return some


@njit
def _scatter(bands: Bands, s: int, inner: Array, border: Array, x: Array) -> None:
    """Write a section's numbers back to those of the rank's rows."""
    for i in range(bands.first[s], bands.first[s] + bands.counts[s, 0]):
        row = bands.number[i]
        x[i] = inner[row] if row >= 0 else border[-1 - row]


@njit
def entries_between(indptr: IntArray, indices: IntArray, values: Array, first: int, number: IntArray) -> Entries:
    """Non-zero entries of this rank's rows in the rows and columns of a smaller system.

    number (n,): of the system's rows in the smaller one, -1 of the others.
    """
    own = number[first : first + indptr.size - 1]
    count = np.sum(np.diff(indptr)[own >= 0])
    rows, columns, entries = np.empty(count, np.int64), np.empty(count, np.int64), np.empty(count)
    n = 0
    for i in np.flatnonzero(own >= 0):
        for k in range(indptr[i], indptr[i + 1]):
            if number[indices[k]] >= 0 and values[k] != 0.0:
                rows[n], columns[n], entries[n] = own[i], number[indices[k]], values[k]
                n += 1
    return rows[:n], columns[:n], entries[:n]
