"""First setting of a scene that asks for an accuracy: a few even elements, some steps to a period, automatic soil."""

from __future__ import annotations

import math
from collections.abc import Iterator

from riser_soil.accuracy.knobs import resolved
from riser_soil.assembly.end_places import periods_of
from riser_soil.assembly.graded_segments import broken
from riser_soil.scene.riser import Segment
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage

EVEN, LEAST, BROKEN = 24, 4, 2  # elements of the riser; at least of a segment, and of a part of one between two places
# Time steps to the shortest period of what moves, times the root of the accuracy, as errors fall with the step's
# square; within limits. Where nothing has a period, to a quarter of a stage; so many to any stage at least.
OF_PERIOD, FEWEST, MOST = 5.0, 16.0, 500.0


def first_setting(scene: Scene) -> Scene:
    """The scene with elements, steps, soil mesh and penalty in numbers, and no accuracy asked any more."""
    length, accuracy = scene.riser.length, scene.accuracy
    assert accuracy is not None
    of_period = min(max(OF_PERIOD / math.sqrt(accuracy), FEWEST), MOST)
    segments = tuple(_cut(part, length, least) for part, least in _parts(scene))
    stages = tuple(_stepped(scene, stage, of_period) for stage in scene.stages)
    riser = scene.riser.model_copy(update={"segments": segments})
    return resolved(scene.model_copy(update={"accuracy": None, "riser": riser, "stages": stages}))


def _parts(scene: Scene) -> Iterator[tuple[Segment, int]]:
    """Segments, broken where something acts, with their least number of elements."""
    for parts in broken(scene):
        yield from ((part, LEAST if len(parts) == 1 else BROKEN) for part in parts)


def _cut(segment: Segment, length: float, least: int) -> Segment:
    elements = max(least, round(EVEN * segment.length / length))
    return segment.model_copy(update={"elements": elements, "element_length": None})


def _stepped(scene: Scene, stage: Stage, of_period: float) -> Stage:
    if not isinstance(stage, DynamicStage):
        return stage
    shortest = min((period for _, period in periods_of(scene, stage)), default=0.25 * stage.duration)
    step = min(shortest, stage.duration) / of_period
    return stage.model_copy(update={"time_step": step, "tolerance": None})
