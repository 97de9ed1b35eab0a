"""A scene with an end at another place, or with a segment of another length, and with it all that belongs there."""

from collections.abc import Callable, Iterator
from typing import Any

from riser_soil.core.quantities import Vector
from riser_soil.scene.attachments import Attachment
from riser_soil.scene.motions import ArcMotion, MotionKind, Vessel, VesselHistory
from riser_soil.scene.riser import Segment
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Load, Stage, StaticStage, TimedStage
from riser_soil.scene.vectors import minus, plus

ArcMap = Callable[[float], float]


def with_end_at(scene: Scene, name: str, place: Vector) -> Scene:
    """The scene with an end at a place [m]; hubs and vessels that move it keep their place beside it, until a static
    stage moves it to a place of its own.
    """
    end = getattr(scene.line, name)
    riser = scene.line.model_copy(update={name: end.model_copy(update={"position": place})})
    stages = tuple(_stages(scene, name, minus(place, end.position)))
    return scene.model_copy(update={"riser": riser, "stages": stages})


def _stages(scene: Scene, name: str, by: Vector) -> Iterator[Stage]:
    for stage in scene.stages:
        if isinstance(stage, StaticStage):
            by = (0.0, 0.0, 0.0) if getattr(stage.move, name, None) is not None else by
            yield stage
        else:
            yield _shifted(stage, name, by)


def _shifted(stage: TimedStage, name: str, by: Vector) -> TimedStage:
    if stage.motion is None or name not in stage.motion.by_end:
        return stage
    given = stage.motion.by_end[name]
    ways = {key: _beside(way, by) for key, way in given.ways.items()}
    motion = stage.motion.model_copy(update={name: given.model_copy(update=ways)})
    return stage.model_copy(update={"motion": motion})


def _beside(way: MotionKind, by: Vector) -> MotionKind:
    match way:
        case ArcMotion():
            return way.model_copy(update={"hub": plus(way.hub, by)})
        case Vessel() | VesselHistory():
            return way.model_copy(update={"reference": plus(way.reference, by)})
        case _:
            return way


def with_segment_as_long(scene: Scene, number: int, length: float) -> Scene:
    """The scene with a segment of a length [m], in as many elements. Attachments, loads and sections keep their places
    in their segments; in this one in proportion.
    """
    segments = scene.line.segments
    before, old = sum(segment.length for segment in segments[:number]), segments[number].length

    def at(arc: float) -> float:
        return arc if arc <= before else max(arc - old, before) + length * min((arc - before) / old, 1.0)

    stages = tuple(
        stage.model_copy(update={"loads": tuple(_load(load, at) for load in stage.loads)}) for stage in scene.stages
    )
    arcs = scene.output.sections.arcs
    sections = scene.output.sections.model_copy(update={"arcs": None if arcs is None else tuple(map(at, arcs))})
    riser: dict[str, Any] = {"attachments": tuple(_attachment(each, at) for each in scene.line.attachments)}
    riser["segments"] = (*segments[:number], _as_long(segments[number], length), *segments[number + 1 :])
    return scene.model_copy(
        update={
            "riser": scene.line.model_copy(update=riser),
            "stages": stages,
            "output": scene.output.model_copy(update={"sections": sections}),
        }
    )


def _as_long(segment: Segment, length: float) -> Segment:
    given, by = segment.element_length, length / segment.length
    scaled = None if given is None else tuple(by * x for x in given) if isinstance(given, tuple) else by * given
    return segment.model_copy(update={"length": length, "element_length": scaled})


def _attachment(given: Attachment, at: ArcMap) -> Attachment:
    return given.model_copy(update={"at": tuple(map(at, given.arcs)), "from_": None, "to": None, "spacing": None})


def _load(load: Load, at: ArcMap) -> Load:
    return load.model_copy(update={"at": at(load.at)}) if isinstance(load.at, float) else load
