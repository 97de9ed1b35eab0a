"""Records of a line: a copy of each accepted state, and all results that follow from many copies at once.

Copied are the few vectors that change as the riser moves on. The results are computed for many steps together, as each
of their operations takes an interpreter longer than the numbers of one instant do.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.contact.touchdown import contact_intervals, merged, touchdown_arc, touchdown_points
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved, Stateful, gathered, restore_all
from riser_soil.core.snapshot import Record, stacked
from riser_soil.results.bending_misfit import bending_misfits
from riser_soil.results.riser_record import code_values, riser_values
from riser_soil.results.settlement_trough import sections_of
from riser_soil.riser.hermite import axis_at
from riser_soil.riser.section_forces import SectionForces
from riser_soil.solve.time_stepper import TimeStepper

if TYPE_CHECKING:
    from riser_soil.assembly.soil_assembly import SoilAssembly
    from riser_soil.code_checks.line_checks import LineChecks
    from riser_soil.contact.contact import ContactResults


class StateCopy(NamedTuple):
    """A line's accepted state, in vectors that later steps don't change.

    inside: a `SectionInput` in one vector; contacts: `ContactResults` of each contact in one. pressure: change of that
    inside since the first stage began [Pa]. ground: quantities of the ground, by their names in a `Record`.
    """

    inside: Array
    pressure: float
    contacts: tuple[Array, ...]
    ground: dict[str, Array]


class InstantReader:
    """Copies a run's states, and makes records of them; on the rank that has the riser.

    fields: names of the quantities wanted, of those of contact and ground. checks: its code checks, None for none.
    """

    def __init__(self, riser: LineAssembly, fields: Sequence[str] = (), checks: LineChecks | None = None) -> None:
        self._riser, self._fields = riser, fields
        self._embedment: Array = np.zeros(riser.line.nodes)
        self._sections = sections_of(riser) if "settlement_across" in self._fields else None
        self._checks = checks

    def begin_stage(self, name: str) -> None:
        """Begin a stage; records of all copies of the stage before have been made."""
        if self._checks is not None:
            self._checks.begin_stage(name)

    def copy(self, stepper: TimeStepper, lay_sections: bool = False) -> StateCopy:
        """A copy of the accepted state.

        lay_sections: where the riser lies now; they are laid anyway as long as they are nowhere.
        """
        contacts, state = self._riser.contacts, stepper.now
        inside = stepper.newton.accepted.section_input(self._riser.line, state)
        contact_results = tuple(stepper.newton.accepted.contact_results(contact, state) for contact in contacts)
        if self._sections is not None and (lay_sections or not self._sections.laid):
            of_one = self._inside(inside[None])
            arc, _, _ = self._touchdown(of_one, self._results_of_contacts([own[None] for own in contact_results]))
            self._sections.lay(of_one.position[0], of_one.tangent[0], float(arc[0]))
        return StateCopy(inside, self._riser.pressure_change(state.t), contact_results, self._ground(state))

    def _ground(self, state: State) -> dict[str, Array]:
        wanted = self._fields if self._riser.contacts else ()
        values = {} if self._sections is None else self._sections.values(state)
        if "slip" in wanted:
            values["slip"] = self._slip()
        if "soil_settlement" in wanted and self._riser.soil is not None:
            values["soil_settlement"] = self._settlement(self._riser.soil, state)
        if "force_on_soil" in wanted:
            values["force_on_soil"] = self._on_soil(state)
        return values

    def record_of(self, copies: Sequence[StateCopy], misfits: bool = False) -> Record:
        """All results of copied states, each of them once and in their order: embedments only grow.

        misfits: whether those of the elements' bending are in it.
        """
        inside = self._inside(np.stack([each.inside for each in copies]))
        packed = [np.stack(vectors) for vectors in zip(*(each.contacts for each in copies), strict=True)]
        contacts = self._results_of_contacts(packed)
        pressed = np.sum([np.zeros(inside.effective_tension.shape), *(of.force_per_length for of in contacts)], axis=0)
        pressure = np.array([each.pressure for each in copies])
        values = riser_values(self._riser, inside, pressed, pressure)
        if self._checks is not None:
            values |= code_values(self._riser, self._checks, inside, pressed, pressure)
        if misfits:
            smooth, steep = bending_misfits(self._riser.line, self._riser.elements, inside.ends)
            values |= {"smooth_misfit": smooth, "steep_misfit": steep}
        values |= self._touch(inside, contacts) | stacked([each.ground for each in copies])
        return Record(self._riser.line.arc, values)

    def _inside(self, numbers: Array) -> SectionForces:
        return SectionForces(self._riser.line, self._riser.elements, numbers)

    def _results_of_contacts(self, numbers: Sequence[Array]) -> list[ContactResults]:
        """Results of each contact from packed numbers, a row an instant."""
        if not numbers:
            return []
        from riser_soil.contact.contact import ContactResults

        nodes, contacts = self._riser.line.nodes, self._riser.contacts
        sizes = [contact.along.arc.size for contact in contacts]
        return [ContactResults.within(own, nodes, size) for own, size in zip(numbers, sizes, strict=True)]

    def _touch(self, inside: SectionForces, contacts: Sequence[ContactResults]) -> dict[str, Array | None]:
        count, fields = len(inside.position), self._fields
        arc, position, points = self._touchdown(inside, contacts)
        return {
            "touchdown_arc": arc,
            "touchdown_position": position,
            "touchdown_points": points,
            "max_penetration": np.max([np.zeros(count), *(of.deepest[:, 0] for of in contacts)], axis=0),
            "contact_force_sum": np.sum([np.zeros((count, 3)), *(of.on_riser for of in contacts)], axis=0),
            "penetration": self._deepest([of.penetration for of in contacts]) if "penetration" in fields else None,
            "embedment": self._embedded([of.depth for of in contacts]) if "embedment" in fields else None,
        }

    def _touchdown(self, inside: SectionForces, contacts: Sequence[ContactResults]) -> tuple[Array, Array, IntArray]:
        """Arc length (nt,) and position (nt, 3) of the touchdown point, number of touchdown points (nt,)."""
        count, line = len(inside.position), self._riser.line
        if not contacts:
            return np.full(count, np.nan), np.full((count, 3), np.nan), np.zeros(count, dtype=np.int64)

        with_results = zip(self._riser.contacts, contacts, strict=True)
        of_each = [contact_intervals(*contact.along, of.clearance, of.force) for contact, of in with_results]
        near = float(line.length.max())
        at_instants = [merged([*itertools.chain(*grounds)], near) for grounds in zip(*of_each, strict=True)]
        arc = np.array([touchdown_arc(intervals) for intervals in at_instants])
        count_of_points = np.array([touchdown_points(intervals) for intervals in at_instants])
        return arc, axis_at(line.arc, inside.position, inside.tangent, arc)[0], count_of_points

    def _deepest(self, depths: Sequence[Array]) -> Array | None:
        return np.max(depths, axis=0) if depths else None

    def _embedded(self, depths: Sequence[Array]) -> Array | None:
        """The greatest depth yet."""
        deepest = self._deepest(depths)
        if deepest is None:
            return None
        grown = np.maximum.accumulate(np.concatenate([self._embedment[None], deepest]))[1:]
        self._embedment = grown[-1]
        return grown

    def _slip(self) -> Array:
        return np.sum([friction.slip() for friction in self._riser.frictions], axis=0)

    def _settlement(self, soil: SoilAssembly, state: State) -> Array:
        return soil.contact.settlement(self._riser.line.positions3(state)[:, :2], state)

    def _on_soil(self, state: State) -> Array:
        """Force per length on the soil [N/m], of contact and friction together."""
        parts = [] if self._riser.soil is None else self._riser.soil.pressed_by
        return np.sum([part.force_on_soil_per_length(state) for part in parts], axis=0)

    def state(self) -> Saved:
        return {"embedment": self._embedment} | gathered(self._owners)

    def restore(self, saved: Saved) -> None:
        self._embedment = saved["embedment"]
        restore_all(self._owners, saved)

    @property
    def _owners(self) -> dict[str, Stateful]:
        owners: dict[str, Stateful] = {} if self._sections is None else {"sections": self._sections}
        return owners if self._checks is None else owners | {"code checks": self._checks}
