"""Figures of bodies, joints and clearances over a stage, at its end and extremes with times; their reader."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved, gathered, packed, restore_all, under, unpacked, within
from riser_soil.results.largest import Range

if TYPE_CHECKING:
    from riser_soil.assembly import Assembly
    from riser_soil.results.bodies_and_joints import BodiesAndJointsReader


class BodiesAndJointsExtremes:
    """Extremes of bodies, joints and clearances in a stage so far, and their values at its last instant."""

    def __init__(self) -> None:
        self._ranges: dict[str, Range] = {}
        self._final: dict[str, Array] = {}

    def update(self, times: Array, rows: Mapping[str, Array]) -> None:
        """Take in values by path, (nt,) or (nt, 3), at times (nt,) [s] (static stages: load factor)."""
        for name, values in rows.items():
            columns = values.reshape(len(values), -1)
            self._ranges.setdefault(name, Range(columns.shape[1])).update(times, columns)
            self._final[name] = values[-1].copy()

    @property
    def nested(self) -> dict[str, Any]:
        """{final, min, max, t_min, t_max} of the stage, nested by path; vectors by component."""
        nested: dict[str, Any] = {}
        for name, final in self._final.items():
            *groups, last = name.split("/")
            inner = nested
            for key in groups:
                inner = inner.setdefault(key, {})
            columns = self._ranges[name].columns()
            extremes = {key: columns[key].reshape(final.shape) for key in ("min", "t_min", "max", "t_max")}
            inner[last] = {key: as_list(values) for key, values in ({"final": final} | extremes).items()}
        return nested

    def state(self) -> Saved:
        names = {"names": packed([*self._final])}
        return names | under("final", dict(self._final)) | under("ranges", gathered(self._ranges))

    def restore(self, saved: Saved) -> None:
        final = within(saved, "final")
        self._final = {name: final[name] for name in unpacked(saved["names"])}
        self._ranges = {name: Range(value.size) for name, value in self._final.items()}
        restore_all(self._ranges, within(saved, "ranges"))


def bodies_and_joints_reader(assembly: Assembly) -> BodiesAndJointsReader | None:
    """Reader of bodies, joints and clearances; None in a scene of one riser."""
    if not assembly.scene.lines:
        return None
    from riser_soil.results.bodies_and_joints import BodiesAndJointsReader

    return BodiesAndJointsReader(assembly)


def bodies_and_joints_values(reader: BodiesAndJointsReader | None, state: State) -> dict[str, Array]:
    """Values of bodies, joints and clearances at an accepted state by path; none without a reader."""
    return {} if reader is None else reader.values(state)
