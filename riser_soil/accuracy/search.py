"""Search for a setting that reaches an accuracy: the first one, a mesh graded by static runs, a trial."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import Any, TypeVar

from riser_soil.accuracy.chain import Variation, bars_of, comparison_runs, run_values, variations
from riser_soil.accuracy.element_sizes import CurveEnvelope
from riser_soil.accuracy.error_bars import SOURCES, ErrorBar, RunValues
from riser_soil.assembly.graded_segments import broken, graded
from riser_soil.assembly.motions import periods_of
from riser_soil.errors import SolveError
from riser_soil.results.peaks import RunPeaks
from riser_soil.scene.lines import by_line, risers, with_risers, with_segments
from riser_soil.scene.riser import Segment
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage, StaticStage
from riser_soil.variants.key_results import key_results
from riser_soil.variants.peaks import peaks_of
from riser_soil.variants.settings import HELPING, refined, resolved

MOST_STATIC_RUNS = 3  # that grade the mesh
LENGTH_RATIO = 1.5  # largest ratio of elements' lengths to those that curvature requires, of a graded mesh
LONGER = Variation("time", {"time_step": 0.5})  # the trial's variation in time: its steps are long already
ATTEMPTS, EACH = 3, 2.0  # runs of a scene that fails; ratio of elements and of steps from one to the next
_Value = TypeVar("_Value")
Envelopes = dict[str, CurveEnvelope]  # by line
OfLines = dict[str, tuple[Segment, ...]]
EVEN, LEAST, BROKEN = 24, 4, 2  # elements of a riser; least number in a segment, and in a part of a segment
# Time steps in the shortest period of a motion, times the root of the accuracy, as errors fall with the square of the
# step; least and largest number of steps in it. Where nothing has a period, it is a quarter of the stage.
OF_PERIOD, FEWEST, MOST = 5.0, 16.0, 500.0


@dataclass(frozen=True, eq=False)
class TriedSetting:
    """A scene that was computed. values: on rank 0. seconds: processor time of the run [s]."""

    scene: Scene
    values: RunValues | None
    bars: list[ErrorBar]
    seconds: float = 0.0


def trial(scene: Scene, accuracy: float, comm: Any) -> TriedSetting:
    """Run of a scene on a mesh that is graded by curvature, with its error bars; collective.

    scene: in its first setting.
    """
    segments = _segments(scene)
    scene = _meshed(scene, accuracy, comm)
    scene, envelopes, peaks = _computed(scene, comm)
    if _length_ratio(envelopes, accuracy, comm) > LENGTH_RATIO:
        scene, _, peaks = _computed(_graded(scene, segments, envelopes, accuracy, comm), comm)
    values = run_values(key_results(peaks.as_summary("sampled")), peaks) if comm.rank == 0 else None
    return TriedSetting(scene, values, measured(scene, values, comm, LONGER))


def measured(scene: Scene, values: RunValues | None, comm: Any, longer: Variation | None = None) -> list[ErrorBar]:
    """Error bars of a run by comparison runs, one for each setting; collective.

    values: of the run, on rank 0. longer: the variation of time steps, if not the usual one.
    """
    single = [
        Variation(SOURCES[name], {name: factor}) for each in variations(scene) for name, factor in each.factors.items()
    ]
    chain = comparison_runs(scene, comm, [longer if longer and each.source == "time" else each for each in single])
    return _on_first(comm, lambda: bars_of(scene, _known(values), chain))


def _known(values: RunValues | None) -> RunValues:
    assert values is not None
    return values


def _meshed(scene: Scene, accuracy: float, comm: Any) -> Scene:
    """The scene on a mesh that is graded by its first static stages; as it is where it begins with another one."""
    segments, statics = _segments(scene), first_statics(scene)
    for _ in range(MOST_STATIC_RUNS if statics else 0):
        part, envelopes, _ = _computed(scene.model_copy(update={"stages": statics}), comm)
        scene = with_risers(scene, risers(part))
        if _length_ratio(envelopes, accuracy, comm) <= LENGTH_RATIO:
            break
        scene = _graded(scene, segments, envelopes, accuracy, comm)
    return scene


def first_statics(scene: Scene) -> Sequence[Any]:
    """The static stages with which a scene begins."""
    return tuple(takewhile(lambda stage: isinstance(stage, StaticStage), scene.stages))


def _computed(scene: Scene, comm: Any, attempts: int = ATTEMPTS) -> tuple[Scene, Envelopes, RunPeaks]:
    """The scene, finer where it fails otherwise, with envelopes and peaks of its run."""
    envelopes: Envelopes = defaultdict(CurveEnvelope)
    try:
        return scene, envelopes, peaks_of(scene, comm, lambda line, instant: envelopes[line].add(instant))
    except SolveError:
        if attempts == 1:
            raise
    return _computed(refined(scene, dict.fromkeys(HELPING, EACH)), comm, attempts - 1)


def _segments(scene: Scene) -> OfLines:
    return {name: line.segments for name, line in risers(scene).items()}


def _graded(scene: Scene, segments: OfLines, envelopes: Envelopes, accuracy: float, comm: Any) -> Scene:
    def made() -> OfLines:
        return {name: graded(segments[name], own.arc, own.lengths(accuracy)) for name, own in envelopes.items()}

    return with_segments(scene, _on_first(comm, made))


def _length_ratio(envelopes: Envelopes, accuracy: float, comm: Any) -> float:
    """Largest ratio of an element's length to the required one, of all lines; the same on all ranks."""
    return _on_first(comm, lambda: max(own.length_ratio(accuracy) for own in envelopes.values()))


def _on_first(comm: Any, value: Callable[[], _Value]) -> _Value:
    """A value that rank 0 computes, on all ranks."""
    shared: _Value = comm.bcast(value() if comm.rank == 0 else None)
    return shared


def first_setting(scene: Scene) -> Scene:
    """The scene from which the search begins: elements, steps, soil mesh and penalty in numbers, no accuracy."""
    accuracy = scene.accuracy
    assert accuracy is not None
    of_period = min(max(OF_PERIOD / math.sqrt(accuracy), FEWEST), MOST)
    stages = tuple(_stepped(scene, stage, of_period) for stage in scene.stages)
    segments = {name: tuple(_first_segments(view)) for name, view in by_line(scene).items()}
    return resolved(with_segments(scene, segments).model_copy(update={"accuracy": None, "stages": stages}))


def _first_segments(scene: Scene) -> Iterator[Segment]:
    """Segments of a scene of one line, cut into elements for the first run."""
    yield from (_cut(part, scene.line.length, least) for part, least in _parts(scene))


def _parts(scene: Scene) -> Iterator[tuple[Segment, int]]:
    """Parts of segments between the points where something acts, with their least number of elements."""
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
