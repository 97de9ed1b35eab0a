"""End of a dynamic step: accelerations caused by contact, momentum correction, energy balance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State
from riser_soil.core.roles import MomentumCorrecting
from riser_soil.core.system import System, total
from riser_soil.solve.riser_mass import InverseMass


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
