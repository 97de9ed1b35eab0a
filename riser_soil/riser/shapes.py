"""Unstressed and initial shapes of the line: positions, tangents and section frames along its arc length.

A `Curve` holds node positions and unit tangents at both ends of each element. `layout` joins an unstressed
and an initial curve to what the line starts from.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError

X = np.array([1.0, 0.0, 0.0])
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Curve:
    """position (nn, 3) m; tangent (ne, 2, 3) unit tangents at the elements' first and second ends."""

    position: Array
    tangent: Array

    @property
    def chord(self) -> Array:
        return np.diff(self.position, axis=0)


@dataclass(frozen=True, eq=False)
class Layout:
    """A line before any load: unstressed shape and initial configuration, in global axes.

    arc: (nn,) arc length of the nodes, from the start. outer_diameter: (ne,).
    T0: (ne, 2, 3, 3) unstressed frames at element ends, columns tangent and two normals. chord0: (ne, 3)
    unstressed chords.
    position: (nn, 3) and rotation: (nn, 3, 3) of the initial configuration; rotation turns T0 to its frames
    there.
    """

    arc: Array
    outer_diameter: Array
    T0: Array
    chord0: Array
    position: Array
    rotation: Array


def straight(arc: Array, start: npt.ArrayLike = (0.0, 0.0, 0.0), direction: npt.ArrayLike = X) -> Curve:
    """A straight line of its own length from `start`."""
    unit = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
    return Curve(np.asarray(start) + arc[:, None] * unit, np.broadcast_to(unit, (arc.size - 1, 2, 3)).copy())


def between(arc: Array, start: npt.ArrayLike, end: npt.ArrayLike) -> Curve:
    """A straight line from `start` to `end`, evenly stretched."""
    first, last = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    chord = last - first
    if not np.any(chord):
        raise SceneError(
            "riser: start and end are the same point, so a straight line between them has no direction"
        )
    unit = straight(arc, first, chord)
    return Curve(first + (arc / arc[-1])[:, None] * chord, unit.tangent)


def through(arc: Array, points: npt.ArrayLike) -> Curve:
    """A smooth curve through points (np, 3), nodes at equal fractions of its arc length and of the
    polyline's.
    """
    polyline = np.asarray(points, dtype=float)
    steps = np.linalg.norm(np.diff(polyline, axis=0), axis=1)
    if len(polyline) < 2 or not np.all(steps > 0.0):
        raise SceneError("riser: points: at least two are needed, and no two in a row may coincide")
    along = np.concatenate([[0.0], np.cumsum(steps)])
    at = arc / arc[-1] * along[-1]
    position = np.stack([np.interp(at, along, polyline[:, i]) for i in range(3)], axis=1)
    return from_nodes(position, nodal_tangents(position))


def circle(
    arc: Array, centre: npt.ArrayLike, start: npt.ArrayLike, angle: float, axis: npt.ArrayLike
) -> Curve:
    """A circular arc from `start`, turning by `angle` (rad) about `axis` through `centre`; its length is the
    line's own.
    """
    middle, first = np.asarray(centre, dtype=float), np.asarray(start, dtype=float)
    k = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    spoke = first - middle
    spoke = spoke - k * (k @ spoke)
    of_arc, length = abs(angle) * float(np.linalg.norm(spoke)), float(arc[-1])
    if abs(of_arc - length) > 1e-6 * length:
        raise SceneError(
            f"riser.unstressed.arc: its length is {of_arc:.9g} m, but the segments sum to {length:.9g} m"
        )
    phi = (arc / arc[-1] * angle)[:, None]
    side = np.cross(k, spoke)
    position = first - spoke + np.cos(phi) * spoke + np.sin(phi) * side
    tangent = np.sign(angle) * (np.cos(phi) * side - np.sin(phi) * spoke)
    return from_nodes(position, tangent / np.linalg.norm(tangent, axis=1, keepdims=True))


def from_nodes(position: Array, tangent: Array) -> Curve:
    """A smooth curve from nodal positions and unit tangents, each (nn, 3)."""
    return Curve(position, np.stack([tangent[:-1], tangent[1:]], axis=1))


def nodal_tangents(position: Array) -> Array:
    """Unit tangents (nn, 3) of the circle (parabola at the ends) through each node and its neighbours."""
    chord = np.diff(position, axis=0)
    length = np.linalg.norm(chord, axis=1, keepdims=True)
    unit = chord / length
    tangent = np.empty_like(position)
    tangent[1:-1] = unit[:-1] * length[1:] + unit[1:] * length[:-1]
    tangent[0], tangent[-1] = unit[0], unit[-1]
    if len(position) > 2:
        inner = tangent[[1, -2]] / np.linalg.norm(tangent[[1, -2]], axis=1, keepdims=True)
        tangent[0], tangent[-1] = _reflected(inner[0], unit[0]), _reflected(inner[1], unit[-1])
    return np.asarray(tangent / np.linalg.norm(tangent, axis=1, keepdims=True))


def _reflected(tangent: Array, chord: Array) -> Array:
    """The tangent at the other end of a circular arc."""
    return np.asarray(2.0 * (tangent @ chord) * chord - tangent)


def frames_along(tangent: Array, second: Array) -> Array:
    """Frames (n, 3, 3) along unit tangents (n, 3), each turned from the one before by the smallest rotation.

    second: the second axis of the first frame, made normal to its tangent.
    """
    first = second - tangent[0] * (tangent[0] @ second)
    frames = np.empty((len(tangent), 3, 3))
    frames[0] = _columns(tangent[0], first / np.linalg.norm(first))
    for i, turn in enumerate(smallest_turns(tangent[:-1], tangent[1:])):
        frames[i + 1] = turn @ frames[i]
    return frames


def _columns(tangent: Array, second: Array) -> Array:
    return np.stack([tangent, second, np.cross(tangent, second)], axis=1)


def smallest_turns(a: Array, b: Array) -> Array:
    """Rotation matrices (n, 3, 3) that take unit vectors a to b, each (n, 3), along the great circle; half turns where
    they are opposite.

    Else half turns about a and about the direction between both, which stay exact where these are nearly opposite.
    """
    middle, first = a + b, _half_turns(a)
    opposite = np.einsum("ni,ni->n", a, b) < -1.0 + 1e-12
    for i in np.flatnonzero(opposite):
        middle[i], first[i] = np.cross(a[i], UP if abs(a[i] @ UP) < 0.9 else X), np.eye(3)
    return _half_turns(middle / np.linalg.norm(middle, axis=1, keepdims=True)) @ first


def _half_turns(axes: Array) -> Array:
    """Rotation matrices (n, 3, 3); axes (n, 3): unit."""
    return np.asarray(2.0 * axes[:, :, None] * axes[:, None, :] - np.eye(3))


def _second_axis(tangent: Array) -> Array:
    """Horizontal and normal to the tangent; y for a vertical one."""
    across = np.cross(UP, tangent)
    return across if np.linalg.norm(across) > 1e-6 else np.array([0.0, 1.0, 0.0])


def layout(arc: Array, outer_diameter: Array, unstressed: Curve, initial: Curve) -> Layout:
    """Layout of the line: the unstressed shape's frames, and rotations that bring them to the initial tangents.

    The first frame turns from the unstressed to the initial tangent by the smallest rotation, and along
    either curve frames turn by the smallest rotations, so the initial shape has no twist beyond that of its geometry. A
    node's rotation is that of the element after it; it serves the element before too where both curves have the same
    kink, or none.
    """
    T0 = _end_frames(unstressed.tangent, _second_axis(unstressed.tangent[0, 0]))
    [turn] = smallest_turns(unstressed.tangent[:1, 0], initial.tangent[:1, 0])
    T = _end_frames(initial.tangent, turn @ T0[0, 0, :, 1])
    first = T[:, 0] @ np.swapaxes(T0[:, 0], 1, 2)
    last = T[-1, 1] @ T0[-1, 1].T
    return Layout(
        arc, outer_diameter, T0, unstressed.chord, initial.position, np.concatenate([first, last[None]])
    )


def _end_frames(tangent: Array, second: Array) -> Array:
    """(ne, 2, 3, 3) from the tangents at element ends (ne, 2, 3)."""
    return frames_along(tangent.reshape(-1, 3), second).reshape(-1, 2, 3, 3)
