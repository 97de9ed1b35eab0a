"""Response amplitude operators (RAOs): a vessel's linear response to the wave components of a sea."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray

TURN = 2.0 * np.pi


@dataclass(frozen=True, eq=False)
class RaoTable:
    """Complex responses to unit waves, amplitude times exp(-i lag).

    frequency: (nf,) increasing [rad/s]. direction: (nd,) increasing from 0 to below 2 pi [rad]. response: (nd, nf, m).
    """

    frequency: Array
    direction: Array
    response: Array

    def at(self, w: Array, direction: Array) -> Array:
        """Responses (n, m) to waves of frequencies w and directions (n,), linear between the table's, in frequency and,
        periodically, in direction; beyond the table's frequencies those at its ends.
        """
        first, last, share = self._between(direction)
        by_direction = (1.0 - share)[:, None, None] * self.response[first] + share[:, None, None] * self.response[last]
        found = np.empty((w.size, self.response.shape[2]), dtype=complex)
        for n, table in enumerate(by_direction):
            found[n] = [np.interp(w[n], self.frequency, column) for column in table.T]
        return found

    def beyond(self, w: Array) -> tuple[BoolArray, BoolArray]:
        """Which waves lie below and above the table's frequencies, but for round-off (n,)."""
        return w < self.frequency[0] * (1.0 - 1e-9), w > self.frequency[-1] * (1.0 + 1e-9)

    def _between(self, direction: Array) -> tuple[IntArray, IntArray, Array]:
        """Numbers of the directions before and after each direction, and the share of the latter."""
        angle = np.mod(direction, TURN)
        last: IntArray = np.searchsorted(self.direction, angle, side="right") % self.direction.size
        first = last - 1
        width = np.mod(self.direction[last] - self.direction[first], TURN)
        width[width == 0.0] = TURN
        share = np.mod(angle - self.direction[first], TURN) / width
        return first, last, np.where(share > 1.0 - 1e-9, 1.0, np.where(share < 1e-9, 0.0, share))
