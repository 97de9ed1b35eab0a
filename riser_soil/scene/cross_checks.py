"""Consistency checks between parts of a scene, each of which is valid by itself."""

import math
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import assert_never

from riser_soil.core.quantities import Vector
from riser_soil.scene.code_check import checks_steel
from riser_soil.scene.code_check_conflicts import code_check_conflicts
from riser_soil.scene.end_checks import end_conflicts, hang_off_conflicts
from riser_soil.scene.ground_checks import feature_conflicts, ground_conflicts
from riser_soil.scene.line_types import LineType
from riser_soil.scene.output import SettlementSections
from riser_soil.scene.plane import initial_ends, leaving_the_plane, resolved_dimension
from riser_soil.scene.problem import Path, Problem, dotted, hint
from riser_soil.scene.riser import Contents, Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import HystereticSeabed
from riser_soil.scene.shapes import ArcShape, PointsShape
from riser_soil.scene.soil import Block
from riser_soil.scene.stage_checks import stage_conflicts
from riser_soil.scene.stages import DynamicStage
from riser_soil.scene.water import Waves
from riser_soil.scene.wave_kinds import Airy, GivenSpectrum, Jonswap, PiersonMoskowitz, Record, Regular, WaveKind

# A given unstressed shape may differ from the segments' length by this part; points leave out the curve.
_ARC_TOLERANCE = 1e-6
_POINTS_TOLERANCE = 0.05
# Distance between an end's position and the initial shape, relative to the riser's length.
_MEETING = 1e-6
# Strain of a riser pulled straight between its ends beyond which the positions must be a mistake.
_GREATEST_STRAIN = 0.1
_GREATEST_STRAIN_AT_FIRST = 0.5  # of a line that a joint lets go to where it belongs: the place of its body is a guess
# Part of its length by which a riser may start shorter when it is laid straight between its ends.
_GREATEST_SLACK = 1e-3

_Check = Callable[[Scene], Iterator[Problem]]


def conflicts(scene: Scene) -> list[Problem]:
    """All conflicts of the scene; a missing line type hides those that follow from it."""
    missing = list(_line_types_exist(scene))
    return missing or [problem for check in _CHECKS for problem in check(scene)]


def _line_types_exist(scene: Scene) -> Iterator[Problem]:
    for n, segment in enumerate(scene.line.segments):
        if segment.line_type not in scene.line_types:
            known = f"must be a key of line_types ({', '.join(scene.line_types)})"
            remedy = f"name one of them or add {segment.line_type}" + hint(
                segment.line_type, scene.line_types
            )
            yield Problem(("riser", "segments", n, "line_type"), known, remedy)


def _line_types_suffice(scene: Scene) -> Iterator[Problem]:
    for name, line in scene.used_line_types.items():
        for key, reason in _wanting(scene, line):
            yield Problem(("line_types", name, key), reason, f"add {key}: {_describe(key)}")


def _no_weight_without_gravity(scene: Scene) -> Iterator[Problem]:
    for name, line in scene.used_line_types.items():
        if scene.gravity == 0.0 and line.submerged_weight:
            path = ("line_types", name, "submerged_weight")
            yield Problem(path, "nothing weighs where gravity is 0", "leave it out, or give gravity")


def _wanting(scene: Scene, line: LineType) -> Iterator[tuple[str, str]]:
    """Keys that a line type of this scene lacks, and why they are needed."""
    if line.mass is None and (reason := _mass_needed(scene, line)):
        yield "mass", reason
    if line.outer_diameter is None and (reason := _diameter_needed(scene, line)):
        yield "outer_diameter", reason
    if line.GJ is None and resolved_dimension(scene) == 3:
        yield "GJ", f"needed in three dimensions{_why_three(scene)}"


def _mass_needed(scene: Scene, line: LineType) -> str | None:
    if scene.has_dynamic_stage:
        return "a dynamic stage needs the mass"
    if scene.gravity > 0.0 and line.submerged_weight is None:
        return "the weight follows from the mass, unless submerged_weight is given"
    return None


def _diameter_needed(scene: Scene, line: LineType) -> str | None:
    if isinstance(scene.seabed, HystereticSeabed):
        return "the law of a hysteretic seabed counts in diameters"
    if scene.water and any(each.wall for each in scene.used_line_types.values()):
        return "the pressure outside acts on it, and the stress of a wall follows from it"
    if scene.water and checks_steel(scene.code_check, scene.used_line_types):
        return "the pressure outside acts on it, and the code check of a steel pipe asks for that"
    if scene.water and scene.gravity > 0.0 and line.submerged_weight is None:
        return "buoyancy follows from the outer diameter, unless submerged_weight is given"
    if line.rotary_inertia is True and scene.has_dynamic_stage:
        return "rotary inertia follows from the diameters, unless it is given in kg.m"
    if scene.water and scene.water.marine_growth:
        return "marine growth lies around the outer diameter"
    if line.drag or line.added_mass or line.sheds or line.strakes:
        return "drag, added mass and vortices follow from the outer diameter"
    if scene.contact and scene.contact_at == "outer":
        return "the pipe's outer surface touches the ground, unless seabed.contact_at is axis"
    return None


def _why_three(scene: Scene) -> str:
    path = next(leaving_the_plane(scene), None)
    return f" ({dotted(path)} leaves the vertical plane)" if path else ""


def _describe(key: str) -> str:
    return LineType.model_fields[key].description or key


def _water_where_it_acts(scene: Scene) -> Iterator[Problem]:
    for name, line in scene.used_line_types.items():
        given = {"drag": line.drag, "added_mass": line.added_mass}
        acting = {key: each is not None and each.acts for key, each in given.items()}
        for key, acts in (acting | {"vortex_force": line.sheds, "strakes": line.strakes is not None}).items():
            if acts and not scene.water:
                remedy = f"add water: {{density: 1025.0}}, or leave out {key}"
                yield Problem(
                    ("line_types", name, key), "acts in water only, and the scene has no water", remedy
                )


def _pressure_on_walls_known(scene: Scene) -> Iterator[Problem]:
    for name, line in scene.used_line_types.items():
        if line.wall is not None and scene.water is not None and scene.water.surface_level is None:
            allowed = "its stress hangs on the pressure outside, which is unknown without water.surface_level"
            yield Problem(("line_types", name, "wall"), allowed, "give water.surface_level [m], or leave out wall")


def _attachments_fit(scene: Scene) -> Iterator[Problem]:
    length = scene.line.length
    for n, given in enumerate(scene.line.attachments):
        path: Path = ("riser", "attachments", n)
        for m, arc in enumerate(given.arcs):
            if arc > length * (1.0 + 1e-9):
                key = "to" if given.at is None else "at"
                place = (*path, key, m) if isinstance(given.at, tuple) else (*path, key)
                yield Problem(place, f"must not exceed the riser's length ({length:.6g} m)", "correct the arc length")
        for key in ("volume", "drag_area"):
            if getattr(given, key) > 0.0 and scene.water is None:
                remedy = f"add water: {{density: 1025.0}}, or leave out {key}"
                yield Problem((*path, key), "acts in water only, and the scene has no water", remedy)


def _stays_in_plane(scene: Scene) -> Iterator[Problem]:
    if scene.dimension == 2:
        for path in leaving_the_plane(scene):
            remedy = "set dimension: 3 or auto, or correct the value"
            yield Problem(path, "leaves the riser's vertical plane, but dimension is 2", remedy)


def _initial_shape_possible(scene: Scene) -> Iterator[Problem]:
    riser, path = scene.line, ("riser", "initial")
    if riser.initial == "catenary" and "free" in (riser.start, riser.end):
        remedy = "give both ends a position, or set initial: unstressed"
        yield Problem(path, "a catenary hangs between two ends with a position", remedy)
    elif riser.initial == "catenary" and scene.gravity == 0.0:
        yield Problem(path, "there is no catenary without gravity", "set initial: straight or unstressed")
    if riser.initial == "straight" and riser.unstressed != "straight" and "free" in (riser.start, riser.end):
        remedy = "give both ends a position, or set initial: unstressed"
        yield Problem(path, "straight needs two ends with a position here", remedy)


def _straight_without_slack(scene: Scene) -> Iterator[Problem]:
    """A straight line between ends nearer than its length would be a strut, and might stay one."""
    start, end, length = scene.line.start, scene.line.end, scene.line.length
    if scene.line.initial != "straight" or not isinstance(start, Support) or not isinstance(end, Support):
        return
    distance = math.dist(start.position, end.position)
    if distance < (1.0 - _GREATEST_SLACK) * length:
        yield Problem(
            ("riser", "initial"),
            f"straight would compress the riser's {length:g} m into the {distance:g} m between its ends",
            "set initial: catenary, give points, or place the end a length away and move it in a static stage",
        )


def _long_enough(scene: Scene) -> Iterator[Problem]:
    start, end, length = scene.line.start, scene.line.end, scene.line.length
    if not isinstance(start, Support) or not isinstance(end, Support):
        return
    distance = math.dist(start.position, end.position)
    greatest = _GREATEST_STRAIN_AT_FIRST if start.jointed or end.jointed else _GREATEST_STRAIN
    if distance > (1.0 + greatest) * length:
        apart = f"the ends are {distance:.6g} m apart, but the riser is only {length:.6g} m long"
        yield Problem(("riser", "end", "position"), apart, "lengthen the segments or bring the ends together")


def _unstressed_shape_fits(scene: Scene) -> Iterator[Problem]:
    shape, length = scene.line.unstressed, scene.line.length
    if isinstance(shape, ArcShape):
        yield from _same_length(("riser", "unstressed", "arc"), shape.arc.length, length, _ARC_TOLERANCE)
    if isinstance(shape, PointsShape):
        along = math.fsum(map(math.dist, shape.points, shape.points[1:]))
        yield from _same_length(("riser", "unstressed", "points"), along, length, _POINTS_TOLERANCE)


def _same_length(path: tuple[str, ...], along: float, length: float, tolerance: float) -> Iterator[Problem]:
    if abs(along - length) > tolerance * length:
        allowed = f"the shape is {along:.6g} m long, but the segments add up to {length:.6g} m"
        yield Problem(path, allowed, "correct the shape or the segments' lengths")


def _initial_shape_meets_the_supports(scene: Scene) -> Iterator[Problem]:
    ends = {"start": scene.line.start, "end": scene.line.end}
    for (key, end), point in zip(ends.items(), initial_ends(scene.line), strict=True):
        if isinstance(end, Support) and math.dist(end.position, point) > _MEETING * scene.line.length:
            place = ", ".join(f"{x:.6g}" for x in point)
            allowed = f"the riser's initial shape has its {key} at [{place}]"
            remedy = "make the two equal, or choose another initial shape (straight, catenary, points)"
            yield Problem(("riser", key, "position"), allowed, remedy)


def _passes_over_block(scene: Scene) -> Iterator[Problem]:
    start, end = scene.line.start, scene.line.end
    block = scene.soil.block if scene.soil else None
    if not isinstance(block, Block) or not isinstance(start, Support) or not isinstance(end, Support):
        return
    if scene.line.initial == "catenary" and not _crosses(block, start.position, end.position):
        remedy = "move the block under the touchdown zone"
        yield Problem(("soil", "block"), "the riser, seen from above, never passes over it", remedy)


def _crosses(block: Block, a: Vector, b: Vector) -> bool:
    """Whether the line from a to b, seen from above, meets the block (Liang and Barsky 1984)."""
    low, high = 0.0, 1.0
    for axis, (first, last) in enumerate((block.x, block.y)):
        step = b[axis] - a[axis]
        if step == 0.0:
            if not first <= a[axis] <= last:
                return False
            continue
        near, far = sorted(((first - a[axis]) / step, (last - a[axis]) / step))
        low, high = max(low, near), min(high, far)
    return low <= high


def _error_bars_from_the_beginning(scene: Scene) -> Iterator[Problem]:
    """Comparison runs have another mesh than the run that the scene begins with."""
    for name, wanted in (("accuracy", scene.accuracy is not None), ("error_bars", scene.error_bars)):
        if wanted and scene.initial is not None:
            yield Problem((name,), "coarser meshes can't begin with another run's end", f"leave out {name} or initial")


def _fields_of_soil(scene: Scene) -> Iterator[Problem]:
    if scene.soil is None and scene.output.soil_fields:
        yield Problem(("output", "soil_fields"), "the scene has no soil", "add soil, or leave it out")


def _sections_across_soil(scene: Scene) -> Iterator[Problem]:
    sections, length = scene.output.sections, scene.line.length
    path: Path = ("output", "sections")
    if scene.soil is None and sections != SettlementSections():
        yield Problem(path, "settlement is that of soil, and the scene has none", "add soil, or leave it out")
        return
    for n, arc in enumerate(sections.arcs or ()):
        if arc > length * (1.0 + 1e-9):
            allowed = f"must not exceed the riser's length ({length:.6g} m)"
            yield Problem((*path, "arcs", n), allowed, "correct the arc length")


_CONTENTS: Path = ("riser", "contents")


def contents_conflicts(scene: Scene) -> Iterator[Problem]:
    """Conflicts of the contents with the line types, and of slugs with each other."""
    given = scene.line.contents
    if given is None:
        return
    bores = {line.inner_diameter for line in scene.used_line_types.values()}
    if not any(bores):
        remedy = "give inner_diameter in line_types, or leave out contents"
        yield Problem(_CONTENTS, "no line type of the riser has room for contents", remedy)
    elif given.uneven_or_moving and len(bores) > 1:
        sizes = ", ".join(f"{bore:g}" for bore in sorted(bores))
        allowed = f"flow and slugs need one bore, and inner_diameter is {sizes} m"
        yield Problem(_CONTENTS, allowed, "make them equal, or leave out speed and slugs")
    yield from _somewhere(given)
    yield from _apart(given, scene.line.length)


def _somewhere(given: Contents) -> Iterator[Problem]:
    for n, slug in enumerate(given.slugs):
        if given.speed == 0.0 and slug.front is None:
            allowed = "slugs without a speed do not move, and their place is not given"
            yield Problem((*_CONTENTS, "slugs", n, "front"), allowed, "give front [m], or riser.contents.speed [m/s]")


def _apart(given: Contents, length: float) -> Iterator[Problem]:
    if len(given.slugs) > 1 and any(slug.spacing for slug in given.slugs):
        allowed = "slugs that follow each other at a spacing are the only ones in a scene"
        yield Problem((*_CONTENTS, "slugs"), allowed, "give one slug with a spacing, or each one with its front")
        return
    placed = sorted((given.front_of(slug, length), n) for n, slug in enumerate(given.slugs))
    for (behind, _), (front, n) in pairwise(placed):
        if front - given.slugs[n].length < behind - 1e-9 * length:
            allowed = f"lies over another one, whose front is at {_arc(given, behind, length):g} m"
            yield Problem((*_CONTENTS, "slugs", n), allowed, "move its front, or shorten it")


def _arc(given: Contents, front: float, length: float) -> float:
    """Arc length of a front that is so far from where the flow comes in [m]."""
    return front if given.speed >= 0.0 else length - front


# A wave breaks at the latest at this height over its length, times tanh kh (Miche 1944).
_BREAKING = 0.142
_LOWER = "lower the waves or lengthen their period"
_LATE = 1e-9  # part of a record's duration by which the stages may be longer


def water_conflicts(scene: Scene) -> Iterator[Problem]:
    """Conflicts of surface and waves with seabed and gravity."""
    if scene.water is None or scene.water.surface_level is None:
        return
    if scene.has_ground and scene.water.surface_level <= scene.seabed_level:
        allowed = f"must lie above the seabed (z = {scene.seabed_level:g} m)"
        yield Problem(("water", "surface_level"), allowed, "raise it, lower the seabed, or leave out water")
    elif scene.water.waves is not None:
        yield from _possible(scene, scene.water.waves)


def _possible(scene: Scene, waves: Waves) -> Iterator[Problem]:
    """Waves that can't exist are no sea at all; steep ones are a doubt."""
    if scene.gravity == 0.0:
        yield Problem(("water", "waves"), "there are no waves without gravity", "give gravity, or leave out waves")
        return
    for path, train in waves.each:
        if isinstance(train, Regular):  # solved for as it is; where there is none, that is told
            continue
        if train.height > (highest := _highest(scene.gravity, scene.water_depth, train.period)):
            which = f"waves of {train.period:.4g} s{_where(scene.water_depth)}"
            allowed = f"must not exceed {highest:.4g} m: higher {which} break"
            yield Problem(("water", "waves", *path, *_height_key(train)), allowed, _LOWER)
        if isinstance(train, Record) and train.record.duration * (1.0 + _LATE) < (acting := _acting(scene)):
            allowed = f"{train.file} lasts {train.record.duration:.6g} s, but waves act for {acting:.6g} s in all"
            yield Problem(("water", "waves", *path, "file"), allowed, "shorten the stages, or take a longer record")


def _height_key(train: WaveKind) -> tuple[str, ...]:
    match train:
        case Airy() | Regular():
            return ("height",)
        case Jonswap() | PiersonMoskowitz():
            return ("Hs",)
        case GivenSpectrum() | Record():
            return ("file",)
    assert_never(train)


def _acting(scene: Scene) -> float:
    """Duration of all dynamic stages [s]."""
    return math.fsum(stage.duration for stage in scene.stages if isinstance(stage, DynamicStage))


def _highest(g: float, h: float, period: float) -> float:
    """A bound of Miche's limit that needs no wave length L: L tanh kh = g T^2/2 pi tanh^2 kh, and is below 2 pi h."""
    return _BREAKING * min(g * period**2 / (2.0 * math.pi), 2.0 * math.pi * h)


def _where(h: float) -> str:
    return f" in {h:g} m of water" if math.isfinite(h) else ""


_CHECKS: tuple[_Check, ...] = (
    _line_types_suffice,
    _no_weight_without_gravity,
    _water_where_it_acts,
    _pressure_on_walls_known,
    _attachments_fit,
    contents_conflicts,
    _stays_in_plane,
    ground_conflicts,
    _initial_shape_possible,
    _straight_without_slack,
    _long_enough,
    _unstressed_shape_fits,
    _initial_shape_meets_the_supports,
    _passes_over_block,
    _fields_of_soil,
    _sections_across_soil,
    _error_bars_from_the_beginning,
    end_conflicts,
    hang_off_conflicts,
    feature_conflicts,
    water_conflicts,
    stage_conflicts,
    code_check_conflicts,
)
