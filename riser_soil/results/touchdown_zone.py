"""Touchdown zone at an instant, over all seabeds and soils that the riser may touch."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from riser_soil.contact.touchdown import ContactInterval, PointsAlong, contact_intervals
from riser_soil.core.arrays import Array
from riser_soil.riser.line import Line
from riser_soil.riser.place import axis_at

Touching = tuple[PointsAlong, Array, Array]
"""Of a contact: its points along the line; gaps and forces there, as in `ContactResults`."""


class TouchdownZone(NamedTuple):
    """Arc length and position (3,) of the touchdown point [m], nan without contact; number of places where the riser
    comes down or leaves the ground.
    """

    arc: float
    position: Array
    points: int


def touchdown_zone(line: Line, touching: Iterable[Touching], position: Array, tangent: Array) -> TouchdownZone:
    """touching: of each contact; position (nn, 3), tangent (ne, 2, 3): see `SectionForces`."""
    of_each = [interval for along, gap, force in touching for interval in contact_intervals(*along, gap, force)]
    intervals = joined(of_each, float(line.length.max()))
    arc = touchdown_arc(intervals, line)
    ends = sum(int(s.start > line.arc[0]) + int(s.end < line.arc[-1]) for s in intervals)
    at = np.full(3, np.nan) if np.isnan(arc) else axis_at(line.arc, position, tangent, arc)[0]
    return TouchdownZone(arc, at, ends)


def joined(intervals: Sequence[ContactInterval], near: float) -> list[ContactInterval]:
    """The intervals in order of the arc length, merged where one ground ends and the next begins within `near` [m]."""
    found: list[ContactInterval] = []
    for this in sorted(intervals):
        if found and this.start - found[-1].end <= near:
            found[-1] = found[-1]._replace(end=max(found[-1].end, this.end))
        else:
            found.append(this)
    return found


def touchdown_arc(intervals: Sequence[ContactInterval], line: Line) -> float:
    """Arc length of the touchdown point [m], as `contact.touchdown` gives it for one ground; nan without contact."""
    if not intervals:
        return float("nan")
    last = intervals[-1]
    return last.start if last.end >= line.arc[-1] and last.start > line.arc[0] else last.end
