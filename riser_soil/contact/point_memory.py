"""History at integration points of the soil's surface, kept only where it differs from that of untouched soil."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.saved_state import Saved


class PointMemory:
    """Rows (n, k) by the numbers (n,) of points; `untouched` (k,) where none is kept."""

    def __init__(self, untouched: Array) -> None:
        self._untouched = untouched
        self.numbers: IntArray = np.empty(0, dtype=np.int64)
        self.rows: Array = np.empty((0, len(untouched)))

    def at(self, numbers: IntArray) -> Array:
        """Rows (n, k) of points (n,)."""
        out = np.tile(self._untouched, (len(numbers), 1))
        if len(self.numbers):
            place = np.minimum(np.searchsorted(self.numbers, numbers), len(self.numbers) - 1)
            found = self.numbers[place] == numbers
            out[found] = self.rows[place[found]]
        return out

    def keep(self, numbers: IntArray, rows: Array) -> None:
        """Keep the rows (n, k) of these points (n,), each at most once, and forget those of all others."""
        changed = np.any(rows != self._untouched, axis=1)
        order = np.argsort(numbers[changed])
        self.numbers, self.rows = numbers[changed][order], rows[changed][order]

    def go_over(self, numbers: IntArray, before: Array, after: Array) -> None:
        """Points (n,) that lay at places (n, 3) lie at others now: each takes the row of that which was nearest."""
        if len(self.numbers):
            self.keep(numbers, self.at(numbers[cKDTree(before).query(after)[1]]))

    def state(self) -> Saved:
        return {"numbers": self.numbers, "rows": self.rows}

    def restore(self, saved: Saved) -> None:
        self.numbers, self.rows = saved["numbers"], saved["rows"]
