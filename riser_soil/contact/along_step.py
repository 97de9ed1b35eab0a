"""A contact law along a step: its work, and the first guess of a step in which the riser touches down."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.compiled import njit
from riser_soil.core.part import State
from riser_soil.seabed.compiled_law import answer
from riser_soil.seabed.grounds import Ground
from riser_soil.seabed.law import NormalLaw
from riser_soil.seabed.points import SeabedPoints, seabed_points

#: How little of the force may be bent along the way, by its slopes and by its rise, for both ends to give the work.
STEADY = 1e-3
#: Panels of the way within the ground, where the laws are smooth, and of that above it, where suction has corners.
WITHIN, ABOVE = 2, 4
#: Gauss points of a panel, by places and weights in 0..1.
_GAUSS = ((0.5 - 0.5 * math.sqrt(0.6), 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + 0.5 * math.sqrt(0.6), 5.0 / 18.0))


class Shares(NamedTuple):
    """Shares (1,) of the law that act where a step starts and where it ends."""

    start: Array
    end: Array


def work_along_step(law: NormalLaw, before: Array, after: Array, history: Array) -> Array:
    """Work per length (...) [N] of the force against the penetration, from `before` to `after` (...) [m] by one way.

    history (..., nh): at the beginning. See `work_at`.
    """
    work = np.empty(before.size)
    rows = np.array(history, order="C").reshape(before.size, history.shape[-1])
    ways = (np.array(each).reshape(-1) for each in (before, after))
    Bound(write_works, *map(Packed, (law.kernel_data, float(law.reach), *ways, rows, work)))()
    return work.reshape(before.shape)


@njit
def write_works(law: Any, reach: float, before: Array, after: Array, history: Array, work: Array) -> None:
    """Write the work per length (n,) [N] at points with histories (n, nh), as of `work_along_step`."""
    workspace = np.empty(history.shape[1])
    for i in range(work.size):
        work[i] = work_at(law, reach, before[i], after[i], history[i], workspace)


class SeabedStep(NamedTuple):
    """Points (n,) near a seabed at the end of a step and where it began; work (n,) [N] per length of a law with a
    history by one way between both, (0,) of others; kernels that find what was there at the beginning, and the work.
    """

    here: SeabedPoints
    began: SeabedPoints
    work: Array
    find_before: list[Bound]


def seabed_step(
    radius: Array, ground: Ground, law: NormalLaw, history: Array, cover: Any = None, shares: Shares | None = None
) -> SeabedStep:
    """Workspace for points of a radius (n,) [m] with a history (n, nh). cover: as of `seabed_points`; shares: of the
    law that act, None for all of it.
    """
    start, end = (None, None) if shares is None else shares
    began, here = (seabed_points(radius, ground, law, history, cover, share) for share in (start, end))
    if history.shape[1] == 0:
        return SeabedStep(here, began, np.zeros(0), began.find)
    work = np.zeros(len(radius))
    ways = began.law.penetration, here.law.penetration, history, work
    write_work = Bound(write_works, *map(Packed, (law.kernel_data, float(law.reach), *ways)))
    return SeabedStep(here, began, work, [*began.find, write_work])


@njit
def work_at(law: Any, reach: float, before: float, after: float, history: Array, workspace: Array) -> float:
    """Work per length [N] at one point, whose history is (nh,); workspace (nh,) is written to.

    Without a history the force has a potential and the work is its change, so that such ground dissipates nothing.
    Else the law is integrated within the ground and above it, as far as there is a force.
    """
    if history.size == 0:
        return answer(law, after, history, workspace)[2] - answer(law, before, history, workspace)[2]
    work = _between(law, max(before, 0.0), max(after, 0.0), history, workspace, WITHIN)
    if reach > 0.0:
        first, last = min(max(before, -reach), 0.0), min(max(after, -reach), 0.0)
        work += _between(law, first, last, history, workspace, ABOVE)
    return work


@njit
def _between(law: Any, first: float, last: float, history: Array, workspace: Array, panels: int) -> float:
    """Work per length [N] between two penetrations: by force and slope at both ends, where the force is all but
    straight between them; else by Gauss points.
    """
    if first == last:
        return 0.0
    (f, slope, _), (g, then, _) = answer(law, first, history, workspace), answer(law, last, history, workspace)
    way, small = last - first, STEADY * min(abs(f), abs(g))
    bent = way * (slope - then) / 12.0
    if abs(bent) < small and abs(g - f - 0.5 * way * (slope + then)) < small:
        return way * (0.5 * (f + g) + bent)
    mean = 0.0
    for panel in range(panels):
        for place, weight in _GAUSS:
            z = first + (panel + place) / panels * way
            mean += weight / panels * answer(law, z, history, workspace)[0]
    return mean * way


def landing_predictor(guess: State, heights: IntArray, present: Array, guessed: Array, start: float) -> Array:
    """The guess's increments, raised where a node would sink below its present depth.

    The motion of the last step carries landing nodes deep into the ground, where the law is far stiffer than at the
    depth at which they come to rest. They start instead from half the law's rounded corner.

    heights (nn,): local numbers of the nodes' vertical dofs. present, guessed (nn,): their gaps less that at which the
    force begins, `start` [m].
    """
    increments = guess.u.copy()
    _lift_each(increments, heights, present, guessed, start)
    return increments


@njit
def _lift_each(increments: Array, heights: IntArray, present: Array, guessed: Array, start: float) -> None:
    for n in range(heights.size):
        increments[heights[n]] += lift(present[n], guessed[n], start)


@njit
def lift(present: float, guessed: float, start: float) -> float:
    """How far a node is raised; arguments as in `landing_predictor`."""
    return max(min(present, -0.5 * start) - guessed, 0.0)
