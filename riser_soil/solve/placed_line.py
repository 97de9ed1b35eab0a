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
    """The accepted configuration `at` of a line, placed once for all that ask in turn, with rates as each asks for."""

    def __init__(self, line: Line) -> None:
        self._line, self.at, shape = line, room_for(line), (line.nodes, line.ndof)
        base = base_of(line)
        self._base = Packed(type(base)(*map(np.copy, base)))
        self._rates, still = (np.zeros(shape), np.zeros(shape)), Packed(np.zeros(shape))
        self._place = bound(place, self.at, self._base, still, still, still)
        self._put = bound(put_rates, self.at, *map(Packed, self._rates))
        self._stand = bound(put_rates, self.at, still, still)
        self._at: Array | None = None  # the places of its nodes where it was placed last
        self._with: tuple[Array | None, Array | None] = None, None  # the rates that it has there

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
        if self._at is self._line.x:
            return
        for kept, given in zip(self._base.value, base_of(self._line), strict=True):
            kept[...] = given
        self._place()
        self._at, self._with = self._line.x, (None, None)
