"""Transfer of what points of the soil hold to those of a new mesh: each takes it from the point nearest to where it is.

So states stay such as the law admits, of any law. What grows with depth is not nearest: the stress by the weight above,
which the new point has of its own depth, and the depth at which the material lay at first, on which its strength hangs,
which each node takes along by its gradient nearby.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from riser_soil.core.arrays import Array, IntArray
from riser_soil.soil.grid import DistributedMesh


def nearest_rows(
    grid: DistributedMesh, before: Array, after: Array, rows: Array, columns: Sequence[str]
) -> tuple[Array, Array]:
    """Rows (n, k) of those points of all ranks, at places (m, 3) before, that are nearest to this rank's places (n, 3)
    after; and the ways (n, 3) from there. A place behind a mirror takes the image of what its own image does;
    columns: names of a row's numbers, see `Mirror.turned`. Collective.
    """
    mirror = grid.mirror
    if mirror is None:
        return _nearest(grid, before, after, rows)
    behind = mirror.behind(after)
    asked = np.where(behind[:, None], mirror.images(after), after)
    found, way = _nearest(grid, before, asked, rows)
    found[behind] *= mirror.turned(columns)
    way[behind] *= mirror.signs
    return found, way


def _nearest(grid: DistributedMesh, before: Array, after: Array, rows: Array) -> tuple[Array, Array]:
    comm = grid.nodes.comm
    gathered = comm.gather((before, rows, after))
    shares = [] if gathered is None else _shares(gathered)
    mine: tuple[Array, Array] = comm.scatter(shares)
    return mine


def _shares(gathered: list[tuple[Array, Array, Array]]) -> list[tuple[Array, Array]]:
    """What each rank gets."""
    places, held, asked = (np.concatenate(each) for each in zip(*gathered, strict=True))
    number: IntArray = cKDTree(places).query(asked)[1]
    ends = np.cumsum([len(after) for _, _, after in gathered])[:-1]
    taken, way = np.split(held[number], ends), np.split(asked - places[number], ends)
    return list(zip(taken, way, strict=True))
