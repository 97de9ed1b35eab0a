"""Transfer of what points of the soil hold to those of a new mesh.

`carried_rows` is for histories: from the point nearest to where the new one is, along the way to the new one by the
gradient to the points that lie ahead, never beyond what those around hold. So a field moves by the way, however short,
and does not stick to the mesh; the law brings the states back to what it admits. The depth at which the material lay at
first, on which its strength hangs, each node takes along from the node nearest, by its gradient nearby.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.spatial import cKDTree

from riser_soil.core.arrays import Array, IntArray
from riser_soil.soil.grid import DistributedMesh

AROUND = 13  # points around a place that are looked at
WITHIN = 1.0 - 1e-6  # of the distance to the farthest: others as far do not count, so that nothing hangs on round-off
SAME = 1e-9  # of the distance to the farthest of them: a way that is none
EASED = 0.01  # of the gradient's matrix, added to it: where no points lie ahead in a direction there is no gradient

Take = Callable[[Array, Array, Array], tuple[Array, ...]]  # of places, rows there, and places asked for


def nearest_rows(
    grid: DistributedMesh, before: Array, after: Array, rows: Array, columns: Sequence[str]
) -> tuple[Array, Array]:
    """Rows (n, k) of those points of all ranks, at places (m, 3) before, that are nearest to this rank's places (n, 3)
    after; and the ways (n, 3) from there. A place behind a mirror takes the image of what its own image does;
    columns: names of a row's numbers, see `Mirror.turned`. Collective.
    """
    mirror = grid.mirror
    if mirror is None:
        found, way = _taken(grid, _nearest, before, after, rows)
        return found, way
    behind = mirror.behind(after)
    asked = np.where(behind[:, None], mirror.images(after), after)
    found, way = _taken(grid, _nearest, before, asked, rows)
    found[behind] *= mirror.turned(columns)
    way[behind] *= mirror.signs
    return found, way


def carried_rows(grid: DistributedMesh, before: Array, after: Array, rows: Array, columns: Sequence[str]) -> Array:
    """Rows (n, k) at this rank's places (n, 3) after, of the field that has rows at places (m, 3) before, on all ranks
    and behind a mirror; columns: see `nearest_rows`. Collective.
    """
    mirror = grid.mirror
    if mirror is not None:
        beyond = ~mirror.behind(before)
        before, rows = before[beyond], rows[beyond]
        before = np.concatenate([before, mirror.images(before)])
        rows = np.concatenate([rows, rows * mirror.turned(columns)])
    return _taken(grid, carried, before, after, rows)[0]


def carried(places: Array, held: Array, asked: Array) -> tuple[Array]:
    """Rows (n, k) at places (n, 3) of the field that holds rows (m, k) at others (m, 3), see the module's text."""
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
    return (out,)


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


def _nearest(places: Array, held: Array, asked: Array) -> tuple[Array, Array]:
    """Rows of the points nearest to places (n, 3), and the ways from there."""
    number: IntArray = cKDTree(places).query(asked)[1]
    return held[number], asked - places[number]


def _taken(grid: DistributedMesh, take: Take, before: Array, after: Array, rows: Array) -> tuple[Array, ...]:
    """This rank's share of what is taken, at the places after of all ranks, from the rows of all; collective."""
    comm = grid.nodes.comm
    gathered = comm.gather((before, rows, after))
    shares = [] if gathered is None else _split(gathered, take)
    mine: tuple[Array, ...] = comm.scatter(shares)
    return mine


def _split(gathered: list[tuple[Array, Array, Array]], take: Take) -> list[tuple[Array, ...]]:
    """What each rank gets."""
    places, held, asked = (np.concatenate(each) for each in zip(*gathered, strict=True))
    ends = np.cumsum([len(after) for _, _, after in gathered])[:-1]
    return list(zip(*(np.split(found, ends) for found in take(places, held, asked)), strict=True))
