"""Curves of several runs on one sheet: ranges along the riser, top tension and TDP in time."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError
from riser_soil.plots import histories
from riser_soil.plots.curves import ALONG_ARC, ARC, PAGE, legend_below, sheet
from riser_soil.plots.ranges import compare_ranges, names
from riser_soil.plots.shape import seabed_under, surface_level
from riser_soil.results import Run
from riser_soil.results.stage_records import StageRecords, along, stage_records

_ZONE = 0.04  # of the riser's length: shown to either side of the touchdown points


@dataclass(frozen=True, eq=False)
class Sheet:
    """A sheet of several runs: what it shows, "" for histories, its caption, and how it is drawn."""

    name: str
    caption: str
    draw: Callable[[], Figure]


def sheets(runs: Mapping[str, Run], stage: str | None) -> Iterator[Sheet]:
    """Curves of all runs that have the stage, on one sheet each; by default the one that is drawn of the first run."""
    chosen = stage_records(next(iter(runs.values())), stage).name
    stages = dict(that_have(runs, chosen))
    if len(stages) < 2:
        return
    first, *others = (names(each) for each in stages.values())
    for name in (name for name in first if all(name in other for other in others)):
        yield Sheet(name, f"{name.replace('_', ' ')} along the riser: {chosen}", partial(_along, stages, name))
    if all(each.moves and each.run.has("effective_tension") for each in stages.values()):
        yield Sheet("", f"top tension and TDP in time: {chosen}", partial(_in_time, stages))


def _along(stages: dict[str, StageRecords], name: str) -> Figure:
    figure, (axes,) = sheet(1, 1, width=PAGE, height=2.8)
    compare_ranges(axes, stages, name)
    return figure


def that_have(runs: Mapping[str, Run], stage: str) -> Iterator[tuple[str, StageRecords]]:
    """Runs that have records of a stage, by their labels."""
    for label, run in runs.items():
        try:
            yield label, stage_records(run, stage)
        except ResultsError:
            continue


def _in_time(stages: dict[str, StageRecords]) -> Figure:
    figure, (top, arc) = sheet(2, 1, width=PAGE, height=2.1)
    tensions = {label: _top_tension(stage) for label, stage in stages.items()}
    histories.compare(top, stages, tensions, "effective tension at\nthe upper end [kN]")
    arcs = {label: stage["touchdown_arc"] for label, stage in stages.items()}
    histories.compare(arc, stages, arcs, "TDP,\narc length [m]")
    for axes in (top, arc):
        legend = axes.get_legend()
        if legend is not None:
            legend.remove()
    legend_below(arc)
    return figure


def _top_tension(stage: StageRecords) -> Array:
    position = stage["position"][0]
    return 1e-3 * stage["effective_tension"][:, 0 if position[0, 2] > position[-1, 2] else -1]


def static_shapes(stages: Mapping[str, StageRecords]) -> Figure:
    """The riser in the vertical plane of its ends at the last record of each case, whole and near touchdown."""
    figure, (whole, near) = sheet(1, 2, width=PAGE, height=3.0)
    first = next(iter(stages.values()))
    origin, ahead = first["position"][-1, 0], along(first["position"][-1])
    zones = []
    for n, (label, stage) in enumerate(stages.items()):
        position, arc = stage["position"][-1], stage["touchdown_arc"][-1]
        x, z = (position - origin) @ ahead, position[:, 2]
        for axes in (whole, near):
            axes.plot(x, z, color=f"C{n}", label=label)
        if np.isfinite(arc):
            place = float(np.interp(arc, stage.run.arc, x))
            near.plot(place, float(np.interp(arc, stage.run.arc, z)), "v", color=f"C{n}", markersize=5.0)
            zones.append(place)
    for axes in (whole, near):
        axes.set(xlabel="horizontal distance from end A [m]", ylabel="z [m], upwards")
    whole.set_aspect("equal", adjustable="datalim")
    level = surface_level(first.run)
    if level is not None:
        whole.axhline(level, color="C0", linewidth=0.8, linestyle="-.", label="water surface")
    if zones:
        _view_of_zone(near, first, origin, ahead, zones)
    else:
        near.remove()
    figure.legend(*whole.get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


def _view_of_zone(axes: Axes, stage: StageRecords, origin: Array, ahead: Array, zones: list[float]) -> None:
    """Around the TDPs; heights are drawn larger than lengths."""
    side = max(_ZONE * float(stage.run.arc[-1]), 0.3 * (max(zones) - min(zones)))
    low, high = min(zones) - side, max(zones) + side
    x = np.linspace(low, high, 100)
    level = seabed_under(stage.run, origin + x[:, None] * ahead)
    ways, heights = (np.concatenate([np.asarray(each, float) for each in values]) for values in (
        [line.get_xdata() for line in axes.lines], [line.get_ydata() for line in axes.lines],
    ))  # fmt: skip
    shown = heights[(ways >= low) & (ways <= high)]
    top, bottom = float(shown.max()), float(min([shown.min(), *([] if level is None else level)]))
    if level is not None:
        axes.plot(x, level, color="saddlebrown", linewidth=1.0)
        axes.fill_between(x, level, bottom - (top - bottom), color="tan", alpha=0.5, linewidth=0.0)
    axes.set(xlim=(low, high), ylim=(bottom - 0.08 * (top - bottom), top + 0.05 * (top - bottom)))
    axes.set_title("touchdown zone, heights drawn larger")


def recorded_by_all(stages: Mapping[str, StageRecords]) -> list[str]:
    """Which of effective tension and bending moment all runs have recorded."""
    return [name for name in ("effective_tension", "bending_moment") if all(s.run.has(name) for s in stages.values())]


def static_tensions(stages: Mapping[str, StageRecords]) -> Figure:
    """Effective tension and bending moment along the line at the last record of each case."""
    there = recorded_by_all(stages)
    figure, panels = sheet(len(there), 1, width=PAGE, height=2.3)
    for axes, name in zip(panels, there, strict=True):
        words, factor = ALONG_ARC[name]
        for label, stage in stages.items():
            axes.plot(stage.run.arc, factor * stage[name][-1], label=label)
        axes.set(xlabel=ARC, ylabel=textwrap.fill(words, 24))
    legend_below(panels[-1])
    return figure
