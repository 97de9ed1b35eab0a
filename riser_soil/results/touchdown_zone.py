"""Touchdown zone at an accepted state, over all seabeds and soils that the riser may touch."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved, Stateful, gathered, restore_all
from riser_soil.core.snapshot import ContactSnapshot
from riser_soil.results.settlement_trough import sections_of
from riser_soil.riser.line import Line
from riser_soil.riser.place import axis_at

if TYPE_CHECKING:
    from riser_soil.contact.touchdown import ContactInterval

# Broadcast arrays can't be written to.
UNTOUCHED = ContactSnapshot(math.nan, np.broadcast_to(np.nan, 3), 0, 0.0, np.broadcast_to(0.0, 3))


class TouchdownZone:
    """Contact results of all grounds, on the rank that evaluates contact. fields: those of `ContactSnapshot` wanted."""

    def __init__(self, assembly: Assembly, fields: Sequence[str] = ()) -> None:
        self._assembly, self._fields = assembly, fields
        self._embedment: Array = np.zeros(assembly.line.nodes)
        self._sections = sections_of(assembly) if "settlement_across" in self._fields else None

    def look(self, state: State, lay_sections: bool = False) -> ContactSnapshot:
        """At each accepted state in turn: the embedment is the greatest depth yet.

        lay_sections: where the riser lies now; they are laid anyway as long as they are nowhere.
        """
        contacts, line = self._assembly.contacts, self._assembly.line
        if not contacts:
            return UNTOUCHED
        of_each = [interval for contact in contacts for interval in contact.contact_intervals(state)]
        intervals = joined(of_each, float(line.length.max()))
        arc = touchdown_arc(intervals, line)
        if self._sections is not None and (lay_sections or not self._sections.laid):
            self._sections.lay(state, arc)
        return ContactSnapshot(
            touchdown_arc=arc,
            touchdown_position=position_at(line, state, arc),
            touchdown_points=sum(int(s.start > line.arc[0]) + int(s.end < line.arc[-1]) for s in intervals),
            max_penetration=max((contact.max_penetration(state) for contact in contacts), default=0.0),
            contact_force=np.asarray(sum((contact.force_on_riser(state) for contact in contacts), np.zeros(3))),
            penetration=self._penetration(state) if "penetration" in self._fields else None,
            embedment=self._embedded(state) if "embedment" in self._fields else None,
            slip=self._slip() if "slip" in self._fields else None,
            settlement=self._settlement(state) if "soil_settlement" in self._fields else None,
            force_on_soil=self._on_soil(state) if "force_on_soil" in self._fields else None,
            sections=self._sections.look(state) if self._sections is not None else None,
        )

    def _settlement(self, state: State) -> Array | None:
        contact, xy = self._assembly.soil_contact, self._assembly.line.positions3(state)[:, :2]
        return None if contact is None else contact.settlement(xy, state)

    def _on_soil(self, state: State) -> Array:
        """Of contact and friction together."""
        return np.asarray(np.sum([part.force_on_soil_per_length(state) for part in self._assembly.on_soil], axis=0))

    def _penetration(self, state: State) -> Array:
        found = [contact.penetration(state) for contact in self._assembly.contacts]
        return np.asarray(np.max(found, axis=0))

    def _slip(self) -> Array:
        return np.asarray(np.sum([friction.slip() for friction in self._assembly.frictions], axis=0))

    def _embedded(self, state: State) -> Array:
        self._embedment = np.max([self._embedment, *(c.depth(state) for c in self._assembly.contacts)], axis=0)
        return self._embedment

    def state(self) -> Saved:
        return {"embedment": self._embedment} | gathered(self._owners)

    def restore(self, saved: Saved) -> None:
        self._embedment = saved["embedment"]
        restore_all(self._owners, saved)

    @property
    def _owners(self) -> dict[str, Stateful]:
        return {} if self._sections is None else {"sections": self._sections}


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
    return axis_at(line, state, arc)[0]
