"""Kernels of loads that do not depend on the motion, and of end springs, see `part_kernels`."""

from __future__ import annotations

from typing import NamedTuple

from riser_soil.core.arrays import Array, IntArray
from riser_soil.riser import rotations
from riser_soil.riser.configuration import Configuration, Maps, PlanarConfiguration, SpatialConfiguration
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent
from riser_soil.riser.spatial_directors import moment_stiffness
from riser_soil.riser.vectors import dot, matadd, matmul, matrix, matscale, matvec, scale, transpose, vector


class GivenForces(NamedTuple):
    """Residual conjugate to q (ne, 4, d), and moments conjugate to the angles in the plane (nn,) of group F.

    potential: whether F is a weight, whose potential F q counts as stored.
    """

    F: Array
    moment: Array
    potential: bool


class SpatialMoments(NamedTuple):
    """Residual conjugate to q (ne, 4, d), and moments (k, 3) of fixed axes at nodes (k,), of group F."""

    F: Array
    node: IntArray
    moment: Array


class PlanarSpring(NamedTuple):
    """A spring [N m/rad] between a node and its support's angle (1,) [rad]."""

    node: int
    stiffness: float
    support: Array


class SpatialSpring(NamedTuple):
    """A spring [N m/rad] between a node and its support's frame (3, 3)."""

    node: int
    stiffness: float
    support: Array


@add_forces.of(GivenForces)
def _given_forces(part: GivenForces, at: Configuration, out: LineForces) -> None:
    out.force_q[:] += part.F
    for n in range(part.moment.size):
        out.force[n, 2] += part.moment[n]


@add_tangent.of(GivenForces)
def _given_tangent(part: GivenForces, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
    """The loads do not change."""


@add_forces.of(SpatialMoments)
def _moment_forces(part: SpatialMoments, at: SpatialConfiguration, out: LineForces) -> None:
    out.force_q[:] += part.F
    for k in range(part.node.size):
        n = part.node[k]
        conjugate = matvec(transpose(matrix(at.H[n])), vector(part.moment[k]))
        for i in range(3):
            out.force[n, 3 + i] -= conjugate[i]


@add_tangent.of(SpatialMoments)
def _moment_tangent(
    part: SpatialMoments, at: SpatialConfiguration, maps: Maps, weights: LineWeights, K: Array
) -> None:
    for k in range(part.node.size):
        n = part.node[k]
        e, first = (n, 3) if n < K.shape[0] else (n - 1, 9)
        change = moment_stiffness(matrix(at.Rn[n]), vector(at.Theta[n]), vector(part.moment[k]))
        for i in range(3):
            for j in range(3):
                K[e, first + i, first + j] -= weights.force * change[i][j]


@add_forces.of(PlanarSpring)
def _planar_forces(part: PlanarSpring, at: PlanarConfiguration, out: LineForces) -> None:
    out.force[part.node, 2] += part.stiffness * (at.angle[part.node] - part.support[0])


@add_tangent.of(PlanarSpring)
def _planar_tangent(part: PlanarSpring, at: PlanarConfiguration, maps: Maps, weights: LineWeights, K: Array) -> None:
    e, i = (0, 2) if part.node == 0 else (part.node - 1, 5)
    K[e, i, i] += weights.force * part.stiffness


@add_forces.of(SpatialSpring)
def _spatial_forces(part: SpatialSpring, at: SpatialConfiguration, out: LineForces) -> None:
    turn = rotations.log(matmul(matrix(at.frames[part.node]), transpose(matrix(part.support))))
    moment = matvec(transpose(matrix(at.H[part.node])), scale(part.stiffness, turn))
    for i in range(3):
        out.force[part.node, 3 + i] += moment[i]


@add_tangent.of(SpatialSpring)
def _spatial_tangent(part: SpatialSpring, at: SpatialConfiguration, maps: Maps, weights: LineWeights, K: Array) -> None:
    n = part.node
    e, first = (0, 3) if n == 0 else (n - 1, 9)
    H = matrix(at.H[n])
    turn = rotations.log(matmul(matrix(at.frames[n]), transpose(matrix(part.support))))
    material = matscale(part.stiffness, matmul(transpose(H), matmul(rotations.left_tangent_inverse(turn), H)))
    turning = moment_stiffness(matrix(at.Rn[n]), vector(at.Theta[n]), scale(part.stiffness, turn))
    change = matadd(material, turning)
    for i in range(3):
        for j in range(3):
            K[e, first + i, first + j] += weights.force * change[i][j]


@add_energy.of(GivenForces)
def _given_energy(part: GivenForces, at: Configuration, energy: Array) -> None:
    if part.potential:
        for e in range(at.q.shape[0]):
            for k in range(4):
                for i in range(at.q.shape[2]):
                    energy[2] += part.F[e, k, i] * at.q[e, k, i]


@add_energy.of(SpatialMoments)
def _moment_energy(part: SpatialMoments, at: SpatialConfiguration, energy: Array) -> None:
    """They have no potential."""


@add_energy.of(PlanarSpring)
def _planar_energy(part: PlanarSpring, at: PlanarConfiguration, energy: Array) -> None:
    energy[1] += 0.5 * part.stiffness * (at.angle[part.node] - part.support[0]) ** 2


@add_energy.of(SpatialSpring)
def _spatial_energy(part: SpatialSpring, at: SpatialConfiguration, energy: Array) -> None:
    turn = rotations.log(matmul(matrix(at.frames[part.node]), transpose(matrix(part.support))))
    energy[1] += 0.5 * part.stiffness * dot(turn, turn)
