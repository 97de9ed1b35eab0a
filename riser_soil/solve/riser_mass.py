"""Inverse of the lines' mass, and what it answers at the end of a dynamic step: accelerations and momentum.

Needed once at the start of a dynamic stage and, with contact, once a step (see time_scheme).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.banded import solve_symmetric
from riser_soil.core.part import Forces, LineField, Part, State, Weights, local
from riser_soil.core.roles import MomentumCorrecting
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System, total

MASS_ONLY = Weights(inertia=1.0, force=0.0, shift_v=0.0, shift_a=1.0)
MASSLESS = 1e-12  # of a node's largest mass


class InverseMass(Protocol):
    """Inverse of the lines' mass, see `RiserMass`."""

    def accelerations(self, t: float, force: Array) -> Array: ...

    def kinetic_energy(self, state: State) -> float: ...

    def state(self) -> Saved: ...

    def restore(self, saved: Saved) -> None: ...


class RiserMass:
    """Inverse of the lines' mass, their own and the added one, on their free dofs; collective over all ranks."""

    def __init__(self, system: System) -> None:
        self._system = system
        self._lines = [_LineMass(system, line) for line in system.model.lines]
        self._parts = _with_inertia(system)

    def accelerations(self, t: float, force: Array) -> Array:
        """a with M a = force, in the accepted configuration at time t; local arrays, zero outside the lines.

        What has no mass (as the twist of a line without inertia about its axis) and prescribed dofs get none.
        """
        out = np.zeros_like(force)
        for mass in self._lines:
            at = local(mass.line)
            mine = mass.solve(t, force[at]) if self._system.comm.rank == 0 else None
            out[at] = self._system.comm.bcast(mine)
        return out

    def kinetic_energy(self, state: State) -> float:
        """Kinetic energy [J] of the lines at an accepted state."""
        mine = sum(part.energy(state).kinetic for part in self._parts)
        return float(self._system.comm.allreduce(mine))

    def state(self) -> Saved:
        """By line, the projectors of its nodes, once they are known: they hold for all configurations but to round-off.
        """
        return {mass.line.name: mass.moving for mass in self._lines if mass.moving is not None}

    def restore(self, saved: Saved) -> None:
        for mass in self._lines:
            mass.moving = saved.get(mass.line.name)


def _with_inertia(system: System) -> list[Part]:
    return [part for part in system.model.parts if part.active and "I" in part.traits.groups]


class _LineMass:
    """The mass of one line. moving: see `projectors`; None until it is first asked for."""

    def __init__(self, system: System, line: LineField) -> None:
        self.line, self._system, self._parts = line, system, _with_inertia(system)
        self.moving: Array | None = None

    def solve(self, t: float, force: Array) -> Array:
        """With rotations counted by the way of the lever's end, so that all masses are in kg."""
        levers = self._system.levers[local(self.line)]
        blocks = self._element_matrices(t)
        of_element = levers[: blocks.shape[1]]
        return self._solve_weighed(blocks / np.outer(of_element, of_element), force / levers) / levers

    def _solve_weighed(self, blocks: Array, force: Array) -> Array:
        if self.moving is None:
            self.moving = projectors(blocks, ~self.line.prescribed)
        banded = _banded(_projected(blocks, self.moving), self.line.size)
        _add_nodal(banded, (blocks.max() or 1.0) * (np.eye(self.moving.shape[1]) - self.moving))
        nodal = force.reshape(len(self.moving), -1, 1)
        return solve_symmetric(banded, (self.moving @ nodal).reshape(-1, 1))[:, 0]

    def _element_matrices(self, t: float) -> Array:
        state = State.at_rest(t, self._system.numbering.size)
        values = {self.line.name: np.zeros_like(self._system.matrix.values[self.line.name])}
        for part in self._parts:
            part.tangent(state, MASS_ONLY, values)
        return values[self.line.name]


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
    kept = axes * moves[:, None, :]
    found = kept @ np.swapaxes(kept, 1, 2)
    found[moves.all(axis=1)] = np.eye(dofs)  # without round-off
    return np.asarray(found)


def _projected(blocks: Array, moving: Array) -> Array:
    """Element matrices of the projected accelerations."""
    dofs = moving.shape[1]
    both = np.zeros_like(blocks)
    both[:, :dofs, :dofs], both[:, dofs:, dofs:] = moving[:-1], moving[1:]
    return np.asarray(both @ blocks @ both)


def _banded(blocks: Array, size: int) -> Array:
    """Upper banded storage of a chain of element matrices (ne, 2 dofs, 2 dofs): ab[u + i - j, j] = a[i, j]."""
    count, width, _ = blocks.shape
    dofs = width // 2
    ab = np.zeros((width, size))
    for i in range(width):
        for j in range(i, width):
            ab[width - 1 + i - j, j : j + dofs * count : dofs] += blocks[:, i, j]
    return ab


def _add_nodal(ab: Array, nodal: Array) -> None:
    """Add matrices of the nodes (nn, dofs, dofs) to the upper banded storage."""
    dofs = nodal.shape[1]
    for i in range(dofs):
        for j in range(i, dofs):
            ab[2 * dofs - 1 + i - j, j::dofs] += nodal[:, i, j]


@dataclass(eq=False)
class CommittedStep:
    """A step just committed, and what its scheme needs from the system there; collective.

    mass: None in statics. solved: its state, increments included; forces: in balance there [N]; dt [s].
    """

    system: System
    mass: InverseMass | None
    correcting: Sequence[MomentumCorrecting]
    solved: State
    forces: Forces
    dt: float

    @cached_property
    def state(self) -> State:
        """Increments zero, rates as solved."""
        solved = self.solved
        return State(solved.t, np.zeros(solved.u.size), solved.v, solved.a)

    @cached_property
    def contact(self) -> Array | None:
        """Accelerations that contact causes [m/s2]; None where no forces may jump."""
        return None if self.system.smooth else self._accelerations(-self.forces.end)

    def with_momentum(self, state: State) -> State:
        """The state with the rates that have the momentum of the step's end."""
        missing = np.zeros_like(state.v)
        for part in self.correcting:
            part.add_momentum_correction(state, missing)
        return State(state.t, state.u, state.v + self._accelerations(missing), state.a)

    def in_balance(self, state: State) -> State:
        """The state with the accelerations that its forces cause."""
        prescribed = np.where(self.system.prescribed, state.a, 0.0)
        forces = self.system.forces(State(state.t, state.u, state.v, prescribed))
        return State(state.t, state.u, state.v, prescribed + self._accelerations(-total(forces)))

    def _accelerations(self, force: Array) -> Array:
        assert self.mass is not None
        return self.mass.accelerations(self.solved.t, force)
