"""Figures of bodies, joints and clearances over a stage, at its end and extremes with times; who looks at them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved, packed, unpacked

if TYPE_CHECKING:
    from riser_soil.assembly import Assembly
    from riser_soil.results.hung import HungReader


class HungExtremes:
    """Extremes of a stage."""

    def __init__(self) -> None:
        self._found: dict[str, dict[str, Any]] = {}

    def update(self, times: Array, rows: Mapping[str, Array]) -> None:
        """Take note of values by path at times (nt,) [s] (static stages: load factor)."""
        for name, values in rows.items():
            self._found[name] = _extended(self._found.get(name), times, values)

    @property
    def nested(self) -> dict[str, Any]:
        """What is known of the stage, nested by path."""
        nested: dict[str, Any] = {}
        for name, found in self._found.items():
            *groups, last = name.split("/")
            inner = nested
            for key in groups:
                inner = inner.setdefault(key, {})
            inner[last] = found
        return nested

    def state(self) -> Saved:
        return {"found": packed(self._found)}

    def restore(self, saved: Saved) -> None:
        self._found = unpacked(saved["found"])


def _extended(before: dict[str, Any] | None, times: Array, values: Array) -> dict[str, Any]:
    """{final, min, max, t_min, t_max} of values (nt,) or (nt, 3), vectors by component."""
    found: dict[str, Any] = {"final": as_list(values[-1])}
    for key, sign in (("min", 1.0), ("max", -1.0)):
        at = (sign * values).argmin(axis=0)
        best, when = np.take_along_axis(values, at[None], axis=0)[0], times[at]
        if before is not None:
            old = np.array(before[key])
            better = sign * best < sign * old
            best, when = np.where(better, best, old), np.where(better, when, np.array(before[f"t_{key}"]))
        found |= {key: as_list(best), f"t_{key}": as_list(when)}
    return found


def hung_reader(assembly: Assembly) -> HungReader | None:
    """None of a scene with one riser."""
    if not assembly.scene.lines:
        return None
    from riser_soil.results.hung import HungReader

    return HungReader(assembly)


def looked_at(reader: HungReader | None, state: State) -> dict[str, Array]:
    """Values at an accepted state by path, the first axis time."""
    return {} if reader is None else {name: value[None] for name, value in reader.look(state).items()}


def joined(looks: Sequence[Mapping[str, Array]]) -> dict[str, Array]:
    """Values at several instants, one after another, by name; the first axis is time."""
    return {name: np.concatenate([each[name] for each in looks]) for name in looks[0]}
