"""Joints between nodes of lines and bodies: the part "joints".

A joint holds two points together, each on an arm s = R r that turns with its node, and their directions: with the gap
g = xa + sa - xb - sb and the rotation phi of the first node against the second from where both are at rest it has the
energy

    k g.g/2 + kr phi.phi/2,    phi = log(Ra C Rb^T),    C = Ra(0)^T exp(q) Rb(0).

At rest they stand as the joint is made, but for two ends of lines, whose axes become one: q turns the second there.

So it acts on both with opposite forces k g and moments kr phi, and what is conjugate to the nodes' rotation vectors is
H^T (s x F + M), H their spin. Its tangent is the Hessian of the energy, exact and symmetric.

Rigid joints are such springs too, `STIFF` times as stiff as the elements that they join: they give as much as a
hundredth of an element does, in all kinds of joints alike, at ends, arcs and bodies, with no other unknowns and no rows
of another kind in the matrix. Dofs that two lines share would leave no gap where ends are pinned, but do not serve for
arms, clamped ends and bodies, where the axes of rotations differ.
`open`: the share of the first gap and of q that a joint still lacks, while lines and bodies come together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.bodies.body import MovingBody
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.riser import rotations
from riser_soil.riser.line import Line
from riser_soil.riser.rotations import moment_stiffness
from riser_soil.riser.spatial_directors import SpatialFrames, SpatialOrientation
from riser_soil.riser.vectors import (
    Mat,
    add,
    cross,
    dot,
    isotropic,
    matadd,
    matmul,
    matrix,
    matvec,
    scale,
    skew,
    sub,
    transpose,
    vecmat,
    vector,
)

STIFF = 100.0  # times EA/l and 4 EI/l of the stiffest element beside a rigid joint
NAME = "joints"


class Side(NamedTuple):
    """A node of a line or body, and the arm (3,) [m] of its point, in the node's axes."""

    field: Line | MovingBody
    node: int
    arm: Array


@dataclass(frozen=True, eq=False)
class JointOf:
    """A joint of two sides with its stiffness k [N/m] and kr [N.m/rad], 0 for none."""

    name: str
    sides: tuple[Side, Side]
    translation: float
    rotation: float


class Laws(NamedTuple):
    """k, kr (m,); arm (m, 2, 3). As the joints were made: first (m, 2, 3, 3), frames; turn (m, 3), q; gap (m, 3)."""

    k: Array
    kr: Array
    arm: Array
    first: Array
    turn: Array
    gap: Array


class JointPlaces(NamedTuple):
    """Nodes of the joints: x, Theta (m, 2, 3); R, H, Rn (m, 2, 3, 3)."""

    x: Array
    Theta: Array
    R: Array
    H: Array
    Rn: Array


class Joints:
    """All joints of a scene (group F), made in the lines' and bodies' present configuration.

    stays: of each, whether the second point stays where it is, on an arm of the first node; else it comes to the first.
    """

    name = NAME
    traits = Traits("F", symmetric=True)

    def __init__(self, joints: Sequence[JointOf], stays: Sequence[bool]) -> None:
        self.joints, self.open = joints, 0.0
        self.active = joints[0].sides[0].field.active
        at = self._places(None)
        arm = np.array([[side.arm for side in joint.sides] for joint in joints])
        for n, second_stays in enumerate(stays):
            if second_stays:
                there = at.x[n, 1] + at.R[n, 1] @ arm[n, 1]
                arm[n, 0] = at.R[n, 0].T @ (there - at.x[n, 0])
        k, kr = (np.array([getattr(joint, name) for joint in joints]) for name in ("translation", "rotation"))
        turn = np.array([_to_one_axis(*joint.sides) if joint.rotation else np.zeros(3) for joint in joints])
        laws = Laws(k, kr, arm, at.R.copy(), turn, np.zeros((len(joints), 3)))
        self.laws = laws._replace(gap=gaps(laws, at, 0.0))

    @property
    def first_gap(self) -> Array:
        """Distances (m,) [m] of the points as the joints were made."""
        return np.asarray(np.linalg.norm(self.laws.gap, axis=1))

    @property
    def first_turn(self) -> Array:
        """Angles (m,) [rad] by which the second sides turn to be at rest."""
        return np.asarray(np.linalg.norm(self.laws.turn, axis=1))

    def _places(self, state: State | None) -> JointPlaces:
        """At a state; None for the accepted one."""
        sides = [side for joint in self.joints for side in joint.sides]
        m = len(self.joints)
        if state is None:
            x, R = (np.array([get(side) for side in sides]) for get in (_place, _frame))
            R = R.reshape(m, 2, 3, 3)
            return JointPlaces(x.reshape(m, 2, 3), np.zeros((m, 2, 3)), R, R, R)
        places = [_look(side, state) for side in sides]
        x, Theta, R, H, Rn = (np.array(values) for values in zip(*places, strict=True))
        vectors, frames = (m, 2, 3), (m, 2, 3, 3)
        return JointPlaces(
            x.reshape(vectors), Theta.reshape(vectors), R.reshape(frames), H.reshape(frames), Rn.reshape(frames)
        )

    @property
    def dofs(self) -> IntArray:
        """Local numbers (m, 12) of the dofs of both nodes."""
        sides = [side for joint in self.joints for side in joint.sides]
        first = np.array([side.field.offset + side.node * side.field.ndof for side in sides], dtype=np.int64)
        return np.asarray((first[:, None] + np.arange(6)).reshape(-1, 12))

    def blocks(self) -> dict[str, MatrixBlock]:
        dofs = self.dofs
        return {NAME: MatrixBlock(dofs, dofs)}

    def residual(self, state: State, forces: Forces) -> None:
        np.add.at(forces.force, self.dofs, conjugate(self.laws, self._places(state), self.open_share_at(state.t)))

    def open_share_at(self, t: float) -> float:
        """Share of the first gap that is open: in the static stage in which joints close it falls to none."""
        return self.open * (1.0 - t)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        add_tangent(values[NAME], weights.force, self.laws, self._places(state), self.open_share_at(state.t))

    def energy(self, state: State) -> Energy:
        return Energy(strain=float(energy_of(self.laws, self._places(state), self.open_share_at(state.t))))

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        """Joints have no history."""

    def acting(self, state: State) -> tuple[Array, Array, Array]:
        """Forces [N] and moments [N.m] on the second node of each joint, at its point (m, 3), and gaps (m, 3) [m]."""
        at = self._places(state)
        share = self.open_share_at(state.t)
        gap = gaps(self.laws, at, share)
        moment = self.laws.kr[:, None] * turns(self.laws, at, share)
        return self.laws.k[:, None] * gap, moment, gap


def _to_one_axis(first: Side, second: Side) -> Array:
    """Rotation vector (3,) of the second of two ends of lines that makes its axis go on along the first's; zero of
    others.
    """
    axes = [_axis(side) for side in (first, second)]
    if axes[0] is None or axes[1] is None:
        return np.zeros(3)
    ahead, onward = axes[0], -axes[1]
    across = np.cross(onward, ahead)
    sine = float(np.linalg.norm(across))
    return np.asarray(across * (np.arctan2(sine, float(onward @ ahead)) / sine if sine > 0.0 else 1.0))


def _axis(side: Side) -> Array | None:
    """Direction (3,) from an end out of its line; None of other places."""
    field = side.field
    if not isinstance(field, Line) or side.node not in (0, field.nodes - 1):
        return None
    frames, last = field.frames, side.node > 0
    assert isinstance(frames, SpatialFrames)
    tangent = frames.R[side.node] @ frames.T0[-1 if last else 0, int(last), :, 0]
    return np.asarray(tangent if last else -tangent)


def _place(side: Side) -> Array:
    return np.asarray(side.field.x[side.node])


def _frame(side: Side) -> Array:
    frames = side.field.frames
    assert isinstance(frames, SpatialFrames)  # a scene with joints is one in space
    return np.asarray(frames.R[side.node])


def _look(side: Side, state: State) -> tuple[Array, ...]:
    """x, Theta, R, H and Rn of a node at a state."""
    trial, n = side.field.trial(state), side.node
    turn = trial.turn
    assert isinstance(turn, SpatialOrientation)
    return trial.x[n], turn.Theta[n], turn.R[n], turn.H[n], turn.Rn[n]


@njit
def gaps(laws: Laws, at: JointPlaces, share: float) -> Array:
    """g (m, 3), less the share of the first one that is open."""
    out = np.empty((laws.k.size, 3))
    for j in range(laws.k.size):
        first = add(vector(at.x[j, 0]), matvec(matrix(at.R[j, 0]), vector(laws.arm[j, 0])))
        second = add(vector(at.x[j, 1]), matvec(matrix(at.R[j, 1]), vector(laws.arm[j, 1])))
        gap = sub(sub(first, second), scale(share, vector(laws.gap[j])))
        out[j, 0], out[j, 1], out[j, 2] = gap
    return out


@njit
def turns(laws: Laws, at: JointPlaces, share: float) -> Array:
    """phi (m, 3), with the share of q that is open."""
    out = np.zeros((laws.k.size, 3))
    for j in range(laws.k.size):
        if laws.kr[j] > 0.0:
            rest = matmul(rotations.exp(scale(1.0 - share, vector(laws.turn[j]))), matrix(laws.first[j, 1]))
            C = matmul(transpose(matrix(laws.first[j, 0])), rest)
            turn = matmul(matrix(at.R[j, 0]), matmul(C, transpose(matrix(at.R[j, 1]))))
            out[j, 0], out[j, 1], out[j, 2] = rotations.log(turn)
    return out


@njit
def energy_of(laws: Laws, at: JointPlaces, share: float) -> float:
    gap, turn, twice = gaps(laws, at, share), turns(laws, at, share), 0.0
    for j in range(laws.k.size):
        twice += laws.k[j] * dot(vector(gap[j]), vector(gap[j])) + laws.kr[j] * dot(vector(turn[j]), vector(turn[j]))
    return 0.5 * twice


@njit
def conjugate(laws: Laws, at: JointPlaces, share: float) -> Array:
    """Forces (m, 12) conjugate to the dofs of both nodes."""
    gap, turn, out = gaps(laws, at, share), turns(laws, at, share), np.empty((laws.k.size, 12))
    for j in range(laws.k.size):
        for side in range(2):
            sign = 1.0 - 2.0 * side
            force, moment = scale(sign * laws.k[j], vector(gap[j])), scale(sign * laws.kr[j], vector(turn[j]))
            arm = matvec(matrix(at.R[j, side]), vector(laws.arm[j, side]))
            on_node = vecmat(add(cross(arm, force), moment), matrix(at.H[j, side]))
            for i in range(3):
                out[j, 6 * side + i], out[j, 6 * side + 3 + i] = force[i], on_node[i]
    return out


@njit
def add_tangent(K: Array, weight: float, laws: Laws, at: JointPlaces, share: float) -> None:
    """Add weight times the derivative of `conjugate` to K (m, 12, 12)."""
    gap, turn = gaps(laws, at, share), turns(laws, at, share)
    gap_by, turn_by, signs = np.zeros((3, 12)), np.zeros((3, 12)), np.array([1.0, -1.0])
    for j in range(laws.k.size):
        k, kr, phi = laws.k[j], laws.kr[j], vector(turn[j])
        inverse = rotations.left_tangent_inverse(phi)
        for side in range(2):
            H, arm = matrix(at.H[j, side]), matvec(matrix(at.R[j, side]), vector(laws.arm[j, side]))
            of_spin = inverse if side == 0 else transpose(inverse)  # T_L^-1 exp(phi) is the transpose of T_L^-1
            _write_columns(gap_by, 6 * side, signs[side], isotropic(1.0))
            _write_columns(gap_by, 6 * side + 3, -signs[side], matmul(skew(arm), H))
            _write_columns(turn_by, 6 * side + 3, signs[side], matmul(of_spin, H))
            force, moment = scale(signs[side] * k, vector(gap[j])), scale(signs[side] * kr, phi)
            both = add(cross(arm, force), moment)
            lever = moment_stiffness(matrix(at.Rn[j, side]), vector(at.Theta[j, side]), both)
            own = matadd(matmul(transpose(H), matmul(matmul(skew(force), skew(arm)), H)), lever)
            for row in range(3):
                for column in range(3):
                    K[j, 6 * side + 3 + row, 6 * side + 3 + column] += weight * own[row][column]
        for row in range(12):
            for column in range(12):
                for i in range(3):
                    K[j, row, column] += weight * k * gap_by[i, row] * gap_by[i, column]
        if kr > 0.0:
            for side in range(2):
                H = matrix(at.H[j, side])
                for row in range(3):
                    for column in range(12):
                        for i in range(3):
                            share = signs[side] * H[i][row] * turn_by[i, column]
                            K[j, 6 * side + 3 + row, column] += weight * kr * share


@njit
def _write_columns(out: Array, first: int, sign: float, values: Mat) -> None:
    """Write sign times a matrix to the columns from `first` on."""
    for i in range(3):
        for column in range(3):
            out[i, first + column] = sign * values[i][column]
