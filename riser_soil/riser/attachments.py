"""Point masses and buoyancy modules on the line, with their weight less buoyancy: the part "attachments".

What acts at xi of an element reaches its q by the shape functions N(xi): a weight w as w N, a mass m as m N N^T. At a
node that is the classical lumped weight and mass. There it counts with the element after the node, so section forces
given at an attachment's node are those just before it; at the riser's two ends they are those of the line, without what
sits there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Energy, Forces, State, Traits, Weights
from riser_soil.riser import hermite
from riser_soil.riser.line import UP, Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.load_kernels import GivenForces


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
    found = [line.place(attachment.arc) for attachment in attachments]
    return np.array([e for e, _ in found], dtype=np.int64), np.array([xi for _, xi in found])


def _shares(line: Line, attachments: Sequence[PointAttachment]) -> tuple[IntArray, Array]:
    """Elements (m,) of the attachments, and N1..N4 (m, 4) where they sit."""
    element, xi = places(line, attachments)
    return element, hermite.shapes(xi, line.length[element])


def split(line: Line, attachments: Sequence[PointAttachment]) -> tuple[list[PointAttachment], list[PointAttachment]]:
    """Attachments along the line, and those at its two ends."""
    ends = (0, 0.0), (line.length.size - 1, 1.0)
    sorted_out: tuple[list[PointAttachment], list[PointAttachment]] = ([], [])
    for attachment in attachments:
        sorted_out[line.place(attachment.arc) in ends].append(attachment)
    return sorted_out


class Masses(NamedTuple):
    """Sums of m N N^T by element (ne, 4, 4), kg, of what sits along the line and of what sits at its ends."""

    along: Array
    ends: Array


def masses(line: Line, attachments: Sequence[PointAttachment]) -> Masses:
    along, ends = (_mass_matrices(line, some) for some in split(line, attachments))
    return Masses(along, ends)


def _mass_matrices(line: Line, attachments: Sequence[PointAttachment]) -> Array:
    M = np.zeros((line.length.size, 4, 4))
    element, N = _shares(line, attachments)
    mass = np.array([attachment.mass for attachment in attachments])
    np.add.at(M, element, mass[:, None, None] * N[:, :, None] * N[:, None, :])
    return M


def _residual(line: Line, attachments: Sequence[PointAttachment]) -> Array:
    """Residual of weight less buoyancy, conjugate to q (ne, 4, d)."""
    F = np.zeros((line.length.size, 4, line.dimension))
    element, N = _shares(line, attachments)
    weight = np.array([attachment.net_weight for attachment in attachments])
    np.add.at(F, element, (weight[:, None] * N)[:, :, None] * (UP @ line.basis))
    return F


class Attachments(LinePart):
    """Weight less buoyancy of attachments (group F), with a potential.

    line: the riser's field. attachments: on it, in any order.
    """

    name = "attachments"
    traits = Traits("F", symmetric=True)

    def __init__(self, line: Line, attachments: Sequence[PointAttachment]) -> None:
        super().__init__(line)
        self._along, self._ends = (_residual(line, some) for some in split(line, attachments))
        self._F = self._along + self._ends

    def element_forces(self, state: State) -> tuple[None, Array]:
        """Element residuals (inertia, force), each (ne, 2 ndof) or None, of what sits along the line."""
        return None, self.line.trial(state).pull_back(self._along)

    def nodal_forces(self, state: State) -> Array:
        """Residual (nn, ndof) of what sits at the line's ends."""
        return self.line.gathered(self.line.trial(state).pull_back(self._ends))

    def residual(self, state: State, forces: Forces) -> None:
        self.line.collect(self.line.trial(state), self._F, forces.force)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        self.line.trial(state).add_turning(values[self.line.name], weights.force, self._F)

    def numbers(self) -> GivenForces:
        return GivenForces(self._F, np.empty(0), potential=True)

    def numbers_within(self, numbers: tuple[Any, ...]) -> GivenForces:
        return GivenForces(self._along, np.empty(0), potential=True)

    def energy(self, state: State) -> Energy:
        """Potential of weight less buoyancy, zero at the origin of the axes."""
        return Energy(potential=float(np.sum(self._F * self.line.trial(state).q)))
