"""A line by its kernel data, where kernels that ask for it find it: where it is accepted, and at trial states."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.bound import Packed, bound
from riser_soil.core.part import State
from riser_soil.riser.configuration import base_of, place, workspace_for, write_rates
from riser_soil.riser.moving_nodes import MovingNodes


class LineBase:
    """The configuration that a line's trials follow from, where it was accepted when it was updated last."""

    def __init__(self, line: MovingNodes) -> None:
        base = base_of(line)
        self.packed = Packed(type(base)(*map(np.copy, base)))
        self._line = line
        self._updated: Array | None = None  # the places of its nodes as they were then

    def update(self) -> None:
        """Write where the line is accepted now; a line that is accepted elsewhere has other arrays."""
        if self._updated is not self._line.x:
            for kept, given in zip(self.packed.value, base_of(self._line), strict=True):
                kept[...] = given
            self._updated = self._line.x


class PlacedTrial:
    """A line at a trial state, placed once for all that ask in turn. count: of the states that it was placed at."""

    def __init__(self, line: MovingNodes, base: LineBase) -> None:
        self._line, self._base, self.at, shape = line, base, workspace_for(line), (line.nodes, line.ndof)
        values = [np.zeros(shape) for _ in range(3)]
        self._place = bound(place, self.at, base.packed, *map(Packed, values))
        self._u, self._v, self._a = (each.ravel() for each in values)
        self._state: State | None = None
        self._from: Array | None = None  # the places of the nodes where the line was accepted
        self.count = 0

    def move(self, state: State) -> None:
        """Place it at a state, whose arrays must not change from then on, unless it is there."""
        line = self._line
        if state is self._state and line.x is self._from:
            return
        self._base.update()
        self._u[:], self._v[:], self._a[:] = state.u[line.part], state.v[line.part], state.a[line.part]
        self._place()
        self._state, self._from = state, line.x
        self.count += 1

    def forget(self) -> None:
        """Place it anew when it is asked for next."""
        self._state = None


class PlacedLine:
    """The accepted configuration `at` of a line, placed once for all that ask in turn, with rates as each asks for.

    base: what it follows from, for trials too, as it was updated last.
    """

    def __init__(self, line: MovingNodes) -> None:
        self._line, self.at, shape = line, workspace_for(line), (line.nodes, line.ndof)
        self._base = LineBase(line)
        self.base, self.update = self._base.packed, self._base.update
        self._rates, still = (np.zeros(shape), np.zeros(shape)), Packed(np.zeros(shape))
        self._place = bound(place, self.at, self.base, still, still, still)
        self._put = bound(write_rates, self.at, *map(Packed, self._rates))
        self._stand = bound(write_rates, self.at, still, still)
        self._at: Array | None = None  # the places of its nodes as they were when it was placed
        self._with: tuple[Array | None, Array | None] = None, None  # the rates that it has there

    def move(self, state: State, velocities_alone: bool = False) -> None:
        """With the rates of an accepted state of all local dofs; its accelerations may not matter."""
        self._renew()
        v, a = self._with
        if v is state.v and (a is state.a or velocities_alone):
            return
        for kept, given in zip(self._rates, (state.v, state.a), strict=True):
            kept.ravel()[:] = given[self._line.part]
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
            self.update()
            self._place()
            self._at, self._with = self._line.x, (None, None)
