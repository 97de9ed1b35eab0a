"""A body: one node that moves, and turns where it is rigid, what it is made of, and forces in its own axes on its dofs.

It is a line of one node in space, without elements.

As much of it is in the water as of a sphere of the same volume about its centre of buoyancy. With the height h of the
water's surface above the centre, over the radius of that sphere, eta from -1 (dry) to 1 (wet), the wet share of a
sphere is s = (2 + 3 eta - eta^3)/4, whose slope is zero at both ends.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.compiled import njit
from riser_soil.core.part import State
from riser_soil.core.sphere import radius_of
from riser_soil.riser import rotations
from riser_soil.riser.configuration import SpatialConfiguration
from riser_soil.riser.moving_nodes import MovingNodes, out_of_plane
from riser_soil.riser.rotations import moment_stiffness
from riser_soil.riser.spatial_directors import SpatialFrames, SpatialOrientation
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    add,
    cross,
    matadd,
    matmul,
    matrix,
    matscale,
    matvec,
    scale,
    skew,
    sub,
    transpose,
    vecmat,
    vector,
)

AXES = ("x", "y", "z")
NONE: Mat = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


class MovingBody(MovingNodes):
    """Field of a body: displacements [m] and a rotation vector [rad] in body axes, which a point keeps at zero.

    position (3,): where the origin of its axes is at first [m]; these are the global ones then. turns: whether it is
    rigid, else a point. lever: arm by which moments are weighed as forces [m].
    Its rates and accelerations are those of a node of a line, see `core.part.State`.
    """

    frames: SpatialFrames
    prescribed: BoolArray

    def __init__(self, name: str, position: Array, turns: bool, lever: float, active: bool = True) -> None:
        frames = SpatialFrames(np.eye(3)[None], np.zeros((0, 2, 3, 3)))
        super().__init__(name, np.array(position, dtype=float)[None], frames, np.zeros(1), np.eye(3), active)
        self.turns, self.lever = turns, lever
        self._fixed: list[int] = []
        self.fix(False)

    def place(self, point: Array) -> Array:
        """Where a point (3,) in body axes is at the accepted state (3,) [m]."""
        return np.asarray(self.x[0] + self.frames.R[0] @ point)

    @contextmanager
    def all_prescribed(self) -> Iterator[None]:
        """While the context lasts the body does not move."""
        free, self.prescribed = self.prescribed, np.ones(self.size, dtype=bool)
        try:
            yield
        finally:
            self.prescribed = free

    def fix(self, fixed: bool) -> None:
        """Fix all of its dofs, or let it move; until the next call."""
        self.prescribed = np.full(self.size, fixed)
        self.prescribed[3:] |= not self.turns
        self.prescribed[self._fixed] = True

    def keep_in_plane(self, across: int) -> None:
        """Keep it in its plane across x (0) or y (1)."""
        self._fixed = out_of_plane(across, self.frames.R[0])
        self.fix(False)

    def prescribe(self, t: float, u: Array, v: Array, a: Array) -> None:
        for values in (u, v, a):
            values[self.prescribed] = 0.0

    def predict(self, guess: State) -> Array:
        return guess.u.copy()

    def inadmissible(self, state: State, before: State | None = None) -> str:
        return ""

    def free_turns(self, state: State) -> Array:
        """Motions (k, size) in each direction by the lever, and about each axis by a radian; none of a fixed body."""
        motions = np.zeros((self.size, self.size))
        motions[:3, :3] = self.lever * np.eye(3)
        turn = self.trial(state).turn
        assert isinstance(turn, SpatialOrientation)
        motions[3:, 3:] = np.linalg.inv(turn.H[0]).T
        return motions[~self.prescribed]

    def in_newtons(self, forces: Array) -> Array:
        out = forces.copy()
        out[3:] /= self.lever
        return out

    def describe(self, entry: int) -> str:
        """ "body buoy, force z"."""
        kind = "force" if entry < 3 else "moment"
        return f"body {self.name}, {kind} {AXES[entry % 3]}"


@dataclass(frozen=True, eq=False)
class BodyProperties:
    """mass [kg]; inertia (3,) about the centre of gravity [kg.m2]; gravity_centre, buoyancy_centre (3,) [m]; volume
    [m3]; drag (3,): CdA [m2]; spin_drag (3,) [m5]; added_mass (3,) [kg]; added_inertia (3,) about the centre of
    buoyancy [kg.m2]; by body axes. Of a point what turns is zero.
    """

    mass: float
    inertia: Array
    gravity_centre: Array
    volume: float
    buoyancy_centre: Array
    drag: Array
    spin_drag: Array
    added_mass: Array
    added_inertia: Array

    @property
    def radius(self) -> float:
        return radius_of(self.volume)

    def mass_matrix(self) -> Array:
        """M (6, 6) about the origin of the body's axes."""
        own = _about_origin(self.mass * np.eye(3), np.diag(self.inertia), self.gravity_centre)
        return own + _about_origin(np.diag(self.added_mass), np.diag(self.added_inertia), self.buoyancy_centre)


def _about_origin(mass: Array, inertia: Array, centre: Array) -> Array:
    """Matrix (6, 6) about the origin of a mass matrix (3, 3) at a centre that moves with b + W x c, and an inertia (3,
    3) about it.
    """
    lever = -_skew(centre)
    return np.block([[mass, mass @ lever], [lever.T @ mass, inertia + lever.T @ mass @ lever]])


def _skew(v: Array) -> Array:
    return np.array(skew(vector(v)))


@njit
def wet(h: float, radius: float) -> tuple[float, float]:
    """s at a height h [m] and its slope [1/m]; without a volume it is 0 above the surface and 1 below."""
    if radius == 0.0:
        return (1.0 if h > 0.0 else 0.0), 0.0
    eta = min(1.0, max(-1.0, h / radius))
    return 0.25 * (2.0 + 3.0 * eta - eta**3), 0.75 * (1.0 - eta**2) / radius


@njit
def wet_height(h: float, radius: float) -> float:
    """The integral of s over h [m], zero in the air."""
    if h >= radius:
        return h
    eta = max(-1.0, h / radius) if radius > 0.0 else -1.0
    return radius * (0.5 * eta + 0.375 * eta**2 - 0.0625 * eta**4 + 0.1875)


class Posture(NamedTuple):
    """A body in a configuration: place, rates and accelerations of translation and rotation; frame R and spin H, and T,
    which gives the spin in the body's own axes.
    """

    x: Vec
    v: Vec
    a: Vec
    W: Vec
    A: Vec
    R: Mat
    H: Mat
    T: Mat


@njit
def posture(at: SpatialConfiguration) -> Posture:
    """Place, rates and rotation of a body in a configuration."""
    R, H = matrix(at.frames[0]), matrix(at.H[0])
    rates = vector(at.v[0, :3]), vector(at.a[0, :3]), vector(at.v[0, 3:]), vector(at.a[0, 3:])
    return Posture(vector(at.x[0]), *rates, R, H, matmul(transpose(R), H))


class Changes(NamedTuple):
    """Derivatives of a force and a moment in body axes by the place and by the rotation dofs."""

    force_by_place: Mat
    force_by_turn: Mat
    moment_by_place: Mat
    moment_by_turn: Mat


@njit
def add_in_body_axes(at: Posture, force: Vec, moment: Vec, out: Array) -> None:
    """Add R f and T_L m of a force and a moment about the origin, both in body axes, to the dofs' (6,)."""
    add_to_dofs(out, matvec(at.R, force), vecmat(moment, at.T))


@njit
def add_to_dofs(out: Array, force: Vec, moment: Vec) -> None:
    """Add what is conjugate to the dofs (6,)."""
    for i in range(3):
        out[i] += force[i]
        out[3 + i] += moment[i]


@njit
def add_changes(K: Array, weight: float, at: Posture, Theta: Vec, force: Vec, moment: Vec, by: Changes) -> None:
    """Add weight times the derivative of what `add_in_body_axes` adds to K (6, 6)."""
    T = transpose(at.T)
    force_by_turn = matadd(matmul(at.R, by.force_by_turn), matscale(-1.0, matmul(skew(matvec(at.R, force)), at.H)))
    turned = rotations.right_tangent_derivative(scale(-1.0, Theta), moment)  # T_L(x) = T_R(-x)
    moment_by_turn = matadd(matmul(T, by.moment_by_turn), matscale(-1.0, turned))
    by_place = matmul(at.R, by.force_by_place), matmul(T, by.moment_by_place)
    add_blocks(K, weight, by_place[0], force_by_turn, by_place[1], moment_by_turn)


@njit
def add_blocks(K: Array, weight: float, xx: Mat, xt: Mat, tx: Mat, tt: Mat) -> None:
    """Add weight times a matrix (6, 6) by its blocks."""
    for i in range(3):
        for j in range(3):
            K[i, j] += weight * xx[i][j]
            K[i, 3 + j] += weight * xt[i][j]
            K[3 + i, j] += weight * tx[i][j]
            K[3 + i, 3 + j] += weight * tt[i][j]


@njit
def add_tangent_at(
    K: Array, weight: float, at: Posture, Rn: Mat, Theta: Vec, arm: Vec, force: Vec, by_place: Mat
) -> None:
    """Add weight times the derivative of a force in global axes at an arm, and of its moment, to K (6, 6).

    by_place: derivative of the force by the place of the arm's end. Rn, Theta: frame at the step's start and rotation.
    """
    end_by_turn = matscale(-1.0, matmul(skew(arm), at.H))  # place of the arm's end, by the rotation dofs
    back, by_turn = transpose(end_by_turn), matmul(by_place, end_by_turn)
    own = matmul(transpose(at.H), matmul(matmul(skew(force), skew(arm)), at.H))
    turning = matadd(matmul(back, by_turn), matadd(own, moment_stiffness(Rn, Theta, cross(arm, force))))
    add_blocks(K, weight, by_place, by_turn, matmul(back, by_place), turning)


@njit
def way_by_increments(first: SpatialConfiguration, last: SpatialConfiguration, arm: Vec) -> Vec:
    """What a force at the end of an arm is multiplied by in the work of a step's increments [m].

    It is the way of the arm's end but for terms of second order in the rotation of the step.
    """
    turned = matvec(matrix(last.H[0]), vector(last.Theta[0]))
    return add(sub(vector(last.x[0]), vector(first.x[0])), cross(turned, arm))


@njit
def by_axes(a: Vec, b: Vec) -> Vec:
    """Products of components."""
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])


@njit
def scaled_rows(a: Vec, A: Mat) -> Mat:
    """diag(a) A."""
    return (scale(a[0], A[0]), scale(a[1], A[1]), scale(a[2], A[2]))
