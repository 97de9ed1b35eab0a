"""Figures of bodies, joints and clearances over a stage: at its end, and their extremes with times."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.saved_state import Saved, packed, unpacked
from riser_soil.results.netcdf import Variable


class HungExtremes:
    """Extremes of the present stage. variables: what is recorded, by path."""

    def __init__(self, variables: Mapping[str, Variable]) -> None:
        self._known = [*variables]
        self._found: dict[str, dict[str, Any]] = {}

    def begin_stage(self) -> None:
        self._found = {}

    def update(self, times: Array, rows: Mapping[str, Array]) -> dict[str, Any]:
        """Take note of values at times (nt,) [s] (static stages: load factor); what is known of the stage, nested by
        path.
        """
        nested: dict[str, Any] = {}
        for name in self._known:
            self._found[name] = _extended(self._found.get(name), times, rows[name])
            *groups, last = name.split("/")
            inner = nested
            for key in groups:
                inner = inner.setdefault(key, {})
            inner[last] = self._found[name]
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
