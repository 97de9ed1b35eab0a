"""A field known at scattered points, carried to other points nearby.

From the point nearest to where a new one is, along the way to the new one by the gradient to the points that lie ahead,
never beyond what those around hold: so a field moves by the way, however short, and does not stick to the points.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import cKDTree

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit

AROUND = 13  # points around a place that are looked at
WITHIN = 1.0 - 1e-6  # of the distance to the farthest: others as far do not count, so that nothing hangs on round-off
SAME = 1e-9  # of the distance to the farthest of them: a way that is none
EASED = 0.01  # of the gradient's matrix, added to it: where no points lie ahead in a direction there is no gradient


def carried(places: Array, values: Array, targets: Array) -> Array:
    """Values (n, k) at targets (n, 3) of a field that has values (m, k) at places (m, 3)."""
    if not len(targets):
        return values[:0]
    apart, near = cKDTree(places).query(targets, k=min(AROUND, len(places)))
    out = values[near[:, 0]]
    _carry(places, values, targets, apart, near, out)
    return out


@njit
def _carry(places: Array, values: Array, targets: Array, apart: Array, near: IntArray, out: Array) -> None:
    """Correct the nearest points' values in `out` (n, k) by the gradient on the way to the targets."""
    shares = np.empty(near.shape[1])
    for i in range(len(out)):
        farthest = apart[i, -1]
        if not apart[i, 0] > SAME * farthest:
            continue
        _write_shares(places, targets[i], apart[i], near[i], shares)
        for c in range(out.shape[1]):
            low = high = base = out[i, c]
            value = base
            for k in range(1, shares.size):
                if apart[i, k] < WITHIN * farthest:
                    beside = values[near[i, k], c]
                    value += shares[k] * (beside - base)
                    low, high = min(low, beside), max(high, beside)
            out[i, c] = min(max(value, low), high)


@njit
def _write_shares(places: Array, target: Array, apart: Array, near: IntArray, shares: Array) -> None:
    """Write shares (k,) of the changes from the nearest point, the first, to the others, for the way from there: a
    linear fit, weighed by how far they lie ahead and how near.
    """
    farthest, way, matrix = apart[-1], target - places[near[0]], np.zeros((3, 3))
    for k in range(1, shares.size):
        along = square = 0.0
        for i in range(3):
            aside = places[near[k], i] - places[near[0], i]
            along, square = along + aside * way[i], square + aside * aside
        ahead = max(along, 0.0) / math.sqrt(square)
        shares[k] = (ahead * (farthest / apart[k] - 1.0)) ** 2 / (way[0] ** 2 + way[1] ** 2 + way[2] ** 2)
        for i in range(3):
            for j in range(3):
                product = (places[near[k], i] - places[near[0], i]) * (places[near[k], j] - places[near[0], j])
                matrix[i, j] += shares[k] * product
    eased = EASED * np.trace(matrix) + SAME * farthest**2
    for i in range(3):
        matrix[i, i] += eased
    solved = np.linalg.solve(matrix, way)
    for k in range(1, shares.size):
        along = 0.0
        for i in range(3):
            along += (places[near[k], i] - places[near[0], i]) * solved[i]
        shares[k] *= along
