"""Inverse of the mass: of lines and bodies, and of soil with inertia.

Needed once at the start of a dynamic stage and, with contact, once a step (see time_scheme). A line's element matrices,
projected onto what moves, are a banded matrix.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.bound import Bound, Packed, in_turn
from riser_soil.core.communicator import any_of
from riser_soil.core.compiled import njit
from riser_soil.core.part import LineField, Part, State, local
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.riser.line_part import MASS_ALONE, LineParts, joined
from riser_soil.solve import step_kernels as kernels
from riser_soil.solve.step_kernels import Dofs, MatrixWorkspace, StepData, matrix_workspace

MASSLESS = 1e-12  # of a node's largest mass
EXACT = 1e-13  # of a force: what its acceleration may lack, in the norm of the inverse diagonal


class MassData(NamedTuple):
    """inverse (nn, ndof) [1/m] of the levers of moments; moving (nn, ndof, ndof): see `projectors`; whole
    (nn,): where they change nothing.
    """

    inverse: Array
    moving: Array
    whole: BoolArray


class LineMass:
    """The mass of a line of some nodes, whose element matrices are written to K (ne, n, n) before each call.

    prescribed, levers (size,): of its dofs.
    """

    def __init__(self, nodes: int, prescribed: BoolArray, levers: Array) -> None:
        shape = nodes, levers.size // nodes
        workspace = matrix_workspace(*shape)
        self.K, self._free, self._has_projectors = workspace.K, ~prescribed, False
        self._step = StepData(*(np.zeros(shape) for _ in range(6)))
        self._dofs = Dofs(np.zeros(shape, dtype=bool), np.ones(shape), *(np.zeros(shape) for _ in range(3)))
        moving, whole, inverse = np.zeros((*shape, shape[1])), np.zeros(nodes, dtype=bool), 1.0 / levers.reshape(shape)
        self._mass = MassData(inverse, moving, whole)
        written, dofs, mass = map(Packed, (workspace, self._dofs, self._mass))
        self._weigh = Bound(weigh, written, mass)
        self._solve_weighed = in_turn(
            Bound(project, written, dofs, mass),
            Bound(kernels.fill, written, dofs),
            Bound(kernels.factorise, written, Packed(np.zeros(1, dtype=np.int64))),
            Bound(kernels.improve, written, Packed(self._step), dofs),
        )
        self._solve = in_turn(self._weigh, self._solve_weighed)
        self._u, self._residual, self._inverse = (each.ravel() for each in (self._step.u, self._dofs.residual, inverse))

    def accelerations(self, force: Array) -> Array:
        """a with M a = force (size,); K is lost.

        What has no mass (as the twist of a line without inertia about its axis) and prescribed dofs get none.
        """
        self._u[:] = 0.0
        np.negative(force, out=self._residual)
        if self._has_projectors:
            self._solve()
        else:
            self._weigh()
            self.restore(projectors(self.K, self._free))
            self._solve_weighed()
        return self._u * self._inverse

    @property
    def moving(self) -> Array | None:
        """`projectors` of its nodes, once they are known: they hold for all configurations but to round-off."""
        return self._mass.moving.copy() if self._has_projectors else None

    def restore(self, moving: Array | None) -> None:
        """Take over projectors that were saved; None where they are not known."""
        self._has_projectors = moving is not None
        if moving is not None:
            self._mass.moving[...] = moving
            self._mass.whole[...] = (moving == np.eye(moving.shape[1])).all(axis=(1, 2))


class NodeMass:
    """The mass of a field of one node, such as a body's, whose matrix is written to K (1, n, n) before each call."""

    moving: Array | None = None

    def __init__(self, prescribed: BoolArray) -> None:
        self.K, self._free = np.zeros((1, prescribed.size, prescribed.size)), ~prescribed

    def accelerations(self, force: Array) -> Array:
        """a with M a = force (size,); prescribed dofs get none."""
        out, free = np.zeros(force.size), self._free
        out[free] = np.linalg.solve(self.K[0][np.ix_(free, free)], force[free])
        return out

    def restore(self, moving: Array | None) -> None:
        """Do nothing: a single node has no projectors."""


def mass_of(nodes: int, prescribed: BoolArray, levers: Array) -> LineMass | NodeMass:
    """The mass of a field of some nodes; arguments as of `LineMass` and `NodeMass`."""
    return NodeMass(prescribed) if nodes == 1 else LineMass(nodes, prescribed, levers)


def projectors(blocks: Array, free: BoolArray) -> Array:
    """Projectors (nn, dofs, dofs) of the nodes onto what is free and has mass.

    A node without rotary inertia has none about its tangents where they agree. That axis need not be an axis of the
    dofs, but it stays where it is in the body axes, so that the projectors hold for all configurations.
    """
    dofs = blocks.shape[1] // 2
    mass = np.zeros((len(blocks) + 1, dofs, dofs))
    mass[:-1] += blocks[:, :dofs, :dofs]
    mass[1:] += blocks[:, dofs:, dofs:]
    mask = free.reshape(-1, dofs)
    masses, axes = np.linalg.eigh(mass * mask[:, :, None] * mask[:, None, :])
    moves = masses > MASSLESS * masses[:, -1:]
    moving = axes * moves[:, None, :]
    projectors = moving @ np.swapaxes(moving, 1, 2)
    projectors[moves.all(axis=1)] = np.eye(dofs)  # without round-off
    return np.asarray(projectors)


@njit
def weigh(workspace: MatrixWorkspace, mass: MassData) -> None:
    """Divide element matrices by the levers, so that all masses are in kg."""
    n, inverse = workspace.K.shape[1], mass.inverse.reshape(mass.inverse.size)
    for e in range(workspace.K.shape[0]):
        K, of_ends = workspace.K[e], inverse[e * (n // 2) : e * (n // 2) + n]
        for i in range(n):
            for j in range(n):
                K[i, j] *= of_ends[i] * of_ends[j]


@njit
def project(workspace: MatrixWorkspace, dofs: Dofs, mass: MassData) -> None:
    """Project element matrices and forces over the levers onto what moves; what does not gets the largest mass, which
    is on a diagonal.
    """
    K, ndof, largest = workspace.K, mass.inverse.shape[1], 0.0
    product, own = np.zeros((ndof, ndof)), np.zeros(ndof)
    for e in range(K.shape[0]):
        for i in range(2 * ndof):
            largest = max(largest, K[e, i, i])
        if mass.whole[e] and mass.whole[e + 1]:
            continue
        for row in range(2):
            for column in range(2):
                block = K[e, row * ndof : (row + 1) * ndof, column * ndof : (column + 1) * ndof]
                _multiply(mass.moving[e + row], block, product)
                _multiply(product, mass.moving[e + column], block)
    if largest == 0.0:
        largest = 1.0
    for n in range(dofs.residual.shape[0]):
        e, first = max(n - 1, 0), ndof if n > 0 else 0
        for i in range(ndof):
            own[i] = dofs.residual[n, i] * mass.inverse[n, i]
            dofs.residual[n, i] = own[i]
        if mass.whole[n]:
            continue
        for i in range(ndof):
            dofs.residual[n, i] = 0.0
            for j in range(ndof):
                dofs.residual[n, i] += mass.moving[n, i, j] * own[j]
                K[e, first + i, first + j] += largest * ((1.0 if i == j else 0.0) - mass.moving[n, i, j])


@njit
def _multiply(a: Array, b: Array, out: Array) -> None:
    """Write the product of two matrices, to another place."""
    for i in range(a.shape[0]):
        for j in range(b.shape[1]):
            total = 0.0
            for k in range(a.shape[1]):
                total += a[i, k] * b[k, j]
            out[i, j] = total


class InverseMass:
    """Inverse of the mass of lines and bodies, their own and the added one, and of other fields, on free dofs;
    collective over all ranks.
    """

    def __init__(self, system: System) -> None:
        self._system = system
        parts = [part for part in system.model.parts if part.active and "I" in part.traits.groups]
        self._parts = joined(parts, accepted=True)
        lines = {line.name for line in system.model.lines}
        others = [part for part in parts if not lines & part.blocks().keys()]
        self._others = OtherMass(system, others) if any_of(system.comm, bool(others)) else None

    @cached_property
    def _lines(self) -> list[tuple[LineField, LineMass | NodeMass, list[Part | LineParts]]]:
        """Each with what has its mass."""
        return [(line, self._mass_of(line), self._parts_of(line)) for line in self._system.model.lines]

    def _mass_of(self, line: LineField) -> LineMass | NodeMass:
        return mass_of(len(line.translation_dofs), line.prescribed, self._system.levers[local(line)])

    def _parts_of(self, line: LineField) -> list[Part | LineParts]:
        def acts(part: Part | LineParts) -> bool:
            return part.line.name == line.name if isinstance(part, LineParts) else line.name in part.blocks()

        return [part for part in self._parts if acts(part)]

    def accelerations(self, t: float, force: Array) -> Array:
        """a with M a = force, in the accepted configuration at time t; local arrays, zero where there is no mass."""
        out, comm = np.zeros(force.size), self._system.comm
        if self._others is not None:
            self._others.write_accelerations(force, out)
        nothing = self._system.no_increments
        rest = State(t, nothing, nothing, nothing)
        for line, mass, parts in self._lines:
            if comm.rank == 0:
                mass.K[...] = 0.0
                for part in parts:
                    if isinstance(part, LineParts):
                        part.mass(rest, mass.K)
                    else:
                        part.tangent(rest, MASS_ALONE, {line.name: mass.K})
                out[local(line)] = mass.accelerations(force[local(line)])
            if comm.size > 1:
                out[local(line)] = comm.bcast(out[local(line)])
        return out

    def kinetic_energy(self, state: State) -> float:
        """Kinetic energy [J] at a state."""
        mine = 0.0
        for part in self._parts:
            mine += part.kinetic_energy(state) if isinstance(part, LineParts) else part.energy(state).kinetic
        return self._system.sum([mine])[0]

    def state(self) -> Saved:
        """By line, the projectors of its nodes, once they are known."""
        return {line.name: moving for line, mass, _ in self._lines if (moving := mass.moving) is not None}

    def restore(self, saved: Saved) -> None:
        for line, mass, _ in self._lines:
            mass.restore(saved.get(line.name))


class OtherMass:
    """Inverse of the mass of fields that are no lines, the same in all configurations, by conjugate gradients with its
    diagonal as preconditioner, which takes some twenty iterations on a mesh of any size; collective.
    """

    def __init__(self, system: System, parts: Sequence[Part]) -> None:
        from scipy.sparse import coo_matrix

        self._system, numbering = system, system.numbering
        self._mass = coo_matrix((numbering.size, numbering.size)).tocsr()
        state = State.at_rest(0.0, numbering.size)
        for part in parts:
            for key, block in part.blocks().items():
                values = block.zeros()
                part.tangent(state, MASS_ALONE, {key: values})
                rows, cols = np.broadcast_to(block.rows[:, :, None], block.shape), block.cols[:, None, :]
                at = rows.ravel(), np.broadcast_to(cols, block.shape).ravel()
                self._mass = self._mass + coo_matrix((values.ravel(), at), shape=self._mass.shape).tocsr()
        diagonal = numbering.sizes_to_global(self._mass.diagonal())
        self._inverse = np.divide(1.0, diagonal, out=np.zeros_like(diagonal), where=diagonal > 0.0)

    def write_accelerations(self, force: Array, out: Array) -> None:
        """Write a with M a = force to free local entries, by conjugate gradients; zero where there is no mass."""
        numbering, inverse = self._system.numbering, self._inverse
        residual = np.where(inverse > 0.0, numbering.add_to_global(force), 0.0)
        acceleration, direction = numbering.zeros(), inverse * residual
        size = limit = self._product(residual, direction)
        limit *= EXACT**2
        while size > limit:
            mass_times = self._times(direction)
            step = size / self._product(direction, mass_times)
            acceleration += step * direction
            residual -= step * mass_times
            before, size = size, self._product(residual, inverse * residual)
            direction = inverse * residual + size / before * direction
        numbering.to_local(acceleration, out)

    def _times(self, x: Array) -> Array:
        local = np.zeros(self._system.numbering.size)
        self._system.numbering.to_local(x, local)
        return self._system.numbering.add_to_global(self._mass @ local)

    def _product(self, a: Array, b: Array) -> float:
        return self._system.sum([float(a @ b)])[0]
