"""Assembly of the riser: its line, beam elements and rotational end springs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from riser_soil.assembly.shape import initial_shape, unstressed_shape
from riser_soil.core.part import Part
from riser_soil.riser import sections, shapes
from riser_soil.riser.ends import End
from riser_soil.riser.line import Line
from riser_soil.riser.springs import EndSpring
from riser_soil.scene.line_types import LineType
from riser_soil.scene.plane import resolved_dimension, vertical_plane
from riser_soil.scene.riser import Riser, RotationSpring, Support
from riser_soil.scene.scene import Scene

if TYPE_CHECKING:
    from riser_soil.riser.attachments import PointAttachment
    from riser_soil.riser.catenary import Catenary


def elements_of(scene: Scene) -> sections.Elements:
    """Properties of all elements, from start to end."""
    around = sections.Surroundings(
        gravity=scene.gravity,
        contents=scene.riser.contents.density if scene.riser.contents else 0.0,
        water=scene.water.density if scene.water else 0.0,
    )
    types = {name: _line_type(t) for name, t in scene.used_line_types.items()}
    segments = [sections.MeshedSegment(types[s.line_type], s.element_lengths) for s in scene.riser.segments]
    return sections.elements(segments, around)


def _line_type(given: LineType) -> sections.SectionProperties:
    """As the elements take it: properties of the same name as they are given, or the elements' own default."""
    EI_y, EI_z = given.bending_stiffness
    outer, inner = given.wall_diameters
    formed: dict[str, Any] = {
        "EI_y": EI_y,
        "EI_z": EI_z,
        "drag": (given.drag.normal, given.drag.tangential) if given.drag else (0.0, 0.0),
        "added_mass": (given.added_mass.normal, given.added_mass.tangential) if given.added_mass else (0.0, 0.0),
        "rotary_inertia": None if given.rotary_inertia is True else float(given.rotary_inertia),
        "damping": given.damping.time if given.damping else 0.0,
        "wall_outer_diameter": outer,
        "wall_inner_diameter": inner,
        "allowable_stress": given.wall.allowable_stress if given.wall else 0.0,
    }
    names = [each.name for each in fields(sections.SectionProperties) if each.name not in formed]
    same = {name: getattr(given, name) for name in names}
    return sections.SectionProperties(**formed, **{name: value for name, value in same.items() if value is not None})


def attachments_of(scene: Scene) -> tuple[PointAttachment, ...]:
    """Everything attached to the riser, one by one."""
    if not scene.riser.attachments:
        return ()
    from riser_soil.riser.attachments import PointAttachment

    water = scene.water.density if scene.water else 0.0
    return tuple(
        PointAttachment(
            arc,
            mass=given.mass,
            net_weight=scene.gravity * (given.mass - water * given.volume),
            volume=given.volume,
            drag_area=given.drag_area,
            added_mass=given.added_mass,
        )
        for given in scene.riser.attachments
        for arc in given.arcs
    )


def attached_weight(line: Line, attachments: Sequence[PointAttachment]) -> list[Part]:
    """The part of the attachments' weight less buoyancy, if there are any."""
    if not attachments:
        return []
    from riser_soil.riser.attachments import Attachments

    return [Attachments(line, attachments)]


def line_of(
    scene: Scene, elements: sections.Elements, attachments: Sequence[PointAttachment], active: bool
) -> tuple[Line, Catenary | None]:
    """The line in its initial shape, and the catenary where it is one."""
    unstressed = unstressed_shape(scene.riser, elements.arc)
    catenary, initial = initial_shape(scene, elements, attachments, unstressed)
    layout = shapes.layout(elements.arc, elements.outer_diameter, unstressed, initial)
    start, end = _end(scene.riser.start), _end(scene.riser.end)
    line = Line(
        resolved_dimension(scene),
        layout,
        start,
        end,
        direction=np.asarray(vertical_plane(scene).direction),
        active=active,
    )
    return line, catenary


def _end(given: str | Support) -> End:
    if not isinstance(given, Support):
        return End(prescribed=False)
    return End(prescribed=True, rotation_fixed=given.rotation == "fixed")


def spins_freely(riser: Riser) -> bool:
    """Whether no end keeps the riser from spinning about its own axis."""
    return not any(isinstance(end, Support) and end.rotation != "free" for end in (riser.start, riser.end))


def springs_of(riser: Riser, line: Line) -> list[Part]:
    """Rotational springs of the ends that have one; at rest in the line's present configuration."""
    ends = ((0, riser.start), (-1, riser.end))
    return [
        EndSpring(line, node, end.rotation.stiffness)
        for node, end in ends
        if isinstance(end, Support) and isinstance(end.rotation, RotationSpring)
    ]
