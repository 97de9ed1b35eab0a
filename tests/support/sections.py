"""Section forces of a line at one state, by residuals of its parts, as results find them for many."""

from __future__ import annotations

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser.line import Line
from riser_soil.riser.section_forces import SectionForces, on_ends, placed, section_input
from riser_soil.riser.sections import Elements


def section_forces(
    line: Line,
    elements: Elements,
    state: State,
    residual: Array,
    viscous: Array | None = None,
    nodal: Array | None = None,
) -> SectionForces:
    """By residuals from `element_residual`, `viscous_residual`, `nodal_residual`."""
    given = section_input(line, placed(line, state), residual, viscous, on_ends(line, state, nodal))
    return SectionForces(line, elements, given)
