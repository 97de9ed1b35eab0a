"""Block elimination of a band with a dense border, by the Schur complement of the band.

    [B  U] [x]   [f]        S = D - V B^-1 U,    S y = g - V B^-1 f,    B x = f - U y
    [V  D] [y] = [g]

B is factorised as `banded` does it. U and the transpose of V, here `right` and `below` (n, nb), are zero but in few
rows of the band, the coupled ones. Source: Golub & Van Loan, Matrix Computations (2013), 3.2.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core import banded, dense
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.banded import Size
from riser_soil.core.compiled import njit


@njit
def condense(
    ab: Array, pivots: IntArray, band: Size, rows: IntArray, right: Array, below: Array, schur: Array
) -> None:
    """Subtract V B^-1 U from the border's matrix (nb, nb). rows (m,): coupled ones, in increasing order."""
    columns = _coupled_columns(rows, right, below)
    U, V = np.empty((rows.size, columns.size)), np.empty((columns.size, rows.size))
    for i in range(rows.size):
        for j in range(columns.size):
            U[i, j], V[j, i] = right[rows[i], columns[j]], below[rows[i], columns[j]]
    inverse = banded.solve_at(ab, pivots, rows, np.eye(rows.size), band)
    product = np.dot(V, np.dot(inverse, U))
    for i in range(columns.size):
        for j in range(columns.size):
            schur[columns[i], columns[j]] -= product[i, j]


@njit
def _coupled_columns(rows: IntArray, right: Array, below: Array) -> IntArray:
    """Unknowns of the border that these rows are coupled with."""
    columns, count = np.empty(right.shape[1], dtype=np.int64), 0
    for j in range(columns.size):
        for k in rows:
            if right[k, j] != 0.0 or below[k, j] != 0.0:
                columns[count] = j
                count += 1
                break
    return columns[:count]


@njit
def forward_eliminate(
    ab: Array, pivots: IntArray, band: Size, rows: IntArray, below: Array, load: Array, border: Array
) -> None:
    """Condense the band's load f (n,) onto the border's: g (nb,) becomes g - V B^-1 f."""
    inner = load.copy()
    banded.solve(ab, pivots, inner, band)
    for k in rows:
        for j in range(border.size):
            border[j] -= below[k, j] * inner[k]


@njit
def back_substitute(rows: IntArray, right: Array, answer: Array, load: Array) -> None:
    """Take what the border's unknowns y (nb,) do off the band's load: f (n,) becomes f - U y."""
    for k in rows:
        load[k] -= dense.product(right, k, 0, answer.size, answer)
