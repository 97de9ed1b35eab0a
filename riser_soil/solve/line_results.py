"""Section forces and contact results of a line by the forces that the line solver evaluated last.

Where it has not solved the step they are evaluated anew, by `step_results`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.bound import Bound, Packed, bound
from riser_soil.core.part import State
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import overrides
from riser_soil.riser.section_forces import section_input
from riser_soil.solve.packed_line import PackedLine

if TYPE_CHECKING:
    from riser_soil.contact.contact import RiserContact


class LineResults:
    """Results of one line; smooth: see `System`.

    The loop's forces are in the axes in which its step began, which parts with viscous forces don't know any more.
    """

    def __init__(self, packed: PackedLine, line: Line, smooth: bool) -> None:
        self._packed, self._line, self._smooth = packed, line, smooth
        self._solved: State | None = None  # last, where no forces may have jumped since
        self._committed: Array | None = None  # the line's places, where its last step was solved by the loop
        self._contacts: dict[RiserContact, tuple[Bound, Array]] = {}  # kernel, and the results that it writes
        self._whole = not any(overrides(part, "viscous_forces") for part in packed.parts.parts)

    def forget(self) -> None:
        """The line moves on."""
        self._solved = self._committed = None

    def solved(self, state: State) -> None:
        """Note the state that the line solver has solved for."""
        self._solved = state if self._smooth else None

    def commit(self) -> None:
        """Note that this state is accepted."""
        self._committed = self._line.x

    def element_residual(self, state: State) -> Array | None:
        """Residual of the line's elements (ne, 2 ndof) at an accepted state, the same array each time; None where the
        loop has not solved for it, or a step turns its axes.
        """
        return self._element_residual() if self._has_solved(state) and not self._line.turns_axes else None

    def section_input(self, state: State, on_ends: Callable[[], Array | None]) -> Array | None:
        """Input of section forces at an accepted state, see `SectionInput`; None where the loop has not solved for it.
        """
        if not self._has_solved(state):
            return None
        return section_input(self._line, self._packed.at, self._element_residual(), on_ends=on_ends())

    def contact_results(self, contact: RiserContact) -> Array | None:
        """Results of a contact where the line was committed last; None where it has not been by the loop."""
        if self._committed is not self._line.x:
            return None
        if contact not in self._contacts:
            self._contacts[contact] = self._bound_results(contact)
        write, results = self._contacts[contact]
        write()
        return results.copy()

    def _bound_results(self, contact: RiserContact) -> tuple[Bound, Array]:
        """Kernel that writes a contact's results in the line's last configuration, and their array."""
        from riser_soil.contact.contact import ContactResults, size_of, write_results

        parts: list[Any] = [*self._packed.parts.parts]
        data = parts[parts.index(contact)].kernel_data()
        sizes = self._line.nodes, contact.along.arc.size
        out = np.empty(size_of(*sizes))
        return bound(write_results, data, self._packed.packed_at, Packed(ContactResults.within(out, *sizes))), out

    def _has_solved(self, state: State) -> bool:
        """Whether a state is that of the step solved last, whose forces are still those of the line solver."""
        solved = self._solved
        return solved is not None and self._whole and state.v is solved.v and state.a is solved.a

    def _element_residual(self) -> Array:
        write, residual = self._written_residual
        write()
        return residual

    @cached_property
    def _written_residual(self) -> tuple[Bound, Array]:
        residual = np.zeros((self._line.length.size, 2 * self._line.ndof))
        return self._packed.write_residual(residual), residual
