"""The lines of a scene one by one: each as a scene of its own, and what joints make of its ends."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from itertools import pairwise
from typing import Any

from riser_soil.core.quantities import Vector
from riser_soil.errors import SceneError
from riser_soil.scene.joints import Joint, JointPoint
from riser_soil.scene.output import SettlementSections
from riser_soil.scene.riser import Riser, Segment, Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import OfLine, Stage, StaticStage

SAME_ARC = 1e-9  # of the line's length: where a node is one already
ENDS = ("start", "end")


def by_line(scene: Scene) -> dict[str, Scene]:
    """Scenes of one line each, by name, in which all else is the same; a scene with `riser` is its own, under ""."""
    if not scene.lines:
        return {"": scene}
    return {name: _of_line(scene, name) for name in scene.lines}


def risers(scene: Scene) -> Mapping[str, Riser]:
    """The lines as the scene gives them, by name; "" of the only one."""
    return scene.lines or {"": scene.line}


def with_risers(scene: Scene, lines: Mapping[str, Riser]) -> Scene:
    """The scene with others in their places."""
    return scene.model_copy(update={"lines": dict(lines)} if scene.lines else {"riser": lines[""]})


def with_segments(scene: Scene, segments: Mapping[str, tuple[Segment, ...]]) -> Scene:
    """The scene with other segments by line."""
    lines = risers(scene).items()
    return with_risers(scene, {name: each.model_copy(update={"segments": segments[name]}) for name, each in lines})


def acts_on(stage: Stage, line: str) -> Any:
    """What acts on a line in a stage, with move or motion and loads; the only line of a scene, "", has its stage's."""
    return stage.lines.get(line, OfLine()) if line else stage


def with_acts(stage: Stage, line: str, **changes: Any) -> Stage:
    """The stage with other values there."""
    acts = acts_on(stage, line).model_copy(update=changes)
    return stage.model_copy(update={"lines": {**stage.lines, line: acts}}) if line else acts


@contextmanager
def placing(line: str) -> Iterator[None]:
    """Problems of a line's own scene get the path that it has in the whole one; "" of the only one."""
    try:
        yield
    except SceneError as err:
        if line and str(err).startswith("riser"):
            raise SceneError(f"lines.{line}{str(err).removeprefix('riser')}") from err
        raise


def _of_line(scene: Scene, name: str) -> Scene:
    line, arcs = scene.lines[name], sorted(_inner_arcs(scene, name))
    ends: dict[str, Any] = {key: _end(scene, name, key) for key in ENDS}
    cut = {"segments": tuple(_cut(line, arcs))}
    stages = tuple(_stage(stage, acts_on(stage, name), line) for stage in scene.stages)
    several: dict[str, Any] = {"lines": {}, "bodies": {}, "joints": {}, "dimension": 3, "stages": stages}
    tied = bool(arcs) and _leads_to_hold(scene, name)
    own = several | {"riser": line.model_copy(update=ends | cut).of_several(tied, axis_across(scene))}
    if scene.soil is not None and scene.soil.line == name:
        return scene.model_copy(update=own | {"soil": scene.soil.model_copy(update={"line": None})})
    return scene.model_copy(update=own | _without_soil(scene))


def axis_across(scene: Scene) -> int | None:
    """The axis, x (0) or y (1), across the vertical plane of several lines whose scene says dimension: 2; else None."""
    if scene.dimension != 2 or not scene.lines:
        return None
    ends = (_end(scene, name, key) for name in scene.lines for key in ENDS)
    places = [end.position for end in ends if isinstance(end, Support)]
    x, y = (_span(place[axis] for place in places) for axis in (0, 1))
    return 0 if y > x else 1


def _span(values: Iterable[float]) -> float:
    numbers = [*values]
    return max(numbers, default=0.0) - min(numbers, default=0.0)


def on_soil(scene: Scene) -> Scene | None:
    """The line that lies on the soil, as of `by_line`; None without soil."""
    return None if scene.soil is None else by_line(scene).get(scene.soil.line or "")


def _leads_to_hold(scene: Scene, name: str) -> bool:
    """Whether joints lead from a line to one with a support, or to a body."""
    reached, new = set[str](), {name}
    while new:
        reached |= new
        pairs = [[point.line or point.body or "" for point in joint.between] for joint in scene.joints.values()]
        new = {other for pair in pairs if reached & {*pair} for other in pair} - reached
    ends = (getattr(scene.lines[other], end) for other in reached & {*scene.lines} for end in ENDS)
    return bool(reached & {*scene.bodies}) or any(isinstance(end, Support) for end in ends)


def _without_soil(scene: Scene) -> dict[str, Any]:
    """The scene for a line that does not lie on its soil."""
    contact = scene.contact if scene.seabed is not None else None
    if contact is not None and contact.method == "surface":
        contact = contact.model_copy(update={"method": "auto"})
    output = scene.output.model_copy(update={"sections": SettlementSections(), "soil_fields": ()})
    return {"soil": None, "contact": contact, "output": output}


def _end(scene: Scene, name: str, key: str) -> Any:
    """An end of a line as the scene gives it; a free end in a joint becomes one that the joint holds."""
    given = getattr(scene.lines[name], key)
    for joint in scene.joints.values():
        for point in joint.between:
            if given == "free" and (point.line, point.at) == (name, key):
                place = first_place(scene, joint) or (0.0, 0.0, 0.0)  # the scene's checks have seen to it
                return Support.by_joint(place, "fixed" if joint.kind == "clamped" else "free")
    return given


def first_place(scene: Scene, joint: Joint) -> Vector | None:
    """Where a joint is at first [m], as it says, or as a body or a support does; None where nothing does."""
    if joint.position is not None:
        return joint.position
    for point in joint.between:
        if point.body is not None and point.body in scene.bodies:
            return joint.first_of(point, scene.bodies[point.body].position)
        end = _supported(scene.lines, point)
        if end is not None:
            return end.position
    return None


def _supported(lines: Mapping[str, Riser], point: JointPoint) -> Support | None:
    if point.line is None or point.line not in lines or point.at not in ENDS:
        return None
    end = getattr(lines[point.line], str(point.at))
    return end if isinstance(end, Support) else None


def arc_of(line: Riser, point: JointPoint) -> float:
    """Arc length of a joint's point [m]."""
    return {"start": 0.0, "end": line.length}[point.at] if isinstance(point.at, str) else float(point.at or 0.0)


def apart_from_joints(scene: Scene, name: str, beyond: float) -> list[bool]:
    """Whether each element of a line is farther than a length [m] along it from the line's joints; a length of zero
    leaves out no element.
    """
    line = by_line(scene)[name].line
    points = (point for joint in scene.joints.values() for point in joint.between if point.line == name)
    joints = [arc_of(line, point) for point in points]
    return [
        all(last <= at - beyond or first >= at + beyond for at in joints) or beyond == 0.0
        for first, last in pairwise(line.node_arcs)
    ]


def _inner_arcs(scene: Scene, name: str) -> Iterator[float]:
    for joint in scene.joints.values():
        yield from (float(p.at) for p in joint.between if p.line == name and isinstance(p.at, float))


def _cut(line: Riser, arcs: list[float]) -> Iterator[Segment]:
    """The segments, those with an arc within them in parts."""
    begin, near = 0.0, SAME_ARC * line.length
    for segment in line.segments:
        end = begin + segment.length
        nodes = [begin]
        for length in segment.element_lengths:
            nodes.append(nodes[-1] + length)
        within = [arc for arc in dict.fromkeys(arcs) if begin + near < arc < end - near]
        if all(min(abs(arc - node) for node in nodes) <= near for arc in within):
            yield segment
        else:
            yield from _parts(segment, [0.0, *(arc - begin for arc in within), segment.length])
        begin = end


def _parts(segment: Segment, cuts: list[float]) -> Iterator[Segment]:
    """Element lengths that grow by equal ratios grow linearly along the segment."""
    L, first = segment.length, segment.element_lengths[0]
    growth = (segment.element_lengths[-1] - first) / L
    for a, b in pairwise(cuts):
        update: dict[str, Any] = {"length": b - a}
        if segment.elements is not None:
            update["elements"] = max(1, round(segment.elements * (b - a) / L))
        else:
            update["element_length"] = (first + growth * a, first + growth * b)
        yield segment.model_copy(update=update)


def _stage(stage: Stage, given: OfLine, line: Riser) -> Stage:
    way = {"move": given.move} if isinstance(stage, StaticStage) else {"motion": given.motion}
    pressure = stage.pressure if line.contents is not None else None
    return stage.model_copy(update={**way, "loads": given.loads, "pressure": pressure, "lines": {}})


def spinning(scene: Scene) -> set[str]:
    """Lines, one of each that are clamped to each other, of which nothing keeps all from spinning about their axes."""
    groups = {name: {name} for name in scene.lines}
    turning = {name for name, line in scene.lines.items() if any(_holds(getattr(line, key)) for key in ENDS)}
    for joint in scene.joints.values():
        if joint.kind == "pinned" or (joint.stiffness is not None and joint.stiffness.rotation is None):
            continue
        names = [point.line for point in joint.between if point.line is not None]
        if len(names) < 2:  # held by the body, or between bodies
            turning.update(names)
            continue
        joined = groups[names[0]] | groups[names[1]]
        groups |= dict.fromkeys(joined, joined)
    return {name for name in scene.lines if not groups[name] & turning and name == min(groups[name])}


def _holds(end: Any) -> bool:
    return isinstance(end, Support) and end.rotation != "free"
