"""Joints between lines and bodies in the line solver: what couples their bands.

A joint's matrix has a block of each node, which is added to that line's band, and blocks between both nodes. The fewest
dofs that these blocks have in their rows or columns are moved to the border, see `dense_border`: the same that statics
eliminates last, see `bordered_band`.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from riser_soil.bodies.joints import JointPlaces, Joints, Laws, add_tangent, conjugate, energy_of
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.compiled import njit
from riser_soil.core.part import Part, State, Weights
from riser_soil.riser.configuration import SpatialConfiguration
from riser_soil.riser.part_kernels import Border, LineForces
from riser_soil.solve.bordered_band import fewest_rows
from riser_soil.solve.dense_border import IN_BAND, DenseBorder, clear_moved
from riser_soil.solve.line_system import Coupling, MakeCoupling
from riser_soil.solve.newton_settings import MOST_JOINTS
from riser_soil.solve.packed_line import PackedLine
from riser_soil.solve.step_kernels import Dofs, MatrixWorkspace


class JointData(NamedTuple):
    """m joints: laws; places of their nodes; share (1,): of the first gap, that is open; forces (m, 12) and
    matrices K (m, 12, 12); sizes (m, 12) of the coordinates. moved (m, 12): number of each dof among those that are
    moved to the border, IN_BAND of the others.
    """

    laws: Laws
    places: JointPlaces
    share: Array
    forces: Array
    K: Array
    sizes: Array
    moved: IntArray


class Sides(NamedTuple):
    """Sides of joints that are on one line: joint, side and node (k,)."""

    joint: IntArray
    side: IntArray
    node: IntArray


@njit
def write_places(at: SpatialConfiguration, sides: Sides, joints: JointData) -> None:
    """Write the places of the joints' nodes on a line."""
    places = joints.places
    for k in range(sides.node.size):
        j, s, n = sides.joint[k], sides.side[k], sides.node[k]
        for i in range(3):
            places.x[j, s, i], places.Theta[j, s, i] = at.x[n, i], at.Theta[n, i]
            for c in range(3):
                places.R[j, s, i, c], places.H[j, s, i, c] = at.frames[n, i, c], at.H[n, i, c]
                places.Rn[j, s, i, c] = at.Rn[n, i, c]


@njit
def find_forces(joints: JointData) -> None:
    """Write the forces of all joints."""
    forces = conjugate(joints.laws, joints.places, joints.share[0])
    for j in range(forces.shape[0]):
        for i in range(12):
            joints.forces[j, i] = forces[j, i]


@njit
def add_to_line(joints: JointData, sides: Sides, forces: LineForces) -> None:
    """Add the joints' forces to those on a line's nodes."""
    for k in range(sides.node.size):
        for i in range(6):
            forces.force[sides.node[k], i] += joints.forces[sides.joint[k], 6 * sides.side[k] + i]


@njit
def write_matrices(joints: JointData, weights: Weights) -> None:
    """Write the joints' matrices."""
    joints.K[:] = 0.0
    add_tangent(joints.K, weights.force, joints.laws, joints.places, joints.share[0])


@njit
def write_sizes(dofs: Dofs, sides: Sides, joints: JointData) -> None:
    """Write the sizes of the coordinates of a line's nodes."""
    for k in range(sides.node.size):
        for i in range(6):
            joints.sizes[sides.joint[k], 6 * sides.side[k] + i] = dofs.sizes[sides.node[k], i]


@njit
def add_terms(joints: JointData, sides: Sides, dofs: Dofs) -> None:
    """Add to the terms that a line's residual is made of."""
    for k in range(sides.node.size):
        j, first = sides.joint[k], 6 * sides.side[k]
        for i in range(6):
            for c in range(12):
                dofs.terms[sides.node[k], i] += abs(joints.K[j, first + i, c]) * joints.sizes[j, c]


@njit
def add_to_matrix(
    joints: JointData, sides: Sides, workspace: MatrixWorkspace, dofs: Dofs, border: Border
) -> None:
    """Add the blocks of a line's nodes to its band, and those that couple other nodes with them to the border."""
    b, ab, fixed, first = len(workspace.band), workspace.ab, dofs.fixed, border.u.size
    for k in range(sides.node.size):
        j, s, n = sides.joint[k], sides.side[k], sides.node[k]
        own, other, K = 6 * s, 6 * (1 - s), joints.K[j]
        border.coupled[n] = True
        for i in range(6):
            if fixed[n, i]:
                continue
            row = joints.moved[j, own + i]
            for c in range(6):
                if not fixed[n, c]:
                    ab[6 * n + i, b + c - i] += K[own + i, own + c]
                column = joints.moved[j, other + c]
                if column == IN_BAND:
                    continue
                if row != IN_BAND:
                    border.corner[first + row, first + column] += K[own + i, other + c]
                else:
                    border.right[6 * n + i, first + column] += K[own + i, other + c]
                    border.below[6 * n + i, first + column] += K[other + c, own + i]


@njit
def add_energy_of_joints(joints: JointData, energy: Array) -> None:
    """Add the joints' energy to (3,): kinetic, strain, potential [J]."""
    energy[1] += energy_of(joints.laws, joints.places, joints.share[0])


def joint_border(beside: Sequence[Part]) -> MakeCoupling | None:
    """What makes the border of joints, if they are not too many; None for anything else."""
    if len(beside) != 1 or not isinstance(beside[0], Joints) or len(beside[0].joints) > MOST_JOINTS:
        return None
    return partial(JointBorder, beside[0])


class JointBorder(Coupling):
    """All joints of a scene, between the lines and bodies that are packed.

    lines: that have joints, each with its sides of them; data: what the loop writes to.
    """

    def __init__(self, joints: Joints, dense: DenseBorder, lines: Sequence[PackedLine]) -> None:
        self._joints, m, self.parts, self._dense = joints, len(joints.joints), (joints,), dense
        vectors, frames = (m, 2, 3), (m, 2, 3, 3)
        places = JointPlaces(*(np.zeros(shape) for shape in (vectors, vectors, frames, frames, frames)))
        matrices = np.zeros((m, 12)), np.zeros((m, 12, 12)), np.zeros((m, 12))
        of_lines = ((line, _sides_of(joints, line)) for line in lines)
        self.lines = [(line, Packed(sides)) for line, sides in of_lines if sides.node.size]
        moved = _numbers_of_moved(joints.dofs, lines)
        dense.move({line: moved[line.line.part] for line in lines})
        self.data = JointData(joints.laws, places, np.zeros(1), *matrices, moved[joints.dofs])
        self._packed = Packed(self.data)

    def begin(self, before: State, step_to: float, guess: Array) -> None:
        self.data.share[0] = self._joints.open_share_at(step_to)

    def forces(self) -> list[Bound]:
        data = self._packed
        return [
            *(Bound(write_places, line.packed_at, sides, data) for line, sides in self.lines),
            Bound(find_forces, data),
            *(Bound(add_to_line, data, sides, line.packed_forces) for line, sides in self.lines),
        ]

    def bulk_tangent(self) -> list[Bound]:
        line, _ = self.lines[0]
        return [Bound(write_matrices, self._packed, line.weights)]

    def terms(self) -> list[Bound]:
        sizes = [Bound(write_sizes, line.packed_dofs, sides, self._packed) for line, sides in self.lines]
        return sizes + [Bound(add_terms, self._packed, sides, line.packed_dofs) for line, sides in self.lines]

    def fill(self) -> list[Bound]:
        data, of = self._packed, self._dense.of
        return [
            *(Bound(clear_moved, of[line]) for line in of),
            *(
                Bound(add_to_matrix, data, sides, line.packed_workspace, line.packed_dofs, of[line])
                for line, sides in self.lines
            ),
        ]

    def account(self, energy: Packed) -> list[Bound]:
        return [Bound(add_energy_of_joints, self._packed, energy)]


def _numbers_of_moved(dofs: IntArray, lines: Sequence[PackedLine]) -> IntArray:
    """Number of each local dof up to the lines' last one among those that are moved to the border: the fewest that all
    entries of the joints' blocks between nodes have in their rows or columns; IN_BAND of the others. dofs (m, 12): of
    the joints. What is fixed has no entries.
    """
    fixed = np.zeros(max(line.line.part.stop for line in lines), dtype=bool)
    for line in lines:
        fixed[line.line.part] = line.dofs.fixed.ravel()
    first, second = np.broadcast_arrays(dofs[:, :6, None], dofs[:, None, 6:])
    free = ~(fixed[first] | fixed[second])
    rows, out = fewest_rows(first[free], second[free]), np.full(len(fixed), IN_BAND)
    out[rows] = np.arange(len(rows))
    return out


def _sides_of(joints: Joints, line: PackedLine) -> Sides:
    """The joints' sides on a line or body."""
    rows = [
        (j, s, side.node)
        for j, joint in enumerate(joints.joints)
        for s, side in enumerate(joint.sides)
        if side.field is line.line
    ]
    joint, side, node = np.array(rows, dtype=np.int64).reshape(-1, 3).T.copy()
    return Sides(joint, side, node)
