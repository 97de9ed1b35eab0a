"""What the compiled loop tells of accepted configurations: mass, kinetic energy and bulk forces.

With contact they are asked for once a step, at the accepted configuration; see `riser_mass` and `time_scheme`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.bound import Bound, Packed, bound, in_turn
from riser_soil.core.part import Forces, State
from riser_soil.core.saved_state import Saved
from riser_soil.riser.configuration import maps_for, write_maps
from riser_soil.riser.part_kernels import (
    LineWeights,
    add_energy,
    add_forces,
    add_tangent,
    clear,
    collect,
    find_water,
    forces_of,
)
from riser_soil.solve import riser_loop as loop
from riser_soil.solve.packed_line import KernelData, PackedLine
from riser_soil.solve.riser_mass import mass_of


class AcceptedLine:
    """Mass, kinetic energy and bulk forces of a line where it is accepted, by the kernels of its parts."""

    def __init__(self, packed: PackedLine) -> None:
        line, dofs = packed.line, packed.dofs
        self.line, self._update, self._placed = line, packed.parts.update_to, packed.placed
        self.mass = mass_of(line.nodes, dofs.fixed.ravel(), dofs.levers.ravel())
        self._forces, self._energy = forces_of(line), np.zeros(3)
        inertial = packed.parts.in_groups("I")
        self._bind_state(packed.parts.in_groups("IF"), inertial)
        self._bind_mass(inertial)

    def _bind_state(self, bulk: Sequence[KernelData], inertial: Sequence[KernelData]) -> None:
        """Bind the kernels of forces and kinetic energy in motion."""
        here, forces, energy = map(Packed, (self._placed.at, self._forces, self._energy))
        each = [bound(add_forces, data, here, forces) for data in bulk]
        self._find_forces = in_turn(Bound(clear, forces), *each, Bound(collect, here, forces))
        self._find_energy = in_turn(*(bound(add_energy, data, here, energy) for data in inertial))

    def _bind_mass(self, inertial: Sequence[KernelData]) -> None:
        """Bind the kernels of the mass at rest."""
        at = self._placed.at
        here, K, weights = Packed(at), Packed(self.mass.K), Packed(LineWeights(1.0, 0.0))
        maps = Packed(maps_for(self.line)._replace(shift_a=1.0))
        self._find_matrices = in_turn(
            *(bound(find_water, data, here) for data in inertial if type(data) in find_water.kernels),
            bound(write_maps, at, maps),
            Bound(loop.clear_tangent, K),
            *(bound(add_tangent, data, here, maps, weights, K) for data in inertial),
        )

    def add_bulk_forces(self, state: State, out: Forces) -> None:
        """Add the forces of groups I and F at an accepted state, those of group E left out."""
        self._update(state.t)
        self._placed.move(state)
        self._find_forces()
        out.inertia[self.line.part] += self._forces.inertia.ravel()
        out.force[self.line.part] += self._forces.force.ravel()

    def kinetic_energy(self, state: State) -> float:
        """Kinetic energy [J] at an accepted state."""
        self._update(state.t)
        self._placed.move(state, velocities_alone=True)
        self._energy[:] = 0.0
        self._find_energy()
        return float(self._energy[0])

    def accelerations(self, t: float, force: Array) -> Array:
        """a with M a = force (size,), in the accepted configuration at time t."""
        self._update(t)
        self._placed.stand()
        self._find_matrices()
        return self.mass.accelerations(force)


class CompiledMass:
    """An `InverseMass` of lines and bodies, local arrays, by the kernels of their parts; and their bulk forces."""

    def __init__(self, lines: Sequence[PackedLine]) -> None:
        self._lines = [AcceptedLine(line) for line in lines]

    def bulk_forces(self, state: State) -> Forces:
        """Forces of groups I and F at an accepted state, those of group E left out."""
        out = Forces.zeros(state.u.size)
        for line in self._lines:
            line.add_bulk_forces(state, out)
        return out

    def kinetic_energy(self, state: State) -> float:
        """Kinetic energy [J] at an accepted state."""
        return sum(line.kinetic_energy(state) for line in self._lines)

    def accelerations(self, t: float, force: Array) -> Array:
        """a with M a = force, in the accepted configuration at time t; zero beside the lines."""
        out = np.zeros_like(force)
        for each in self._lines:
            out[each.line.part] = each.accelerations(t, force[each.line.part])
        return out

    def state(self) -> Saved:
        """As of `RiserMass`."""
        found = ((each.line.name, each.mass.moving) for each in self._lines)
        return {name: moving for name, moving in found if moving is not None}

    def restore(self, saved: Saved) -> None:
        for each in self._lines:
            each.mass.restore(saved.get(each.line.name))
