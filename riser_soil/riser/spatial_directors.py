"""Node orientations (directors) of a line in space: a rotation matrix per node; see `directors`."""

import math
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.saved_state import Saved
from riser_soil.riser import rotations
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    cross,
    dot,
    isotropic,
    matadd,
    matmul,
    matrix,
    matscale,
    matvec,
    outer,
    scale,
    skew,
    store,
    sub,
    transpose,
    vector,
)
from riser_soil.riser.vectors import add as plus


class SpatialOrientation:
    """Trial orientation of a line in space; arguments as of `SpatialFrames`."""

    def __init__(self, Rn: Array, Theta: Array, T0: Array) -> None:
        self.Rn, self.Theta, self.T0 = Rn, Theta, T0
        ne = len(T0)
        self.R, self.H = np.empty_like(Rn), np.empty_like(Rn)
        self.frame1, self.frame2, self.tangent = np.empty((ne, 3, 3)), np.empty((ne, 3, 3)), np.empty((ne, 2, 3))
        self.P = np.empty((ne, 2, 3, 3))
        orient(Rn, Theta, T0, self.R, self.H, self.frame1, self.frame2, self.tangent, self.P)

    def at(self, node: int) -> Array:
        """Orientation of a node: its frame (3, 3)."""
        return self.R[node]

    @property
    def turned(self) -> Array:
        """What the dofs have turned by (nn, 3): the increments, as frames are exact after any number of turns."""
        return self.Theta

    def motion(self, v: Array, a: Array) -> tuple[Array, Array]:
        """q' and q'' (ne, 4, 3) from rates and accelerations of the dofs (nn, 6), angular ones in body axes."""
        rate, acceleration = (np.empty((len(self.T0), 4, 3)) for _ in range(2))
        write_motion(self.R, self.T0, v, a, rate, acceleration)
        return rate, acceleration

    def moment_maps(self, axes: Array, nodes: Sequence[int] | slice = slice(None)) -> Array:
        """Maps H^-T (n, 3, 3) of moments conjugate to the rotation increments to those in global axes; axes: unit."""
        return np.swapaxes(np.linalg.inv(self.H[nodes]), -1, -2)

    def geometric(self, F: Array) -> Array:
        """(ne, 2, 3, 3) from the residual conjugate to the tangents, F (ne, 2, 3)."""
        G = np.empty((len(F), 2, 3, 3))
        write_geometric(self.Rn, self.H, self.Theta, self.tangent, F, G)
        return G


class SpatialFrames:
    """Committed node frames of a line in space.

    R: (nn, 3, 3), identity in the unstressed configuration. T0: unstressed frames at element ends (ne, 2, 3,
    3), their columns tangent and normals.
    """

    dofs = 3

    def __init__(self, R: Array, T0: Array) -> None:
        self.R, self.T0 = np.ascontiguousarray(R), np.ascontiguousarray(T0)

    def turned(self, orientation: Array, rotation: Array) -> Array:
        """An orientation turned by a rotation vector (3,) in global axes."""
        return np.array(rotations.exp(vector(rotation))) @ orientation

    def rotation(self, first: Array, second: Array) -> Array:
        """Rotation vector (3,) in global axes, no longer than pi, from one orientation to another."""
        return np.array(rotations.log(matrix(second @ first.T)))

    def increment(self, node: int, orientation: Array) -> Array:
        """Increment (3,), no longer than pi, that brings a node to an orientation."""
        return np.array(rotations.log(matrix(self.R[node].T @ orientation)))

    def in_body_axes(self, orientation: Array, rate: Array) -> Array:
        """An angular rate (3,) in global axes as the dofs have it."""
        return np.asarray(orientation.T @ rate)

    def turn(self, increment: Array) -> SpatialOrientation:
        return self.turning(increment)()

    def turning(self, increment: Array) -> Callable[[], SpatialOrientation]:
        """What makes the orientation after an increment from where the line is now, whenever it is called."""
        return partial(SpatialOrientation, self.R, np.ascontiguousarray(increment), self.T0)

    def in_new_axes(self, moment: Array, increment: Array) -> Array:
        """Moments (nn, 3) conjugate to the increment, as the next one has them: those in the turned body's axes."""
        return _to_body_axes(moment, increment)

    def commit(self, increment: Array) -> None:
        """Keep R, brought back to a rotation to second order (round-off would pile up over many steps)."""
        self.R = _turned(self.R, increment)

    def state(self) -> Saved:
        return {"R": self.R}

    def restore(self, saved: Saved) -> None:
        self.R = saved["R"]


@njit
def orient(
    Rn: Array, Theta: Array, T0: Array, R: Array, H: Array, first: Array, second: Array, tangent: Array, P: Array
) -> None:
    """Write R and H of the nodes, frames and tangents of the elements' ends, and P."""
    write_node_frames(Rn, Theta, R, H)
    write_end_frames(R, T0, first, second, tangent)
    for e in range(T0.shape[0]):
        for side in range(2):
            store(matscale(-1.0, matmul(skew(vector(tangent[e, side])), matrix(H[e + side]))), P[e, side])


@njit
def _turned(Rn: Array, Theta: Array) -> Array:
    """R = Rn exp(Theta) (nn, 3, 3), rounded to 3 R/2 - R R' R/2."""
    out = np.empty_like(Rn)
    for i in range(Rn.shape[0]):
        R = matmul(matrix(Rn[i]), rotations.exp(vector(Theta[i])))
        square = matmul(R, transpose(R))
        store(matadd(matscale(1.5, R), matscale(-0.5, matmul(square, R))), out[i])
    return out


@njit
def first_wound(Theta: Array) -> int:
    """First element whose ends turn by increments (nn, 3) that differ by more than half a turn; ne without any."""
    ne = Theta.shape[0] - 1
    for e in range(ne):
        turn = sub(vector(Theta[e + 1]), vector(Theta[e]))
        if dot(turn, turn) > math.pi**2:
            return e
    return ne


@njit
def _to_body_axes(moment: Array, Theta: Array) -> Array:
    """T_R^-1 and the turn to the new axes together are the transpose of T_R^-1, that is T_L^-1."""
    out = np.empty_like(moment)
    for i in range(moment.shape[0]):
        turned = matvec(rotations.left_tangent_inverse(vector(Theta[i])), vector(moment[i]))
        out[i, 0], out[i, 1], out[i, 2] = turned
    return out


@njit
def write_node_frames(Rn: Array, Theta: Array, R: Array, H: Array) -> None:
    """Write R = Rn exp(Theta) and H = Rn T_L(Theta), which gives the spatial spin H dTheta; each (nn, 3, 3)."""
    for i in range(Rn.shape[0]):
        before, turn = matrix(Rn[i]), vector(Theta[i])
        store(matmul(before, rotations.exp(turn)), R[i])
        store(matmul(before, rotations.left_tangent(turn)), H[i])


@njit
def write_end_frames(R: Array, T0: Array, first: Array, second: Array, tangent: Array) -> None:
    """Write frames T = R T0 at the first and second end of each element, each (ne, 3, 3), and tangents (ne, 2, 3)."""
    for e in range(T0.shape[0]):
        store(matmul(matrix(R[e]), matrix(T0[e, 0])), first[e])
        store(matmul(matrix(R[e + 1]), matrix(T0[e, 1])), second[e])
        for i in range(3):
            tangent[e, 0, i], tangent[e, 1, i] = first[e, i, 0], second[e, i, 0]


@njit
def _double_cross(w: Vec, t0: Vec) -> Mat:
    """d(w x (w x t0))/dw."""
    return matadd(isotropic(dot(w, t0)), matadd(outer(w, t0), matscale(-2.0, outer(t0, w))))


@njit
def _end_rates(R: Mat, t0: Vec, w: Vec, alpha: Vec) -> tuple[Vec, Vec]:
    """t' and t'' of one end from the angular velocity and acceleration in body axes."""
    turning = cross(w, t0)
    return matvec(R, turning), matvec(R, plus(cross(alpha, t0), cross(w, turning)))


@njit
def _t0(T0: Array) -> Vec:
    """Unstressed tangent of an end with the frame T0 (3, 3)."""
    return (T0[0, 0], T0[1, 0], T0[2, 0])


@njit
def write_motion(R: Array, T0: Array, v: Array, a: Array, rate: Array, acceleration: Array) -> None:
    """Write q' and q'' (ne, 4, 3) from rates and accelerations of the dofs (nn, 6), angular ones in body axes."""
    for e in range(T0.shape[0]):
        for side in range(2):
            n, at = e + side, 2 * side + 1
            turned = _end_rates(matrix(R[n]), _t0(T0[e, side]), vector(v[n, 3:]), vector(a[n, 3:]))
            rate[e, at, 0], rate[e, at, 1], rate[e, at, 2] = turned[0]
            acceleration[e, at, 0], acceleration[e, at, 1], acceleration[e, at, 2] = turned[1]
            for i in range(3):
                rate[e, 2 * side, i], acceleration[e, 2 * side, i] = v[n, i], a[n, i]


@njit
def write_maps(
    R: Array,
    H: Array,
    T0: Array,
    v: Array,
    a: Array,
    shift_v: float,
    shift_a: float,
    first: Array,
    second: Array,
) -> None:
    """Write d t'/dTheta = -[t'] H - shift_v R [t0] and d t''/dTheta = -[t''] H - shift_a R [t0] + shift_v R d(W x (W
    x t0))/dW, each (ne, 2, 3, 3), from angular rates and accelerations v and a (nn, 3).
    """
    for e in range(T0.shape[0]):
        for side in range(2):
            frame, spin = matrix(R[e + side]), matrix(H[e + side])
            t0, w = _t0(T0[e, side]), vector(v[e + side])
            rate, acceleration = _end_rates(frame, t0, w, vector(a[e + side]))
            lever = skew(scale(-1.0, t0))
            turned = matmul(skew(scale(-1.0, rate)), spin)
            store(matadd(turned, matscale(shift_v, matmul(frame, lever))), first[e, side])
            turned = matmul(skew(scale(-1.0, acceleration)), spin)
            change = matadd(matscale(shift_a, lever), matscale(shift_v, _double_cross(w, t0)))
            store(matadd(turned, matmul(frame, change)), second[e, side])


@njit
def write_geometric(Rn: Array, H: Array, Theta: Array, t: Array, F: Array, G: Array) -> None:
    """Write d(H^T (t x F))/dTheta (ne, 2, 3, 3) at fixed F (ne, 2, 3): H turns, and so does t."""
    for e in range(t.shape[0]):
        for side in range(2):
            node, spin = e + side, matrix(H[e + side])
            tangent, force = vector(t[e, side]), vector(F[e, side])
            turning = matmul(transpose(spin), matmul(matmul(skew(force), skew(tangent)), spin))
            lever = rotations.moment_stiffness(matrix(Rn[node]), vector(Theta[node]), cross(tangent, force))
            store(matadd(turning, lever), G[e, side])
