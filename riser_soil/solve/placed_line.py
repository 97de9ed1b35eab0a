"""A line at its accepted configuration in numbers, where the kernels that ask about it find it."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.packed import Packed
from riser_soil.core.part import State
from riser_soil.riser.configuration import base_of, place, put_rates, room_for
from riser_soil.riser.line import Line
from riser_soil.riser.part_kernels import bound


class PlacedLine:
    """The accepted configuration `at` of a line, placed once for all that ask in turn, with rates as each asks for.

    base: what it follows from, for trials too, as it was brought last.
    """

    def __init__(self, line: Line) -> None:
        self._line, self.at, shape = line, room_for(line), (line.nodes, line.ndof)
        base = base_of(line)
        self.base = Packed(type(base)(*map(np.copy, base)))
        self._rates, still = (np.zeros(shape), np.zeros(shape)), Packed(np.zeros(shape))
        self._place = bound(place, self.at, self.base, still, still, still)
        self._put = bound(put_rates, self.at, *map(Packed, self._rates))
        self._stand = bound(put_rates, self.at, still, still)
        self._brought: Array | None = None  # the places of its nodes as they were when the base was brought last
        self._at: Array | None = None  # and when it was placed
        self._with: tuple[Array | None, Array | None] = None, None  # the rates that it has there

    def bring(self) -> None:
        """Bring the base to where the line is accepted now; a line that is accepted elsewhere has other arrays."""
        if self._brought is not self._line.x:
            for kept, given in zip(self.base.value, base_of(self._line), strict=True):
                kept[...] = given
            self._brought = self._line.x

    def move(self, state: State, velocities_alone: bool = False) -> None:
        """With the rates of an accepted state; its accelerations may not matter."""
        self._renew()
        v, a = self._with
        if v is state.v and (a is state.a or velocities_alone):
            return
        for kept, given in zip(self._rates, (state.v, state.a), strict=True):
            kept.ravel()[:] = given
        self._put()
        self._with = state.v, state.a

    def stand(self) -> None:
        """Without rates."""
        self._renew()
        self._stand()
        self._with = None, None

    def _renew(self) -> None:
        """Place it, unless it is where it was."""
        if self._at is not self._line.x:
            self.bring()
            self._place()
            self._at, self._with = self._line.x, (None, None)
