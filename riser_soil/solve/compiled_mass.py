"""What the compiled loop tells of accepted configurations: mass, bulk forces, forces of the elements.

With contact they are asked for once a step, at the accepted configuration; see `riser_mass` and `time_scheme`.

What acts within a riser's elements is found for all parts at once, where `riser.section_forces` asks one by one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.bound import Bound, Packed, bound, in_turn
from riser_soil.core.part import Forces, State
from riser_soil.core.saved_state import Saved
from riser_soil.riser.configuration import Configuration, maps_for, write_maps
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart, overrides
from riser_soil.riser.part_kernels import (
    LineForces,
    LineWeights,
    add_energy,
    add_forces,
    add_tangent,
    clear,
    collect,
    find_water,
    forces_of,
    write_residual,
)
from riser_soil.riser.placed_line import PlacedLine
from riser_soil.riser.section_forces import BoundSections, viscous_residual
from riser_soil.riser.sections import Elements
from riser_soil.solve import riser_loop as loop
from riser_soil.solve.packed_riser import KernelParts
from riser_soil.solve.riser_mass import LineMass

KernelData = tuple[Any, ...]


class CompiledMass:
    """A `InverseMass` of one line, by the kernels of its parts; and the bulk forces of an accepted state.

    placed: the line where it is accepted; bulk, inertial: kernel data of the parts with forces in groups I and F, and
    in I; prescribed, levers (size,): of the line's dofs; update: writes what depends on the time into the kernel data.
    """

    def __init__(
        self,
        line: Line,
        placed: PlacedLine,
        bulk: Sequence[KernelData],
        inertial: Sequence[KernelData],
        prescribed: BoolArray,
        levers: Array,
        update: Callable[[float], None],
    ) -> None:
        self._line, self._update, self._placed = line, update, placed
        self._mass, self._forces, self._energy = LineMass(line.nodes, prescribed, levers), forces_of(line), np.zeros(3)
        self._bind_state(bulk, inertial)
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
        here, K, weights = Packed(at), Packed(self._mass.K), Packed(LineWeights(1.0, 0.0))
        maps = Packed(maps_for(self._line)._replace(shift_a=1.0))
        self._find_matrices = in_turn(
            *(bound(find_water, data, here) for data in inertial if type(data) in find_water.kernels),
            bound(write_maps, at, maps),
            Bound(loop.clear_tangent, K),
            *(bound(add_tangent, data, here, maps, weights, K) for data in inertial),
        )

    def bulk_forces(self, state: State) -> Forces:
        """Forces of groups I and F at an accepted state, those of group E left out."""
        self._update(state.t)
        self._placed.move(state)
        self._find_forces()
        forces = self._forces
        return Forces(*(group.ravel().copy() for group in (forces.inertia, forces.force, forces.end)))

    def kinetic_energy(self, state: State) -> float:
        """Kinetic energy [J] at an accepted state."""
        self._update(state.t)
        self._placed.move(state, velocities_alone=True)
        self._energy[:] = 0.0
        self._find_energy()
        return float(self._energy[0])

    def accelerations(self, t: float, force: Array) -> Array:
        """a with M a = force, in the accepted configuration at time t."""
        self._update(t)
        self._placed.stand()
        self._find_matrices()
        return self._mass.accelerations(force)

    def state(self) -> Saved:
        """As of `RiserMass`."""
        moving = self._mass.moving
        return {} if moving is None else {self._line.name: moving}

    def restore(self, saved: Saved) -> None:
        self._mass.restore(saved.get(self._line.name))


def mass_of(
    line: Line, placed: PlacedLine, parts: KernelParts, prescribed: BoolArray, levers: Array
) -> CompiledMass:
    """Inverse of a line's mass, by its parts; see `CompiledMass`."""
    groups = parts.in_groups("IF"), parts.in_groups("I")
    return CompiledMass(line, placed, *groups, prescribed, levers, parts.update_to)


class ElementForces:
    """Residuals of the elements of a line and its section forces, in a configuration where parts have put their forces.

    parts: of the line, for what follows from strain rates.
    """

    def __init__(self, line: Line, at: Configuration, forces: LineForces, parts: Sequence[LinePart]) -> None:
        self._line = line
        self._damped = [part for part in parts if overrides(part, "viscous_forces")]
        self._at, self._residual = at, np.zeros((line.length.size, 2 * line.ndof))
        self._put = Bound(write_residual, Packed(at), Packed(forces), Packed(self._residual))
        self._viscous = np.zeros_like(self._residual) if self._damped else None
        self._sections: dict[Elements, BoundSections] = {}

    def residual(self) -> Array:
        """Sum over parts and groups (ne, 2 ndof); the same array each time."""
        self._put()
        return self._residual

    def section_forces(self, elements: Elements, state: State) -> Array:
        """Of the line whose elements these are, see `SectionForces.within`."""
        if elements not in self._sections:
            given = self._residual, self._viscous
            self._sections[elements] = BoundSections(self._line, elements, self._at, *given)
        self.residual()
        if self._viscous is not None:
            self._viscous[...] = viscous_residual(self._line, self._damped, state)
        return self._sections[elements].found()


class AcceptedForces:
    """What the parts of a line put within its elements at an accepted state: workspace of its own beside that of the
    loop.

    placed: the line there; parts: with their data. whole: whether the loop's forces tell the same, where it has
    solved for the state: in the axes in which that step began, which parts with viscous forces don't know any more.
    forces: as found last.
    """

    def __init__(self, line: Line, placed: PlacedLine, parts: Sequence[tuple[LinePart, tuple[Any, ...]]]) -> None:
        self._placed = placed
        self.whole = not any(overrides(part, "viscous_forces") for part, _ in parts)
        out = forces_of(line)
        here, forces = Packed(placed.at), Packed(out)
        self._find = in_turn(
            Bound(clear, forces),
            *(bound(add_forces, data, here, forces) for _, data in parts),
        )
        self.forces = ElementForces(line, placed.at, out, [part for part, _ in parts])

    def found(self, state: State) -> ElementForces:
        """At an accepted state, to whose time the kernel data has been updated."""
        self._placed.move(state)
        self._find()
        return self.forces
