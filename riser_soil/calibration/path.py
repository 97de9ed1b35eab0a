"""Path of penetration through measured points: steps between its turns, and where along it each point lies."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from riser_soil.core.arrays import Array, IntArray

FIRST, GROWTH = 0.1, 1.6  # first step after a turn over the largest step; a step over the one before it
TURN = 0.5  # way back that makes a turn, over the largest step: less is scatter of the measurement


@dataclass(frozen=True, eq=False)
class PenetrationPath:
    """Penetrations w (m,) [m] to step through, from the start on, and the place (n,) of each measured point along it,
    in steps: 2.5 is midway between w[2] and w[3]."""

    w: Array
    place: Array

    def at_points(self, values: Array) -> Array:
        """Values (m,) at the steps, as they are at the measured points (n,)."""
        return np.interp(self.place, np.arange(len(self.w)), values)


def path_through(measured: Array, start: float, step: float) -> PenetrationPath:
    """The path from a start [m] to the first measured penetration (n,) [m] and on through its turns, in steps of at
    most `step` [m], short ones after each turn."""
    corners = turns(measured, TURN * step)
    ends = np.concatenate(([start], measured[corners]))
    w, place = [start], np.zeros(len(measured))
    branch = np.searchsorted(corners, np.arange(len(measured)))
    for n, (a, b) in enumerate(pairwise(ends)):
        reached = len(w) - 1
        if a != b:
            stops = a + (b - a) * steps(abs(b - a), step)
            w.extend(stops[1:])
            along, mine = (stops - a) / (b - a), branch == n
            part = np.clip((measured[mine] - a) / (b - a), 0.0, 1.0)
            place[mine] = reached + np.interp(part, along, np.arange(len(stops)))
        else:
            place[branch == n] = reached
    return PenetrationPath(np.array(w), place)


def steps(length: float, largest: float) -> Array:
    """Parts 0..1 of a length [m] whose steps grow to `largest` [m]."""
    sizes = list[float]()
    size = FIRST * largest
    while sum(sizes) < length:
        sizes.append(size)
        size = min(GROWTH * size, largest)
    ends = np.cumsum([0.0, *sizes])
    return np.asarray(ends / ends[-1])


def turns(w: Array, least: float) -> IntArray:
    """Indexes into w (n,) at which it turns back by at least `least`; the first point and the last are among them."""
    found, extreme, way = [0], 0, 0.0
    for n, value in enumerate(w):
        if way == 0.0:
            way = float(np.sign(value - w[0])) if abs(value - w[0]) >= least else 0.0
            extreme = n if way else 0
        elif way * (value - w[extreme]) > 0.0:
            extreme = n
        elif way * (w[extreme] - value) >= least:
            found.append(extreme)
            way, extreme = -way, n
    return np.unique([*found, extreme, len(w) - 1])
