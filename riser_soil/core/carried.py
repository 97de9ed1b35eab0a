"""A field known at scattered points, carried to other points nearby.

From the point nearest to where a new one is, along the way to the new one by the gradient to the points that lie ahead,
never beyond what those around hold: so a field moves by the way, however short, and does not stick to the points.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from riser_soil.core.arrays import Array, IntArray

AROUND = 13  # points around a place that are looked at
WITHIN = 1.0 - 1e-6  # of the distance to the farthest: others as far do not count, so that nothing hangs on round-off
SAME = 1e-9  # of the distance to the farthest of them: a way that is none
EASED = 0.01  # of the gradient's matrix, added to it: where no points lie ahead in a direction there is no gradient


def carried(places: Array, held: Array, asked: Array) -> Array:
    """Rows (n, k) at places (n, 3) of the field that holds rows (m, k) at others (m, 3)."""
    apart, near = cKDTree(places).query(asked, k=min(AROUND, len(places)))
    out = held[near[:, 0]]
    moved = np.flatnonzero(apart[:, 0] > SAME * apart[:, -1])
    apart, near, base = apart[moved], near[moved], out[moved]
    shares, counts = _shares(places, asked[moved], apart, near), apart[:, 1:] < WITHIN * apart[:, -1:]
    found, low, high = base.copy(), base.copy(), base.copy()
    for number, share, counted in zip(near[:, 1:].T, shares.T, counts.T, strict=True):
        beside = np.where(counted[:, None], held[number], base)
        found += share[:, None] * (beside - base)
        np.minimum(low, beside, out=low)
        np.maximum(high, beside, out=high)
    out[moved] = np.clip(found, low, high)
    return out


def _shares(places: Array, asked: Array, apart: Array, near: IntArray) -> Array:
    """Shares (n, k - 1) of the changes from the nearest point to the others, for the way from there: a linear fit,
    weighed by how far they lie ahead and how near.
    """
    base = places[near[:, 0]]
    way, aside = asked - base, places[near[:, 1:]] - base[:, None]
    ahead = np.einsum("nki,ni->nk", aside, way) / np.linalg.norm(aside, axis=2)
    weight = (np.maximum(ahead, 0.0) * (apart[:, -1:] / apart[:, 1:] - 1.0)) ** 2 / np.sum(way**2, axis=1)[:, None]
    matrix = np.einsum("nk,nki,nkj->nij", weight, aside, aside)
    eased = EASED * np.trace(matrix, axis1=1, axis2=2) + SAME * apart[:, -1] ** 2
    solved = np.linalg.solve(matrix + eased[:, None, None] * np.eye(3), way[:, :, None])[:, :, 0]
    return np.asarray(weight * np.einsum("nki,ni->nk", aside, solved))
