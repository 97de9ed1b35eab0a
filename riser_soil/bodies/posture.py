"""A body in a configuration, and forces and moments in its own axes as they act on its dofs."""

from __future__ import annotations

from typing import NamedTuple

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser import rotations
from riser_soil.riser.configuration import SpatialConfiguration
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    matadd,
    matmul,
    matrix,
    matscale,
    matvec,
    scale,
    skew,
    transpose,
    vecmat,
    vector,
)

NONE: Mat = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


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
    """Of the body whose configuration this is."""
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
def by_axes(a: Vec, b: Vec) -> Vec:
    """Products of components."""
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])


@njit
def scaled_rows(a: Vec, A: Mat) -> Mat:
    """diag(a) A."""
    return (scale(a[0], A[0]), scale(a[1], A[1]), scale(a[2], A[2]))
