"""Node orientations (directors): unit tangents at element ends from rotation dofs, in the plane and in space.

`PlanarFrames` keeps an angle per node, `SpatialFrames` a rotation matrix. Each gives the trial orientation
for a rotation increment as a turn with the same members:

    tangent   unit tangents t at both ends of each element (ne, 2, d)
    P         dt/dTheta (ne, 2, d, r)
    motion    q' and q'' from the rates and accelerations of the dofs; see `hermite`
    maps      P and the derivatives of t', t'' with respect to Theta, rates following by the shifts
    geometric derivative of P^T F with respect to Theta at fixed F

R is the identity in the unstressed configuration. With body-axes angular velocity W and acceleration A,
t = R t0, t' = R (W x t0), t'' = R (A x t0 + W x (W x t0)).
"""

import math

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.saved_state import Saved
from riser_soil.riser import rotations
from riser_soil.riser.hermite import interleave
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

Maps = tuple[Array, Array, Array]
SPACE = fixed(3)


class PlanarOrientation:
    """Trial orientation of a plane line. angle (nn,) [rad], initial angle of element ends alpha0 (ne, 2)."""

    def __init__(self, angle: Array, alpha0: Array) -> None:
        self.angle = angle
        self.end_angle, self.tangent, self.normal = _planar_ends(angle, alpha0)

    def at(self, node: int) -> Array:
        """Orientation of a node: its angle (1,)."""
        return self.angle[node : node + 1]

    @property
    def P(self) -> Array:
        return self.normal[..., None]

    @property
    def wound(self) -> BoolArray:
        """Elements (ne,) whose ends differ by more than half a turn."""
        return np.asarray(np.abs(self.end_angle[:, 1] - self.end_angle[:, 0]) > np.pi)

    def motion(self, v: Array, a: Array) -> tuple[Array, Array]:
        """q' and q'' (ne, 4, 2) from rates and accelerations of the dofs (nn, 3)."""
        rate, acceleration = _planar_motion(self.tangent, self.normal, v, a)
        return rate, acceleration

    def maps(self, v: Array, a: Array, shift_v: float, shift_a: float) -> Maps:
        first, second = _planar_maps(self.tangent, self.normal, v, a, shift_v, shift_a)
        return self.P, first, second

    def geometric(self, F: Array) -> Array:
        """(ne, 2, 1, 1) from the residual conjugate to the tangents, F (ne, 2, 2)."""
        return np.asarray(_planar_geometric(self.tangent, F))

    def state(self) -> Saved:
        """Arrays from which `PlanarFrames.turn_of` restores the orientation."""
        return {"angle": self.angle}


class PlanarFrames:
    """Committed node angles of a plane line; angles grow without limit.

    A trial with its rates and their derivatives costs about 0.6 of one of `SpatialFrames`, and with half the dofs a
    Newton iteration as well; a step costs 0.7 (`benchmarks.twins`).

    angle: (nn,) rad from the unstressed configuration. alpha0: unstressed tangent angle at element ends (ne,
    2).
    """

    dofs = 1

    def __init__(self, angle: Array, alpha0: Array) -> None:
        self.angle, self.alpha0 = angle, alpha0

    def turned(self, orientation: Array, rotation: Array) -> Array:
        """An orientation turned by an angle (1,)."""
        return orientation + rotation

    def rotation(self, first: Array, second: Array) -> Array:
        """Angle (1,) from one orientation to another."""
        return second - first

    def increment(self, node: int, orientation: Array) -> Array:
        """Increment (1,) that brings a node to an orientation."""
        return orientation - self.angle[node]

    def in_body_axes(self, orientation: Array, rate: Array) -> Array:
        """An angular rate (1,) as the dofs have it."""
        return rate

    def turn(self, increment: Array) -> PlanarOrientation:
        return PlanarOrientation(self.angle + increment[:, 0], self.alpha0)

    def in_new_axes(self, moment: Array, increment: Array) -> Array:
        """Moments (nn, 1) conjugate to the increment, as the next one has them."""
        return moment

    def commit(self, increment: Array) -> None:
        self.angle = self.angle + increment[:, 0]

    def turn_of(self, saved: Saved) -> PlanarOrientation:
        return PlanarOrientation(saved["angle"], self.alpha0)

    def state(self) -> Saved:
        return {"angle": self.angle}

    def restore(self, saved: Saved) -> None:
        self.angle = saved["angle"]


class SpatialOrientation:
    """Trial orientation of a line in space; see `SpatialFrames` for the arguments."""

    def __init__(self, Rn: Array, Theta: Array, T0: Array) -> None:
        self.Rn, self.Theta, self.T0 = Rn, Theta, T0
        self.R, self.H, self.frame1, self.frame2, self.tangent, self.P = _orient(Rn, Theta, T0)

    def at(self, node: int) -> Array:
        """Orientation of a node: its frame (3, 3)."""
        return self.R[node]

    @property
    def wound(self) -> BoolArray:
        """Elements (ne,) whose ends turn by increments that differ by more than half a turn."""
        return _wound(self.Theta)

    def motion(self, v: Array, a: Array) -> tuple[Array, Array]:
        """q' and q'' (ne, 4, 3) from rates and accelerations of the dofs (nn, 6), angular ones in body axes."""
        rate, acceleration = _spatial_motion(self.R, self.T0, v, a)
        return rate, acceleration

    def in_space(self, moment: Array, nodes: IntArray) -> Array:
        """Moments (n, 3) in global axes of those conjugate to the rotation increments of some nodes (n,)."""
        return _in_space(self.Rn, self.Theta, moment, nodes)

    def maps(self, v: Array, a: Array, shift_v: float, shift_a: float) -> Maps:
        first, second = _spatial_maps(self.R, self.H, self.T0, v, a, shift_v, shift_a)
        return self.P, first, second

    def geometric(self, F: Array) -> Array:
        """(ne, 2, 3, 3) from the residual conjugate to the tangents, F (ne, 2, 3)."""
        return _spatial_geometric(self.Rn, self.H, self.Theta, self.tangent, F)

    def state(self) -> Saved:
        """Arrays from which `SpatialFrames.turn_of` restores the orientation, to the last bit."""
        return {"R": self.Rn, "increment": self.Theta}


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
        return SpatialOrientation(self.R, np.ascontiguousarray(increment), self.T0)

    def in_new_axes(self, moment: Array, increment: Array) -> Array:
        """Moments (nn, 3) conjugate to the increment, as the next one has them: those in the turned body's axes."""
        return _to_body_axes(moment, increment)

    def commit(self, increment: Array) -> None:
        """Keep R, brought back to a rotation to second order (round-off would pile up over many steps)."""
        self.R = _turned(self.R, increment)

    def turn_of(self, saved: Saved) -> SpatialOrientation:
        return SpatialOrientation(saved["R"], saved["increment"], self.T0)

    def state(self) -> Saved:
        return {"R": self.R}

    def restore(self, saved: Saved) -> None:
        self.R = saved["R"]


Frames = PlanarFrames | SpatialFrames
Orientation = PlanarOrientation | SpatialOrientation


@njit
def _planar_ends(angle: Array, alpha0: Array) -> tuple[Array, Array, Array]:
    """Angle (ne, 2), tangent and normal (ne, 2, 2) of element ends."""
    ne = alpha0.shape[0]
    end_angle, tangent, normal = np.empty((ne, 2)), np.empty((ne, 2, 2)), np.empty((ne, 2, 2))
    for e in range(ne):
        for side in range(2):
            end_angle[e, side] = angle[e + side] + alpha0[e, side]
            cosine, sine = math.cos(end_angle[e, side]), math.sin(end_angle[e, side])
            tangent[e, side, 0], tangent[e, side, 1] = cosine, sine
            normal[e, side, 0], normal[e, side, 1] = -sine, cosine
    return end_angle, tangent, normal


@njit
def _planar_motion(tangent: Array, normal: Array, v: Array, a: Array) -> tuple[Array, Array]:
    ne = tangent.shape[0]
    rate, acceleration = np.empty((ne, 4, 2)), np.empty((ne, 4, 2))
    for e in range(ne):
        for side in range(2):
            w, alpha = v[e + side, 2], a[e + side, 2]
            for i in range(2):
                t, n = tangent[e, side, i], normal[e, side, i]
                rate[e, 2 * side, i], acceleration[e, 2 * side, i] = v[e + side, i], a[e + side, i]
                rate[e, 2 * side + 1, i] = w * n
                acceleration[e, 2 * side + 1, i] = alpha * n - w**2 * t
    return rate, acceleration


@njit
def _planar_maps(
    tangent: Array, normal: Array, v: Array, a: Array, shift_v: float, shift_a: float
) -> tuple[Array, Array]:
    """Derivatives of t' and t'' by the angle, each (ne, 2, 2, 1), from angular rates v and a (nn, 1)."""
    ne = tangent.shape[0]
    first, second = np.empty((ne, 2, 2, 1)), np.empty((ne, 2, 2, 1))
    for e in range(ne):
        for side in range(2):
            w, alpha = v[e + side, 0], a[e + side, 0]
            for i in range(2):
                t, n = tangent[e, side, i], normal[e, side, i]
                first[e, side, i, 0] = shift_v * n - w * t
                second[e, side, i, 0] = (shift_a - w**2) * n - (alpha + 2.0 * shift_v * w) * t
    return first, second


@njit
def _planar_geometric(tangent: Array, F: Array) -> Array:
    """d(n . F)/dangle at fixed F: the normal turns against the tangent."""
    G = np.empty((tangent.shape[0], 2, 1, 1))
    for e in range(tangent.shape[0]):
        for side in range(2):
            G[e, side, 0, 0] = -tangent[e, side, 0] * F[e, side, 0] - tangent[e, side, 1] * F[e, side, 1]
    return G


@njit
def _orient(Rn: Array, Theta: Array, T0: Array) -> tuple[Array, Array, Array, Array, Array, Array]:
    """R and H of the nodes, frames and tangents of the elements' ends, P."""
    R, H = node_frames(Rn, Theta)
    first, second, tangent = end_frames(R, T0)
    return R, H, first, second, tangent, _spatial_P(tangent, H)


@njit
def _in_space(Rn: Array, Theta: Array, moment: Array, nodes: IntArray) -> Array:
    """H^-T m, that is Rn T_R^-1 m."""
    out = np.empty((nodes.size, 3))
    for i in range(nodes.size):
        inverse = transpose(rotations.left_tangent_inverse(vector(Theta[nodes[i]])))
        out[i, 0], out[i, 1], out[i, 2] = matvec(matrix(Rn[nodes[i]]), matvec(inverse, vector(moment[i])))
    return out


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
def _wound(Theta: Array) -> BoolArray:
    wound = np.empty(Theta.shape[0] - 1, dtype=np.bool_)
    for e in range(wound.size):
        turn = sub(vector(Theta[e + 1]), vector(Theta[e]))
        wound[e] = dot(turn, turn) > math.pi**2
    return wound


@njit
def _to_body_axes(moment: Array, Theta: Array) -> Array:
    """T_R^-1 and the turn to the new axes together are the transpose of T_R^-1, that is T_L^-1."""
    out = np.empty_like(moment)
    for i in range(moment.shape[0]):
        turned = matvec(rotations.left_tangent_inverse(vector(Theta[i])), vector(moment[i]))
        out[i, 0], out[i, 1], out[i, 2] = turned
    return out


@njit
def node_frames(Rn: Array, Theta: Array) -> tuple[Array, Array]:
    """R = Rn exp(Theta) and H = Rn T_L(Theta), which gives the spatial spin H dTheta; each (nn, 3, 3)."""
    R, H = np.empty_like(Rn), np.empty_like(Rn)
    for i in range(Rn.shape[0]):
        before, turn = matrix(Rn[i]), vector(Theta[i])
        store(matmul(before, rotations.exp(turn)), R[i])
        store(matmul(before, rotations.left_tangent(turn)), H[i])
    return R, H


@njit
def end_frames(R: Array, T0: Array) -> tuple[Array, Array, Array]:
    """Frames T = R T0 at the first and second end of each element, each (ne, 3, 3), and tangents (ne, 2, 3)."""
    ne = T0.shape[0]
    first, second, tangent = np.empty((ne, 3, 3)), np.empty((ne, 3, 3)), np.empty((ne, 2, 3))
    for e in range(ne):
        store(matmul(matrix(R[e]), matrix(T0[e, 0])), first[e])
        store(matmul(matrix(R[e + 1]), matrix(T0[e, 1])), second[e])
        tangent[e, 0], tangent[e, 1] = first[e, :, 0], second[e, :, 0]
    return first, second, tangent


@njit
def _spatial_P(t: Array, H: Array) -> Array:
    P = np.empty((t.shape[0], 2, 3, 3))
    for e in range(t.shape[0]):
        for side in range(2):
            store(matscale(-1.0, matmul(skew(vector(t[e, side])), matrix(H[e + side]))), P[e, side])
    return P


@njit
def _double_cross(w: Vec, t0: Vec) -> Mat:
    """d(w x (w x t0))/dw."""
    return matadd(isotropic(dot(w, t0)), matadd(outer(w, t0), matscale(-2.0, outer(t0, w))))


@njit
def _spatial_rates(R: Array, T0: Array, v: Array, a: Array) -> tuple[Array, Array]:
    ne = T0.shape[0]
    first, second = np.empty((ne, 2, 3)), np.empty((ne, 2, 3))
    for e in range(ne):
        for side in range(2):
            frame, t0 = matrix(R[e + side]), transpose(matrix(T0[e, side]))[0]
            w, alpha = vector(v[e + side]), vector(a[e + side])
            turning = cross(w, t0)
            first[e, side, 0], first[e, side, 1], first[e, side, 2] = matvec(frame, turning)
            bend = matvec(frame, plus(cross(alpha, t0), cross(w, turning)))
            second[e, side, 0], second[e, side, 1], second[e, side, 2] = bend
    return first, second


@njit
def _spatial_motion(R: Array, T0: Array, v: Array, a: Array) -> tuple[Array, Array]:
    first, second = _spatial_rates(R, T0, v[:, 3:], a[:, 3:])
    return interleave(v, first, SPACE), interleave(a, second, SPACE)


@njit
def _spatial_maps(
    R: Array, H: Array, T0: Array, v: Array, a: Array, shift_v: float, shift_a: float
) -> tuple[Array, Array]:
    """d t'/dTheta = -[t'] H - shift_v R [t0];  d t''/dTheta = -[t''] H - shift_a R [t0] + shift_v R d(W x (W
    x t0))/dW.
    """
    ne = T0.shape[0]
    rates = _spatial_rates(R, T0, v, a)
    first, second = np.empty((ne, 2, 3, 3)), np.empty((ne, 2, 3, 3))
    for e in range(ne):
        for side in range(2):
            frame, spin = matrix(R[e + side]), matrix(H[e + side])
            t0, w = transpose(matrix(T0[e, side]))[0], vector(v[e + side])
            lever = skew(scale(-1.0, t0))
            turned = matmul(skew(scale(-1.0, vector(rates[0][e, side]))), spin)
            store(matadd(turned, matscale(shift_v, matmul(frame, lever))), first[e, side])
            turned = matmul(skew(scale(-1.0, vector(rates[1][e, side]))), spin)
            change = matadd(matscale(shift_a, lever), matscale(shift_v, _double_cross(w, t0)))
            store(matadd(turned, matmul(frame, change)), second[e, side])
    return first, second


@njit
def moment_stiffness(Rn: Mat, Theta: Vec, m: Vec) -> Mat:
    """d(H^T m)/dTheta at fixed spatial moment m."""
    return rotations.right_tangent_derivative(Theta, matvec(transpose(Rn), m))


@njit
def _spatial_geometric(Rn: Array, H: Array, Theta: Array, t: Array, F: Array) -> Array:
    """d(H^T (t x F))/dTheta at fixed F: H turns, and so does t."""
    G = np.empty((t.shape[0], 2, 3, 3))
    for e in range(t.shape[0]):
        for side in range(2):
            node, spin = e + side, matrix(H[e + side])
            tangent, force = vector(t[e, side]), vector(F[e, side])
            turning = matmul(transpose(spin), matmul(matmul(skew(force), skew(tangent)), spin))
            lever = moment_stiffness(matrix(Rn[node]), vector(Theta[node]), cross(tangent, force))
            store(matadd(turning, lever), G[e, side])
    return G
