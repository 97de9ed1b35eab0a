"""Trial configuration of the line, and how loads per length reach its dofs."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import cached_property
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed
from riser_soil.core.part import State
from riser_soil.riser import hermite
from riser_soil.riser.directors import Orientation


class Trial:
    """The line at a trial state: x (nn, d), chord (ne, d); on demand its orientation, which `turning` makes, and rates
    of q.
    """

    def __init__(
        self, state: State, x: Array, chord: Array, turning: Callable[[], Orientation], rates: tuple[Array, Array]
    ) -> None:
        self.state, self.x, self.chord, self._turning = state, x, chord, turning
        self._v, self._a = rates
        self._kept: dict[Hashable, Any] = {}

    def once(self, key: Hashable, make: Callable[[Trial], Any]) -> Any:
        """A value that a part computes at this trial, cached under a key of its own."""
        if key not in self._kept:
            self._kept[key] = make(self)
        return self._kept[key]

    @cached_property
    def turn(self) -> Orientation:
        """Orientation of the nodes; where a step was solved in compiled code, nobody may ask for it."""
        return self._turning()

    @cached_property
    def q(self) -> Array:
        """q (ne, 4, d)."""
        return _interleave(self.x, self.turn.tangent)

    @cached_property
    def q_rate(self) -> Array:
        """q' (ne, 4, d)."""
        return self.turn.motion(self._v, self._a)[0]

    def pull_back(self, F: Array) -> Array:
        """Element residual in the dofs (ne, 2 ndof) of F (ne, 4, d) conjugate to q."""
        return np.asarray(hermite.pull_back(F, self.turn.P))

    def add_turning(self, out: Array, weight: float, F: Array) -> None:
        """Add to out (ne, n, n) weight times the derivative of `pull_back` at fixed F (ne, 4, d)."""
        geometric = self.turn.geometric(F[:, 1::2])
        hermite.add_geometric(out, weight, geometric, self.x.shape[1])


def _interleave(nodal: Array, directors: Array) -> Array:
    """(ne, 4, d) from nodal translations (nn, ≥ d) and end directors (ne, 2, d), as q orders them."""
    q: Array = hermite.interleave(nodal, directors, fixed(directors.shape[2]))
    return q
