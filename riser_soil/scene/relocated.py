"""A scene with an end at another place, and with it what carries the end."""

from collections.abc import Iterator

from riser_soil.core.quantities import Vector
from riser_soil.scene.motions import ArcMotion, MotionKind, Vessel, VesselHistory
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage, StaticStage, TimedStage
from riser_soil.scene.vectors import minus, plus


def with_end_at(scene: Scene, name: str, place: Vector) -> Scene:
    """The scene with an end at a place [m]; hubs and vessels that move it keep their place beside it, until a static
    stage moves it to a place of its own.
    """
    end = getattr(scene.riser, name)
    riser = scene.riser.model_copy(update={name: end.model_copy(update={"position": place})})
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
