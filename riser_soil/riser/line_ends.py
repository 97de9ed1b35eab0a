"""What a line's ends hold: which dofs, where their supports have turned to, and the motion that they prescribe.

Rigid-body motions that the supports leave free, such as a turn about the chord between the ends, take no energy where
the loads do not depend on the direction.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, as_list
from riser_soil.core.compiled import njit
from riser_soil.core.saved_state import Saved
from riser_soil.riser.directors import Frames, Orientation
from riser_soil.riser.spatial_directors import SpatialOrientation

Kinematics = tuple[Array, Array, Array]
Motion = Callable[[float], Kinematics]
"""Seconds since the stage began (load factor in statics) -> position, velocity, acceleration (3,) in global
axes.
"""


class SupportRotation(NamedTuple):
    """A support turned from where it is at the stage's beginning, each (3,) in global axes.

    rotation: rotation vector [rad]; about one axis it may count whole turns. angular_velocity [rad/s],
    angular_acceleration [rad/s2].
    """

    rotation: Array
    angular_velocity: Array
    angular_acceleration: Array


@dataclass
class End:
    """Boundary condition of an end.

    motion, when given, moves the prescribed position; without it the end stays where it is. turning, of the seconds
    since the stage began, turns the support: a fixed rotation turns with it, and so does the rest direction of a
    rotational spring. A free rotation is not affected. heaves: whether a prescribed end is free to move up and down, so
    that the horizontal part of its motion alone moves it.
    """

    prescribed: bool
    rotation_fixed: bool = False
    motion: Motion | None = None
    turning: Callable[[float], SupportRotation] | None = None
    heaves: bool = False

    def fixed_coordinates(self, dimension: int) -> int:
        """Number of its coordinates that are prescribed: the first ones, as the vertical one is the last."""
        return (dimension - self.heaves) if self.prescribed else 0


class LineEnds:
    """The ends of a line of some nodes, whose axes are constant: origin (3,), basis (3, d), turning_axes (3, r).

    prescribed (size,): of the line's dofs. Supports turn from where they were at the stage's beginning.
    """

    def __init__(
        self, start: End, end: End, nodes: int, frames: Frames, origin: Array, basis: Array, turning_axes: Array
    ) -> None:
        self._ends, self._nodes, self._frames = ((0, start), (nodes - 1, end)), nodes, frames
        self._origin, self._basis, self._turning_axes = origin, basis, turning_axes
        self._dimension = basis.shape[1]
        self._ndof = self._dimension + frames.dofs
        unturned = frames.turn(np.zeros((nodes, frames.dofs)))
        self._supports = self._bases = {node: unturned.at(node).copy() for node, _ in self._ends}
        self._motions: dict[int, tuple[Motion, float, Array, Array]] = {}
        self._fixed: list[int] = []  # dofs of all nodes that are prescribed not to move
        self.prescribe_spin(False)

    def fix(self, dofs: list[int]) -> None:
        """Prescribe that some dofs of all nodes do not move."""
        self._fixed = dofs
        self.prescribe_spin(False)

    def prescribe_spin(self, spin: bool) -> None:
        """Whether the start of a line in space is kept from spinning about the pipe's axis; until the next call."""
        prescribed, d = np.zeros((self._nodes, self._ndof), dtype=bool), self._dimension
        for node, end in self._ends:
            prescribed[node, : end.fixed_coordinates(d)] = True
            prescribed[node, d:] = end.rotation_fixed
        prescribed[0, d] |= spin and d == 3
        prescribed[:, self._fixed] = True
        self._prescribe(prescribed.ravel())

    def _prescribe(self, prescribed: BoolArray) -> None:
        self.prescribed = prescribed
        edges = np.flatnonzero(np.diff(prescribed, prepend=False, append=False))
        self._runs = [slice(*run) for run in as_list(edges.reshape(-1, 2))]  # of dofs that are prescribed

    @contextmanager
    def all_prescribed(self) -> Iterator[None]:
        """While the context lasts all dofs are prescribed not to move."""
        free = self.prescribed
        self._prescribe(np.ones(free.size, dtype=bool))
        try:
            yield
        finally:
            self._prescribe(free)

    def begin_stage(self) -> None:
        """Supports turn from where they are now."""
        self._bases = self._supports

    def turn_support(self, node: int, rotation: Array) -> None:
        """Turn the support of a node by a rotation vector (3,) in global axes, before anything moves."""
        self._supports[node] = self._frames.turned(self._supports[node], rotation @ self._turning_axes)

    def support(self, node: int, t: float) -> Array:
        """Orientation of the support of the first or last node, as the turn's `at` gives that of the node: the node's
        own at first, then turned by the support's rotation.
        """
        turning, base = dict(self._ends)[node].turning, self._bases[node]
        return base if turning is None else self._frames.turned(base, turning(t).rotation @ self._turning_axes)

    def spread(self, t: float, x: Array, moved: Array, reach: dict[int, Array]) -> None:
        """Add what is missing of the ends' motion to increments (nn, ndof) of nodes at x (nn, d).

        reach: by end, the share (nn,) that each node takes.
        """
        for node, motion, count in self._moving():
            _spread_motion(moved, node, self._motion(node, motion, t, x)[0], count, reach[node])

    def prescribe(self, t: float, x: Array, u: Array, v: Array, a: Array) -> None:
        """Write increments, rates and accelerations of prescribed dofs into the field's slices; nodes at x (nn, d)."""
        for run in self._runs:
            u[run] = v[run] = a[run] = 0.0
        for node, motion, count in self._moving():
            at = slice(node * self._ndof, node * self._ndof + count)
            u[at], v[at], a[at] = self._motion(node, motion, t, x)[:, :count]
        for node, end in self._ends:
            if end.rotation_fixed and end.turning is not None:
                self._turn(node, end.turning(t), self.support(node, t), (u, v, a))

    def _moving(self) -> Iterator[tuple[int, Motion, int]]:
        """Nodes whose place is prescribed, with their motion and the number of their coordinates that are."""
        for node, end in self._ends:
            if end.prescribed and end.motion is not None:
                yield node, end.motion, end.fixed_coordinates(self._dimension)

    def _motion(self, node: int, motion: Motion, t: float, x: Array) -> Array:
        """Increment, velocity and acceleration (3, d), in the line's axes, by which a motion moves its node; cached by
        time and place.
        """
        cached = self._motions.get(node)
        if cached is None or cached[0] is not motion or cached[1] != t or cached[2] is not x:
            rows = _motion_in_axes(np.array(motion(t)), self._origin, self._basis, x[node])
            cached = self._motions[node] = motion, t, x, rows
        return cached[3]

    def _turn(self, node: int, turning: SupportRotation, support: Array, values: tuple[Array, Array, Array]) -> None:
        """Write the increment, rate and acceleration of a rotation that follows its support."""
        at = slice(node * self._ndof + self._dimension, (node + 1) * self._ndof)
        u, v, a = values
        u[at] = self._frames.increment(node, support)
        v[at] = self._frames.in_body_axes(support, turning.angular_velocity @ self._turning_axes)
        a[at] = self._frames.in_body_axes(support, turning.angular_acceleration @ self._turning_axes)

    def commit(self, t: float) -> None:
        """Supports are where they have turned to."""
        turned = {node: self.support(node, t) for node, end in self._ends if end.turning is not None}
        if turned:
            self._supports = self._supports | turned

    def state(self) -> Saved:
        """Orientations of the supports, now and at the stage's beginning."""
        supports, bases = (np.stack([at[node] for node, _ in self._ends]) for at in (self._supports, self._bases))
        return {"supports": supports, "bases": bases}

    def restore(self, saved: Saved) -> None:
        nodes = [node for node, _ in self._ends]
        self._supports, self._bases = (dict(zip(nodes, saved[name], strict=True)) for name in ("supports", "bases"))


@njit
def _spread_motion(moved: Array, node: int, to: Array, count: int, reach: Array) -> None:
    """Add the rest of a node's motion `to` (d,) to the first coordinates of increments (nn, ndof), by shares (nn,)."""
    for i in range(count):
        rest = to[i] - moved[node, i]
        for n in range(moved.shape[0]):
            moved[n, i] += reach[n] * rest


@njit
def _motion_in_axes(motion: Array, origin: Array, basis: Array, start: Array) -> Array:
    """Displacement, velocity and acceleration (3, d) in the axes of a line: of a motion (3, 3), its place first, from
    where the node is, `start` (d,).
    """
    out = np.zeros((3, basis.shape[1]))
    for k in range(3):
        for i in range(basis.shape[1]):
            for j in range(3):
                out[k, i] += (motion[k, j] - (origin[j] if k == 0 else 0.0)) * basis[j, i]
    for i in range(basis.shape[1]):
        out[0, i] -= start[i]
    return out


STILL = 1e-9  # of the line's length, or a radian: what moves less does not move


def free_turns(x: Array, turn: Orientation, prescribed: BoolArray, length: float) -> Array:
    """Increments (k, nn, d + r) of independent rigid motions that move no prescribed dof; in space sections may spin.

    x (nn, d): positions; prescribed (nn, d + r). length: the line's [m]; also the largest displacement of each motion.
    None where an increment turns a node by more than half a turn: near a whole one rotation vectors have no rates.
    """
    if isinstance(turn, SpatialOrientation) and np.linalg.norm(turn.Theta, axis=1).max() > math.pi:
        return np.zeros((0, *prescribed.shape))
    motions = _rigid_motions(x, turn, length)
    units = unit_lengths(x.shape, motions.shape[2], length)
    motions /= units
    none = np.zeros((len(motions), 1))
    _, sizes, combined = np.linalg.svd(np.hstack([motions[:, prescribed], none]).T)
    free = _independent(combined[np.count_nonzero(sizes > STILL) :] @ motions.reshape(len(motions), -1))
    free = free.reshape(-1, *units.shape)
    largest = np.abs(free[..., : x.shape[1]]).max(axis=(1, 2), initial=0.0)
    moving = largest > STILL
    return np.asarray(free[moving] / largest[moving][:, None, None] * units)


def _independent(motions: Array) -> Array:
    """Orthonormal motions (k, n) that make up the same ones: a straight line spins as it turns about itself."""
    _, sizes, basis = np.linalg.svd(motions, full_matrices=False)
    return np.asarray(basis[sizes > STILL])


def unit_lengths(shape: tuple[int, ...], dofs: int, length: float) -> Array:
    """Units that make translations [m] and rotations comparable (nn, d + r): the line's length, and one."""
    nodes, d = shape
    units = np.ones((nodes, dofs))
    units[:, :d] = length
    return units


def _rigid_motions(x: Array, turn: Orientation, length: float) -> Array:
    """Shifts by the length and turns by a radian about the first node; in space also a spin about the tangents."""
    nodes, d = x.shape
    arm, shifts = x - x[0], [np.tile(length * axis, (nodes, 1)) for axis in np.eye(d)]
    if not isinstance(turn, SpatialOrientation):
        turned, still = np.stack([-arm[:, 1], arm[:, 0]], axis=1), np.zeros((nodes, 1))
        return np.stack([np.hstack([moved, still]) for moved in shifts] + [np.hstack([turned, still + 1.0])])
    tangents = np.concatenate([turn.tangent[:, 0], turn.tangent[-1:, 1]])
    spins = np.concatenate([np.zeros((3, nodes, 3)), np.repeat(np.eye(3)[:, None], nodes, axis=1), tangents[None]])
    moved = np.zeros((7, nodes, 3))
    moved[:3] = shifts
    moved[3:6] = np.cross(spins[3:6], arm)
    rotated = np.linalg.solve(turn.H, spins.transpose(1, 2, 0)).transpose(2, 0, 1)
    return np.concatenate([moved, rotated], axis=2)
