"""Several runs side by side: what their scenes differ in, headline quantities with differences, curves on one sheet."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from matplotlib.figure import Figure

from riser_soil.accuracy.headlines import headlines
from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError
from riser_soil.plots import histories
from riser_soil.plots.curves import sheet
from riser_soil.plots.ranges import compare_ranges, names
from riser_soil.report.extremes import READ_IN
from riser_soil.report.tables import NOTHING, Table, number
from riser_soil.results import Run
from riser_soil.results.stage_records import StageRecords, stage_records

_MISSING = object()


@dataclass(frozen=True)
class Sheet:
    """A figure with its caption."""

    caption: str
    figure: Figure


def differences_table(runs: Mapping[str, Run]) -> Table:
    """Keys of the scenes that are not the same in all runs; runs by their labels."""
    flat = {label: dict(_flattened(run.scene, "")) for label, run in runs.items()}
    keys = dict.fromkeys(key for each in flat.values() for key in each)
    rows = []
    for key in keys:
        values = [each.get(key, _MISSING) for each in flat.values()]
        if any(value != values[0] for value in values):
            rows.append([key, *(NOTHING if value is _MISSING else str(value) for value in values)])
    return Table(("key", *runs), rows)


def headlines_table(runs: Mapping[str, Run]) -> Table:
    """Headline quantities, and by how much they differ from the first run's: relative to their scale."""
    known = [headlines(run.summary) for run in runs.values()]
    first, *others = known
    rows = []
    for key in dict.fromkeys(key for each in known for key in each):
        one = next(each[key] for each in known if key in each)
        unit, scale = READ_IN.get(one.unit, (one.unit, 1.0))
        values = [number(each[key].value * scale) if key in each else NOTHING for each in known]
        row = [key, unit, values[0]]
        for value, each in zip(values[1:], others, strict=True):
            row += [value, _difference(first, each, key)]
        rows.append(row)
    labels = [*runs]
    heads = [head for label in labels[1:] for head in (label, f"differs from {labels[0]} by [%]")]
    note = (
        "Of static stages at their end, of dynamic ones the extremes. A difference is relative to the first run's size; of "
        "forces to a tenth of the stage's largest at least, of touchdown arcs to the distance of the ends."
    )
    return Table(("quantity", "unit", labels[0], *heads), rows, note)


def sheets(runs: Mapping[str, Run], stage: str | None) -> Iterator[Sheet]:
    """Curves of all runs that have the stage, on one sheet each; by default the stage that the first would be drawn at."""
    chosen = stage_records(next(iter(runs.values())), stage).name
    stages = dict(_that_have(runs, chosen))
    if len(stages) < 2:
        return
    shared = [name for name in names(next(iter(stages.values()))) if all(name in names(each) for each in stages.values())]
    for name in shared:
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


def _difference(first: Mapping[str, Any], other: Mapping[str, Any], key: str) -> str:
    if key not in first or key not in other:
        return NOTHING
    share = first[key].relative(other[key].value - first[key].value)
    signed = share if other[key].value >= first[key].value else -share
    return f"{100.0 * signed:+.3g}"


def _flattened(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict) and value:
        for key, inner in value.items():
            yield from _flattened(inner, f"{path}.{key}" if path else str(key))
    elif isinstance(value, list) and any(isinstance(item, dict) for item in value):
        for n, inner in enumerate(value):
            yield from _flattened(inner, f"{path}.{n}")
    else:
        yield path, value
