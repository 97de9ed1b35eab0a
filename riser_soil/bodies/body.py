"""A body: one node that moves, and turns where it is rigid. Its dofs are those of a node of a line in space.

As much of it is in the water as of a sphere of the same volume about its centre of buoyancy. With the height h of the
water's surface above the centre, over the radius of that sphere, eta from -1 (dry) to 1 (wet), the wet share of a
sphere is s = (2 + 3 eta - eta^3)/4, whose slope is zero at both ends.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.identity_cache import IdentityCache
from riser_soil.core.part import MatrixBlock, State
from riser_soil.core.saved_state import Saved, under, within
from riser_soil.riser.line import Trial
from riser_soil.riser.line_kernels import write_magnitudes
from riser_soil.riser.spatial_directors import SpatialFrames, SpatialOrientation

AXES = ("x", "y", "z")
NO_ENDS: Array = np.zeros((0, 2, 3, 3))


class MovingBody:
    """Field of a body: displacements [m], and of a rigid one a rotation vector [rad] in body axes.

    position (3,): where the origin of its axes is at first [m]; these are the global ones then. turns: whether it is
    rigid, with six degrees of freedom, else a point with three. lever: arm by which moments are weighed as forces [m].
    active: whether this rank evaluates and owns it.
    Its rates and accelerations are those of a node of a line, see `core.part.State`.
    """

    dimension, nodes = 3, 1

    def __init__(self, name: str, position: Array, turns: bool, lever: float, active: bool = True) -> None:
        self.name = self.space = name
        self.active = active
        self.x: Array = np.array(position, dtype=float)[None]
        self.frames, self.turns, self.lever = SpatialFrames(np.eye(3)[None], NO_ENDS), turns, lever
        self.ndof = self.size = 6 if turns else 3
        self.offset = 0
        self.global_index: IntArray = np.arange(self.size, dtype=np.int64)
        self.owned: BoolArray = np.full(self.size, active)
        self.prescribed: BoolArray = np.zeros(self.size, dtype=bool)
        self._trials = IdentityCache[State, Trial](first=1, latest=2)

    @property
    def turns_axes(self) -> bool:
        return self.turns

    @property
    def part(self) -> slice:
        """The field's slice of local arrays."""
        return slice(self.offset, self.offset + self.size)

    @property
    def translation_dofs(self) -> IntArray:
        return self.offset + np.arange(3, dtype=np.int64)[None]

    def nodal(self, values: Array) -> Array:
        """View (1, ndof) of the body's slice of a local array."""
        return values[self.part][None]

    def block(self) -> MatrixBlock:
        """Pattern of the body's name: all its dofs."""
        dofs = self.offset + np.arange(self.size, dtype=np.int64)[None]
        return MatrixBlock(dofs, dofs)

    def trial(self, state: State) -> Trial:
        """The body at a state, whose arrays must not change from then on."""
        return self._trials.made_of(state, self._make_trial)

    def _make_trial(self, state: State) -> Trial:
        u = self.nodal(state.u)
        turned = u[:, 3:] if self.turns else np.zeros((1, 3))
        rates = self.nodal(state.v), self.nodal(state.a)
        return Trial(state, self.x + u[:, :3], np.zeros((0, 3)), self.frames.turning(turned), rates)

    def place(self, point: Array) -> Array:
        """Where a point (3,) in body axes is at the accepted state (3,) [m]."""
        return np.asarray(self.x[0] + self.frames.R[0] @ point)

    @contextmanager
    def held(self) -> Iterator[None]:
        """As long as this lasts it does not move."""
        free, self.prescribed = self.prescribed, np.ones(self.size, dtype=bool)
        try:
            yield
        finally:
            self.prescribed = free

    def hold(self, held: bool) -> None:
        """Whether it is kept from moving; until the next call."""
        self.prescribed = np.full(self.size, held)

    def prescribe(self, t: float, u: Array, v: Array, a: Array) -> None:
        for values in (u, v, a):
            values[self.prescribed] = 0.0

    def predict(self, guess: State) -> Array:
        return guess.u.copy()

    def inadmissible(self, state: State, before: State | None = None) -> str:
        return ""

    def in_new_axes(self, conjugate: Array, increments: Array) -> Array:
        """Moments in the axes that the body has turned to."""
        out = conjugate.copy()
        if self.turns:
            out[3:] = self.frames.in_new_axes(conjugate[None, 3:], increments[None, 3:])[0]
        return out

    def free_turns(self, state: State) -> Array:
        """Motions (k, size) in each direction by the lever, and about each axis by a radian; none of a body held."""
        if self.prescribed.any():
            return np.zeros((0, self.size))
        motions = np.zeros((self.size, self.size))
        motions[:3, :3] = self.lever * np.eye(3)
        if self.turns:
            turn = self.trial(state).turn
            assert isinstance(turn, SpatialOrientation)
            motions[3:, 3:] = np.linalg.inv(turn.H[0]).T
        return motions

    def in_newtons(self, forces: Array) -> Array:
        out = forces.copy()
        out[3:] /= self.lever
        return out

    def magnitudes(self, state: State) -> Array:
        out, turned = np.empty((1, self.ndof)), self.nodal(state.u)[:, 3:]
        write_magnitudes(self.trial(state).x, np.ascontiguousarray(turned), out)
        return out.ravel()

    def commit(self, state: State) -> None:
        u = self.nodal(state.u)
        self.x = self.x + u[:, :3]
        if self.turns:
            self.frames.commit(np.ascontiguousarray(u[:, 3:]))
        self._trials.forget()

    def state(self) -> Saved:
        return {"x": self.x} | under("frames", self.frames.state())

    def restore(self, saved: Saved) -> None:
        self._trials.forget()
        self.x = saved["x"]
        self.frames.restore(within(saved, "frames"))

    def describe(self, entry: int) -> str:
        """ "body buoy, force z"."""
        kind = "force" if entry < 3 else "moment"
        return f"body {self.name}, {kind} {AXES[entry % 3]}"


def radius_of(volume: float) -> float:
    """Of a sphere of a volume [m3]."""
    return float((3.0 * volume / (4.0 * math.pi)) ** (1.0 / 3.0))


def wet(h: float, radius: float) -> tuple[float, float]:
    """s at a height h [m] and its slope [1/m]; without a volume it is 0 above the surface and 1 below."""
    if radius == 0.0:
        return float(h > 0.0), 0.0
    eta = min(1.0, max(-1.0, h / radius))
    return 0.25 * (2.0 + 3.0 * eta - eta**3), 0.75 * (1.0 - eta**2) / radius


def wet_height(h: float, radius: float) -> float:
    """The integral of s over h [m], zero in the air."""
    if h >= radius:
        return h
    eta = max(-1.0, h / radius) if radius > 0.0 else -1.0
    return radius * (0.5 * eta + 0.375 * eta**2 - 0.0625 * eta**4 + 0.1875)
