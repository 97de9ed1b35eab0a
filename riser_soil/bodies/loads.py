"""Inertia of a body with added mass, weight and buoyancy, and what holds it as it is let go.

The origin of the body's axes is at x, its frame is R, its spin H dTheta, v and W its rates. In body axes the origin has
the velocity b = R^T v, and with the mass matrix M (6, 6) of b and W, added mass included, the momenta are
(P, L) = M (b, W). Kirchhoff's equations give the force and moment

    f = P' + W x P,    m = L' + W x L + b x P,    b' = R^T a - W x b,

so that no energy is made, however different the added masses are (Lamb, Hydrodynamics, 1932, art. 124). Conjugate to
the dofs are R f and T_L(Theta) m. The added mass meets the body's own velocity, and is that of all of it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.bodies.body import BodyProperties, MovingBody, wet, wet_height
from riser_soil.bodies.posture import (
    NONE,
    Changes,
    Posture,
    add_blocks,
    add_changes,
    add_in_body_axes,
    add_to_dofs,
    posture,
)
from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.part import Traits
from riser_soil.riser import rotations
from riser_soil.riser.configuration import Maps, SpatialConfiguration
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent
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
    outer,
    scale,
    skew,
    sub,
    transpose,
    vecmat,
    vector,
)

STIFFER, LEAST = 10.0, 1e-6  # times the moment, of what holds a body as it is let go; its least force [N]


class InertiaData(NamedTuple):
    """M (6, 6), of `BodyProperties`."""

    M: Array


@njit
def _momenta(part: InertiaData, b: Vec, W: Vec) -> tuple[Vec, Vec]:
    """M times the rates of translation and rotation, or their accelerations."""
    M = part.M
    linear = add(matvec(matrix(M[:3, :3]), b), matvec(matrix(M[:3, 3:]), W))
    return linear, add(matvec(matrix(M[3:, :3]), b), matvec(matrix(M[3:, 3:]), W))


@njit
def _momenta_by(part: InertiaData, b: Mat, W: Mat) -> tuple[Mat, Mat]:
    """The same of their derivatives."""
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
    part: InertiaData, at: SpatialConfiguration, maps: Maps, weights: LineWeights, K: Array
) -> None:
    here, shift_v, shift_a = posture(at), maps.shift_v, maps.shift_a
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

    def make_kernel_data(self) -> InertiaData:
        return InertiaData(self.M)


class WeightData(NamedTuple):
    """weight and whole buoyancy [N]; level of the water, inf without a surface, and radius [m]; the centres (3,)."""

    weight: float
    buoyancy: float
    level: float
    radius: float
    gravity_centre: Array
    buoyancy_centre: Array


@njit
def _lifts(part: WeightData, at: Posture) -> tuple[tuple[Vec, float, float], tuple[Vec, float, float]]:
    """Arms in global axes, upward residuals [N] and their slopes by height [N/m], of weight and buoyancy."""
    low, high = matvec(at.R, vector(part.gravity_centre)), matvec(at.R, vector(part.buoyancy_centre))
    share, slope = 1.0, 0.0
    if part.level < math.inf:
        share, slope = wet(part.level - at.x[2] - high[2], part.radius)
    return (low, part.weight, 0.0), (high, -part.buoyancy * share, part.buoyancy * slope)


@add_forces.of(WeightData)
def _add_weight(part: WeightData, at: SpatialConfiguration, out: LineForces) -> None:
    here = posture(at)
    for arm, force, _ in _lifts(part, here):
        upward = (0.0, 0.0, force)
        add_to_dofs(out.force[0], upward, vecmat(cross(arm, upward), here.H))


@add_tangent.of(WeightData)
def _add_tangent_of_weight(
    part: WeightData, at: SpatialConfiguration, maps: Maps, weights: LineWeights, K: Array
) -> None:
    here = posture(at)
    for arm, force, slope in _lifts(part, here):
        upward, height = (0.0, 0.0, force), (0.0, 0.0, 1.0)
        risen = scale(-1.0, matmul(skew(arm), here.H)[2])
        own = matmul(transpose(here.H), matmul(matmul(skew(upward), skew(arm)), here.H))
        lever = moment_stiffness(matrix(at.Rn[0]), vector(at.Theta[0]), cross(arm, upward))
        turning = matadd(matscale(slope, outer(risen, risen)), matadd(own, lever))
        across = matscale(slope, outer(height, risen))
        add_blocks(K[0], weights.force, matscale(slope, outer(height, height)), across, transpose(across), turning)


@add_energy.of(WeightData)
def _add_potential(part: WeightData, at: SpatialConfiguration, energy: Array) -> None:
    here = posture(at)
    (low, _, _), (high, _, _) = _lifts(part, here)
    height = here.x[2] + high[2]
    lifted = wet_height(part.level - height, part.radius) if part.level < math.inf else -height
    energy[2] += part.weight * (here.x[2] + low[2]) + part.buoyancy * lifted


class BodyWeight(CompiledPart):
    """Weight, and buoyancy under calm water (group F), with a potential that is zero at z = 0, buoyancy's in the air.

    weight [N]; buoyancy: of the whole volume [N]. level: of the water [m], inf without a surface.
    """

    name = "body weight"
    traits = Traits("F", symmetric=True)

    def __init__(self, body: MovingBody, given: BodyProperties, weight: float, buoyancy: float, level: float) -> None:
        super().__init__(body)
        self._given, self._weight, self._buoyancy, self._level = given, weight, buoyancy, level

    @property
    def load(self) -> float:
        """The larger of weight and buoyancy [N]."""
        return max(self._weight, self._buoyancy)

    def make_kernel_data(self) -> WeightData:
        given, forces = self._given, (float(self._weight), float(self._buoyancy))
        return WeightData(*forces, float(self._level), given.radius, given.gravity_centre, given.buoyancy_centre)


class ReleaseData(NamedTuple):
    """Springs k [N/m] and kr [N.m/rad] to a place x (3,) and an orientation R (3, 3); left (1,): the share there is."""

    k: float
    kr: float
    x: Array
    R: Array
    left: Array


@njit
def _turned(part: ReleaseData, at: Posture) -> Vec:
    """Rotation vector from the orientation that the spring holds it to."""
    turn: Vec = rotations.log(matmul(at.R, transpose(matrix(part.R))))
    return turn


@add_forces.of(ReleaseData)
def _add_release(part: ReleaseData, at: SpatialConfiguration, out: LineForces) -> None:
    here, left = posture(at), part.left[0]
    force = scale(left * part.k, sub(here.x, vector(part.x)))
    add_to_dofs(out.force[0], force, vecmat(scale(left * part.kr, _turned(part, here)), here.H))


@add_tangent.of(ReleaseData)
def _add_tangent_of_release(
    part: ReleaseData, at: SpatialConfiguration, maps: Maps, weights: LineWeights, K: Array
) -> None:
    here, left = posture(at), part.left[0]
    turn = _turned(part, here)
    spin = matmul(transpose(here.H), matmul(rotations.left_tangent_inverse(turn), here.H))
    lever = moment_stiffness(matrix(at.Rn[0]), vector(at.Theta[0]), scale(part.kr, turn))
    turning = matadd(matscale(part.kr, spin), lever)
    add_blocks(K[0], weights.force * left, isotropic(part.k), NONE, NONE, turning)


@add_energy.of(ReleaseData)
def _no_energy(part: ReleaseData, at: SpatialConfiguration, energy: Array) -> None:
    """None is told, as a static stage has no account."""


class Release(CompiledPart):
    """What has held a body, in the stage in which it is let go: a spring to where it is, and to how it stands, that has
    the reaction at first and gets as soft as the load factor grows (group F).

    reaction (6,): conjugate to its dofs as it was held [N, N.m]. With a potential, so that it can't tip the body over.
    """

    name = "release"
    traits = Traits("F", symmetric=True)

    def __init__(self, body: MovingBody, reaction: Array) -> None:
        super().__init__(body)
        force, moment = float(np.linalg.norm(reaction[:3])), float(np.linalg.norm(reaction[3:]))
        k, kr = max(force, LEAST) / body.lever, STIFFER * (moment + max(force, LEAST) * body.lever)
        R = body.frames.R[0]
        turned = np.array(rotations.exp(vector(R @ reaction[3:] / kr))) @ R
        self._springs = ReleaseData(k, kr, body.x[0] + reaction[:3] / k, turned, np.ones(1))

    def make_kernel_data(self) -> ReleaseData:
        return self._springs

    def renew_kernel_data(self, start: float, end: float) -> None:
        self._springs.left[0] = 1.0 - end
