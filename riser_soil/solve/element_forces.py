"""What acts within a riser's elements, and its section forces, by the kernels of its parts; see `part_kernels`.

As `riser.section_forces`, which asks the parts' methods one by one. At an accepted state of a riser alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.bound import Bound, in_turn
from riser_soil.core.compiled import njit
from riser_soil.core.packed import Packed
from riser_soil.core.part import State
from riser_soil.riser.configuration import (
    Configuration,
    PlanarConfiguration,
    put_moment_maps,
)
from riser_soil.riser.hermite import put_pulled_back
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart, overrides
from riser_soil.riser.part_kernels import LineForces, add_forces, bound, clear, forces_of
from riser_soil.riser.placed_line import PlacedLine
from riser_soil.riser.section_forces import NO_FRAMES, section_input, viscous_residual
from riser_soil.riser.section_kernels import SectionForces, put_section_forces, size_of
from riser_soil.riser.sections import Elements


class ElementForces:
    """Residuals of the elements of a line and its section forces, in a configuration where parts have put their forces.

    parts: of the line, for what follows from strain rates.
    """

    def __init__(self, line: Line, at: Configuration, forces: LineForces, parts: Sequence[LinePart]) -> None:
        self._line = line
        self._damped = [part for part in parts if overrides(part, "viscous_forces")]
        self._at, self._residual = at, np.zeros((line.length.size, 2 * line.ndof))
        self._put = Bound(put_residual, Packed(at), Packed(forces), Packed(self._residual))
        self._elements: Elements | None = None

    def residual(self) -> Array:
        """Sum over parts and groups (ne, 2 ndof); the same array each time."""
        self._put()
        return self._residual

    def section_forces(self, elements: Elements, state: State) -> Array:
        """Of the line whose elements these are, see `SectionForces.within`."""
        if self._elements is not elements:
            self._bind_sections(elements)
        self.residual()
        if self._damped:
            self._viscous[...] = viscous_residual(self._line, self._damped, state)
        self._put_sections()
        return self._sections.copy()

    def _bind_sections(self, elements: Elements) -> None:
        line, at, self._elements = self._line, self._at, elements
        maps = np.empty((line.nodes, 3, line.frames.dofs))
        frames = (NO_FRAMES, NO_FRAMES) if isinstance(at, PlanarConfiguration) else (at.frame1, at.frame2)
        viscous = np.zeros_like(self._residual) if self._damped else None
        given = section_input(line, elements, self._residual, viscous, at.x, maps, at.tangent, *frames)
        self._viscous, self._sections = given.viscous, np.empty(size_of(line.nodes))
        self._put_sections = in_turn(
            bound(put_moment_maps, at, Packed(np.ascontiguousarray(line.turning_axes)), Packed(maps)),
            Bound(put_section_forces, Packed(given), Packed(SectionForces.within(self._sections, line.nodes))),
        )


class AcceptedForces:
    """What the parts of a line put within its elements at an accepted state: room of its own beside that of the loop.

    placed: the line there; parts: with their numbers. whole: whether the loop's forces tell the same, where it has
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
            *(bound(add_forces, numbers, here, forces) for _, numbers in parts),
        )
        self.forces = ElementForces(line, placed.at, out, [part for part, _ in parts])

    def found(self, state: State) -> ElementForces:
        """At an accepted state, to whose time the numbers have been brought."""
        self._placed.move(state)
        self._find()
        return self.forces


@njit
def put_residual(at: Configuration, forces: LineForces, out: Array) -> None:
    """Write the sum of all groups within the elements."""
    q = forces.inertia_q + forces.force_q + forces.end_q
    put_pulled_back(q, at.P, out, at.D, at.R)
    for e in range(out.shape[0]):
        for i in range(out.shape[1]):
            out[e, i] += forces.inertia_e[e, i] + forces.force_e[e, i]
