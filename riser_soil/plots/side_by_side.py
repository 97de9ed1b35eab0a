"""Curves of several runs on one sheet: ranges along the riser, top tension and touchdown in time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from matplotlib.figure import Figure

from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError
from riser_soil.plots import histories
from riser_soil.plots.curves import sheet
from riser_soil.plots.ranges import compare_ranges, names
from riser_soil.results import Run
from riser_soil.results.stage_records import StageRecords, stage_records


@dataclass(frozen=True)
class Sheet:
    """A figure with its caption."""

    caption: str
    figure: Figure


def sheets(runs: Mapping[str, Run], stage: str | None) -> Iterator[Sheet]:
    """Curves of all runs that have the stage, on one sheet each; by default the one that is drawn of the first run."""
    chosen = stage_records(next(iter(runs.values())), stage).name
    stages = dict(_that_have(runs, chosen))
    if len(stages) < 2:
        return
    first, *others = (names(each) for each in stages.values())
    for name in (name for name in first if all(name in other for other in others)):
        figure, (axes,) = sheet(1, 1, width=8.0, height=3.6)
        compare_ranges(axes, stages, name)
        yield Sheet(f"{name.replace('_', ' ')} along the riser: {chosen}", figure)
    if all(each.moves for each in stages.values()):
        yield Sheet(f"top tension and touchdown in time: {chosen}", _in_time(stages))


def _that_have(runs: Mapping[str, Run], stage: str) -> Iterator[tuple[str, StageRecords]]:
    for label, run in runs.items():
        try:
            yield label, stage_records(run, stage)
        except ResultsError:
            continue


def _in_time(stages: dict[str, StageRecords]) -> Figure:
    figure, (top, arc) = sheet(2, 1, height=2.4)
    tensions = {label: _top_tension(stage) for label, stage in stages.items()}
    histories.compare(top, stages, tensions, "effective tension at\nthe upper end [kN]")
    arcs = {label: stage["touchdown_arc"] for label, stage in stages.items()}
    histories.compare(arc, stages, arcs, "touchdown point,\narc length [m]")
    return figure


def _top_tension(stage: StageRecords) -> Array:
    position = stage["position"][0]
    return 1e-3 * stage["effective_tension"][:, 0 if position[0, 2] > position[-1, 2] else -1]
