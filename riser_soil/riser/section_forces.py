"""Section forces, moments and reactions of the line, from the residuals of its elements.

An element's residual, summed over the parts that act within it, is what its neighbours exert on its ends. So
moments contain the fixed-end part of distributed loads and inertia; without it they are useless on coarse
meshes.

A section's moment M changes along the unstressed arc s as M' = F x t, with the section's force F and the unit tangent
t, so its magnitude as |M|' = M . (F x t)/|M|. Both ends of an element have a value and a slope of their own.

All is evaluated for many states at once, whose inputs are rows of one array. Each number follows from its row alone,
by operations that round in one way wherever a number lies, so it does not depend on how many rows there are.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cached_property
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, views
from riser_soil.core.part import State
from riser_soil.riser.bending_peaks import largest_between_nodes
from riser_soil.riser.components import across, at_ends, cross, dot, ends_in_front, mean_beside, size, vectors
from riser_soil.riser.configuration import Configuration, PlanarConfiguration
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart, LineParts, overrides
from riser_soil.riser.placed_line import LineTrials
from riser_soil.riser.sections import Elements

NEGLIGIBLE = 1e-9  # of the line's largest moment: one that is none but for round-off


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


def on_ends(line: Line, state: State, nodal: Array | None) -> Array | None:
    """Force and moment (2, 2, 3) in global axes on the nodes at the line's two ends, by `nodal_residual`."""
    if nodal is None:
        return None
    d, maps = line.dimension, line.trial(state).turn.moment_maps(line.turning_axes, [0, -1])
    loads = zip(nodal[[0, -1]], maps, strict=True)
    return np.stack([[line.basis @ load[:d], to_global @ load[d:]] for load, to_global in loads])


def _total(forces: Iterable[Array | None], shape: tuple[int, int]) -> Array:
    total = np.zeros(shape)
    for values in forces:
        if values is not None:
            total += values
    return total


def placed(line: Line, state: State) -> Configuration:
    """The line's configuration at a state, until the next call."""
    trial = line.once(LineTrials).now
    trial.move(state)
    return trial.at


class SectionInput(NamedTuple):
    """Input of section forces at one state; at many states with one axis more in front.

    residual (ne, 2, ndof): at the elements' ends, from `element_residual`; viscous: its viscous share, (0, 2, ndof) for
    none. on_ends (2, 2, 3): what acts on the nodes at the line's two ends, each by force and moment, from `on_ends`.
    x (nn, d), tangent (ne, 2, d): in the line's axes. turn: in a plane the nodes' angles (nn,); in space H (nn, 3, 3):
    H^T times a moment is conjugate to the rotation dofs. first_frame, second_frame (ne, 3, 3): at the elements' ends;
    (0, 3, 3) in a plane.
    """

    residual: Array
    on_ends: Array
    x: Array
    tangent: Array
    turn: Array
    first_frame: Array
    second_frame: Array
    viscous: Array

    @classmethod
    def within(cls, rows: Array, line: Line) -> SectionInput:
        """Views of packed numbers (..., n), from `section_input`."""
        shapes = _shapes(line)
        damped = rows.shape[-1] > sum(map(math.prod, shapes))
        return cls(*views(rows, [*shapes, (len(line.length) if damped else 0, 2, line.ndof)]))


def _shapes(line: Line) -> list[tuple[int, ...]]:
    """Shapes of the arrays of `SectionInput`, without viscous forces."""
    nn, ne, d = line.nodes, line.length.size, line.dimension
    turn, frame = ((nn,), (0, 3, 3)) if d == 2 else ((nn, 3, 3), (ne, 3, 3))
    return [(ne, 2, line.ndof), (2, 2, 3), (nn, d), (ne, 2, d), turn, frame, frame]


def section_input(
    line: Line, at: Configuration, residual: Array, viscous: Array | None = None, on_ends: Array | None = None
) -> Array:
    """A copy of all that the section forces at a state follow from in one vector, see `SectionInput`.

    residual, viscous (ne, 2 ndof), on_ends (2, 2, 3): see there; None for none.
    """
    turn = (at.angle,) if isinstance(at, PlanarConfiguration) else (at.H, at.frame1, at.frame2)
    parts = (
        residual,
        np.zeros((2, 2, 3)) if on_ends is None else on_ends,
        at.x,
        at.tangent,
        *turn,
        *(() if viscous is None else (viscous,)),
    )
    return np.concatenate([part.ravel() for part in parts])


class ElementEnds(NamedTuple):
    """Section forces at the elements' ends less their viscous share, along the line's axes, see `components`.

    force (d, 2, ..., ne) [N], moment (r, 2, ..., ne) [N m]; tangent (d, 2, ..., ne): unit; frames (3, 3, 2, ..., ne):
    axes of the sections, one behind the other, None in a plane; turn: see `SectionInput`.
    """

    force: Array
    moment: Array
    tangent: Array
    frames: Array | None
    turn: Array


class SectionForces:
    """Section forces and moments, exerted by the line after a node on the line before it, in global axes.

    They are of one state, or of many with one axis more in front. At a node they are means of the two elements beside
    it. Curvatures follow from the bending moment less its viscous share.
    """

    def __init__(self, line: Line, elements: Elements, rows: Array) -> None:
        """rows (..., n): from `section_input`."""
        self._line, self._elements = line, elements
        self._input = SectionInput.within(rows, line)

    @cached_property
    def position(self) -> Array:
        """Places of the nodes (nn, 3) [m]."""
        return self._in_global(np.moveaxis(self._input.x, -1, 0)) + self._line.origin

    @cached_property
    def tangent(self) -> Array:
        """Unit tangents at the elements' ends (ne, 2, 3), in the direction of growing arc length."""
        return np.moveaxis(self._in_global(self._tangent), 0, -2)

    @cached_property
    def force(self) -> Array:
        """Force at the nodes (nn, 3) [N]."""
        return self._in_global(self._force)

    @cached_property
    def moment(self) -> Array:
        """Moment at the nodes (nn, 3) [N m]."""
        return self._moment_in_global(self._moment)

    @cached_property
    def effective_tension(self) -> Array:
        """Tension at the nodes (nn,) [N], positive in tension."""
        return dot(self._force, self._axis)

    @cached_property
    def bending_moment(self) -> Array:
        """Magnitude at the nodes (nn,) [N m]."""
        return size(self._bending)

    @property
    def moment_slope(self) -> Array:
        """Slope of the bending moment's magnitude at the elements' ends (ne, 2) [N].

        It differs beside a node on which a force or contact acts. From an end where there is no moment but for
        round-off, as in a hinge, it grows. It is 0 in elements without any at their ends, as of a chain.
        """
        return np.moveaxis(self._moment_slope, 0, -1)

    @cached_property
    def curvature(self) -> Array:
        """Magnitude at the nodes (nn,) [1/m]."""
        return mean_beside(self._curvature)

    @property
    def curvature_beside(self) -> Array:
        """Magnitude of the curvature at the elements' ends (ne, 2) [1/m], which differs where stiffnesses meet."""
        return np.moveaxis(self._curvature, 0, -1)

    @cached_property
    def curvature_slope(self) -> Array:
        """Slope of the curvature's magnitude at the elements' ends (ne, 2) [1/m2]."""
        moment = at_ends(self.bending_moment)
        bends = np.broadcast_to(np.maximum(*self._elements.flexibility), moment.shape).copy()
        np.divide(self._curvature, moment, out=bends, where=moment > negligible(self.bending_moment))
        return np.moveaxis(self._moment_slope * bends, 0, -1)

    @cached_property
    def about_axes(self) -> Array:
        """Torque and bending moments about the section's own y and z axes (nn, 3) [N m].

        In space the first section's y axis is horizontal before all motion, to the left of the tangent (of a vertical
        one along the global y axis), and z completes the right-handed frame; along the riser frames follow without
        twist. In a plane y is normal to it, to the left of the direction from start to end, and so z points up where
        the riser is level.
        """
        if self._frames is not None:
            moment = at_ends(self._moment, axis=1)
            components = np.stack([mean_beside(dot(axis, moment)) for axis in self._frames], axis=-1)
            return np.asarray(components * self._elements.bends_beside[:, None])
        components, (x, y, _) = np.zeros((*self._moment.shape[1:], 3)), self._line.normal
        components[..., 1] = (y * self._line.basis[0, 0] - x * self._line.basis[1, 0]) * self._moment[0]
        return np.asarray(components * self._elements.bends_beside[:, None])

    @cached_property
    def end_force(self) -> Array:
        """Force of the supports on the line's two ends (2, 3) [N]."""
        return self.force[..., [0, -1], :] * [[-1.0], [1.0]] + self._input.on_ends[..., 0, :]

    @cached_property
    def end_moment(self) -> Array:
        """Moment of the supports, springs among them, on the line's two ends (2, 3) [N m]."""
        return self.moment[..., [0, -1], :] * [[-1.0], [1.0]] + self._input.on_ends[..., 1, :]

    @cached_property
    def least_tension(self) -> tuple[Array, Array]:
        """Least effective tension of the nodes [N], of equal ones the first, and its arc length [m], each (...,)."""
        at = self.effective_tension.argmin(axis=-1)
        return self.effective_tension.min(axis=-1), self._line.arc[at]

    @cached_property
    def largest_moment(self) -> tuple[Array, Array]:
        """Largest bending moment, between nodes too [N m], and its arc length [m], each (...,)."""
        moment = np.moveaxis(at_ends(self.bending_moment), 0, -1)
        return largest_between_nodes(self._line.arc, moment, self.moment_slope)[:2]

    @cached_property
    def largest_curvature(self) -> tuple[Array, Array]:
        """Largest curvature, between nodes too [1/m], and its arc length [m], each (...,)."""
        return largest_between_nodes(self._line.arc, self.curvature_beside, self.curvature_slope)[:2]

    @property
    def ends(self) -> ElementEnds:
        """Forces and moments at the elements' ends."""
        elastic, d = self._sections, self._line.dimension
        if self._damped:
            elastic = elastic - _of_sections(self._input.viscous)
        maps = None if self._maps is None else at_ends(self._maps, axis=2)
        moment = _moment_of(elastic[d:], maps)
        return ElementEnds(elastic[:d], moment, self._tangent, self._frames, self._input.turn)

    # Along the line's axes, with components in front, see `components`:

    @cached_property
    def _maps(self) -> Array | None:
        """Inverse transposes (3, 3, ..., nn) of the maps from rotation dofs, by columns; None in a plane."""
        if self._line.dimension == 2:
            return None
        H = np.moveaxis(self._input.turn, (-1, -2), (0, 1))
        columns = [cross(H[1], H[2]), cross(H[2], H[0]), cross(H[0], H[1])]
        return np.stack(columns) / dot(H[0], columns[0])

    @cached_property
    def _sections(self) -> Array:
        """What acts in the sections at the elements' ends (d + r, 2, ..., ne): forces, and what turns the dofs."""
        return _of_sections(self._input.residual)

    @cached_property
    def _tangent(self) -> Array:
        """Unit tangents (d, 2, ..., ne) at the elements' ends."""
        return ends_in_front(self._input.tangent)

    @cached_property
    def _frames(self) -> Array | None:
        """Section axes (3, 3, 2, ..., ne) at the elements' ends, one behind the other; None in a plane."""
        both = self._input.first_frame, self._input.second_frame
        in_front = [np.moveaxis(frames, (-1, -2), (0, 1)) for frames in both]
        return None if self._line.dimension == 2 else np.stack(in_front, axis=2)

    @cached_property
    def _force(self) -> Array:
        """(d, ..., nn)."""
        return mean_beside(np.moveaxis(self._sections[: self._line.dimension], 1, 0))

    @cached_property
    def _moment(self) -> Array:
        """(r, ..., nn)."""
        return self._moment_at_nodes(self._sections)

    def _moment_at_nodes(self, sections: Array) -> Array:
        turning = mean_beside(np.moveaxis(sections[self._line.dimension :], 1, 0))
        return _moment_of(turning, self._maps)

    @cached_property
    def _axis(self) -> Array:
        """Unit tangents (d, ..., nn) at the nodes, in the mean direction."""
        mean = mean_beside(np.moveaxis(self._tangent, 1, 0))
        return np.asarray(mean / size(mean))

    @cached_property
    def _bending(self) -> Array:
        """Moments (r, ..., nn) across the line; none between chains."""
        moment, bends = across(self._moment, self._axis), self._elements.bends_beside
        return moment if bends.all() else np.asarray(moment * bends)

    @cached_property
    def _elastic(self) -> Array:
        """Bending moments (r, ..., nn) less their viscous share."""
        if not self._damped:
            return self._bending
        viscous = self._moment_at_nodes(_of_sections(self._input.viscous))
        return np.asarray(self._bending - across(viscous, self._axis))

    @property
    def _damped(self) -> bool:
        return self._input.viscous.shape[-3] > 0

    @cached_property
    def _moment_slope(self) -> Array:
        """(2, ..., ne)."""
        return moment_slopes(self._bending, cross(self._sections[: self._line.dimension], self._tangent))

    @cached_property
    def _curvature(self) -> Array:
        """Bending moment over stiffness (2, ..., ne), about both section axes where there are two stiffnesses."""
        (y, z), frames = self._elements.flexibility, self._frames
        if frames is None:
            return np.asarray(at_ends(size(self._elastic)) * y)
        moment = at_ends(self._elastic, axis=1)
        return np.asarray(np.sqrt((dot(frames[1], moment) * y) ** 2 + (dot(frames[2], moment) * z) ** 2))

    def _in_global(self, components: Array) -> Array:
        """Vectors (..., 3) in global axes by components (d, ...) along the line's axes."""
        if len(components) == 3:
            return vectors(components)
        out = np.empty((*components.shape[1:], 3))
        for i, (along, up) in enumerate(self._line.basis):
            np.multiply(components[0], along, out=out[..., i])
            out[..., i] += components[1] * up
        return out

    def _moment_in_global(self, components: Array) -> Array:
        """Moments (..., 3) in global axes by components (r, ...)."""
        if len(components) == 3:
            return vectors(components)
        return vectors(np.stack([components[0] * along for along in self._line.normal]))


def moment_slopes(moment: Array, shear: Array) -> Array:
    """Slopes (2, ..., ne) of the magnitude of moments across the line, see `SectionForces.moment_slope`.

    moment (r, ..., nn): at the nodes [N m]; shear (r, 2, ..., ne): cross product of the section's force and the unit
    tangent at the elements' ends [N].
    """
    magnitude = size(moment)
    at_end = at_ends(magnitude)
    none = at_end <= negligible(magnitude)
    slope = np.divide(dot(at_ends(moment, axis=1), shear), at_end, out=np.zeros(at_end.shape), where=~none)
    for end, grows in enumerate((none[0] & ~none[1], none[1] & ~none[0])):
        slope[end][grows] = (1.0 - 2.0 * end) * size(shear[:, end][:, grows])
    return slope


def negligible(magnitude: Array) -> Array:
    """The largest moment (..., 1) that counts as none beside magnitudes (..., nn)."""
    return np.asarray(NEGLIGIBLE * magnitude.max(axis=-1, keepdims=True))


def _of_sections(residual: Array) -> Array:
    """Residuals (..., ne, 2, n) at the elements' ends as what acts in the sections there (n, 2, ..., ne)."""
    sections = ends_in_front(residual)
    sections[:, 0] *= -1.0
    return sections


def _moment_of(turning: Array, maps: Array | None) -> Array:
    """Moments (r, ...) by what is conjugate to the rotation dofs, with `SectionForces._maps`."""
    return turning if maps is None else np.stack([dot(maps[:, i], turning) for i in range(3)])


def at_most(beside: Array) -> Array:
    """The larger (..., nn) of what the elements beside a node have there (..., ne, 2)."""
    first, second = np.full((2, *beside.shape[:-2], beside.shape[-2] + 1), -np.inf)
    first[..., :-1], second[..., 1:] = np.moveaxis(beside, -1, 0)
    return np.maximum(first, second)
