"""Section forces, moments and reactions of the line, from the residuals of its elements.

An element's residual, summed over the parts that act within it, is what its neighbours exert on its ends. So
moments contain the fixed-end part of distributed loads and inertia; without it they are useless on coarse
meshes.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.bound import Bound, Packed, bound, in_turn
from riser_soil.core.part import State
from riser_soil.riser.configuration import Configuration, PlanarConfiguration, write_moment_maps
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart, LineParts, overrides
from riser_soil.riser.placed_line import LineTrials
from riser_soil.riser.section_kernels import (
    SectionForces,
    SectionInput,
    size_of,
    write_end_forces,
    write_section_forces,
)
from riser_soil.riser.sections import Elements

NOTHING = np.empty((0, 0))


def element_residual(line: Line, parts: Iterable[LinePart | LineParts], state: State) -> Array:
    """Sum over parts (ne, 2 ndof)."""
    return _total((part.element_forces(state) for part in parts), (line.length.size, 2 * line.ndof))


def viscous_residual(line: Line, parts: Iterable[LinePart], state: State) -> Array | None:
    """The share of `element_residual` (ne, 2 ndof) that follows from strain rates; None where no part has any."""
    damped = [part.viscous_forces(state) for part in parts if overrides(part, "viscous_forces")]
    return _total(damped, (line.length.size, 2 * line.ndof)) if damped else None


def nodal_residual(line: Line, parts: Iterable[LinePart], state: State) -> Array | None:
    """Sum (nn, ndof) of what acts on nodes but isn't a support, if anything: contact with soil, point loads and masses.
    """
    forces_of_parts = [forces for part in parts if (forces := part.nodal_forces(state)) is not None]
    return _total(forces_of_parts, (line.nodes, line.ndof)) if forces_of_parts else None


def _total(forces: Iterable[Array | None], shape: tuple[int, int]) -> Array:
    total = np.zeros(shape)
    for values in forces:
        if values is not None:
            total += values
    return total


def section_forces(
    line: Line, elements: Elements, state: State, residual: Array, viscous: Array | None = None
) -> SectionForces:
    """Section forces at the nodes, averaged over the two adjoining elements.

    residual: from `element_residual`; viscous: from `viscous_residual`, for the curvature follows from the rest of
    the bending moment.
    """
    return SectionForces.within(section_vector(line, elements, state, residual, viscous), line.nodes)


def section_vector(
    line: Line, elements: Elements, state: State, residual: Array, viscous: Array | None = None
) -> Array:
    """Section forces at the nodes in one vector, in the order of `SectionForces`; arguments as of `section_forces`."""
    return line.once(_SectionsAtTrials).found(elements, state, residual, viscous)


class _SectionsAtTrials:
    """Section forces of a line at trial states, by kernels that are bound once."""

    def __init__(self, line: Line) -> None:
        self._line, self._trial = line, line.once(LineTrials).now
        self._bound: dict[tuple[Elements, bool], tuple[BoundSections, Array, Array | None]] = {}

    def found(self, elements: Elements, state: State, residual: Array, viscous: Array | None) -> Array:
        key = elements, viscous is not None
        if key not in self._bound:
            own = np.empty(residual.shape), None if viscous is None else np.empty(viscous.shape)
            self._bound[key] = BoundSections(self._line, elements, self._trial.at, *own), *own
        sections, kept, kept_viscous = self._bound[key]
        kept[...] = residual
        if kept_viscous is not None:
            kept_viscous[...] = viscous
        self._trial.move(state)
        return sections.found()


class BoundSections:
    """Section forces of a line in a configuration by residuals (ne, 2 ndof) in arrays that may be written to anew."""

    def __init__(
        self, line: Line, elements: Elements, at: Configuration, residual: Array, viscous: Array | None
    ) -> None:
        maps = np.empty((line.nodes, 3, line.frames.dofs))
        none = np.empty((0, 3, 3))
        frames = (none, none) if isinstance(at, PlanarConfiguration) else (at.frame1, at.frame2)
        given = residual, NOTHING if viscous is None else viscous, at.x, maps, at.tangent, *frames
        constant = line.basis, line.origin, line.arc, elements.bends_beside, *elements.flexibility
        needed = SectionInput(*given, *(np.ascontiguousarray(values) for values in constant))
        self._out = np.empty(size_of(line.nodes))
        self._put = in_turn(
            bound(write_moment_maps, at, Packed(np.ascontiguousarray(line.turning_axes)), Packed(maps)),
            Bound(write_section_forces, Packed(needed), Packed(SectionForces.within(self._out, line.nodes))),
        )

    def found(self) -> Array:
        """Section forces at the nodes in one vector, in the order of `SectionForces`; a copy."""
        self._put()
        return self._out.copy()


def add_at_ends(line: Line, state: State, nodal: Array, inside: SectionForces) -> None:
    """Add what acts on the nodes at the line's ends, from `nodal_residual`, to what is exerted there: the sum is what
    the supports exert. A spring is a support, so its moment belongs to it.
    """
    maps, d = _moment_maps(line, state), line.dimension
    for n in (0, -1):
        inside.end_force[n] += line.basis @ nodal[n, :d]
        inside.end_moment[n] += maps[n] @ nodal[n, d:]


def end_forces(line: Line, state: State, residual: Array) -> tuple[Array, Array]:
    """Force and moment on the elements' ends, each (ne, 2, 3), global axes."""
    shape = line.length.size, 2, 3
    force, moment = np.empty(shape), np.empty(shape)
    write_end_forces(np.ascontiguousarray(residual), line.basis, _moment_maps(line, state), force, moment)
    return force, moment


def _moment_maps(line: Line, state: State) -> Array:
    """Maps (nn, 3, r) of what is conjugate to the rotation dofs of nodes to moments in global axes."""
    maps: Array = line.trial(state).once("moment maps", lambda trial: trial.turn.moment_maps(line.turning_axes))
    return maps


def at_most(beside: Array) -> Array:
    """The larger (..., nn) of what the elements beside a node have there (..., ne, 2)."""
    first, second = np.full((2, *beside.shape[:-2], beside.shape[-2] + 1), -np.inf)
    first[..., :-1], second[..., 1:] = np.moveaxis(beside, -1, 0)
    return np.maximum(first, second)
