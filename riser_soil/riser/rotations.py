"""Finite rotations: exponential, logarithm and tangent maps of a rotation vector, and element arrays by its changes.

Rotation vectors Theta are in rad. With R = Rn exp[Theta], a change dTheta turns the frame by the spatial spin
w = Rn T_L(Theta) dTheta, which is T_R(Theta) dTheta in the frame's own axes; T_R is the transpose of T_L.
With theta = |Theta|, a = sin(theta)/theta, b = (1 - cos(theta))/theta^2, c = (theta - sin(theta))/theta^3:

    exp[Theta] = I + a [Theta] + b [Theta]^2,    T_L = I + b [Theta] + c [Theta]^2,
    T_L^-1 = I - [Theta]/2 + k [Theta]^2,        k = (1 - (theta/2) cot(theta/2))/theta^2.

Vectors are tuples (or arrays) of three numbers, matrices tuples of three rows: see `vectors`.
Source: Cardona & Geradin, A beam finite element non-linear theory with finite rotations, Int. J. Numer. Meth.
Engng 26 (1988).

Element forces and tangents by spatial spins are changed to those by rotation vectors. A node's frame is R = Rn
exp[Theta]; its spin is w = H dTheta with H = Rn T_L(Theta). Element e joins nodes e and e + 1, its dofs are ordered
displacement1, rotation1, displacement2, rotation2. Arrays are changed in place.
"""

import math

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    cross,
    dot,
    isotropic,
    matadd,
    matrix,
    matscale,
    matvec,
    outer,
    skew,
    transpose,
    vecmat,
    vector,
)

SERIES_BELOW = 0.25  # theta^2 under which the closed forms lose digits and the power series have converged
BERNOULLI = (  # |B_2n| / (2n)!, n = 8, 7, ..., 1: the coefficients of theta^(2n-2) in k
    3617.0 / 10670622842880000.0,
    1.0 / 74724249600.0,
    691.0 / 1307674368000.0,
    1.0 / 47900160.0,
    1.0 / 1209600.0,
    1.0 / 30240.0,
    1.0 / 720.0,
    1.0 / 12.0,
)
SMALLEST_SINE_SQUARED = 1e-20  # sin^2(theta/2) under which its arc sine equals it to round-off


@njit
def exp_coefficients(x: float) -> tuple[float, float, float]:
    """(a, b, c) of the exponential and its tangent maps at x = theta^2."""
    if x < SERIES_BELOW:
        # each power series as b0 (1 - x/r1 (1 - x/r2 (...)))
        c = 1.0 - x / 42.0 * (1.0 - x / 72.0 * (1.0 - x / 110.0 * (1.0 - x / 156.0 * (1.0 - x / 210.0))))
        c = (1.0 - x / 20.0 * c) / 6.0
        b = 1.0 - x / 30.0 * (1.0 - x / 56.0 * (1.0 - x / 90.0 * (1.0 - x / 132.0 * (1.0 - x / 182.0))))
        return 1.0 - x * c, 0.5 * (1.0 - x / 12.0 * b), c
    theta = math.sqrt(x)
    a = math.sin(theta) / theta
    half_sine = math.sin(0.5 * theta)
    return a, 2.0 * half_sine * half_sine / x, (1.0 - a) / x


@njit
def exp_slopes(x: float) -> tuple[float, float]:
    """(db/dtheta, dc/dtheta)/theta at x = theta^2, so that the gradients of b and c are these times Theta."""
    if x < SERIES_BELOW:
        db = -1.0 / 12.0 + x * (1.0 / 180.0 - x * (1.0 / 6720.0 - x * (1.0 / 453600.0 - x / 47900160.0)))
        dc = -1.0 / 60.0 + x * (1.0 / 1260.0 - x * (1.0 / 60480.0 - x * (1.0 / 4989600.0 - x / 622702080.0)))
        return db, dc
    a, b, c = exp_coefficients(x)
    return (a - 2.0 * b) / x, (b - 3.0 * c) / x


@njit
def inverse_coefficient(x: float) -> float:
    """k of the inverse tangent map at x = theta^2; singular at theta = 2 pi."""
    if x < SERIES_BELOW:
        k = 0.0
        for coefficient in BERNOULLI:
            k = k * x + coefficient
        return k
    theta = math.sqrt(x)
    return (1.0 - 0.5 * theta / math.tan(0.5 * theta)) / x


@njit
def _polynomial(one: float, linear: float, square: float, v: Vec) -> Mat:
    """one I + linear [v] + square [v]^2, with [v]^2 = v v' - |v|^2 I."""
    diagonal = isotropic(one - square * dot(v, v))
    return matadd(matadd(diagonal, matscale(linear, skew(v))), matscale(square, outer(v, v)))


@njit
def _double_cross_derivative(v: Vec, m: Vec) -> Mat:
    """d(v x (v x m))/dv."""
    return matadd(isotropic(dot(v, m)), matadd(outer(v, m), matscale(-2.0, outer(m, v))))


@njit
def exp(rotation: Vec) -> Mat:
    """The rotation matrix of a rotation vector (rad)."""
    a, b, _ = exp_coefficients(dot(rotation, rotation))
    return _polynomial(1.0, a, b, rotation)


@njit
def left_tangent(rotation: Vec) -> Mat:
    """T_L: rate of the rotation vector to spatial spin."""
    _, b, c = exp_coefficients(dot(rotation, rotation))
    return _polynomial(1.0, b, c, rotation)


@njit
def left_tangent_inverse(rotation: Vec) -> Mat:
    """Inverse of T_L, for rotations below 2 pi."""
    return _polynomial(1.0, -0.5, inverse_coefficient(dot(rotation, rotation)), rotation)


@njit
def right_tangent_derivative(rotation: Vec, m: Vec) -> Mat:
    """d(T_R(Theta) m)/dTheta at fixed m, the geometric stiffness of a moment m given in the unturned axes. T_R, the
    transpose of T_L: rate of the rotation vector to spin in the rotated axes.
    """
    _, b, c = exp_coefficients(dot(rotation, rotation))
    db, dc = exp_slopes(dot(rotation, rotation))
    once = cross(rotation, m)
    twice = cross(rotation, once)
    change = (dc * twice[0] - db * once[0], dc * twice[1] - db * once[1], dc * twice[2] - db * once[2])
    linear = matadd(matscale(b, skew(m)), matscale(c, _double_cross_derivative(rotation, m)))
    return matadd(linear, outer(change, rotation))


@njit
def quaternion(R: Mat) -> tuple[float, float, float, float]:
    """Unit quaternion (w, x, y, z), w >= 0, of a rotation matrix.

    Divides by its largest component, so it is accurate for every angle (Spurrier, J. Spacecraft 15, 1978).
    """
    xx, yy, zz = R[0][0], R[1][1], R[2][2]
    trace = xx + yy + zz
    if trace >= max(xx, yy, zz):
        w4 = 2.0 * math.sqrt(1.0 + trace)
        return 0.25 * w4, (R[2][1] - R[1][2]) / w4, (R[0][2] - R[2][0]) / w4, (R[1][0] - R[0][1]) / w4
    if xx >= yy and xx >= zz:
        x4 = 2.0 * math.sqrt(1.0 + xx - yy - zz)
        w, x, y, z = (R[2][1] - R[1][2]) / x4, 0.25 * x4, (R[1][0] + R[0][1]) / x4, (R[2][0] + R[0][2]) / x4
    elif yy >= zz:
        y4 = 2.0 * math.sqrt(1.0 + yy - zz - xx)
        w, x, y, z = (R[0][2] - R[2][0]) / y4, (R[1][0] + R[0][1]) / y4, 0.25 * y4, (R[2][1] + R[1][2]) / y4
    else:
        z4 = 2.0 * math.sqrt(1.0 + zz - xx - yy)
        w, x, y, z = (R[1][0] - R[0][1]) / z4, (R[0][2] + R[2][0]) / z4, (R[2][1] + R[1][2]) / z4, 0.25 * z4
    sign = -1.0 if w < 0.0 else 1.0
    return sign * w, sign * x, sign * y, sign * z


@njit
def log(R: Mat) -> Vec:
    """Rotation vector (rad), no longer than pi, of a rotation matrix."""
    w, x, y, z = quaternion(R)
    square = x * x + y * y + z * z
    if square < SMALLEST_SINE_SQUARED:
        factor = 2.0 / w
    else:
        sine = math.sqrt(square)
        factor = 2.0 * math.atan2(sine, w) / sine
    return (factor * x, factor * y, factor * z)


@njit
def _moment_to_increments(moment: Array, H: Mat) -> None:
    m = vecmat(vector(moment), H)
    moment[0], moment[1], moment[2] = m


@njit
def element_to_increments(e: int, f: Array, H: Array) -> None:
    """Turn the moments in f (12,) of element e, conjugate to spins, into those of rotation vectors; H: (nn, 3, 3)."""
    _moment_to_increments(f[3:6], matrix(H[e]))
    _moment_to_increments(f[9:12], matrix(H[e + 1]))


@njit
def _rotate_columns(K: Array, H: Mat) -> None:
    """K (12, 3) becomes K H."""
    for i in range(12):
        row = vecmat(vector(K[i]), H)
        K[i, 0], K[i, 1], K[i, 2] = row


@njit
def _moment_tangent(Rn: Mat, Theta: Vec, moment: Vec) -> Mat:
    """d(H' m)/dTheta of a spatially fixed moment."""
    return right_tangent_derivative(Theta, vecmat(moment, Rn))


@njit
def _end_to_increments(K: Array, at: int, moment: Vec, H: Mat, Rn: Mat, Theta: Vec) -> None:
    """Transform the rows and columns at..at+2 of K (12, 12), and add the change of H at fixed moment."""
    _rotate_columns(K[:, at : at + 3], H)
    rows_to_increments(K, at, moment, H, Rn, Theta)


@njit
def rows_to_increments(K: Array, at: int, moment: Vec, H: Mat, Rn: Mat, Theta: Vec) -> None:
    """Turn the rows at..at+2 of K (12, 12), those of a spatial moment, into those conjugate to the rotation vector."""
    _rotate_columns(K[at : at + 3].T, H)
    geometric = _moment_tangent(Rn, Theta, moment)
    for i in range(3):
        for j in range(3):
            K[at + i, at + j] += geometric[i][j]


@njit
def tangent_to_increments(e: int, f: Array, K: Array, H: Array, Rn: Array, Theta: Array) -> None:
    """Turn the tangent K (12, 12) of element e by spins, where its forces are f (12,), into that by rotation vectors.

    H, Rn (nn, 3, 3) and Theta (nn, 3) belong to the nodes. K becomes the Hessian of the strain energy.
    """
    for end in range(2):
        n, at = e + end, 3 + 6 * end
        moment = vector(f[at : at + 3])
        _end_to_increments(K, at, moment, matrix(H[n]), matrix(Rn[n]), vector(Theta[n]))


@njit
def moment_stiffness(Rn: Mat, Theta: Vec, m: Vec) -> Mat:
    """d(H^T m)/dTheta at fixed spatial moment m."""
    return right_tangent_derivative(Theta, matvec(transpose(Rn), m))
