"""Extremes of a stage's figures, code checks, bodies and joints by one reduction: the largest values so far, and when
and where they were.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved


class Largest:
    """Largest values so far of n figures, each with its time and with what belongs to it, as its arc length.

    Of equal values the first counts; nan does not count. values, times (n,): -inf and nan before the first; beside
    (m, n): of m kinds.
    """

    def __init__(self, size: int, beside: int = 0) -> None:
        self._rows = np.full((2 + beside, size), np.nan)
        self._rows[0] = -np.inf

    @property
    def values(self) -> Array:
        return self._rows[0]

    @property
    def times(self) -> Array:
        return self._rows[1]

    @property
    def beside(self) -> Array:
        return self._rows[2:]

    def update(self, times: Array, values: Array, *beside: Array) -> None:
        """Take in values (nt, n) at times (nt,), and what belongs to each, (nt, n)."""
        known = np.where(np.isnan(values), -np.inf, values)
        at, column = known.argmax(axis=0), np.arange(values.shape[1])
        rows = np.stack([known[at, column], times[at], *(each[at, column] for each in beside)])
        larger = rows[0] > self._rows[0]
        self._rows[:, larger] = rows[:, larger]

    def state(self) -> Saved:
        return {"rows": self._rows.copy()}

    def restore(self, saved: Saved) -> None:
        self._rows = saved["rows"].copy()


class Range:
    """Least and largest values so far of n figures, see `Largest`."""

    def __init__(self, size: int, beside: int = 0) -> None:
        self._least, self._most = Largest(size, beside), Largest(size, beside)

    def update(self, times: Array, values: Array, *beside: Array) -> None:
        self._least.update(times, -values, *beside)
        self._most.update(times, values, *beside)

    def columns(self) -> dict[str, Array]:
        """Each (n,), by the names that they have in summary.json."""
        least, most = -self._least.values, self._most.values
        return {"min": least, "max": most, "t_min": self._least.times, "t_max": self._most.times}

    @property
    def beside(self) -> dict[str, Array]:
        """Each (m, n)."""
        return {"min": self._least.beside, "max": self._most.beside}

    def state(self) -> Saved:
        return {"least": self._least.state()["rows"], "most": self._most.state()["rows"]}

    def restore(self, saved: Saved) -> None:
        for each, name in ((self._least, "least"), (self._most, "most")):
            each.restore({"rows": saved[name]})
