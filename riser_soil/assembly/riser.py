"""Assembly of the riser: its line, beam elements and rotational end springs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from riser_soil.assembly.shape import initial_shape, unstressed_shape
from riser_soil.core.arrays import Array
from riser_soil.core.part import Part, State
from riser_soil.errors import SceneError
from riser_soil.riser import sections, shapes
from riser_soil.riser.attachments import Attachments, PointAttachment
from riser_soil.riser.catenary import Catenary
from riser_soil.riser.line import UP, Line
from riser_soil.riser.line_ends import End
from riser_soil.riser.sections import Elements
from riser_soil.riser.springs import EndSpring
from riser_soil.riser.wall_stress import HydrostaticPressure, Pressures
from riser_soil.scene.line_types import LineType
from riser_soil.scene.plane import resolved_dimension, vertical_plane
from riser_soil.scene.riser import Riser, RotationSpring, Support
from riser_soil.scene.scene import Scene

MOST_SHAPES = 30  # tried for marine growth
SETTLED = 1e-9  # of the riser's length: change of the first shape by which its growth is no other


def elements_of(scene: Scene) -> sections.Elements:
    """Properties of all elements, from start to end."""
    around = sections.Surroundings(
        gravity=scene.gravity,
        contents=scene.line.contents.density if scene.line.contents else 0.0,
        water=scene.water.density if scene.water else 0.0,
    )
    bare = elements_along(scene.line, scene.used_line_types, around)
    given = scene.water.marine_growth if scene.water else None
    return bare if given is None else _grown(scene, bare, np.array(given), around)


def _grown(scene: Scene, bare: sections.Elements, given: Array, around: sections.Surroundings) -> sections.Elements:
    """Elements with the marine growth, rows of z, thickness and density, of the heights at which the first shape hangs
    with it.

    SceneError where shape and growth do not settle.
    """
    from riser_soil.riser.additions import Growth, with_growth

    growth, attachments, grown = Growth(*given.T), attachments_of(scene), bare
    unstressed = unstressed_shape(scene.line, bare.arc)
    before: Array = np.full(bare.arc.size, np.inf)
    for _ in range(MOST_SHAPES):
        z = initial_shape(scene, grown, attachments, unstressed)[1].position[:, 2]
        if np.abs(z - before).max() < SETTLED * bare.arc[-1]:
            return grown
        grown, before = with_growth(bare, growth, z, around), z
    raise SceneError(
        "water.marine_growth: it changes the riser's first shape, and this the growth, without end; give riser.initial "
        "as points, or less growth"
    )


def elements_along(
    riser: Riser, line_types: Mapping[str, LineType], around: sections.Surroundings
) -> sections.Elements:
    """Elements of a riser of these line types; what is around changes mass and weight alone."""
    segments = [_of_type(line_types[s.line_type], s.element_lengths, around) for s in riser.segments]
    return _stiffened(riser, sections.joined(segments), around)


def _stiffened(riser: Riser, elements: sections.Elements, around: sections.Surroundings) -> sections.Elements:
    """Elements with the bend stiffeners of the ends that have one."""
    for end, is_last in ((riser.start, False), (riser.end, True)):
        if isinstance(end, Support) and end.bend_stiffener is not None:
            from riser_soil.riser.additions import Taper, with_taper

            elements = with_taper(elements, Taper(**end.bend_stiffener.model_dump()), is_last, around)
    return elements


def _of_type(given: LineType, lengths: Sequence[float], around: sections.Surroundings) -> sections.Elements:
    """Elements of a line type; what it does not give is None here."""
    EI_y, EI_z = given.bending_stiffness
    outer, inner = given.wall_diameters
    return sections.elements(
        lengths,
        around,
        EA=given.EA,
        EI_y=EI_y,
        EI_z=EI_z,
        GJ=given.GJ,
        mass=given.mass,
        outer_diameter=given.outer_diameter,
        inner_diameter=given.inner_diameter,
        submerged_weight=given.submerged_weight,
        rotary_inertia=None if given.rotary_inertia is True else float(given.rotary_inertia),
        pipe_diameter=given.pipe_diameter,
        wall_outer_diameter=outer,
        wall_inner_diameter=inner,
        allowable_stress=given.wall.allowable_stress if given.wall else None,
        drag=(given.normal_drag, given.drag.tangential if given.drag else 0.0),
        added_mass=(given.added_mass.normal, given.added_mass.tangential) if given.added_mass else None,
        vortices=given.vortices,
        in_line_vortices=given.in_line_vortices,
        damping=given.damping.time if given.damping else None,
        min_bend_radius=given.min_bend_radius,
        max_tension=given.max_tension,
    )


def attachments_of(scene: Scene) -> tuple[PointAttachment, ...]:
    """Everything attached to the riser, one by one."""
    if not scene.line.attachments:
        return ()
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
        for given in scene.line.attachments
        for arc in given.arcs
    )


def attached_weight(line: Line, attachments: Sequence[PointAttachment]) -> list[Part]:
    """The part of the attachments' weight less buoyancy, if there are any."""
    if not attachments:
        return []
    return [Attachments(line, attachments)]


def line_of(
    scene: Scene, elements: sections.Elements, attachments: Sequence[PointAttachment], active: bool, name: str
) -> tuple[Line, Catenary | None]:
    """The line in its initial shape, and the catenary where it is one."""
    unstressed = unstressed_shape(scene.line, elements.arc)
    catenary, initial = initial_shape(scene, elements, attachments, unstressed)
    layout = shapes.layout(elements.arc, elements.outer_diameter, unstressed, initial)
    start, end = _end(scene.line.start), _end(scene.line.end)
    line = Line(
        resolved_dimension(scene),
        layout,
        start,
        end,
        direction=np.asarray(vertical_plane(scene).direction),
        active=active,
        name=name,
        loose=elements.loose,
    )
    if scene.line.across is not None:
        line.keep_in_plane(scene.line.across)
    return line, catenary


def _end(given: str | Support) -> End:
    if not isinstance(given, Support) or given.jointed:
        return End(prescribed=False)
    return End(prescribed=True, rotation_fixed=given.rotation == "fixed", heaves=given.tensioner is not None)


def spins_freely(riser: Riser) -> bool:
    """Whether no end keeps the riser from spinning about its own axis."""
    return not any(isinstance(end, Support) and end.rotation != "free" for end in (riser.start, riser.end))


def springs_of(riser: Riser, line: Line) -> list[Part]:
    """Rotational springs of the ends that have one; at rest in the line's present configuration, or at their neutral
    angle.
    """
    springs = list[Part]()
    for node, end in ((0, riser.start), (-1, riser.end)):
        if isinstance(end, Support) and isinstance(end.rotation, RotationSpring):
            if end.rotation.neutral_angle is not None:
                line.turn_support(node, _to_neutral(line, node, end.rotation.neutral_angle))
            springs.append(EndSpring(line, node, end.rotation.stiffness))
    return springs


def _to_neutral(line: Line, node: int, angle: float) -> Array:
    """Rotation vector (3,) [rad] from an end's present tangent to its direction at a neutral angle [deg]."""
    at_rest = line.trial(State.at_rest(0.0, line.offset + line.size)).turn.tangent @ line.basis.T
    tangent = at_rest[node, 1 if node else 0]
    upwards = 1.0 if tangent[2] >= 0.0 else -1.0
    neutral = upwards * (np.sin(np.radians(angle)) * line.direction * upwards + np.cos(np.radians(angle)) * UP)
    across = np.cross(tangent, neutral)
    sine = float(np.linalg.norm(across))
    return np.asarray(across * (np.arctan2(sine, tangent @ neutral) / sine if sine > 0.0 else 1.0))


def no_wall_tension(scene: Scene) -> str:
    """Why there is no wall tension; empty where there is one."""
    if scene.water is None:
        needed = scene.line.contents or any(line.wall for line in scene.used_line_types.values())
        return "" if needed else "without water and contents it is the effective tension"
    if scene.water.surface_level is None:
        return "the pressure outside is unknown without water.surface_level"
    if any(line.outer_diameter is None for line in scene.used_line_types.values()):
        return "the pressure outside acts on outer_diameter, which a line type lacks"
    return ""


def pressures_of(scene: Scene, line: Line, elements: Elements) -> Pressures | None:
    """Both pressures; None where the wall tension is not known."""
    if no_wall_tension(scene):
        return None
    return Pressures(_inside(scene, line), _outside(scene), elements.pipe_bore, elements.pipe_diameter)


def _inside(scene: Scene, line: Line) -> HydrostaticPressure | None:
    given = scene.line.contents
    if given is None:
        return None
    ends = line.to_global(line.x[[0, -1]])[:, 2]
    level = float(ends.max()) if given.pressure_level is None else given.pressure_level
    return HydrostaticPressure(level, scene.gravity * given.density, given.pressure)


def _outside(scene: Scene) -> HydrostaticPressure | None:
    if scene.water is None or scene.water.surface_level is None:
        return None
    return HydrostaticPressure(scene.water.surface_level, scene.gravity * scene.water.density)
