"""Nodes that move and turn, with elements between them: what a line and a body, which is one node, have in common."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.identity_cache import IdentityCache
from riser_soil.core.part import MatrixBlock, State
from riser_soil.core.saved_state import Saved, under, within
from riser_soil.riser import hermite
from riser_soil.riser.directors import Frames, Orientation

Made = TypeVar("Made")


class Trial:
    """The nodes at a trial state: x (nn, d), chord (ne, d); on demand their orientation, which `turning` makes, and
    rates of q.
    """

    def __init__(
        self, state: State, x: Array, chord: Array, turning: Callable[[], Orientation], rates: tuple[Array, Array]
    ) -> None:
        self.state, self.x, self.chord, self._turning = state, x, chord, turning
        self._v, self._a = rates
        self._cache: dict[Hashable, Any] = {}

    def once(self, key: Hashable, make: Callable[[Trial], Any]) -> Any:
        """A value that a part computes at this trial, cached under a key of its own."""
        if key not in self._cache:
            self._cache[key] = make(self)
        return self._cache[key]

    @cached_property
    def turn(self) -> Orientation:
        """Orientation of the nodes; where a step was solved in compiled code, nobody may ask for it."""
        return self._turning()

    @cached_property
    def q(self) -> Array:
        """q (ne, 4, d)."""
        q: Array = hermite.interleave(self.x, self.turn.tangent, fixed(self.x.shape[1]))
        return q

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


class MovingNodes:
    """Field of nodes with `ndof` dofs each, interleaved: translations [m] and a rotation vector [rad], in space in body
    axes. Base of `Line` and `MovingBody`, which say what is prescribed.

    x (nn, d), frames: the accepted configuration; arc (nn,): their places along the chain; basis (3, d): its axes.
    loose (ne,): see `Line`.
    active: whether this rank evaluates and owns it.
    """

    def __init__(self, name: str, x: Array, frames: Frames, arc: Array, basis: Array, active: bool) -> None:
        self.name = self.space = name
        self.x: Array = x
        self.chord: Array = np.diff(x, axis=0)
        self.frames, self.arc, self.basis, self.active = frames, arc, basis, active
        self.length = np.diff(arc)
        self.loose = np.zeros(self.length.size)
        self.nodes, self.dimension = x.shape
        self.ndof = self.dimension + frames.dofs
        self.size = self.nodes * self.ndof
        self.offset = 0
        self.global_index: IntArray = np.arange(self.size, dtype=np.int64)
        self.owned: BoolArray = np.full(self.size, active)
        self._made: dict[Callable[[Any], Any], Any] = {}
        self._trials = IdentityCache[State, Trial](first=1, latest=2)

    @property
    def offset(self) -> int:
        """The field's first dof in local arrays; setting it moves the field's slice of them, `part`."""
        return self._offset

    @offset.setter
    def offset(self, first: int) -> None:
        self._offset, self.part = first, slice(first, first + self.size)

    def nodal(self, values: Array) -> Array:
        """View (nn, ndof) of the field's slice of a local array."""
        return values[self.part].reshape(self.nodes, self.ndof)

    @property
    def translation_dofs(self) -> IntArray:
        """Local numbers of the translations (nn, d)."""
        return self.offset + self._translations if self.offset else self._translations

    @cached_property
    def _translations(self) -> IntArray:
        first = self.ndof * np.arange(self.nodes, dtype=np.int64)
        return np.asarray(first[:, None] + np.arange(self.dimension), dtype=np.int64)

    def element_at(self, arc: float) -> tuple[int, float]:
        """Element at an arc length and the place xi in it, exactly 0 or 1 at a node: 0, save at the chain's end."""
        if self.nodes == 1:
            return 0, 0.0
        after = int(np.searchsorted(self.arc, arc + 1e-9 * self.arc[-1], side="right")) - 1
        e = min(max(after, 0), self.length.size - 1)
        xi = (arc - self.arc[e]) / self.length[e]
        near = float(np.clip(np.round(xi), 0.0, 1.0))
        return e, near if abs(arc - self.arc[e] - near * self.length[e]) < 1e-9 * self.arc[-1] else float(xi)

    def element_block(self) -> MatrixBlock:
        """Pattern of the field's name: all dofs of each element, or of a single node."""
        elements = max(self.nodes - 1, 1)
        first = self.offset + self.ndof * np.arange(elements, dtype=np.int64)
        dofs = first[:, None] + np.arange(min(2, self.nodes) * self.ndof)
        return MatrixBlock(dofs, dofs)

    def scatter(self, element: Array, values: Array) -> None:
        """Add element arrays (ne, 2 ndof) along the chain to the field's slice of a local array."""
        hermite.scatter(element, self.nodal(values))

    def trial(self, state: State) -> Trial:
        """The nodes at a state, whose arrays must not change from then on.

        Kept for the first state since the last commit, where the step begins, and for the last two.
        """
        return self._trials.made_of(state, self._make_trial)

    def once(self, make: Callable[[Any], Made]) -> Made:
        """What is made of the field for all who ask, when it is first asked for."""
        if make not in self._made:
            self._made[make] = make(self)
        made: Made = self._made[make]
        return made

    def forget(self) -> None:
        """Drop the cached trials."""
        self._trials.forget()

    def _make_trial(self, state: State) -> Trial:
        u = self.nodal(state.u)
        x, chord = after_increments(self.x, self.chord, u)
        turning = self.frames.turning(u[:, self.dimension :])
        return Trial(state, x, chord, turning, (self.nodal(state.v), self.nodal(state.a)))

    @property
    def turns_axes(self) -> bool:
        """In space the rotation dofs are about body axes; in a plane about its normal."""
        return self.dimension == 3

    def in_new_axes(self, conjugate: Array, increments: Array) -> Array:
        """Forces (size,) conjugate to the increments, as those of the step after these increments have them."""
        out = conjugate.copy().reshape(self.nodes, self.ndof)
        turned = increments.reshape(self.nodes, self.ndof)[:, self.dimension :]
        out[:, self.dimension :] = self.frames.in_new_axes(out[:, self.dimension :], turned)
        return out.ravel()

    def magnitudes(self, state: State) -> Array:
        trial, out = self.trial(state), np.empty((self.nodes, self.ndof))
        write_magnitudes(trial.x, trial.turn.turned, out)
        return out.ravel()

    def commit(self, state: State) -> None:
        """Accept the increments of a state; chords sum theirs, so their round-off is not that of far positions."""
        u = self.nodal(state.u)
        self.x, self.chord = after_increments(self.x, self.chord, u)
        self.frames.commit(u[:, self.dimension :])
        self.forget()

    def state(self) -> Saved:
        """Positions, chords and frames."""
        return {"x": self.x, "chord": self.chord} | under("frames", self.frames.state())

    def restore(self, saved: Saved) -> None:
        self.forget()
        self.x, self.chord = saved["x"], saved["chord"]
        self.frames.restore(within(saved, "frames"))


def out_of_plane(across: int, R: Array) -> list[int]:
    """Dofs of a node in space that leave a plane across x (0) or y (1): that translation, and turns about its body axes
    R (3, 3) but for the one across.
    """
    stays = int(np.abs(R[across]).argmax())
    return [across, *(3 + axis for axis in range(3) if axis != stays)]


@njit
def after_increments(x: Array, chord: Array, u: Array) -> tuple[Array, Array]:
    """Positions (nn, d) and chords (ne, d) after the increments u (nn, ndof)."""
    place, along = np.empty(x.shape), np.empty(chord.shape)
    write_moved(x, chord, u, place, along)
    return place, along


@njit
def write_moved(x: Array, chord: Array, u: Array, place: Array, along: Array) -> None:
    """Write positions (nn, d) and chords (ne, d) after the increments u (nn, ndof)."""
    for n in range(x.shape[0]):
        for i in range(x.shape[1]):
            place[n, i] = x[n, i] + u[n, i]
    for e in range(chord.shape[0]):
        for i in range(x.shape[1]):
            along[e, i] = chord[e, i] + (u[e + 1, i] - u[e, i])


@njit
def write_magnitudes(x: Array, turned: Array, out: Array) -> None:
    """Write the sizes (nn, ndof) of the coordinates: of places x (nn, d), and of turns (nn, r) [rad], at least one,
    as cosines and sines of less are no more exact.
    """
    d = x.shape[1]
    for n in range(x.shape[0]):
        for i in range(d):
            out[n, i] = abs(x[n, i])
        for i in range(turned.shape[1]):
            out[n, d + i] = max(abs(turned[n, i]), 1.0)
