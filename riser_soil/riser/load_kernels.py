"""Kernels of loads that do not depend on the motion, see `part_kernels`."""

from __future__ import annotations

from typing import NamedTuple

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.riser.configuration import Configuration, Maps, SpatialConfiguration
from riser_soil.riser.part_kernels import LineForces, LineWeights, add_energy, add_forces, add_tangent
from riser_soil.riser.spatial_directors import moment_stiffness
from riser_soil.riser.vectors import matrix, matvec, transpose, vector


class GivenForces(NamedTuple):
    """Residual of group F: conjugate to q (ne, 4, d), of what acts within elements; to the dofs of nodes (nn, ndof).

    potential: whether they are weights, whose potential counts as stored.
    """

    F: Array
    nodal: Array
    potential: bool


class SpatialMoments(NamedTuple):
    """The same, and moments (k, 3) of fixed axes at nodes (k,)."""

    F: Array
    nodal: Array
    node: IntArray
    moment: Array


@njit
def _add_given(F: Array, nodal: Array, out: LineForces) -> None:
    for e in range(F.shape[0]):
        for k in range(4):
            for i in range(F.shape[2]):
                out.force_q[e, k, i] += F[e, k, i]
    for n in range(nodal.shape[0]):
        for i in range(nodal.shape[1]):
            out.force[n, i] += nodal[n, i]


@add_forces.of(GivenForces)
def _given_forces(part: GivenForces, at: Configuration, out: LineForces) -> None:
    _add_given(part.F, part.nodal, out)


@add_tangent.of(GivenForces)
def _given_tangent(part: GivenForces, at: Configuration, maps: Maps, weights: LineWeights, K: Array) -> None:
    """The loads do not change."""


@add_forces.of(SpatialMoments)
def _moment_forces(part: SpatialMoments, at: SpatialConfiguration, out: LineForces) -> None:
    _add_given(part.F, part.nodal, out)
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


@add_energy.of(GivenForces)
def _given_energy(part: GivenForces, at: Configuration, energy: Array) -> None:
    if not part.potential:
        return
    for e in range(at.q.shape[0]):
        for k in range(4):
            for i in range(at.q.shape[2]):
                energy[2] += part.F[e, k, i] * at.q[e, k, i]
    for n in range(at.x.shape[0]):
        for i in range(at.x.shape[1]):
            energy[2] += part.nodal[n, i] * at.x[n, i]


@add_energy.of(SpatialMoments)
def _moment_energy(part: SpatialMoments, at: SpatialConfiguration, energy: Array) -> None:
    """They have no potential."""
