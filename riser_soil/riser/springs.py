"""Rotational spring between an end and its support: the parts "start spring" and "end spring"."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.part import Traits, Weights
from riser_soil.riser import rotations
from riser_soil.riser.configuration import Maps, PlanarConfiguration, SpatialConfiguration
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent, add_work
from riser_soil.riser.vectors import Vec, add, dot, matadd, matmul, matrix, matscale, matvec, scale, transpose, vector


class PlanarSpring(NamedTuple):
    """A spring [N m/rad] between a node and its support, whose angles [rad] are those before a step and at its end,
    each (1,).
    """

    node: int
    stiffness: float
    before: Array
    support: Array


class SpatialSpring(NamedTuple):
    """A spring [N m/rad] between a node and its support, whose frames are those before a step and at its end, each
    (3, 3).
    """

    node: int
    stiffness: float
    before: Array
    support: Array


class EndSpring(CompiledPart):
    """Moment stiffness times the rotation vector from the support's orientation to the end's (group F).

    line: the riser's field. node: 0 for the start, -1 for the end. stiffness: N m/rad.
    At rest in the line's first configuration, but for what `Line.turn_support` has turned, from where the support may
    turn. In space the rotation is below pi and counts twist too; in the plane it is unlimited.
    """

    line: Line

    traits = Traits("F", symmetric=True)

    def __init__(self, line: Line, node: int, stiffness: float) -> None:
        super().__init__(line)
        self.stiffness = stiffness
        self.node = node % line.nodes
        self.name = "start spring" if self.node == 0 else "end spring"

    def make_kernel_data(self) -> PlanarSpring | SpatialSpring:
        kind = PlanarSpring if self.line.dimension == 2 else SpatialSpring
        supports = (np.array(self.line.support(self.node, 0.0)) for _ in range(2))
        return kind(self.node, self.stiffness, *supports)

    def renew_kernel_data(self, start: float, end: float) -> None:
        for support, t in ((self._data.before, start), (self._data.support, end)):
            support[:] = self.line.support(self.node, t)


@njit
def _turned(at: SpatialConfiguration, node: int, support: Array) -> Vec:
    """Rotation vector from a support to a node."""
    return rotations.log(matmul(matrix(at.frames[node]), transpose(matrix(support))))


@add_forces.of(PlanarSpring)
def _planar_forces(part: PlanarSpring, at: PlanarConfiguration, out: LineForces) -> None:
    out.force[part.node, 2] += part.stiffness * (at.angle[part.node] - part.support[0])


@add_tangent.of(PlanarSpring)
def _planar_tangent(part: PlanarSpring, at: PlanarConfiguration, maps: Maps, weights: Weights, K: Array) -> None:
    e, i = (0, 2) if part.node == 0 else (part.node - 1, 5)
    K[e, i, i] += weights.force * part.stiffness


@add_energy.of(PlanarSpring)
def _planar_energy(part: PlanarSpring, at: PlanarConfiguration, energy: Array) -> None:
    energy[1] += 0.5 * part.stiffness * (at.angle[part.node] - part.support[0]) ** 2


@add_work.of(PlanarSpring)
def _planar_work(part: PlanarSpring, first: PlanarConfiguration, last: PlanarConfiguration, work: Array) -> None:
    """Add the work of the support's rotation against the mean moment [J]."""
    before, after = first.angle[part.node] - part.before[0], last.angle[part.node] - part.support[0]
    work[1] -= 0.5 * part.stiffness * (before + after) * (part.support[0] - part.before[0])


@add_forces.of(SpatialSpring)
def _spatial_forces(part: SpatialSpring, at: SpatialConfiguration, out: LineForces) -> None:
    turn = _turned(at, part.node, part.support)
    moment = matvec(transpose(matrix(at.H[part.node])), scale(part.stiffness, turn))
    for i in range(3):
        out.force[part.node, 3 + i] += moment[i]


@add_tangent.of(SpatialSpring)
def _spatial_tangent(part: SpatialSpring, at: SpatialConfiguration, maps: Maps, weights: Weights, K: Array) -> None:
    """H^T k T_L^-1(phi) H of the rotation vector phi, and the change of H at fixed moment."""
    n = part.node
    e, first = (0, 3) if n == 0 else (n - 1, 9)
    H, turn = matrix(at.H[n]), _turned(at, n, part.support)
    material = matscale(part.stiffness, matmul(transpose(H), matmul(rotations.left_tangent_inverse(turn), H)))
    turning = rotations.moment_stiffness(matrix(at.Rn[n]), vector(at.Theta[n]), scale(part.stiffness, turn))
    change = matadd(material, turning)
    for i in range(3):
        for j in range(3):
            K[e, first + i, first + j] += weights.force * change[i][j]


@add_energy.of(SpatialSpring)
def _spatial_energy(part: SpatialSpring, at: SpatialConfiguration, energy: Array) -> None:
    turn = _turned(at, part.node, part.support)
    energy[1] += 0.5 * part.stiffness * dot(turn, turn)


@add_work.of(SpatialSpring)
def _spatial_work(part: SpatialSpring, first: SpatialConfiguration, last: SpatialConfiguration, work: Array) -> None:
    """Add the work of the support's rotation against the mean moment [J]."""
    both = add(_turned(first, part.node, part.before), _turned(last, part.node, part.support))
    rotation = rotations.log(matmul(matrix(part.support), transpose(matrix(part.before))))
    work[1] -= 0.5 * part.stiffness * dot(both, rotation)
