"""Points near a seabed: how far off the ground they are, and what the seabed's law answers there.

Loops over the points are compiled for each ground and each law, once for all contacts, which call them by address: a
contact's own kernels are the same on all seabeds.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.bound import Bound, Packed, call_each, calls
from riser_soil.core.by_type import by_type
from riser_soil.core.compiled import njit
from riser_soil.core.entries import Calls
from riser_soil.seabed.compiled_law import LawPoints, answer_acting, law_points
from riser_soil.seabed.grounds import Ground, GroundPoints, Vec, ground_points, write_distances, write_hessians
from riser_soil.seabed.law import NormalLaw

UNKNOWN = -1  # number of what lies on the ground below a place


class SeabedPoints(NamedTuple):
    """Points (n,) near a seabed. radius (n,) [m]: a point touches as a sphere about its place does. reach [m]: gap from
    which on the law has no force. cover (n,): number of what was found on the ground below, see `covered_by`.

    Kernels: of the distances from the ground and of their hessians, of none on flat ground; of what lies on the ground,
    of places within the law's reach and of all; of the law.
    """

    at: GroundPoints
    law: LawPoints
    radius: Array
    reach: float
    cover: IntArray
    write_distances: Calls
    write_hessians: Calls
    set_aside: Calls
    set_all_aside: Calls
    answer: Calls


def seabed_points(radius: Array, ground: Ground, law: NormalLaw, history: Array, cover: Any = None) -> SeabedPoints:
    """Points of a radius (n,) with a history (n, nh) of the law. cover: kernel data of what lies on the ground in
    places, None for nothing.
    """
    n, reach = len(radius), max(float(law.reach), float(law.start))
    at, points, below = ground_points(n), law_points(np.zeros(n), history), np.full(n, UNKNOWN)
    of_ground, packed, of_law = Packed(ground.kernel_data), Packed(at), Packed(points)
    hessians = [] if ground.flat else [Bound(write_hessians, of_ground, packed, Packed(points.acts))]
    covered = [
        [] if cover is None else [Bound(set_aside, *map(Packed, (cover, within, at.place, below, points.penetration)))]
        for within in (reach, math.inf)
    ]
    answers = [Bound(answer_acting, Packed(law.kernel_data), of_law)]
    kernels = [Bound(write_distances, of_ground, packed)], hessians, *covered, answers
    return SeabedPoints(at, points, radius, reach, below, *(calls(*each) for each in kernels))


@njit
def find_penetrations(points: SeabedPoints) -> None:
    """Find by how much the points at their places sink in; by -inf where something else lies on the ground, of those
    within the law's reach.
    """
    call_each(points.write_distances)
    for p in range(points.radius.size):
        points.law.penetration[p] = points.radius[p] - points.at.distance[p]
    call_each(points.set_aside)


@by_type
def covered_by(cover: Any, x: Vec, known: int) -> Any:
    """What lies on the ground below a place x, in global axes: its number, < 0 for nothing. known: what was found there
    last, UNKNOWN at first.
    """


@njit
def set_aside(cover: Any, within: float, place: Array, below: IntArray, penetration: Array) -> None:
    """Find what lies on the ground below places (n, 3) within a gap [m], and write a penetration of -inf where there is
    something.
    """
    for p in range(penetration.size):
        if penetration[p] > -within:
            below[p] = covered_by(cover, (place[p, 0], place[p, 1], place[p, 2]), below[p])
            if below[p] >= 0:
                penetration[p] = -np.inf
