"""A scene with an end elsewhere, a segment of another length, or its vessel at an offset, and what belongs there."""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from riser_soil.core.quantities import Vector
from riser_soil.scene.attachments import Attachment
from riser_soil.scene.joints import Joint, JointPoint
from riser_soil.scene.lines import ENDS, acts_on, by_line, risers, with_acts, with_risers
from riser_soil.scene.motions import ArcMotion, Motion, MotionKind, Vessel, VesselHistory
from riser_soil.scene.riser import Segment, Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Load, MovedEnds, Stage, StaticStage
from riser_soil.scene.vectors import minus, plus

ArcMap = Callable[[float], float]
LineEnd = tuple[str, str]
"""A line's name, "" of the only one, and start or end."""


def with_end_at(scene: Scene, line: str, name: str, place: Vector) -> Scene:
    """The scene with an end of a line, "" of the only one, at a place [m]; hubs and vessels that move it keep their
    place beside it, until a static stage moves it to a place of its own.
    """
    riser = risers(scene)[line]
    end = getattr(riser, name)
    stages = tuple(_stages(scene, line, name, minus(place, end.position)))
    moved = riser.model_copy(update={name: end.model_copy(update={"position": place})})
    return with_risers(scene, {**risers(scene), line: moved}).model_copy(update={"stages": stages})


def _stages(scene: Scene, line: str, name: str, by: Vector) -> Iterator[Stage]:
    for stage in scene.stages:
        acts = acts_on(stage, line)
        if isinstance(stage, StaticStage):
            by = (0.0, 0.0, 0.0) if getattr(acts.move, name, None) is not None else by
            yield stage
        elif acts.motion is not None and name in acts.motion.by_end:
            yield with_acts(stage, line, motion=_shifted(acts.motion, name, by))
        else:
            yield stage


def _shifted(motion: Motion, name: str, by: Vector) -> Motion:
    given = motion.by_end[name]
    ways = {key: _beside(way, by) for key, way in given.ways.items()}
    return motion.model_copy(update={name: given.model_copy(update=ways)})


def _beside(way: MotionKind, by: Vector) -> MotionKind:
    match way:
        case ArcMotion():
            return way.model_copy(update={"hub": plus(way.hub, by)})
        case Vessel() | VesselHistory():
            return way.model_copy(update={"reference": plus(way.reference, by)})
        case _:
            return way


def vessel_ends(scene: Scene) -> list[LineEnd]:
    """Lines ("" of the only one) and names of the ends that hang from the vessel whose offset a scene gives: those that
    it names, else the upper one of each line, unless a joint holds that one.
    """
    assert scene.vessel is not None
    if scene.vessel.ends is not None:
        return [end_named(name) for name in scene.vessel.ends]
    upper = ((line, upper_end(view)) for line, view in by_line(scene).items())
    return [(line, name) for line, name in upper if name is not None]


def end_named(name: str) -> LineEnd:
    """Line and name of an end as `vessel.ends` names it: end, or of several lines west.end."""
    line, _, end = name.rpartition(".")
    return line, end


def end_name(key: LineEnd) -> str:
    """An end as `vessel.ends` names it."""
    return ".".join(each for each in key if each)


def upper_end(scene: Scene) -> str | None:
    """The higher one of a line's ends that have a place; None where a joint holds it, or they are level."""
    given = [(name, getattr(scene.line, name)) for name in ENDS]
    heights = {name: end.position[2] for name, end in given if isinstance(end, Support)}
    if not heights or (len(heights) == 2 and heights["start"] == heights["end"]):
        return None
    highest = max(heights, key=lambda name: heights[name])
    return None if getattr(scene.line, highest).jointed else highest


class Displacement(NamedTuple):
    """A vessel's offset [m], and by name where its ends are without it and with it [m]."""

    offset: Vector
    ends: dict[str, tuple[Vector, Vector]]

    @property
    def in_words(self) -> str:
        """The offset and the displaced ends in words."""
        moved = (f"{name} from {_shown(before)} to {_shown(after)}" for name, (before, after) in self.ends.items())
        return f"vessel at the offset {_shown(self.offset)} m: {', '.join(moved)} m"

    @property
    def summary(self) -> dict[str, Any]:
        """Block `vessel` of summary.json."""
        ends = {name: {"from": before, "to": after} for name, (before, after) in self.ends.items()}
        return {"offset": self.offset, "ends": ends}


def _shown(place: Vector) -> str:
    return "[" + ", ".join(f"{x:.6g}" for x in place) + "]"


def displacement(scene: Scene) -> Displacement:
    """What a vessel's offset does to the ends that hang from it, of a scene that has one."""
    assert scene.vessel is not None
    by, ends = scene.vessel.offset, dict[str, tuple[Vector, Vector]]()
    for line, name in vessel_ends(scene):
        place = getattr(risers(scene)[line], name).position
        ends[end_name((line, name))] = place, plus(place, by)
    return Displacement(by, ends)


def at_offset(scene: Scene) -> Scene:
    """The scene with its vessel's offset in its stages, and no offset any more: the first stage, a static one, moves
    the vessel's ends by it, and hubs and references of later motions come along.
    """
    plain = scene.model_copy(update={"vessel": None})
    if scene.vessel is None or not any(scene.vessel.offset):
        return plain
    for line, name in vessel_ends(scene):
        plain = _with_end_moved_at_first(plain, line, name, scene.vessel.offset)
    return plain


def _with_end_moved_at_first(scene: Scene, line: str, name: str, by: Vector) -> Scene:
    first, *later = _stages(scene, line, name, by)
    move = acts_on(first, line).move or MovedEnds()
    target = plus(getattr(risers(scene)[line], name).position, by)
    first = with_acts(first, line, move=move.model_copy(update={name: target}))
    return scene.model_copy(update={"stages": (first, *later)})


def with_segment_as_long(scene: Scene, line: str, number: int, length: float) -> Scene:
    """The scene with a segment of a line, "" of the only one, of a length [m], in as many elements. Attachments, loads,
    joints and sections keep their places in their segments; in this one in proportion.
    """
    riser = risers(scene)[line]
    segments = riser.segments
    before, old = sum(segment.length for segment in segments[:number]), segments[number].length

    def at(arc: float) -> float:
        return arc if arc <= before else max(arc - old, before) + length * min((arc - before) / old, 1.0)

    changed: dict[str, Any] = {"attachments": tuple(_attachment(each, at) for each in riser.attachments)}
    changed["segments"] = (*segments[:number], _as_long(segments[number], length), *segments[number + 1 :])
    varied = with_risers(scene, {**risers(scene), line: riser.model_copy(update=changed)})
    own: dict[str, Any] = {"stages": tuple(_with_loads(stage, line, at) for stage in scene.stages)}
    own["joints"] = {name: _joint(joint, line, at) for name, joint in scene.joints.items()}
    on_soil = not line or (scene.soil is not None and scene.soil.line == line)
    if on_soil and (arcs := scene.output.sections.arcs) is not None:
        sections = scene.output.sections.model_copy(update={"arcs": tuple(map(at, arcs))})
        own["output"] = scene.output.model_copy(update={"sections": sections})
    return varied.model_copy(update=own)


def _as_long(segment: Segment, length: float) -> Segment:
    given, by = segment.element_length, length / segment.length
    scaled = None if given is None else tuple(by * x for x in given) if isinstance(given, tuple) else by * given
    return segment.model_copy(update={"length": length, "element_length": scaled})


def _attachment(given: Attachment, at: ArcMap) -> Attachment:
    return given.model_copy(update={"at": tuple(map(at, given.arcs)), "from_": None, "to": None, "spacing": None})


def _with_loads(stage: Stage, line: str, at: ArcMap) -> Stage:
    loads = acts_on(stage, line).loads
    return with_acts(stage, line, loads=tuple(_load(load, at) for load in loads)) if loads else stage


def _joint(joint: Joint, line: str, at: ArcMap) -> Joint:
    def moved(point: JointPoint) -> JointPoint:
        if point.line != line or not isinstance(point.at, float):
            return point
        return point.model_copy(update={"at": at(point.at)})

    return joint.model_copy(update={"between": tuple(map(moved, joint.between))})


def _load(load: Load, at: ArcMap) -> Load:
    return load.model_copy(update={"at": at(load.at)}) if isinstance(load.at, float) else load
