"""Round-off of the residual: where Newton's method ends because nothing is left that it could improve.

The residual of a stiff line or contact is a small difference of large numbers: some eps EA of a bar that has turned, or
eps k z of a penalty k at a height z. Where that is above what is allowed, the norms of the residual stay as they are,
and Newton's steps, before a line search shortens them, are the unknowns' own round-off. A load or time step that stops
so is solved as far as it can be told; a larger floor for the residual would hide small loads on long lines instead.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from riser_soil.core.arrays import Array

STALLED = 0.5  # the norm of a residual that falls by less in each of two iterations stays as it is
STILL = 1e-10  # Newton's step of the unknowns, over their increments in the load or time step
EPS = float(np.finfo(float).eps)


class RoundOff:
    """Follows the unknowns of a step. total: sums over the ranks; size: a length [m] whose round-off the unknowns
    together may move by, as the lines' own, some three times.
    """

    def __init__(self, total: Callable[[list[float]], list[float]], size: float) -> None:
        self._total, self._size = total, size
        self.begin()

    def begin(self) -> None:
        """Begin a load or time step."""
        self._newton_step: Array | None = None

    def follow(self, newton_step: Array) -> None:
        """An iteration's whole step, whatever part of it is taken; this rank's [m], angles times the lever."""
        self._newton_step = newton_step

    def reached(self, x: Array, norms: list[float]) -> bool:
        """Whether iterations neither lower the residual's norms, of all so far, nor would move the unknowns x any more
        but by the round-off of places; x: this rank's increments [m], angles times the lever. Collective.
        """
        step = self._newton_step
        if step is None or len(norms) < 3 or any(b <= STALLED * a for a, b in pairwise(norms[-3:])):
            return False
        moved, whole = self._total([float(np.sum(step**2)), float(np.sum(x**2))])
        return moved <= max(STILL**2 * whole, (EPS * self._size) ** 2)
