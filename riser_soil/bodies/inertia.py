"""Inertia of a body with added mass, at an instant and over a step of the midpoint rule: the part "body inertia".

The origin of the body's axes is at x, its frame is R, its spin H dTheta, v and W its rates. In body axes the origin has
the velocity b = R^T v, and with the mass matrix M (6, 6) of b and W, added mass included, the momenta are
(P, L) = M (b, W). Kirchhoff's equations give the force and moment

    f = P' + W x P,    m = L' + W x L + b x P,    b' = R^T a - W x b,

so that no energy is made, however different the added masses are (Lamb, Hydrodynamics, 1932, art. 124). Conjugate to
the dofs are R f and T_L(Theta) m. The added mass meets the body's own velocity, and is that of all of it.

A step of the midpoint rule has, with the momenta p = R P and l = R L in global axes at its ends,

    f = (p1 - p0)/dt,    m = (l1 - l0)/dt + v x (p0 + p1)/2,    v = (x1 - x0)/dt,

so that the change of l + x x p is the moment about a fixed point of the forces in the middle, exactly. With
(W0 + W1)/2 = Theta/dt of the step's rotation vector Theta, along which both ends' axes agree, a body that turns about
its centre keeps its energy, too (compare Simo & Wong, Int. J. Numer. Meth. Engng 31 (1991)); beside it, and with added
masses that differ, energy errs in second order, without a drift, as the step is the same backwards.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.bodies.body import (
    NONE,
    Changes,
    MovingBody,
    Posture,
    add_blocks,
    add_changes,
    add_in_body_axes,
    add_to_dofs,
    posture,
)
from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.part import State, Traits, Weights
from riser_soil.core.roles import Starting
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.riser import rotations
from riser_soil.riser.configuration import Maps, SpatialConfiguration
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent
from riser_soil.riser.rotations import moment_stiffness
from riser_soil.riser.vectors import (
    Mat,
    Vec,
    add,
    cross,
    dot,
    isotropic,
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


class InertiaData(NamedTuple):
    """M (6, 6), of `BodyProperties`."""

    M: Array


@njit
def _momenta(part: InertiaData, b: Vec, W: Vec) -> tuple[Vec, Vec]:
    """M times the rates of translation b and rotation W, or times their accelerations."""
    M = part.M
    linear = add(matvec(matrix(M[:3, :3]), b), matvec(matrix(M[:3, 3:]), W))
    return linear, add(matvec(matrix(M[3:, :3]), b), matvec(matrix(M[3:, 3:]), W))


@njit
def _momenta_by(part: InertiaData, b: Mat, W: Mat) -> tuple[Mat, Mat]:
    """M times derivatives of the rates of translation b (3, n) and rotation W (3, n), or of the accelerations."""
    M = part.M
    linear = matadd(matmul(matrix(M[:3, :3]), b), matmul(matrix(M[:3, 3:]), W))
    return linear, matadd(matmul(matrix(M[3:, :3]), b), matmul(matrix(M[3:, 3:]), W))


@njit
def _inertial(part: InertiaData, at: Posture) -> tuple[Vec, Vec, Vec, Vec, Vec]:
    """b, P, L, and the force and moment in body axes."""
    b = vecmat(at.v, at.R)
    P, L = _momenta(part, b, at.W)
    force, moment = _momenta(part, sub(vecmat(at.a, at.R), cross(at.W, b)), at.A)
    return b, P, L, add(force, cross(at.W, P)), add(moment, add(cross(at.W, L), cross(b, P)))


@add_forces.of(InertiaData)
def _add_inertia(part: InertiaData, at: SpatialConfiguration, out: LineForces) -> None:
    here = posture(at)
    _, _, _, force, moment = _inertial(part, here)
    add_in_body_axes(here, force, moment, out.inertia[0])


@add_tangent.of(InertiaData)
def _add_tangent_of_inertia(
    part: InertiaData, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array
) -> None:
    here, shift_v, shift_a = posture(at), weights.shift_v, weights.shift_a
    b, P, L, force, moment = _inertial(part, here)
    inverse, spin, drift = transpose(here.R), skew(here.W), skew(b)
    b_by_place, b_by_turn = matscale(shift_v, inverse), matmul(drift, here.T)
    rate_by_place = matadd(matscale(shift_a, inverse), matscale(-1.0, matmul(spin, b_by_place)))
    rate_by_turn = matmul(skew(vecmat(here.a, here.R)), here.T)
    rate_by_turn = matadd(rate_by_turn, matadd(matscale(shift_v, drift), matscale(-1.0, matmul(spin, b_by_turn))))
    P_by_place, L_by_place = _momenta_by(part, b_by_place, NONE)
    P_by_turn, L_by_turn = _momenta_by(part, b_by_turn, isotropic(shift_v))
    force_by_place, moment_by_place = _momenta_by(part, rate_by_place, NONE)
    force_by_turn, moment_by_turn = _momenta_by(part, rate_by_turn, isotropic(shift_a))
    by_spin_P, by_spin_L, turned = matscale(-shift_v, skew(P)), matscale(-shift_v, skew(L)), matscale(-1.0, skew(P))
    by = Changes(
        matadd(force_by_place, matmul(spin, P_by_place)),
        matadd(force_by_turn, matadd(matmul(spin, P_by_turn), by_spin_P)),
        matadd(
            matadd(moment_by_place, matmul(spin, L_by_place)),
            matadd(matmul(drift, P_by_place), matmul(turned, b_by_place)),
        ),
        matadd(
            matadd(moment_by_turn, matadd(matmul(spin, L_by_turn), by_spin_L)),
            matadd(matmul(drift, P_by_turn), matmul(turned, b_by_turn)),
        ),
    )
    add_changes(K[0], weights.inertia, here, vector(at.Theta[0]), force, moment, by)


@add_energy.of(InertiaData)
def _add_kinetic(part: InertiaData, at: SpatialConfiguration, energy: Array) -> None:
    here = posture(at)
    b = vecmat(here.v, here.R)
    P, L = _momenta(part, b, here.W)
    energy[0] += 0.5 * (dot(b, P) + dot(here.W, L))


class BodyInertia(CompiledPart):
    """Mass, inertia and added mass (group I), see the module's text. M: of `BodyProperties`."""

    name = "body inertia"
    traits = Traits("I", symmetric=False)

    def __init__(self, body: MovingBody, M: Array) -> None:
        super().__init__(body)
        self.M = M

    def make_kernel_data(self) -> InertiaData | MidpointInertiaData:
        return InertiaData(self.M)


class MidpointInertiaData(NamedTuple):
    """At an instant, and elapsed (1,): from a step's start to its middle [s], zero between steps."""

    instant: InertiaData
    elapsed: Array


class StepEnd(NamedTuple):
    """Where a step begins or ends: velocity v and frame R, momenta in global axes."""

    v: Vec
    R: Mat
    linear: Vec
    angular: Vec


@njit
def _end_of_step(part: MidpointInertiaData, at: SpatialConfiguration, after: float) -> StepEnd:
    """By the middle of the step: of its end for `after` 1, of its start for -1."""
    here, half = posture(at), after * part.elapsed[0]
    R = matmul(matrix(at.Rn[0]), rotations.exp(scale(1.0 + after, vector(at.Theta[0]))))
    v, W = add(here.v, scale(half, here.a)), add(here.W, scale(half, here.A))
    P, L = _momenta(part.instant, vecmat(v, R), W)
    return StepEnd(v, R, matvec(R, P), matvec(R, L))


@njit
def _over_step(part: MidpointInertiaData, at: SpatialConfiguration, start: StepEnd, end: StepEnd) -> tuple[Vec, Vec]:
    """Force and moment in global axes."""
    by, mean = 0.5 / part.elapsed[0], scale(0.5, add(start.linear, end.linear))
    moment = add(scale(by, sub(end.angular, start.angular)), cross(vector(at.v[0, :3]), mean))
    return scale(by, sub(end.linear, start.linear)), moment


@add_forces.of(MidpointInertiaData)
def _add_inertia_over_step(part: MidpointInertiaData, at: SpatialConfiguration, out: LineForces) -> None:
    if part.elapsed[0] == 0.0:
        add_forces(part.instant, at, out)
    else:
        start, end = _end_of_step(part, at, -1.0), _end_of_step(part, at, 1.0)
        force, moment = _over_step(part, at, start, end)
        add_to_dofs(out.inertia[0], force, vecmat(moment, matrix(at.H[0])))


@add_tangent.of(MidpointInertiaData)
def _add_tangent_over_step(
    part: MidpointInertiaData, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array
) -> None:
    if part.elapsed[0] == 0.0:
        add_tangent(part.instant, at, maps, weights, K)
    else:
        start, end = _end_of_step(part, at, -1.0), _end_of_step(part, at, 1.0)
        _, moment = _over_step(part, at, start, end)
        Rn, Theta, H = matrix(at.Rn[0]), vector(at.Theta[0]), matrix(at.H[0])
        follows, by = weights.shift_v + part.elapsed[0] * weights.shift_a, 0.5 / part.elapsed[0]
        spin, inverse = matscale(2.0, matmul(Rn, rotations.left_tangent(scale(2.0, Theta)))), transpose(end.R)
        by_place = _momenta_by(part.instant, matscale(follows, inverse), NONE)
        by_turn = _momenta_by(part.instant, matmul(inverse, matmul(skew(end.v), spin)), isotropic(follows))
        p_by_place, l_by_place = matmul(end.R, by_place[0]), matmul(end.R, by_place[1])
        p_by_turn = matadd(matmul(end.R, by_turn[0]), matscale(-1.0, matmul(skew(end.linear), spin)))
        l_by_turn = matadd(matmul(end.R, by_turn[1]), matscale(-1.0, matmul(skew(end.angular), spin)))
        drift = matscale(0.5, skew(vector(at.v[0, :3])))
        carried = matscale(-0.5 * weights.shift_v, skew(add(start.linear, end.linear)))
        moment_by_place = matadd(matadd(matscale(by, l_by_place), matmul(drift, p_by_place)), carried)
        moment_by_turn = matadd(matscale(by, l_by_turn), matmul(drift, p_by_turn))
        turning = matadd(matmul(transpose(H), moment_by_turn), moment_stiffness(Rn, Theta, moment))
        across = matmul(transpose(H), moment_by_place)
        add_blocks(K[0], weights.inertia, matscale(by, p_by_place), matscale(by, p_by_turn), across, turning)


@add_energy.of(MidpointInertiaData)
def _add_kinetic_over_step(part: MidpointInertiaData, at: SpatialConfiguration, energy: Array) -> None:
    """Add the kinetic energy where a step begins or ends."""
    add_energy(part.instant, at, energy)


class MidpointBodyInertia(BodyInertia):
    """Inertia of a body in steps of the midpoint rule; between steps, that of an instant."""

    traits = Traits("I", symmetric=False, roles=(Starting, Stateful))

    def __init__(self, body: MovingBody, M: Array) -> None:
        super().__init__(body, M)
        self._t, self._over_step = math.inf, MidpointInertiaData(InertiaData(M), np.zeros(1))

    def make_kernel_data(self) -> MidpointInertiaData:
        return self._over_step

    def begin_stage(self, state: State) -> None:
        self._start(state.t)

    def renew_kernel_data(self, start: float, end: float) -> None:
        self._over_step.elapsed[0] = max(end - self._t, 0.0)

    def commit(self, state: State) -> None:
        self._start(state.t)

    def _start(self, t: float) -> None:
        """Start a step from a time [s]."""
        self._t, self._over_step.elapsed[0] = t, 0.0

    def state(self) -> Saved:
        return {"t": np.array(self._t)}

    def restore(self, saved: Saved) -> None:
        self._start(float(saved["t"]))
