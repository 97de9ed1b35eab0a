"""What the line solver tells of lines and bodies where they are accepted.

Mass, kinetic energy and bulk forces are asked for once a step with contact, see `riser_mass` and `time_scheme`. What
acts within a line's elements is found for all parts at once, where `riser.section_forces` asks one by one.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.core.arrays import Array
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
    forces_at,
    write_residual,
)
from riser_soil.riser.section_forces import BoundSections, nodal_residual, viscous_residual
from riser_soil.riser.sections import Elements
from riser_soil.solve import step_kernels as kernels
from riser_soil.solve.packed_line import KernelData, PackedLine
from riser_soil.solve.riser_mass import mass_of

if TYPE_CHECKING:
    from riser_soil.contact.contact import RiserContact


class AcceptedLine:
    """Mass, kinetic energy and bulk forces of a line where it is accepted, by the kernels of its parts."""

    def __init__(self, packed: PackedLine) -> None:
        line, dofs = packed.line, packed.dofs
        self.line, self._update, self._placed = line, packed.parts.update_to, packed.placed
        self.mass = mass_of(line.nodes, dofs.fixed.ravel(), dofs.levers.ravel())
        self._forces, self._energy = forces_at(packed.placed.at), np.zeros(3)
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
            Bound(kernels.set_zero, K),
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
        """Projectors of each line's nodes, as `RiserMass` has them."""
        found = ((each.line.name, each.mass.moving) for each in self._lines)
        return {name: moving for name, moving in found if moving is not None}

    def restore(self, saved: Saved) -> None:
        for each in self._lines:
            each.mass.restore(saved.get(each.line.name))


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
        """Section forces of the line whose elements these are, see `SectionForces.within`."""
        if elements not in self._sections:
            given = self._residual, self._viscous
            self._sections[elements] = BoundSections(self._line, elements, self._at, *given)
        self.residual()
        if self._viscous is not None:
            self._viscous[...] = viscous_residual(self._line, self._damped, state)
        return self._sections[elements].found()


class LineResults:
    """Results of one line; smooth: see `System`.

    The loop's forces tell the same as those found anew where it has solved for a state: in the axes in which that step
    began, which parts with viscous forces don't know any more.
    """

    def __init__(self, packed: PackedLine, line: Line, smooth: bool) -> None:
        self._packed, self._line, self._smooth = packed, line, smooth
        self._solved: State | None = None  # last, where no forces may have jumped since
        self._committed: Array | None = None  # the line's places, where its last step was solved by the loop
        self._looked_at: State | None = None  # the accepted state whose forces were found last
        self._contacts: dict[RiserContact, tuple[Bound, Array]] = {}  # how they tell their results, and where to
        self._on_nodes = [part for part in packed.parts.parts if overrides(part, "nodal_forces")]
        self._whole = not any(overrides(part, "viscous_forces") for part in packed.parts.parts)

    def forget(self) -> None:
        """The line moves on."""
        self._solved = self._committed = self._looked_at = None

    def solved(self, state: State) -> None:
        """The loop has solved for a state."""
        self._solved = state if self._smooth else None

    def commit(self) -> None:
        """What the loop has solved for is accepted."""
        self._committed = self._line.x

    def element_residual(self, state: State) -> Array:
        """Residual of the line's elements (ne, 2 ndof) at an accepted state; as solved where no step turns its axes."""
        known = self._has_solved(state) and not self._line.turns_axes
        return (self._at_solution if known else self._found_at(state)).residual()

    def section_forces(self, elements: Elements, state: State) -> Array:
        """At an accepted state; of the one solved for last as the loop has found its forces."""
        found = self._at_solution if self._has_solved(state) else self._found_at(state)
        return found.section_forces(elements, state)

    def nodal_residual(self, state: State) -> Array | None:
        """Residual of what acts on the line's nodes (nn, ndof) without holding them."""
        return nodal_residual(self._line, self._on_nodes, state) if self._on_nodes else None

    def contact_results(self, contact: RiserContact, state: State) -> Array:
        """Results of a contact at an accepted state: of the one committed last as the loop has found its forces."""
        if self._committed is not self._line.x:
            return contact.results(state)
        if contact not in self._contacts:
            self._contacts[contact] = self._bound_results(contact)
        put, found = self._contacts[contact]
        put()
        return found.copy()

    def _bound_results(self, contact: RiserContact) -> tuple[Bound, Array]:
        """A contact's results where the loop has left the line: what writes them, and where to."""
        from riser_soil.contact.contact import ContactResults, size_of, write_results

        data = next(data for part, data in self._packed.parts.with_data if part is contact)
        sizes = self._line.nodes, contact.along.arc.size
        out = np.empty(size_of(*sizes))
        return bound(write_results, data, self._packed.packed_at, Packed(ContactResults.within(out, *sizes))), out

    def _has_solved(self, state: State) -> bool:
        """Whether a state is that of the step solved last, whose forces the loop has left and nothing has changed."""
        solved = self._solved
        return solved is not None and self._whole and state.v is solved.v and state.a is solved.a

    def _found_at(self, state: State) -> ElementForces:
        found, find = self._accepted
        if state is not self._looked_at:
            self._looked_at, parts = state, self._packed.parts
            if parts.t != state.t or not self._smooth:  # contact has a new history since the step was solved
                parts.update(state.t, state.t)
            self._packed.placed.move(state)
            find()
        return found

    @cached_property
    def _accepted(self) -> tuple[ElementForces, Bound]:
        """Forces where the line is accepted, in workspace of their own beside that of the loop, and what finds them."""
        parts, at = self._packed.parts, self._packed.placed.at
        out = forces_at(at)
        here, forces = Packed(at), Packed(out)
        each = (bound(add_forces, data, here, forces) for data in parts.kernel_data)
        return ElementForces(self._line, at, out, parts.parts), in_turn(Bound(clear, forces), *each)

    @cached_property
    def _at_solution(self) -> ElementForces:
        packed = self._packed
        return ElementForces(self._line, packed.at, packed.forces, packed.parts.parts)
