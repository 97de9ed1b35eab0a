"""Assembly of contents that flow or are uneven."""

from __future__ import annotations

from riser_soil.assembly.sea import wave_clock
from riser_soil.riser.contents import Flow, InnerFlow, SlugTrain
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.scene.riser import Contents
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage, StaticStage


def contents_of(scene: Scene, given: Contents, line: Line, elements: Elements, stage: Stage) -> InnerFlow:
    """The part of a line's contents in a stage.

    In a first static stage they grow with the load factor, as a current does, but where a scene begins with the end of
    another run. In stages without time slugs stand where the clock of the dynamic stages has them.
    """
    runs, first = isinstance(stage, DynamicStage), stage.name == scene.stages[0].name
    grows = isinstance(stage, StaticStage) and first and scene.initial is None
    return contents_at(scene, given, line, elements, wave_clock(scene, stage), runs=runs, grows=grows)


def contents_at(
    scene: Scene,
    given: Contents,
    line: Line,
    elements: Elements,
    clock: float,
    runs: bool = False,
    grows: bool = False,
) -> InnerFlow:
    """The part of a line's contents at a time of the sea's clock [s].

    runs: whether slugs move on. grows: whether the forces grow with the load factor.
    """
    fronts = [given.front_of(each, scene.line.length) for each in given.slugs]
    slugs = [
        SlugTrain(each.density - given.density, each.length, front, each.spacing or 0.0)
        for each, front in zip(given.slugs, fronts, strict=True)
    ]
    flow = Flow(given.density, given.speed, slugs, scene.gravity, clock, runs, grows)
    return InnerFlow(line, elements.inner_diameter, flow)
