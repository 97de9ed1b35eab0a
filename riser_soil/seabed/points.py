"""Points near a seabed: how deep they are in the ground, and what the seabed's law answers there.

Loops over the points are compiled for each ground and each law, once for all contacts, which call them by address: a
contact's own kernels are the same on all seabeds.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.by_type import by_type
from riser_soil.core.compiled import njit
from riser_soil.seabed.compiled_law import LawPoints, answer_acting, keep_history, law_points
from riser_soil.seabed.grounds import Ground, GroundPoints, Vec, ground_points, write_hessians, write_penetrations
from riser_soil.seabed.law import NormalLaw

UNKNOWN = -1  # number of what lies on the ground below a place


class SeabedPoints(NamedTuple):
    """Points near a seabed, and bound kernels over them. `write_penetrations`: -inf where something else lies on the
    ground. `answer`: the law's there. `write_hessians`: of the distances of points where the law acts; none on flat
    ground. `set_all_aside`: penetrations of -inf beyond the law's reach, too. `keep`: the history after the step in the
    place of that before it; none for a law without a history.
    """

    ground: GroundPoints
    law: LawPoints
    write_penetrations: list[Bound]
    answer: list[Bound]
    write_hessians: list[Bound]
    set_all_aside: list[Bound]
    keep: list[Bound]

    @property
    def find(self) -> list[Bound]:
        """Penetrations, and the law's answer there."""
        return [*self.write_penetrations, *self.answer]


def seabed_points(
    radius: Array, ground: Ground, law: NormalLaw, history: Array, cover: Any = None, share: Array | None = None
) -> SeabedPoints:
    """Points that touch as spheres of a radius (n,) [m] do, with a history (n, nh) of the law. cover: kernel data of
    what lies on the ground in places, None for nothing; share (1,): of the law that acts, None for all of it.
    """
    at = ground_points(radius)
    points, reach = law_points(at.penetration, history), max(float(law.reach), float(law.start))
    of_ground, of_law, placed, packed = map(Packed, (ground.kernel_data, law.kernel_data, at, points))
    below = Packed(np.full(len(radius), UNKNOWN))
    near, everywhere = (
        [] if cover is None else [Bound(set_aside, Packed(cover), placed, below, Packed(each))]
        for each in (reach, math.inf)
    )
    weighed = [] if share is None else [Bound(weigh_answer, packed, Packed(share))]
    penetrations = [Bound(write_penetrations, of_ground, placed), *near]
    answer = [Bound(answer_acting, of_law, packed), *weighed]
    hessians = [] if ground.flat else [Bound(write_hessians, of_ground, placed, Packed(points.acts))]
    keep = [Bound(keep_history, of_law, packed)] if history.shape[-1] > 0 else []
    return SeabedPoints(at, points, penetrations, answer, hessians, everywhere, keep)


@by_type
def covered_by(cover: Any, x: Vec, previous: int) -> Any:
    """Number of what lies on the ground below a place x in global axes, < 0 for nothing. previous: the number there
    last time, UNKNOWN at first.
    """


@njit
def set_aside(cover: Any, points: GroundPoints, below: IntArray, reach: float) -> None:
    """Find what lies on the ground below points within a reach [m], and write a penetration of -inf where there is
    something. below (n,): its number.
    """
    place, penetration = points.place, points.penetration
    for p in range(penetration.size):
        if penetration[p] > -reach:
            below[p] = covered_by(cover, (place[p, 0], place[p, 1], place[p, 2]), below[p])
            if below[p] >= 0:
                penetration[p] = -np.inf


@njit
def weigh_answer(points: LawPoints, share: Array) -> None:
    """Scale the answer by the share (1,) of the law that acts."""
    for p in range(points.force.size):
        points.force[p] *= share[0]
        points.slope[p] *= share[0]
        points.stored[p] *= share[0]
