"""Weight and buoyancy of a body, and springs that release it gradually."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.bodies.body import (
    NONE,
    BodyProperties,
    MovingBody,
    Posture,
    add_blocks,
    add_tangent_at,
    add_to_dofs,
    posture,
    wet,
    wet_height,
)
from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.part import Traits, Weights
from riser_soil.riser import rotations
from riser_soil.riser.configuration import Maps, SpatialConfiguration
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent
from riser_soil.riser.rotations import moment_stiffness
from riser_soil.riser.vectors import (
    Vec,
    cross,
    isotropic,
    matadd,
    matmul,
    matrix,
    matscale,
    matvec,
    scale,
    sub,
    transpose,
    vecmat,
    vector,
)

STIFFER, LEAST = 10.0, 1e-6  # times the moment, of the springs that release a body; their least force [N]


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
    part: WeightData, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array
) -> None:
    here, Rn, Theta = posture(at), matrix(at.Rn[0]), vector(at.Theta[0])
    for arm, force, slope in _lifts(part, here):
        rising = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, slope))
        add_tangent_at(K[0], weights.force, here, Rn, Theta, arm, (0.0, 0.0, force), rising)


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

    def __init__(
        self, body: MovingBody, properties: BodyProperties, weight: float, buoyancy: float, level: float
    ) -> None:
        super().__init__(body)
        self._properties, self._weight, self._buoyancy, self._level = properties, weight, buoyancy, level

    @property
    def load(self) -> float:
        """The larger of weight and buoyancy [N]."""
        return max(self._weight, self._buoyancy)

    @property
    def net(self) -> float:
        """Weight less the buoyancy of the whole volume [N]."""
        return self._weight - self._buoyancy

    def make_kernel_data(self) -> WeightData:
        body, forces = self._properties, (float(self._weight), float(self._buoyancy))
        return WeightData(*forces, float(self._level), body.radius, body.gravity_centre, body.buoyancy_centre)


class ReleaseData(NamedTuple):
    """Springs k [N/m] and kr [N.m/rad] to a place x (3,) and an orientation R (3, 3). share (1,): of k, kr in use."""

    k: float
    kr: float
    x: Array
    R: Array
    share: Array


@njit
def _turned(part: ReleaseData, at: Posture) -> Vec:
    """Rotation vector from the orientation that the spring holds it to."""
    turn: Vec = rotations.log(matmul(at.R, transpose(matrix(part.R))))
    return turn


@add_forces.of(ReleaseData)
def _add_release(part: ReleaseData, at: SpatialConfiguration, out: LineForces) -> None:
    here, share = posture(at), part.share[0]
    force = scale(share * part.k, sub(here.x, vector(part.x)))
    add_to_dofs(out.force[0], force, vecmat(scale(share * part.kr, _turned(part, here)), here.H))


@add_tangent.of(ReleaseData)
def _add_tangent_of_release(
    part: ReleaseData, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array
) -> None:
    here, share = posture(at), part.share[0]
    turn = _turned(part, here)
    spin = matmul(transpose(here.H), matmul(rotations.left_tangent_inverse(turn), here.H))
    lever = moment_stiffness(matrix(at.Rn[0]), vector(at.Theta[0]), scale(part.kr, turn))
    turning = matadd(matscale(part.kr, spin), lever)
    add_blocks(K[0], weights.force * share, isotropic(part.k), NONE, NONE, turning)


@add_energy.of(ReleaseData)
def _no_energy(part: ReleaseData, at: SpatialConfiguration, energy: Array) -> None:
    """Springs of a release have no energy here: a static stage has no energy balance."""


class Release(CompiledPart):
    """Springs in place of a body's fixture, in the static stage that sets it free: to its place and to its orientation,
    with the fixture's reaction at first. They soften to nothing as the load factor grows (group F).

    reaction (6,): conjugate to the dofs of the fixed body [N, N.m]. Springs have a potential, which a constant moment
    has not; so they can't tip the body over.
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
        self._springs.share[0] = 1.0 - end
