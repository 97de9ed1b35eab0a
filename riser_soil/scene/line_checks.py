"""Consistency checks of scenes with several lines: each line by itself, names, joints, and what is not there yet."""

import math
from collections.abc import Iterator

from riser_soil.core.quantities import Vector
from riser_soil.core.step_outputs import OF_STEP
from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.cross_checks import conflicts
from riser_soil.scene.ground_checks import ROUND_OFF, below_seabed
from riser_soil.scene.joints import Joint, JointPoint
from riser_soil.scene.lines import ENDS, apart_from_joints, arc_of, axis_across, by_line, first_place, risers
from riser_soil.scene.output import SettlementSections
from riser_soil.scene.plane import VerticalPlane, leaving_the_plane, positions
from riser_soil.scene.problem import Path, Problem, dotted, hint, shown, value_at
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import HystereticSeabed
from riser_soil.scene.stages import OfBody, StaticStage
from riser_soil.scene.variants import at_offset
from riser_soil.scene.vessel_checks import vessel_conflicts, vessels_of_end

_FILES = ("soil", "results")  # other files of a run
# At the root of results.nc, beside what steps have, and of modes.nc.
_IN_RESULTS = (
    *("time", "stage", "step", "step_time", "step_stage", "component", "section", "offset"),
    *("bodies", "joints", "clearance"),
    *(output.name for output in OF_STEP),
)
_IN_MODES = ("mode", "direction", "frequency", "period", "share")
_RESERVED = frozenset((*_FILES, *_IN_RESULTS, *_IN_MODES))
_OF_LEDGER = ("dissipated_", "work_")  # beginnings of the names of a part's energies
_OF_STAGE = ("move", "motion", "loads")
_ORIGIN = (0.0, 0.0, 0.0)
_ALONG = ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0))  # a plane, by the axis across it


def all_conflicts(scene: Scene) -> list[Problem]:
    """All conflicts of a scene, whether it has one line or several, with its vessel at its offset, too."""
    return _conflicts(scene) or [*vessel_conflicts(scene)] or [*_at_offset(scene)]


def _at_offset(scene: Scene) -> Iterator[Problem]:
    """Conflicts that the vessel's offset brings in a scene without others; none before hang-offs are found."""
    if scene.vessel is None or any(line.hangs_off for line in risers(scene).values()):
        return
    moved = at_offset(scene)
    for problem in _conflicts(moved):
        given = value_at(moved.model_dump(by_alias=True), problem.path)
        allowed = f"then {dotted(problem.path)}, {shown(given)}, {problem.allowed}"
        yield Problem(("vessel", "offset"), allowed, problem.remedy)


def _conflicts(scene: Scene) -> list[Problem]:
    if not scene.lines:
        return [*conflicts(scene), *_without_lines(scene)]
    checks = (_names, _joints, _bodies, _stages, _clearances, _soil, _seabed, _for_nothing, _hang_offs, _plane, _water)
    own = [problem for check in checks for problem in check(scene)] or [*_above_seabed(scene)]
    if own:
        return own
    problems = {(p.path, p.allowed): p for name, view in by_line(scene).items() for p in _moved(conflicts(view), name)}
    return [*problems.values(), *_clearances_beyond(scene)]


def _without_lines(scene: Scene) -> Iterator[Problem]:
    if scene.output.clearance:
        yield Problem(("output", "clearance"), "is one between lines, and the scene has riser", "leave it out")
    if scene.soil is not None and scene.soil.line is not None:
        yield Problem(("soil", "line"), "the scene has riser, not lines", "leave it out")
    if scene.seabed is not None and scene.seabed.direction_deg is not None:
        yield Problem(("seabed", "direction_deg"), "slope and profile run along the riser's plane", "leave it out")
    for n, stage in enumerate(scene.stages):
        if stage.lines:
            yield Problem(("stages", n, "lines"), "the scene has riser, not lines", "give move, motion and loads here")
        if stage.bodies:
            yield Problem(("stages", n, "bodies"), "the scene has riser, not lines", "leave it out")


def _moved(problems: list[Problem], name: str) -> Iterator[Problem]:
    """Problems with the paths that the keys of a line have in the scene."""
    for problem in problems:
        yield Problem(path_of_line(problem.path, name), problem.allowed, problem.remedy)


def path_of_line(path: Path, name: str) -> Path:
    """A path in a line's own scene, as it is in the whole one."""
    if path[:1] == ("riser",):
        return ("lines", name, *path[1:])
    if path[:1] == ("stages",) and len(path) > 2 and path[2] in _OF_STAGE:
        return (*path[:2], "lines", name, *path[2:])
    return path


def _names(scene: Scene) -> Iterator[Problem]:
    for key, names in (("lines", scene.lines), ("bodies", scene.bodies), ("joints", scene.joints)):
        for name in names:
            if not name.replace("_", "").replace("-", "").isalnum() or not name.isascii():
                yield Problem((key, name), "names files: letters, digits, _ and - alone", "rename it")
    for name in scene.lines:
        if name in scene.bodies:
            yield Problem(("bodies", name), "a line has the same name", "rename one of the two")
        if name in _RESERVED or name.startswith(_OF_LEDGER):
            yield Problem(("lines", name), "is the name of another file or group of the results", "rename it")


def _joints(scene: Scene) -> Iterator[Problem]:
    for name, joint in scene.joints.items():
        path: Path = ("joints", name)
        ends = enumerate(joint.between)
        problems = [p for n, point in ends for p in _point(scene, (*path, "between", n), joint, point)]
        yield from problems
        if problems:
            continue
        first, second = joint.between
        if (first.line, first.body) == (second.line, second.body):
            yield Problem((*path, "between"), "both points are of the same line or body", "name two of them")
        elif any(_free_end(scene, point) for point in joint.between) and first_place(scene, joint) is None:
            yield Problem((*path, "position"), "nothing says where the joint is at first", "give position [m]")


def _point(scene: Scene, path: Path, joint: Joint, point: JointPoint) -> Iterator[Problem]:
    for key, known in (("line", scene.lines), ("body", scene.bodies)):
        name = getattr(point, key)
        if name is not None and name not in known:
            allowed = f"must be one of {', '.join(known) or 'none: the scene has no ' + key}"
            yield Problem((*path, key), allowed, f"name one of them{hint(name, known)}")
            return
    turns = joint.kind == "clamped" or (joint.stiffness is not None and joint.stiffness.rotation is not None)
    if point.body is not None and not scene.bodies[point.body].turns:
        if any(point.offset):
            yield Problem((*path, "offset"), "a point has no place beside its own", "leave it out, or make it rigid")
        if turns:
            yield Problem((*path, "body"), "a point has no direction to clamp to", "pin the joint, or make it rigid")
    if point.line is not None:
        line = scene.lines[point.line]
        if arc_of(line, point) > line.length:
            yield Problem((*path, "at"), f"must not exceed the line's length ({line.length:.6g} m)", "correct the arc")
        types = (scene.line_types.get(segment.line_type) for segment in line.segments)
        if turns and not max((max(each.bending_stiffness) for each in types if each is not None), default=1.0):
            yield Problem((*path, "line"), "a line without bending stiffness (EI: 0) bears no moment", "pin the joint")


def _bodies(scene: Scene) -> Iterator[Problem]:
    """How bodies touch the seabed."""
    for name, body in scene.bodies.items():
        given, path = body.contact, ("bodies", name, "contact")
        if given is None:
            continue
        if scene.seabed is None:
            yield Problem(path, "is that with a seabed, and the scene has none", "add seabed, or leave it out")
        if given.points is not None and not body.turns:
            yield Problem((*path, "points"), "a point has none beside its own place", "leave it out, or make it rigid")
        if given.stiffness is not None and isinstance(scene.seabed, HystereticSeabed):
            remedy = "give width, or leave it out"
            yield Problem((*path, "stiffness"), "a hysteretic seabed has its own, in seabed.law", remedy)


def _above_seabed(scene: Scene) -> Iterator[Problem]:
    """Where bodies and joints are at first; of a scene without other conflicts of its lines."""
    view = next(iter(by_line(scene).values()))
    if not scene.contact or view.laid_from_below:
        return
    places: list[tuple[Path, Vector | None]] = [
        (("bodies", name, "position"), body.position) for name, body in scene.bodies.items()
    ]
    places += [(("joints", name, "position"), joint.position) for name, joint in scene.joints.items()]
    for path, place in places:
        if place is not None and place[2] < (ground := ground_height(view, place)) - ROUND_OFF:
            yield below_seabed(path, ground)


def _free_end(scene: Scene, point: JointPoint) -> bool:
    return point.line is not None and point.at in ENDS and getattr(scene.lines[point.line], str(point.at)) == "free"


def _stages(scene: Scene) -> Iterator[Problem]:
    for n, stage in enumerate(scene.stages):
        for key in _OF_STAGE:
            if getattr(stage, key, None):
                remedy = f"write lines: {{NAME: {{{key}: ...}}}} in the stage"
                yield Problem(("stages", n, key), "does not say of which line it is", remedy)
        for name, own in stage.lines.items():
            path: Path = ("stages", n, "lines", name)
            if name not in scene.lines:
                allowed = f"must be one of lines ({', '.join(scene.lines)})"
                yield Problem(path, allowed, f"name one of them{hint(name, scene.lines)}")
                continue
            key, way = ("motion", own.motion) if isinstance(stage, StaticStage) else ("move", own.move)
            if way is not None:
                yield Problem((*path, key), f"a {stage.kind} stage has none", "give it in a stage of the other kind")
            for key, moved in (("move", own.move), ("motion", own.motion)):
                for end in ENDS:
                    if getattr(moved, end, None) is not None and _jointed(scene, name, end):
                        yield Problem((*path, key, end), "a joint holds this end", "leave it out")
        for name, acts in stage.bodies.items():
            yield from _on_body(scene, ("stages", n, "bodies", name), name, acts)


def _on_body(scene: Scene, path: Path, name: str, acts: OfBody) -> Iterator[Problem]:
    if name not in scene.bodies:
        allowed = f"must be one of bodies ({', '.join(scene.bodies)})"
        yield Problem(path, allowed, f"name one of them{hint(name, scene.bodies)}")
        return
    for m, load in enumerate(acts.loads):
        if load.moment is not None and not scene.bodies[name].turns:
            yield Problem((*path, "loads", m, "moment"), "a point does not turn", "leave it out, or take kind: rigid")


def _clearances(scene: Scene) -> Iterator[Problem]:
    for n, pair in enumerate(scene.output.clearance):
        path: Path = ("output", "clearance", n, "between")
        for m, name in enumerate(pair.between):
            if name not in scene.lines:
                allowed = f"must be one of lines ({', '.join(scene.lines)})"
                yield Problem((*path, m), allowed, f"name one of them{hint(name, scene.lines)}")
        if pair.between[0] == pair.between[1]:
            yield Problem(path, "a line has no clearance from itself", "name two lines")
        before = [other.key for other in scene.output.clearance[:n]]
        if pair.key in before:
            allowed = f"is {pair.key} in the results, as output.clearance.{before.index(pair.key)} is"
            yield Problem(path, allowed, "leave one out, turn the two names round, or rename a line")


def _clearances_beyond(scene: Scene) -> Iterator[Problem]:
    """Problems of clearances whose `beyond` leaves no element of a line; for a scene without other conflicts."""
    for n, pair in enumerate(scene.output.clearance):
        for name in pair.between:
            if not any(apart_from_joints(scene, name, pair.beyond)):
                allowed = f"must leave an element of {name}, which is {scene.lines[name].length:g} m long"
                yield Problem(("output", "clearance", n, "beyond"), allowed, "take a shorter length")


def _soil(scene: Scene) -> Iterator[Problem]:
    if scene.soil is None or scene.soil.line in scene.lines:
        return
    allowed = f"must be one of lines ({', '.join(scene.lines)}), the one that lies on the soil"
    yield Problem(("soil", "line"), allowed, f"name one of them{hint(scene.soil.line or '', scene.lines)}")


def _seabed(scene: Scene) -> Iterator[Problem]:
    seabed = scene.seabed
    if seabed is not None and seabed.direction_deg is None and (seabed.slope_deg or seabed.profile is not None):
        key = "slope_deg" if seabed.slope_deg else "profile"
        allowed = f"seabed.{key} needs it where there are several lines, each in a plane of its own"
        yield Problem(("seabed", "direction_deg"), allowed, "say which way it runs, from x towards y [deg]")


def _for_nothing(scene: Scene) -> Iterator[Problem]:
    """Problems of keys that concern none of the lines."""
    if scene.contact is not None and scene.seabed is None and scene.soil is None:
        yield Problem(("contact",), "there is nothing to touch", "add seabed or soil, or leave out contact")
    if scene.soil is None and scene.output.sections != SettlementSections():
        yield Problem(("output", "sections"), "are those of soil, and the scene has none", "add soil, or leave it out")
    if all(line.contents is None for line in scene.lines.values()):
        for n, stage in enumerate(scene.stages):
            if stage.pressure is not None:
                remedy = "give a line contents, or leave it out"
                yield Problem(("stages", n, "pressure"), "is that of contents, and all lines are empty", remedy)


def _hang_offs(scene: Scene) -> Iterator[Problem]:
    """An end that takes its vessel along must be the only one on it."""
    for name, line in scene.lines.items():
        for end in ENDS:
            asked = getattr(getattr(line, end), "hang_off", None)
            moved = {"layback": end, "anchor": "start" if end == "end" else "end"}.get(asked.by) if asked else None
            mine = vessels_of_end(scene, name, moved) if moved else []
            others = [key for key in _moved_ends(scene) if key != (name, moved)]
            if any(vessel in vessels_of_end(scene, *key) for vessel in mine for key in others):
                allowed = "another end hangs on the same vessel, which would come along with this one alone"
                remedy = "take by: length, or move the other end"
                yield Problem(("lines", name, end, "hang_off"), allowed, remedy)


def _moved_ends(scene: Scene) -> Iterator[tuple[str, str]]:
    return ((name, end) for name in scene.lines for end in ENDS)


def _jointed(scene: Scene, name: str, end: str) -> bool:
    points = (point for joint in scene.joints.values() for point in joint.between)
    return getattr(scene.lines[name], end) == "free" and any((p.line, p.at) == (name, end) for p in points)


def _plane(scene: Scene) -> Iterator[Problem]:
    """Problems of what leaves the plane along x or y in which the scene lies."""
    if (across := axis_across(scene)) is None:
        return
    views = by_line(scene)
    places = sorted((place for view in views.values() for _, place in positions(view)), key=lambda x: x[across])
    middle = places[(len(places) - 1) // 2] if places else _ORIGIN
    plane = VerticalPlane(middle, _ALONG[across], max(view.line.length for view in views.values()))
    paths = [path_of_line(path, name) for name, view in views.items() for path in leaving_the_plane(view, plane)]
    paths += [path for path, leaves in (*_of_bodies_and_joints(scene, plane), *_of_ground(scene, plane)) if leaves]
    allowed = f"leaves the lines' plane along {'yx'[across]}, but dimension is 2"
    for path in dict.fromkeys(paths):
        yield Problem(path, allowed, "set dimension: 3 or auto, or correct the value")


def _of_bodies_and_joints(scene: Scene, plane: VerticalPlane) -> Iterator[tuple[Path, bool]]:
    """Places and loads of bodies and joints, and whether they leave a plane."""
    for name, body in scene.bodies.items():
        yield ("bodies", name, "position"), not plane.holds_point(body.position)
        for key in ("centre_of_gravity", "centre_of_buoyancy"):
            yield ("bodies", name, key), not plane.holds_vector(getattr(body, key, _ORIGIN))
    for name, joint in scene.joints.items():
        yield ("joints", name, "position"), joint.position is not None and not plane.holds_point(joint.position)
        for n, point in enumerate(joint.between):
            yield ("joints", name, "between", n, "offset"), not plane.holds_vector(point.offset)
    for n, stage in enumerate(scene.stages):
        for name, acts in stage.bodies.items():
            for m, load in enumerate(acts.loads):
                path: Path = ("stages", n, "bodies", name, "loads", m)
                yield (*path, "force"), load.force is not None and not plane.holds_vector(load.force)
                yield (*path, "moment"), load.moment is not None and not plane.holds_axis(load.moment)


def _of_ground(scene: Scene, plane: VerticalPlane) -> Iterator[tuple[Path, bool]]:
    """Ground that slopes across a plane, or may do so."""
    seabed = scene.seabed
    if seabed is not None:
        yield ("seabed", "grid"), seabed.grid is not None
        if seabed.direction_deg is not None:
            angle = math.radians(seabed.direction_deg)
            way = (math.cos(angle), math.sin(angle), 0.0)
            yield ("seabed", "direction_deg"), not plane.holds_vector(way)


def _water(scene: Scene) -> Iterator[Problem]:
    """Problems of keys that a scene of several lines does not have."""
    over_a_grid, water = scene.seabed is not None and scene.seabed.grid is not None, scene.water
    if over_a_grid and water is not None and water.waves is not None and water.depth is None:
        yield Problem(("water", "depth"), "over a grid of heights each line has another", "give it for the waves [m]")
