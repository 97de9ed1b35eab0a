"""Largest values of a stage so far, and when and where they were: the one reduction of figures, utilisations, code
checks, bodies, joints, soil, and of what must stay small for a result to be plausible.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.saved_state import Saved, Stateful, gathered, restore_all


class Largest:
    """Largest values so far of n figures, each with its time and with m numbers that belong to it, as its arc length.

    floor: only larger values count, and it is the value before the first of them. tolerance: share of the largest value
    by which another must exceed it, where a solver leaves so much open. Of equal values the first counts; nan does not
    count. values, times (n,): floor and nan before the first; beside (m, n): nan before it.
    """

    def __init__(self, size: int = 1, beside: int = 0, floor: float = -np.inf, tolerance: float = 0.0) -> None:
        self._rows = np.full((2 + beside, size), np.nan)
        self._rows[0] = floor
        self._tolerance = tolerance

    @property
    def values(self) -> Array:
        return self._rows[0]

    @property
    def times(self) -> Array:
        return self._rows[1]

    @property
    def beside(self) -> Array:
        return self._rows[2:]

    def of(self, figure: int = 0) -> list[float]:
        """Largest value of a figure by its number, its time, and what belongs to it."""
        return as_list(self._rows[:, figure])

    def update(self, times: Array, values: Array, *beside: Array) -> None:
        """Take in values (nt, n) at times (nt,), and what belongs to each, (nt, n)."""
        comparable = np.where(np.isnan(values), -np.inf, values)
        at, column = comparable.argmax(axis=0), np.arange(values.shape[1])
        rows = np.stack([comparable[at, column], times[at], *(each[at, column] for each in beside)])
        size = np.where(np.isfinite(self.values), np.abs(self.values), 0.0)
        larger = rows[0] > self.values + self._tolerance * size
        self._rows[:, larger] = rows[:, larger]

    def state(self) -> Saved:
        return {"rows": self._rows.copy()}

    def restore(self, saved: Saved) -> None:
        self._rows = saved["rows"].copy()


def largest_along(values: Array, *beside: Array) -> list[Array]:
    """The largest values (nt, 1) of rows along the riser (nt, n), the first of equal ones, and what belongs to them.

    beside: (nt, n), or (n,) where it is the same at all times, as the arc length. nan does not count.
    """
    at = np.where(np.isnan(values), -np.inf, values).argmax(axis=1)[:, None]
    return [np.take_along_axis(np.broadcast_to(each, values.shape), at, axis=1) for each in (values, *beside)]


class LargestAt(NamedTuple):
    """A largest value, its time [s] or load factor, and its arc length [m]; nan for the places of none."""

    value: float
    t: float
    arc: float


class LargestAlong:
    """Largest values along a riser so far, each > 0, by the names of what they are; 0 before the first."""

    def __init__(self, names: Sequence[str]) -> None:
        self._largest = {name: Largest(beside=1, floor=0.0) for name in names}

    def __getitem__(self, name: str) -> LargestAt:
        return LargestAt(*self._largest[name].of())

    def update(self, times: Array, arc: Array, along: Mapping[str, Array]) -> None:
        """Take in values (nt, n) by name at times (nt,) and arc lengths (n,)."""
        for name, values in along.items():
            self._largest[name].update(times, *largest_along(values, arc))

    def state(self) -> Saved:
        return gathered(self._largest)

    def restore(self, saved: Saved) -> None:
        restore_all(self._largest, saved)


class Range:
    """Least and largest values so far of n figures, with their times and what belongs to them."""

    def __init__(self, size: int, beside: int = 0) -> None:
        self._least, self._most = Largest(size, beside), Largest(size, beside)

    def update(self, times: Array, values: Array, *beside: Array) -> None:
        self._least.update(times, -values, *beside)
        self._most.update(times, values, *beside)

    def columns(self) -> dict[str, Array]:
        """Extremes and their times, each (n,), by their names in summary.json."""
        least, most = -self._least.values, self._most.values
        return {"min": least, "max": most, "t_min": self._least.times, "t_max": self._most.times}

    @property
    def beside(self) -> dict[str, Array]:
        """Values (m, n) that belong to the least and to the largest ones."""
        return {"min": self._least.beside, "max": self._most.beside}

    def state(self) -> Saved:
        return gathered(self._owners)

    def restore(self, saved: Saved) -> None:
        restore_all(self._owners, saved)

    @property
    def _owners(self) -> dict[str, Stateful]:
        return {"least": self._least, "most": self._most}
