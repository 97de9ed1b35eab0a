"""Touchdown zone at an accepted state, over all seabeds and soils that the riser may touch."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved
from riser_soil.core.snapshot import ContactSnapshot
from riser_soil.riser import stations
from riser_soil.riser.line import Line

if TYPE_CHECKING:
    from riser_soil.contact.touchdown import ContactInterval


class TouchdownZone:
    """Contact results of all grounds, on the rank that evaluates contact. fields: those of `ContactSnapshot` wanted."""

    def __init__(self, assembly: Assembly, fields: Sequence[str] = ()) -> None:
        self._assembly, self._fields = assembly, fields
        self._embedment: Array = np.zeros(assembly.line.nodes)

    def look(self, state: State) -> ContactSnapshot:
        """At each accepted state in turn: the embedment is the greatest depth yet."""
        contacts, line = self._assembly.contacts, self._assembly.line
        of_each = [interval for contact in contacts for interval in contact.contact_intervals(state)]
        intervals = joined(of_each, float(line.length.max()))
        arc = touchdown_arc(intervals, line)
        return ContactSnapshot(
            touchdown_arc=arc,
            touchdown_position=position_at(line, state, arc),
            touchdown_points=sum(int(s.start > line.arc[0]) + int(s.end < line.arc[-1]) for s in intervals),
            max_penetration=max((contact.max_penetration(state) for contact in contacts), default=0.0),
            contact_force=np.asarray(sum((contact.force_on_riser(state) for contact in contacts), np.zeros(3))),
            penetration=self._penetration(state) if "penetration" in self._fields else None,
            embedment=self._embedded(state) if "embedment" in self._fields else None,
            slip=self._slip() if "slip" in self._fields else None,
        )

    def _penetration(self, state: State) -> Array:
        found = [contact.penetration(state) for contact in self._assembly.contacts]
        return np.asarray(np.max(found, axis=0))

    def _slip(self) -> Array:
        return np.asarray(np.sum([friction.slip() for friction in self._assembly.frictions], axis=0))

    def _embedded(self, state: State) -> Array:
        self._embedment = np.max([self._embedment, *(c.depth(state) for c in self._assembly.contacts)], axis=0)
        return self._embedment

    def state(self) -> Saved:
        return {"embedment": self._embedment}

    def restore(self, saved: Saved) -> None:
        self._embedment = saved["embedment"]


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


def position_at(line: Line, state: State, arc: float) -> Array:
    """Position of the riser's axis (3,) [m], global axes, at an arc length [m]; nan where that is."""
    if np.isnan(arc):
        return np.full(3, np.nan)
    e = int(np.clip(np.searchsorted(line.arc, arc) - 1, 0, line.length.size - 1))
    length = line.length[e : e + 1]
    at = stations.points(length, (arc - line.arc[e]) / length)
    return line.to_global(stations.interpolate(at, line.trial(state).q[e : e + 1])[0, 0])
