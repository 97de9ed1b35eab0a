"""End points of the riser's initial shape."""

import math

from riser_soil.core.quantities import Vector
from riser_soil.scene.riser import Riser, Support
from riser_soil.scene.shapes import ArcShape, CircularArc, PointsShape
from riser_soil.scene.vectors import cross, dot, minus, plus, times

_ORIGIN = (0.0, 0.0, 0.0)
_ALONG_X = (1.0, 0.0, 0.0)


def initial_ends(riser: Riser) -> tuple[Vector, Vector]:
    """Start and end of the initial shape [m]; they must lie at the prescribed positions of the ends."""
    start, end = (e.position if isinstance(e, Support) else None for e in (riser.start, riser.end))
    if isinstance(riser.initial, PointsShape):
        return riser.initial.points[0], riser.initial.points[-1]
    if riser.initial != "unstressed" and start is not None and end is not None:
        return start, end
    if riser.initial == "unstressed" and isinstance(riser.unstressed, PointsShape):
        return riser.unstressed.points[0], riser.unstressed.points[-1]
    if riser.initial == "unstressed" and isinstance(riser.unstressed, ArcShape):
        return riser.unstressed.arc.from_point, _far_end(riser.unstressed.arc)
    return _straight(start, end, riser.length)


def _straight(start: Vector | None, end: Vector | None, length: float) -> tuple[Vector, Vector]:
    """A straight unstressed riser: from start towards end; along +x when an end is free."""
    first = start or _ORIGIN
    chord = minus(end, first) if start and end else _ALONG_X
    distance = math.hypot(*chord)
    direction = times(1.0 / distance, chord) if distance > 0.0 else _ALONG_X
    return first, plus(first, times(length, direction))


def _far_end(arc: CircularArc) -> Vector:
    """The arc's last point, by Rodrigues' formula."""
    axis = times(1.0 / math.hypot(*arc.axis), arc.axis)
    arm, angle = minus(arc.from_point, arc.centre), math.radians(arc.angle_deg)
    turned = plus(times(math.cos(angle), arm), times(math.sin(angle), cross(axis, arm)))
    return plus(arc.centre, plus(turned, times((1.0 - math.cos(angle)) * dot(axis, arm), axis)))
