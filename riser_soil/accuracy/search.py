"""Search for a setting that reaches an accuracy: the first one, a mesh graded by static runs, a trial."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import Any, TypeVar

from riser_soil.accuracy.chain import Envelopes, Variation, bars_of, comparison_runs, peaks_of, run_values, variations
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
from riser_soil.variants.settings import refined, resolved

SHAPES = 3  # static runs at most that grade the mesh
SETTLED = 1.5  # elements at most so many times as long as curvature asks for
LONGER = Variation("time", {"time_step": 0.5})  # of the trial, whose steps are long already
ATTEMPTS, EACH = 3, 2.0  # of a scene that fails, each with elements and steps so much finer
HELPING = ("elements", "time_step")
_Found = TypeVar("_Found")
OfLines = dict[str, tuple[Segment, ...]]
EVEN, LEAST, BROKEN = 24, 4, 2  # elements of the riser; at least of a segment, and of a part of one between two places
# Time steps to the shortest period of what moves, times the root of the accuracy, as errors fall with the step's
# square; within limits. Where nothing has a period, to a quarter of a stage; so many to any stage at least.
OF_PERIOD, FEWEST, MOST = 5.0, 16.0, 500.0


@dataclass(frozen=True, eq=False)
class TriedSetting:
    """A scene that was computed, its values on rank 0, its error bars, and the seconds that it took as a run."""

    scene: Scene
    values: RunValues | None
    bars: list[ErrorBar]
    seconds: float = 0.0


def trial(scene: Scene, accuracy: float, comm: Any) -> TriedSetting:
    """On a mesh that curvature has graded, with comparison runs; collective. scene: in its first setting."""
    segments = _segments(scene)
    scene = _meshed(scene, accuracy, comm)
    scene, seen, peaks = _computed(scene, comm)
    if _excess(seen, accuracy, comm) > SETTLED:
        scene, _, peaks = _computed(_graded(scene, segments, seen, accuracy, comm), comm)
    values = run_values(key_results(peaks.as_summary("sampled")), peaks) if comm.rank == 0 else None
    return TriedSetting(scene, values, measured(scene, values, comm, LONGER))


def measured(scene: Scene, values: RunValues | None, comm: Any, longer: Variation | None = None) -> list[ErrorBar]:
    """Error bars of a run by comparison runs, elements and penalty apart; collective. values: the run's, on rank 0.
    longer: steps, if other than usual.
    """
    apart = [*_apart(variations(scene))]
    chain = comparison_runs(scene, comm, apart if longer is None else _with(longer, apart))
    return _on_first(comm, lambda: bars_of(scene, _known(values), chain))


def _with(longer: Variation, usual: Sequence[Variation]) -> list[Variation]:
    return [longer if each.source == longer.source else each for each in usual]


def _apart(varying: Sequence[Variation]) -> Iterator[Variation]:
    """Source by source: a run may need one of them."""
    for _, factors in varying:
        yield from (Variation(SOURCES[name], {name: factor}) for name, factor in factors.items())


def _known(values: RunValues | None) -> RunValues:
    assert values is not None
    return values


def _meshed(scene: Scene, accuracy: float, comm: Any) -> Scene:
    """By the static stages that the scene begins with; as it is where there is none."""
    segments, statics = _segments(scene), first_statics(scene)
    for _ in range(SHAPES if statics else 0):
        part, seen, _ = _computed(scene.model_copy(update={"stages": statics}), comm)
        scene = with_risers(scene, risers(part))
        if _excess(seen, accuracy, comm) <= SETTLED:
            break
        scene = _graded(scene, segments, seen, accuracy, comm)
    return scene


def first_statics(scene: Scene) -> Sequence[Any]:
    return tuple(takewhile(lambda stage: isinstance(stage, StaticStage), scene.stages))


def _computed(scene: Scene, comm: Any) -> tuple[Scene, Envelopes, RunPeaks]:
    """The scene, finer where it fails otherwise, and what was seen of it."""
    for _ in range(ATTEMPTS - 1):
        seen: Envelopes = {}
        try:
            return scene, seen, peaks_of(scene, comm, seen)
        except SolveError:
            scene = refined(scene, dict.fromkeys(HELPING, EACH))
    seen = {}
    return scene, seen, peaks_of(scene, comm, seen)


def _segments(scene: Scene) -> OfLines:
    return {name: line.segments for name, line in risers(scene).items()}


def _graded(scene: Scene, segments: OfLines, seen: Envelopes, accuracy: float, comm: Any) -> Scene:
    def made() -> OfLines:
        return {name: graded(segments[name], own.arc, own.lengths(accuracy)) for name, own in seen.items()}

    return with_segments(scene, _on_first(comm, made))


def _excess(seen: Envelopes, accuracy: float, comm: Any) -> float:
    """Largest of all lines' errors over the accuracy asked for; the same on all ranks."""
    return _on_first(comm, lambda: max(own.excess(accuracy) for own in seen.values()))


def _on_first(comm: Any, found: Callable[[], _Found]) -> _Found:
    """What rank 0 finds."""
    there: _Found = comm.bcast(found() if comm.rank == 0 else None)
    return there


def first_setting(scene: Scene) -> Scene:
    """The scene with elements, steps, soil mesh and penalty in numbers, and no accuracy asked any more."""
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
