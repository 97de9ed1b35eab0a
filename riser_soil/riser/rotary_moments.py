"""Rotary inertia moments of element ends in space, their derivatives and kinetic energy (Euler's equations).

An end has the inertia tensor J [kg m2] in its node's body axes, where Euler's equations for the angular velocity W
and acceleration A give the moment

    m = J A + W x J W,

conjugate to the body-axes spin. With the node's frame R = Rn exp[Theta] that spin is T_R(Theta) dTheta, so that
T_L(Theta) m is conjugate to the rotation vector. Arrays of nodes: Theta, W, A (nn, 3); of ends: J (ne, 2, 3, 3).
"""

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.rotations import left_tangent, right_tangent_derivative
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    add,
    cross,
    dot,
    matadd,
    matmul,
    matrix,
    matscale,
    matvec,
    scale,
    skew,
    vector,
)


@njit
def _moment(J: Mat, W: Vec, A: Vec) -> Vec:
    return add(matvec(J, A), cross(W, matvec(J, W)))


@njit
def _moment_derivative(J: Mat, W: Vec, shift_v: float, shift_a: float) -> Mat:
    """dm/dTheta, the rates following by the shifts."""
    gyroscopic = matadd(matmul(skew(W), J), matscale(-1.0, skew(matvec(J, W))))
    return matadd(matscale(shift_a, J), matscale(shift_v, gyroscopic))


@njit
def moments(J: Array, Theta: Array, W: Array, A: Array) -> Array:
    """Residual (ne, 2, 3) conjugate to the rotation vectors."""
    out = np.empty((J.shape[0], 2, 3))
    for e in range(J.shape[0]):
        for side in range(2):
            out[e, side, 0], out[e, side, 1], out[e, side, 2] = end_moment(J, e, side, Theta, W, A)
    return out


@njit
def end_moment(J: Array, e: int, side: int, Theta: Array, W: Array, A: Array) -> Vec:
    """That of one end."""
    n = e + side
    m = _moment(matrix(J[e, side]), vector(W[n]), vector(A[n]))
    return matvec(left_tangent(vector(Theta[n])), m)


@njit
def add_tangent(
    K: Array, weight: float, J: Array, Theta: Array, W: Array, A: Array, shift_v: float, shift_a: float
) -> None:
    """Add weight times the derivative of `moments` to K (ne, 12, 12)."""
    for e in range(J.shape[0]):
        for side in range(2):
            n, at, tensor = e + side, 3 + 6 * side, matrix(J[e, side])
            rotation, spin = vector(Theta[n]), vector(W[n])
            m = _moment(tensor, spin, vector(A[n]))
            turning = matscale(-1.0, right_tangent_derivative(scale(-1.0, rotation), m))  # T_L(x) = T_R(-x)
            rates = matmul(left_tangent(rotation), _moment_derivative(tensor, spin, shift_v, shift_a))
            change = matadd(turning, rates)
            for i in range(3):
                for j in range(3):
                    K[e, at + i, at + j] += weight * change[i][j]


@njit
def kinetic_energy(J: Array, W: Array) -> float:
    """Kinetic energy [J] of all ends."""
    twice = 0.0
    for e in range(J.shape[0]):
        for side in range(2):
            spin = vector(W[e + side])
            twice += dot(spin, matvec(matrix(J[e, side]), spin))
    return 0.5 * twice
