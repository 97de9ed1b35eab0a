"""Assembly of the riser's unstressed shape and initial configuration."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, assert_never

import numpy as np

from riser_soil.assembly.scales import contact_radius
from riser_soil.core.arrays import Array
from riser_soil.riser import sections, shapes
from riser_soil.riser.catenary import Catenary, catenary
from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.riser import Riser, Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.shapes import ArcShape, PointsShape

if TYPE_CHECKING:
    from riser_soil.riser.attachments import PointAttachment

# The least radius H/w of a first shape's bends, over the elements' length, and over the length (EI/w)^(1/3) that a line
# needs to bend under its own weight: sharper than elements and pipe can follow.
SHARPEST_IN_ELEMENTS = 0.5
SHARPEST_BEND = 0.4
DIP = 5.0  # over the depth of an end below springs: the length over which the first shape goes down to it
ROUND_OFF = 1e-12  # strain of a line as long as its ends are apart


def _ends(riser: Riser) -> tuple[Array | None, Array | None]:
    start, end = (np.asarray(e.position) if isinstance(e, Support) else None for e in (riser.start, riser.end))
    return start, end


def unstressed_shape(riser: Riser, arc: Array) -> shapes.Curve:
    match riser.unstressed:
        case ArcShape(arc=given):
            return shapes.circle(arc, given.centre, given.from_point, np.radians(given.angle_deg), given.axis)
        case PointsShape(points=points):
            return shapes.through(arc, points)
        case "straight":
            return _straight(riser, arc)
        case _:
            assert_never(riser.unstressed)


def _straight(riser: Riser, arc: Array) -> shapes.Curve:
    """Straight line from start to end; along x where an end is free."""
    start, end = _ends(riser)
    if start is None or end is None or np.array_equal(start, end):
        return shapes.straight(arc, np.zeros(3) if start is None else start)
    return shapes.straight(arc, start, end - start)


def initial_shape(
    scene: Scene, elements: sections.Elements, attachments: Sequence[PointAttachment], unstressed: shapes.Curve
) -> tuple[Catenary | None, shapes.Curve]:
    """The first shape, and the catenary where it is one."""
    given = scene.line.initial
    match given:
        case "catenary":
            start, end = _ends(scene.line)
            assert start is not None, "the scene's checks let no catenary start without two prescribed ends"
            assert end is not None
            catenary = catenary_between(scene, elements, attachments, start, end)
            tension = tensions_of_taut(elements, start, end)
            if catenary.slack > 0.0 and tension is not None:  # so steep that no cable's bend counts
                return None, _pulled_straight(elements, tension, start, end)
            return catenary, _down_to(catenary.curve, elements, start, end)
        case PointsShape(points=points):
            return None, shapes.through(elements.arc, points)
        case "straight":
            return None, _laid_straight(scene.line, elements.arc)
        case "unstressed":
            return None, unstressed
        case _:
            assert_never(given)


def tensions_of_taut(elements: sections.Elements, start: Array, end: Array) -> Array | None:
    """Tensions (ne,) [N] amid the elements of a line that is pulled straight between two places: each stretches by
    T l/EA, and T grows by w dz. None where some of it is pressed, as where its own weight stretches it enough.
    """
    distance, rise = float(np.linalg.norm(end - start)), float(end[2] - start[2])
    if distance == 0.0:
        return None
    gained = elements.weight * elements.length * (rise / distance)
    above_start = np.cumsum(gained) - 0.5 * gained
    flexibility = elements.length / elements.EA
    at_start = (distance - elements.length.sum() - (above_start * flexibility).sum()) / flexibility.sum()
    tension: Array = at_start + above_start
    return tension if (tension > -ROUND_OFF * elements.EA).all() else None


def _pulled_straight(elements: sections.Elements, tension: Array, start: Array, end: Array) -> shapes.Curve:
    """Straight between the ends, stretched by the tensions (ne,) that this takes."""
    along = np.append(0.0, np.cumsum(elements.length * (1.0 + tension / elements.EA)))
    return shapes.between(along, start, end)


def _laid_straight(riser: Riser, arc: Array) -> shapes.Curve:
    """Straight between the ends, as long as they are apart; along x where one is free."""
    start, end = _ends(riser)
    if start is not None and end is not None:
        return shapes.between(arc, start, end)
    return shapes.straight(arc, np.zeros(3) if start is None else start)


def catenary_between(
    scene: Scene,
    elements: sections.Elements,
    attachments: Sequence[PointAttachment],
    start: Array,
    end: Array,
    near: Catenary | None = None,
) -> Catenary:
    """The riser as a catenary between two points (3,) [m], on the ground where there is one, from its surface where one
    of them lies below springs; near: as of `catenary`.
    """
    ends, level = np.array([start, end]), resting_level(scene, elements, np.array([start, end]))
    if scene.laid_from_below:
        ends[:, 2] = np.maximum(ends[:, 2], level)
    return catenary(
        elements.arc,
        ends[0],
        ends[1],
        elements.weight,
        elements.EA,
        level=level,
        points=np.array([(attachment.arc, attachment.net_weight) for attachment in attachments]).reshape(-1, 2),
        least_H=_least_tension(elements),
        heaps=not elements.bends.any(),
        surface=_surface(scene),
        near=near,
    )


def _down_to(curve: shapes.Curve, elements: sections.Elements, start: Array, end: Array) -> shapes.Curve:
    """A curve whose ends are brought down to places below them, over some times how deep they are."""
    position, arc = curve.position.copy(), elements.arc
    for node, place, away in ((0, start, arc), (-1, end, arc[-1] - arc)):
        sunk = position[node, 2] - place[2]
        if sunk > 0.0:
            position[:, 2] -= sunk * np.maximum(0.0, 1.0 - away / min(DIP * sunk, arc[-1])) ** 2
            position[node] = place
    if np.array_equal(position, curve.position):
        return curve
    return shapes.from_nodes(position, shapes.nodal_tangents(position))


def _surface(scene: Scene) -> float:
    """Height z [m] of the water's surface; inf where it is not known."""
    level = None if scene.water is None else scene.water.surface_level
    return np.inf if level is None else level


def resting_level(scene: Scene, elements: sections.Elements, ends: Array) -> float:
    """Height z [m] of the axis where the thinnest of the riser rests, below the lower of its ends (2, 3) [m]; -inf
    where there is nothing to rest on. A trench in soil doesn't count.
    """
    if scene.contact is None:
        return -np.inf
    x, y, z = (float(value) for value in ends[np.argmin(ends[:, 2])])
    ground = ground_height(scene, (x, y, z)) if scene.soil is None else scene.seabed_level
    return ground + float(contact_radius(scene, elements).min())


def least_bend(elements: sections.Elements) -> float:
    """The shortest length (EI/w)^(1/3) [m] over which the line bends under its own weight; inf where nothing weighs."""
    w, EI = np.abs(elements.weight), np.maximum(elements.EI_y, elements.EI_z)
    return float(np.cbrt(EI[w > 0.0] / w[w > 0.0]).min(initial=np.inf))


def _least_tension(elements: sections.Elements) -> float:
    """H [N] of a catenary that the elements can follow: where they bend, for chain goes slack."""
    w, EI = np.abs(elements.weight), np.maximum(elements.EI_y, elements.EI_z)
    least = np.maximum(SHARPEST_IN_ELEMENTS * w * elements.length, SHARPEST_BEND * np.cbrt(EI * w**2))
    return float(least.max(where=elements.bends, initial=0.0))
