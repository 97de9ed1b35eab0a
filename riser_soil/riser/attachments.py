"""Point masses and buoyancy modules on the line, with their weight less buoyancy: the part "attachments".

What acts at xi of an element reaches its q by the shape functions N(xi): a weight w as w N, a mass m as m N N^T. At a
node that is the classical lumped weight and mass. There it counts with the element after the node, so section forces
given at an attachment's node are those just before it; at the riser's two ends they are those of the line, without what
sits there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.part import State, Traits, Weights
from riser_soil.riser import hermite
from riser_soil.riser.configuration import Configuration, Maps
from riser_soil.riser.line import UP, Line
from riser_soil.riser.line_part import CompiledPart
from riser_soil.riser.part_kernels import LineForces, add_energy, add_forces, add_tangent


@dataclass(frozen=True)
class PointAttachment:
    """A point mass or buoyancy module.

    arc: place on the line [m]. mass: kg. net_weight: weight less the buoyancy of the whole volume [N], positive
    downwards. volume: m3. drag_area: drag coefficient times area [m2]. added_mass: coefficient, on the water displaced.
    Drag and added mass are the same in all directions.
    """

    arc: float
    mass: float = 0.0
    net_weight: float = 0.0
    volume: float = 0.0
    drag_area: float = 0.0
    added_mass: float = 0.0


def places(line: Line, attachments: Sequence[PointAttachment]) -> tuple[IntArray, Array]:
    """Elements (m,) of the attachments, and where they sit in them, xi (m,)."""
    at = [line.element_at(attachment.arc) for attachment in attachments]
    return np.array([e for e, _ in at], dtype=np.int64), np.array([xi for _, xi in at])


def _shares(line: Line, attachments: Sequence[PointAttachment]) -> tuple[IntArray, Array]:
    """Elements (m,) of the attachments, and N1..N4 (m, 4) where they sit."""
    element, xi = places(line, attachments)
    return element, hermite.shapes(xi, line.length[element])


def split(line: Line, attachments: Sequence[PointAttachment]) -> tuple[list[PointAttachment], list[PointAttachment]]:
    """Attachments along the line, and those at its two ends."""
    ends = (0, 0.0), (line.length.size - 1, 1.0)
    sorted_out: tuple[list[PointAttachment], list[PointAttachment]] = ([], [])
    for attachment in attachments:
        sorted_out[line.element_at(attachment.arc) in ends].append(attachment)
    return sorted_out


class Masses(NamedTuple):
    """Masses of attachments [kg]. along: sums of m N N^T by element (ne, 4, 4); ends: of what sits at the line's ends
    (2,).
    """

    along: Array
    ends: Array


def masses(line: Line, attachments: Sequence[PointAttachment]) -> Masses:
    along, ends = split(line, attachments)
    return Masses(_mass_matrices(line, along), _at_ends(line, ends, [attachment.mass for attachment in ends]))


def _mass_matrices(line: Line, attachments: Sequence[PointAttachment]) -> Array:
    M = np.zeros((line.length.size, 4, 4))
    element, N = _shares(line, attachments)
    mass = np.array([attachment.mass for attachment in attachments])
    np.add.at(M, element, mass[:, None, None] * N[:, :, None] * N[:, None, :])
    return M


def _at_ends(line: Line, attachments: Sequence[PointAttachment], values: Sequence[float]) -> Array:
    """Sums (2,) at the start and at the end of values of attachments there."""
    sums = np.zeros(2)
    for attachment, value in zip(attachments, values, strict=True):
        sums[int(line.element_at(attachment.arc) != (0, 0.0))] += value
    return sums


class GivenForces(NamedTuple):
    """Residual of group F: conjugate to q (ne, 4, d), of what acts within elements; to the dofs of nodes (nn, ndof).

    potential: whether they are weights, whose potential counts as stored.
    """

    F: Array
    nodal: Array
    potential: bool


def _weights(line: Line, attachments: Sequence[PointAttachment]) -> GivenForces:
    """Weight less buoyancy."""
    F, nodal, up = np.zeros((line.length.size, 4, line.dimension)), np.zeros((line.nodes, line.ndof)), UP @ line.basis
    along, ends = split(line, attachments)
    element, N = _shares(line, along)
    weight = np.array([attachment.net_weight for attachment in along])
    np.add.at(F, element, (weight[:, None] * N)[:, :, None] * up)
    nodal[[0, -1], : line.dimension] = np.outer(_at_ends(line, ends, [each.net_weight for each in ends]), up)
    return GivenForces(F, nodal, potential=True)


class Attachments(CompiledPart):
    """Weight less buoyancy of attachments (group F), with a potential, zero at the origin of the axes.

    line: the riser's field. attachments: on it, in any order.
    """

    name = "attachments"
    traits = Traits("F", symmetric=True)

    def __init__(self, line: Line, attachments: Sequence[PointAttachment]) -> None:
        super().__init__(line)
        self._weights = _weights(line, attachments)

    def make_kernel_data(self) -> GivenForces:
        return self._weights

    def nodal_forces(self, state: State) -> Array | None:
        return self.forces_on_nodes(state) if self._weights.nodal.any() else None


@njit
def add_given(F: Array, nodal: Array, out: LineForces) -> None:
    """Add given residuals of elements F (ne, 4, d) and nodes, as of `GivenForces`."""
    for e in range(F.shape[0]):
        for k in range(4):
            for i in range(F.shape[2]):
                out.force_q[e, k, i] += F[e, k, i]
    for n in range(nodal.shape[0]):
        for i in range(nodal.shape[1]):
            out.force[n, i] += nodal[n, i]


@add_forces.of(GivenForces)
def _given_forces(part: GivenForces, at: Configuration, out: LineForces) -> None:
    add_given(part.F, part.nodal, out)


@add_tangent.of(GivenForces)
def _given_tangent(part: GivenForces, at: Configuration, maps: Maps, weights: Weights, K: Array) -> None:
    """The loads do not change."""


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
