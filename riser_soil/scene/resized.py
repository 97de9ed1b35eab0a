"""A scene with a segment of another length, and all that has its place along the riser."""

from collections.abc import Callable
from typing import Any

from riser_soil.scene.attachments import Attachment
from riser_soil.scene.riser import Segment
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Load

ArcMap = Callable[[float], float]


def with_segment_as_long(scene: Scene, number: int, length: float) -> Scene:
    """The scene with a segment of a length [m], in as many elements. Attachments, loads and sections keep their places
    in their segments; in this one in proportion.
    """
    segments = scene.riser.segments
    before, old = sum(segment.length for segment in segments[:number]), segments[number].length

    def at(arc: float) -> float:
        return arc if arc <= before else max(arc - old, before) + length * min((arc - before) / old, 1.0)

    stages = tuple(
        stage.model_copy(update={"loads": tuple(_load(load, at) for load in stage.loads)}) for stage in scene.stages
    )
    arcs = scene.output.sections.arcs
    sections = scene.output.sections.model_copy(update={"arcs": None if arcs is None else tuple(map(at, arcs))})
    riser: dict[str, Any] = {"attachments": tuple(_attachment(each, at) for each in scene.riser.attachments)}
    riser["segments"] = (*segments[:number], _as_long(segments[number], length), *segments[number + 1 :])
    return scene.model_copy(
        update={
            "riser": scene.riser.model_copy(update=riser),
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
