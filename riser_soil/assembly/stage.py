"""Time scheme of a stage, the times that its steps have to hit, and the loads that act on a line in it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import assert_never

from riser_soil.assembly.sea import current_times
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import (
    DynamicStage,
    GeneralizedAlphaScheme,
    Load,
    MidpointScheme,
    NewmarkScheme,
    Stage,
    TimedStage,
    loads_in,
    varying_in,
)
from riser_soil.solve.time_scheme import GeneralizedAlpha, Midpoint, Scheme, Static


def scheme_of(stage: Stage) -> Scheme:
    """The time scheme of a stage."""
    if not isinstance(stage, DynamicStage):
        return Static()
    match stage.scheme:
        case MidpointScheme():
            return Midpoint()
        case NewmarkScheme(newmark=given):
            return GeneralizedAlpha.newmark(given.beta, given.gamma)
        case GeneralizedAlphaScheme(generalized_alpha=given):
            return GeneralizedAlpha.from_rho_inf(given.rho_inf)
        case _:
            assert_never(stage.scheme)


def times_to_hit(scene: Scene, stage: TimedStage) -> list[float]:
    """Times [s] in a stage where output is due, a motion's ramp ends, or the history of a load or current bends."""
    motions = stage.motion.by_end.values() if stage.motion else ()
    ramps = [way.ramp for motion in motions for way in motion.ways.values() if way.ramp]
    bends = [t for load in varying_in(stage) for t, _ in load.history or ()]
    paces = {scene.output.interval, scene.output.xdmf_interval} - {None}
    bends += current_times(scene, stage)
    return [*ramps, *bends, *(t for pace in paces if pace for t in _multiples(pace, stage.duration))]


def _multiples(interval: float, end: float) -> list[float]:
    return [n * interval for n in range(1, int(end / interval) + 1)]


def loads_on_line(scene: Scene, stage: Stage) -> list[Load]:
    """Loads on a line in a stage, the constant upward forces of heave-compensated ends among them."""
    return [*_tensioners(scene), *loads_in(scene.stages, stage)]


def _tensioners(scene: Scene) -> Iterator[Load]:
    """The constant upward forces of heave-compensated ends, as loads."""
    always = (0.0, 1.0), (1.0, 1.0)
    start, end = scene.line.start, scene.line.end
    if isinstance(start, Support) and start.tensioner is not None:
        yield Load(at="start", force=(0.0, 0.0, start.tensioner.tension), history=always)
    if isinstance(end, Support) and end.tensioner is not None:
        yield Load(at="end", force=(0.0, 0.0, end.tensioner.tension), history=always)
