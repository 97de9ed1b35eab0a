"""Assembly of a stage: its loads, inertia, damping, step control and time scheme."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, assert_never

import numpy as np

from riser_soil.assembly.sea import current_times, wave_clock
from riser_soil.core.part import Part
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import (
    DynamicStage,
    GeneralizedAlphaScheme,
    MidpointScheme,
    NewmarkScheme,
    Stage,
    StaticStage,
    TimedStage,
    VaryingLoad,
    loads_in,
    loads_on_body,
    varying_in,
)
from riser_soil.scene.stages import Load as LoadScene
from riser_soil.solve.time_scheme import GeneralizedAlpha, Midpoint, Scheme, Static

if TYPE_CHECKING:
    from riser_soil.bodies.body import MovingBody
    from riser_soil.riser.attachments import Masses, PointAttachment
    from riser_soil.riser.loads import AppliedLoad


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


def loads_of(scene: Scene, line: Line, stage: Stage) -> list[Part]:
    """The part of the loads on the riser in a stage, if there are any."""
    loads = [*_tensioners(scene), *loads_in(scene.stages, stage)]
    if not loads:
        return []
    from riser_soil.riser.loads import PointLoads

    static, places = stage.kind == "static", {"start": 0.0, "end": float(line.arc[-1]), None: 0.0}
    arcs = (places[load.at] if isinstance(load.at, str | None) else load.at for load in loads)
    return [PointLoads(line, [_applied(load, static, arc) for load, arc in zip(loads, arcs, strict=True)])]


def loads_of_body(scene: Scene, body: MovingBody, stage: Stage) -> list[Part]:
    """The part of the loads on a body in a stage, if there are any."""
    loads = loads_on_body(scene.stages, stage, body.name)
    if not loads:
        return []
    from riser_soil.riser.loads import PointLoads

    return [PointLoads(body, [_applied(load, stage.kind == "static", 0.0) for load in loads])]


def _tensioners(scene: Scene) -> Iterator[LoadScene]:
    """The constant upward forces of heave-compensated ends, as loads."""
    always = (0.0, 1.0), (1.0, 1.0)
    start, end = scene.line.start, scene.line.end
    if isinstance(start, Support) and start.tensioner is not None:
        yield LoadScene(at="start", force=(0.0, 0.0, start.tensioner.tension), history=always)
    if isinstance(end, Support) and end.tensioner is not None:
        yield LoadScene(at="end", force=(0.0, 0.0, end.tensioner.tension), history=always)


def _applied(given: VaryingLoad, static: bool, arc: float) -> AppliedLoad:
    from riser_soil.riser.loads import AppliedLoad

    vectors = {k: getattr(given, k, None) for k in ("force", "moment", "distributed")}
    return AppliedLoad(_factor(given, static), arc, **{k: np.asarray(v) for k, v in vectors.items() if v is not None})


def _factor(given: VaryingLoad, static: bool) -> Callable[[float], float]:
    if given.history is None:
        return (lambda t: t) if static else (lambda t: 1.0)
    times, factors = np.array(given.history).T
    return lambda t: float(np.interp(t, times, factors))


def dynamic_parts(
    stage: DynamicStage, line: Line, elements: Elements, attachments: Sequence[PointAttachment] = ()
) -> list[Part]:
    """Parts of dynamic stages: inertia and damping."""
    parts = _inertia(line, elements, attachments)
    if isinstance(stage.scheme, MidpointScheme):
        from riser_soil.riser.midpoint_inertia import over_steps

        parts = [over_steps(part) for part in parts]
    if elements.damping.any():
        from riser_soil.riser.structural_damping import StructuralDamping

        parts.append(StructuralDamping(line, elements))
    return parts


def contents_of(scene: Scene, line: Line, elements: Elements, stage: Stage) -> list[Part]:
    """The part of contents that flow or are uneven in a stage, if there are any.

    In a first static stage they grow with the load factor, as a current does, but where a scene begins with the end of
    another run. In stages without time slugs stand where the clock of the dynamic stages has them.
    """
    runs, first = isinstance(stage, DynamicStage), stage.name == scene.stages[0].name
    grows = isinstance(stage, StaticStage) and first and scene.initial is None
    return contents_at(scene, line, elements, wave_clock(scene, stage), runs=runs, grows=grows)


def contents_at(
    scene: Scene, line: Line, elements: Elements, clock: float, runs: bool = False, grows: bool = False
) -> list[Part]:
    """The part of uneven or flowing contents at a time of the sea's clock [s], if there are any.

    runs: whether slugs move on. grows: whether the forces grow with the load factor.
    """
    given = scene.line.contents
    if given is None or not given.uneven_or_moving:
        return []
    from riser_soil.riser.contents import Flow, InnerFlow, SlugTrain

    fronts = [given.front_of(each, scene.line.length) for each in given.slugs]
    slugs = [
        SlugTrain(each.density - given.density, each.length, front, each.spacing or 0.0)
        for each, front in zip(given.slugs, fronts, strict=True)
    ]
    flow = Flow(given.density, given.speed, slugs, scene.gravity, clock, runs, grows)
    return [InnerFlow(line, elements.inner_diameter, flow)]


def _inertia(line: Line, elements: Elements, attachments: Sequence[PointAttachment]) -> list[Part]:
    from riser_soil.riser.inertia import Inertia

    parts: list[Part] = [Inertia(line, elements.mass, _attached_mass(line, attachments))]
    if line.dimension == 3 or elements.rotary_inertia.any():
        from riser_soil.riser.inertia import RotaryInertia

        parts.append(RotaryInertia(line, elements.rotary_inertia, elements.polar_inertia))
    return parts


def _attached_mass(line: Line, attachments: Sequence[PointAttachment]) -> Masses | None:
    if not attachments:
        return None
    from riser_soil.riser.attachments import masses

    return masses(line, attachments)
