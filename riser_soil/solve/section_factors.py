"""Factors of the matrices of soil in sections: each is eliminated by itself, down to its few rows that touch the riser.

A section's matrix is a band, of its interior, with a border of those few unknowns that touch.

    [B  U] [x]   [f]
    [V  D] [y] = [g]

Elimination in B = L R puts L⁻¹ U in the place of U and V R⁻¹ in that of V. Their product is subtracted from D: that is
the Schur complement, the section's share in the system of all borders and the riser (`section_solver`).

Rows are not exchanged: soil that bears its weight has positive pivots in any order. Where a pivot loses all its digits,
factorisation fails and a solver that exchanges rows is used instead. Columns of U and V are zero before the first
coupled row, and skipped there. Source: Golub & Van Loan, Matrix Computations (2013), 4.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.rows import add_multiple

Csr = tuple[IntArray, IntArray, Array]
Entries = Csr  # rows, columns, values
Place = tuple[IntArray, IntArray, Array, int, int, int]  # of a section: CSR, rows before the rank's, first and last row

LOST = 1e-12  # of an entry on the diagonal: a pivot below that
AT_ONCE = fixed(8)  # numbers of a row; rows are filled up with zeros to a multiple of it


class Bands(NamedTuple):
    """Matrices of ns sections: at most n rows each, b entries beside the diagonal and m rows in the border.

    first (ns,): each section's first row among its rank's. number (rows,): number of each of the rank's rows within its
    section's interior, or -1 less its number within the border. counts (ns, 4): rows in all, in the interior, in the
    border, and in the interior before the first row coupled with the border. renewed (ns,): whether the last tangent
    changed the section. band (ns, n + b, w), right, below (ns, n + b, m): factors, see `_eliminate`. schur (ns, m, m):
    the product V B⁻¹ U, which is subtracted from the border's matrix.
    """

    first: IntArray
    number: IntArray
    counts: IntArray
    renewed: BoolArray
    band: Array
    right: Array
    below: Array
    schur: Array


class SectionFactors:
    """Factors of the matrices of a rank's sections, which are kept from tangent to tangent.

    at: rows of each section among the rank's `rows`; before: rows of the ranks before it.
    """

    def __init__(self, at: Sequence[slice], rows: int, before: int) -> None:
        ns, none = len(at), np.empty((len(at), 0, 0))
        counts = np.zeros((ns, 4), dtype=np.int64)
        counts[:, 0] = [each.stop - each.start for each in at]
        first, number = np.array([each.start for each in at], dtype=np.int64), np.zeros(rows, dtype=np.int64)
        self.bands = Bands(first, number, counts, np.zeros(ns, dtype=bool), none, none, none, none)
        self._rows, self._before, self._width = int(counts[:, 0].max(initial=0)), before, 0
        self._factorised, self._coupled = np.empty(0), np.zeros(rows, dtype=bool)  # values and coupled rows before

    def factorise(self, csr: Csr, coupled: BoolArray) -> bool:
        """Factorise the sections whose entries in the rank's rows have changed; whether all pivots are sound.

        coupled (rows,): whether a row is coupled with others than its section's.
        """
        before = self._factorised if self._factorised.size else np.full_like(csr[2], np.nan)
        width, border = renumber(*csr, self._before, before, self._coupled, coupled, self.bands)
        if width > self._width or border > self.bands.right.shape[2]:
            self._make_room(width, border)
        self._factorised, self._coupled = np.empty(0), coupled.copy()
        if not factorise_sections(*csr, self._before, self._width, self.bands):
            return False
        self._factorised = csr[2].copy()
        return True

    def _make_room(self, width: int, border: int) -> None:
        """Allocate for so many entries beside the diagonal and rows in a border, or as many as there was room for."""
        ns, m = len(self.bands.counts), max(_filled_up(border), self.bands.right.shape[2])
        self._width = b = max(width, self._width)
        band, right, below = (np.zeros((ns, self._rows + b, size)) for size in (1 + b + _filled_up(b), m, m))
        self.bands = self.bands._replace(band=band, right=right, below=below, schur=np.zeros((ns, m, m)))
        self.bands.renewed[:] = True

    def schur_entries(self, number: IntArray) -> list[Entries]:
        """Entries of -V B⁻¹ U of each section: its Schur complement less D. number (rows,): of rows in that system."""
        found, (first, inside, counts) = [], self.bands[:3]
        for s in np.flatnonzero(counts[:, 2]):
            rows = slice(first[s], first[s] + counts[s, 0])
            border, m = number[rows][inside[rows] < 0], counts[s, 2]
            found.append((np.repeat(border, m), np.tile(border, m), -self.bands.schur[s, :m, :m].ravel()))
        return found

    def forward_eliminate(self, x: Array) -> None:
        """Condense a load x (rows,) of each section onto its border, in place."""
        forward_eliminate(self.bands, self._width, x)

    def back_substitute(self, x: Array) -> None:
        """Solve for the interiors, in place, when the borders' part of x (rows,) is solved for."""
        back_substitute(self.bands, self._width, x)


def _filled_up(count: int) -> int:
    return -(-count // len(AT_ONCE)) * len(AT_ONCE)


@njit
def coupled_apart(indptr: IntArray, indices: IntArray, values: Array, first: int, section: IntArray) -> IntArray:
    """1 for rows of the system (n,) that a non-zero entry of this rank couples to rows outside their section, else 0.

    first: first of this rank's rows; section (n,): section of each row, -1 for none.
    """
    found = np.zeros(section.size, np.int64)
    for i in range(indptr.size - 1):
        own = section[first + i]
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
            if section[j] != own and values[k] != 0.0:
                found[first + i] = found[j] = 1
    return found


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
def factorise_sections(
    indptr: IntArray, indices: IntArray, values: Array, before: int, b: int, bands: Bands
) -> bool:
    """Factorise the sections whose matrices have changed; whether all pivots are sound."""
    for s in np.flatnonzero(bands.renewed):
        first, n = bands.first[s], bands.counts[s, 1]
        place = indptr, indices, values, before, first, first + bands.counts[s, 0]
        band, right, below = bands.band[s], bands.right[s], bands.below[s]
        band[...], right[...], below[...] = 0.0, 0.0, 0.0
        _write_blocks(place, bands.number, b, band, right, below)
        bands.counts[s, 3] = start = _first_coupled(right, below, n)
        if not _eliminate(band, right, below, n, b, start):
            return False
        if start < n:
            bands.schur[s] = np.dot(below[start:n].T, right[start:n])
        else:
            bands.schur[s] = 0.0
    return True


@njit
def _write_blocks(place: Place, number: IntArray, b: int, band: Array, right: Array, below: Array) -> None:
    """Write a section's non-zero entries to its blocks: B to the band, U to the right, V below, turned over."""
    indptr, indices, values, before, first, last = place
    for i in range(first, last):
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k] - before
            if values[k] == 0.0 or not first <= j < last:
                continue
            row, column = number[i], number[j]
            if row >= 0 and column >= 0:
                band[row, b + column - row] = values[k]
            elif row >= 0:
                right[row, -1 - column] = values[k]
            elif column >= 0:
                below[column, -1 - row] = values[k]


@njit
def _first_coupled(right: Array, below: Array, n: int) -> int:
    """Row of the interior from which on the border is coupled."""
    for k in range(n):
        if right[k].any() or below[k].any():
            return k
    return n


@njit
def _eliminate(band: Array, right: Array, below: Array, n: int, b: int, start: int) -> bool:
    """Factorise a section's interior, n rows, in place; whether all pivots are sound. band: entry (i, j) at
    [i, b + j - i], the rows filled up; the inverse of a pivot takes its place. right: entries in the border's columns,
    below: those in its rows, turned over. start: the first row that is coupled with the border.
    """
    step, width, m = len(AT_ONCE), band.shape[1], right.shape[1]
    sound = band[:n, b] * LOST
    for k in range(n):
        if not band[k, b] > sound[k]:
            return False
        inverse = 1.0 / band[k, b]
        band[k, b] = inverse
        for i in range(1, b + 1):
            factor = band[k + i, b - i] * inverse
            band[k + i, b - i] = factor
            if factor == 0.0:
                continue
            to, own = (k + i) * width + b - i + 1, k * width + b + 1
            for j in range(0, b, step):
                add_multiple(band, to + j, -factor, band, own + j, AT_ONCE)
            if k >= start:
                for j in range(0, m, step):
                    add_multiple(right, (k + i) * m + j, -factor, right, k * m + j, AT_ONCE)
        if k < start:
            continue
        for j in range(m):
            below[k, j] *= inverse
        for i in range(1, b + 1):
            factor = band[k, b + i]
            if factor != 0.0:
                for j in range(0, m, step):
                    add_multiple(below, (k + i) * m + j, -factor, below, k * m + j, AT_ONCE)
    return True


@njit
def forward_eliminate(bands: Bands, b: int, x: Array) -> None:
    """Condense the load x (rows,) of each section onto its border: f becomes L⁻¹ f, and g becomes g - V B⁻¹ f."""
    inner, border = np.empty(bands.band.shape[1]), np.empty(bands.right.shape[2])
    for s in range(bands.first.size):
        n, start, band, below = bands.counts[s, 1], bands.counts[s, 3], bands.band[s], bands.below[s]
        if not _gather(bands, s, x, inner, border):
            continue
        _forward(band, inner[:n], b)
        for k in range(start, n):
            for j in range(border.size):
                border[j] -= below[k, j] * inner[k]
        _scatter(bands, s, inner, border, x)


@njit
def back_substitute(bands: Bands, b: int, x: Array) -> None:
    """Solve for the interiors, R x = L⁻¹ f - L⁻¹ U y, when the borders' unknowns y are in x (rows,)."""
    inner, border = np.empty(bands.band.shape[1]), np.empty(bands.right.shape[2])
    for s in range(bands.first.size):
        n, start, band, right = bands.counts[s, 1], bands.counts[s, 3], bands.band[s], bands.right[s]
        if not _gather(bands, s, x, inner, border):
            continue
        for k in range(start, n):
            for j in range(border.size):
                inner[k] -= right[k, j] * border[j]
        _backward(band, inner[:n], b)
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
def _forward(band: Array, x: Array, b: int) -> None:
    """Solve with the left factor L, in place."""
    for k in range(x.size):
        first = max(b - k, 0)
        x[k] -= _product(band, k, first, x, k - b + first, b - first)


@njit
def _backward(band: Array, x: Array, b: int) -> None:
    """Solve with the right factor R, in place."""
    for k in range(x.size - 1, -1, -1):
        x[k] = (x[k] - _product(band, k, b + 1, x, k + 1, min(b, x.size - 1 - k))) * band[k, b]


@njit
def _product(band: Array, k: int, first: int, x: Array, start: int, count: int) -> float:
    """Scalar product of `count` entries of row k and of x, in four sums that a processor adds up side by side."""
    s0 = s1 = s2 = s3 = 0.0
    j = 0
    while j + 4 <= count:
        s0 += band[k, first + j] * x[start + j]
        s1 += band[k, first + j + 1] * x[start + j + 1]
        s2 += band[k, first + j + 2] * x[start + j + 2]
        s3 += band[k, first + j + 3] * x[start + j + 3]
        j += 4
    while j < count:
        s0 += band[k, first + j] * x[start + j]
        j += 1
    return (s0 + s1) + (s2 + s3)


@njit
def entries_between(indptr: IntArray, indices: IntArray, values: Array, first: int, number: IntArray) -> Entries:
    """Non-zero entries of this rank's rows in the rows and columns of a smaller system.

    number (n,): of the system's rows in the smaller one, -1 of the others.
    """
    own = number[first : first + indptr.size - 1]
    count = np.sum(np.diff(indptr)[own >= 0])
    rows, columns, found = np.empty(count, np.int64), np.empty(count, np.int64), np.empty(count)
    n = 0
    for i in np.flatnonzero(own >= 0):
        for k in range(indptr[i], indptr[i + 1]):
            if number[indices[k]] >= 0 and values[k] != 0.0:
                rows[n], columns[n], found[n] = own[i], number[indices[k]], values[k]
                n += 1
    return rows[:n], columns[:n], found[:n]
