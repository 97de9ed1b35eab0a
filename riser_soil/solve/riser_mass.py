"""Inverse of the lines' mass, and what it answers at the end of a dynamic step: accelerations and momentum.

Needed once at the start of a dynamic stage and, with contact, once a step (see time_scheme).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, LineField, Part, State, Weights, local
from riser_soil.core.roles import MomentumCorrecting
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System, total
from riser_soil.solve.line_mass import LineMass

MASS_ONLY = Weights(inertia=1.0, force=0.0, shift_v=0.0, shift_a=1.0)


class InverseMass(Protocol):
    """Inverse of the lines' mass, see `RiserMass`."""

    def accelerations(self, t: float, force: Array) -> Array: ...

    def kinetic_energy(self, state: State) -> float: ...

    def state(self) -> Saved: ...

    def restore(self, saved: Saved) -> None: ...


class RiserMass:
    """Inverse of the lines' mass, their own and the added one, on their free dofs; collective over all ranks."""

    def __init__(self, system: System) -> None:
        self._system, self._parts = system, _with_inertia(system)

    @cached_property
    def _lines(self) -> list[tuple[LineField, LineMass]]:
        return [(line, self._mass_of(line)) for line in self._system.model.lines]

    def _mass_of(self, line: LineField) -> LineMass:
        return LineMass(len(line.translation_dofs), line.prescribed, self._system.levers[local(line)])

    def accelerations(self, t: float, force: Array) -> Array:
        """a with M a = force, in the accepted configuration at time t; local arrays, zero outside the lines."""
        out, comm = np.zeros_like(force), self._system.comm
        for line, mass in self._lines:
            out[local(line)] = comm.bcast(self._of_line(line, mass, t, force) if comm.rank == 0 else None)
        return out

    def _of_line(self, line: LineField, mass: LineMass, t: float, force: Array) -> Array:
        mass.K[...], state = 0.0, State.at_rest(t, force.size)
        for part in self._parts:
            part.tangent(state, MASS_ONLY, {line.name: mass.K})
        return mass.accelerations(force[local(line)])

    def kinetic_energy(self, state: State) -> float:
        """Kinetic energy [J] of the lines at an accepted state."""
        mine = sum(part.energy(state).kinetic for part in self._parts)
        return float(self._system.comm.allreduce(mine))

    def state(self) -> Saved:
        """By line, the projectors of its nodes, once they are known."""
        return {line.name: moving for line, mass in self._lines if (moving := mass.moving) is not None}

    def restore(self, saved: Saved) -> None:
        for line, mass in self._lines:
            mass.restore(saved.get(line.name))


def _with_inertia(system: System) -> list[Part]:
    return [part for part in system.model.parts if part.active and "I" in part.traits.groups]


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
