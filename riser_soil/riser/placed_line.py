"""A line by its kernel data, where kernels that ask for it find it: at states, placed once for all that ask in turn."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.bound import Packed, bound
from riser_soil.core.part import State, Weights
from riser_soil.riser.configuration import base_of, maps_for, place, workspace_for, write_maps, write_rates
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
            for target, source in zip(self.packed.value, base_of(self._line), strict=True):
                target[...] = source
            self._updated = self._line.x


class TrialConfiguration:
    """Configuration `at` of a line after increments from its base, and the kernels that write it.

    u, v, a (nn, ndof): increments, rates and accelerations that `place` reads. maps, weights: of its tangent, which
    `write_maps` finds there.
    """

    def __init__(self, line: MovingNodes, base: LineBase, u: Array, v: Array, a: Array) -> None:
        self.at, rates = workspace_for(line), (Packed(v), Packed(a))
        self.place = bound(place, self.at, base.packed, Packed(u), *rates)
        self.put_rates = bound(write_rates, self.at, *rates)
        self.maps, self.weights = Packed(maps_for(line)), Packed(Weights.of_statics())
        self.write_maps = bound(write_maps, self.at, self.maps, self.weights)

    def weigh(self, weights: Weights) -> bool:
        """Take the weights of a tangent; whether they have changed."""
        if weights == self.weights.value:
            return False
        self.weights.renew(Weights(*map(float, weights)))
        return True


class PlacedLine:
    """A line at a state. count: of the states that it was placed at; at accepted states only its rates are new."""

    def __init__(self, line: MovingNodes, base: LineBase) -> None:
        self._line, self._base = line, base
        u, v, a = (np.zeros((line.nodes, line.ndof)) for _ in range(3))
        self.trial = TrialConfiguration(line, base, u, v, a)
        self.at, self._u, self._v, self._a = self.trial.at, u.ravel(), v.ravel(), a.ravel()
        self._state: State | None = None
        self._from: Array | None = None  # the places of the nodes where the line was accepted
        self._moved = False  # whether it has moved from there
        self._increments: Array | None = None  # of all local dofs, that were looked at last: whether they move it
        self._moves = False
        self._rates: tuple[Array | None, Array | None] = None, None  # that it has, of all local dofs
        self.count, self._mapped = 0, -1  # the count for which the maps hold

    def move(self, state: State, velocities_alone: bool = False) -> None:
        """Place it at a state, whose arrays must not change from then on, unless it is there; its accelerations may not
        matter.
        """
        line = self._line
        if state is self._state and line.x is self._from:
            return
        self._base.update()
        moves, (v, a) = self._moves_by(state.u), self._rates
        unmoved = line.x is self._from and not (moves or self._moved)
        if not (unmoved and state.v is v and (velocities_alone or state.a is a)):
            self._v[:], self._a[:], self._rates = state.v[line.part], state.a[line.part], (state.v, state.a)
            if unmoved:
                self.trial.put_rates()
            else:
                self._u[:] = state.u[line.part]
                self.trial.place()
        self._state, self._from, self._moved = None if velocities_alone else state, line.x, moves
        self.count += 1

    def _moves_by(self, increments: Array) -> bool:
        """Whether increments of all local dofs move the line."""
        if increments is not self._increments:
            self._increments, self._moves = increments, np.count_nonzero(increments[self._line.part]) > 0
        return self._moves

    def forget(self) -> None:
        """Place it anew next time, even at the same state."""
        self._state = self._increments = None

    def differentiate(self, weights: Weights) -> None:
        """Write the maps of the tangent at the state."""
        if self.trial.weigh(weights) or self._mapped != self.count:
            self.trial.write_maps()
            self._mapped = self.count


class LineTrials:
    """A line at a trial state, `now`, and where a step begins, `then`, in which its parts are evaluated.

    base: the accepted configuration that both follow from. start, end: times [s] of the step.
    """

    def __init__(self, line: MovingNodes) -> None:
        self.base = LineBase(line)
        self.now, self.then = PlacedLine(line, self.base), PlacedLine(line, self.base)
        self.start = self.end = np.nan

    def step_to(self, t: float) -> None:
        """Times of the step that ends at t: it starts at the time that was asked for before."""
        if t != self.end:
            self.start, self.end = (t if np.isnan(self.end) else self.end), t

    def forget(self) -> None:
        """Forget all results: the parts' kernel data have changed, or others have used them."""
        self.now.forget()
