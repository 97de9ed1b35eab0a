"""Range graphs: least, mean and largest value of a quantity at each node of the riser over a stage's records.

With its limits, along the whole riser and near the touchdown points.
"""

from __future__ import annotations

import textwrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from riser_soil.assembly.riser import elements_of
from riser_soil.core.arrays import Array
from riser_soil.core.outputs import ALONG_RISER
from riser_soil.errors import RiserSoilError
from riser_soil.plots.curves import ALONG_ARC, ARC, PAGE, legend_below, sheet
from riser_soil.results.stage_records import StageRecords

_LIMITED = "utilisation"  # quantities that are limited by 1 have this in their names
_NEAR_LIMIT = 0.4  # of the limit, from which on it is drawn; a quantity that is smaller would be a flat line under it
_LINE = 24  # characters of an axis's name in one line
_ROUND_OFF = 1e-9  # of the largest value
_SIDE = 0.1  # of the span where a quantity acts: shown beside it
_ZONE = 0.04  # of the riser's length, shown on both sides of the touchdown points
_WHOLE = 0.6  # of the riser's length: where more of it is near them, that is no view from close by


def names(stage: StageRecords) -> list[str]:
    """Quantities along the riser that the run recorded and knows: what the table of outputs has but for vectors."""
    there = stage.run.variables
    known = [output.name for output in ALONG_RISER if not output.vector and output.name in there]
    return [name for name in known if np.isfinite(stage[name]).any()]


def draw_range(axes: Axes, stage: StageRecords, name: str, legend: bool = True) -> None:
    """The range of a quantity of ALONG_ARC; of a stage with one record a line."""
    words, factor = ALONG_ARC[name]
    values, arc = factor * stage[name], stage.run.arc
    if len(values) == 1:
        axes.plot(arc, values[0], color="C0", label=f"static, {_extremes(stage, name, values[0])}")
    else:
        _draw_band(axes, stage, name, values)
    _mark_touchdown(axes, stage)
    _draw_limit(axes, stage, name, float(np.nanmax(values)), factor)
    axes.set_xlim(*_span(arc, values))
    axes.set_xlabel(ARC)
    axes.set_ylabel(textwrap.fill(words, _LINE))
    if legend:
        axes.legend(fontsize="small")


def range_sheet(stage: StageRecords, name: str) -> Figure:
    """The range along the whole riser, and below it that near the touchdown points, if anything is known there."""
    near = _near_touchdown(stage)
    within = None if near is None else _limits_within(stage, name, near)
    figure, panels = sheet(1 if within is None else 2, 1, width=PAGE, height=2.7 if within is None else 2.05)
    draw_range(panels[0], stage, name)
    if within is not None:
        draw_range(panels[1], stage, name, legend=False)
        panels[1].set(title="near the TDP", xlim=near, ylim=within)
    return figure


def _near_touchdown(stage: StageRecords) -> tuple[float, float] | None:
    """Arc lengths [m] from and to which the view from close by goes."""
    touchdown, arc = stage["touchdown_arc"], stage.run.arc
    if np.isnan(touchdown).all():
        return None
    side = _ZONE * float(arc[-1])
    low, high = max(float(np.nanmin(touchdown)) - side, 0.0), min(float(np.nanmax(touchdown)) + side, float(arc[-1]))
    return (low, high) if high - low < _WHOLE * arc[-1] else None


def _limits_within(stage: StageRecords, name: str, near: tuple[float, float]) -> tuple[float, float] | None:
    """Least and largest value between two arc lengths, with some room; None where nothing is known there."""
    arc, values = stage.run.arc, ALONG_ARC[name][1] * stage[name]
    at = [*near, *arc[(arc > near[0]) & (arc < near[1])]]
    limits = [np.interp(at, arc, edge(values, axis=0)) for edge in (np.min, np.max)]
    if np.isnan(limits[1]).all():
        return None
    low, high = float(np.nanmin(limits[0])), float(np.nanmax(limits[1]))
    room = 0.06 * (high - low) or 1e-9 + abs(high)
    return low - room, high + room


def _draw_limit(axes: Axes, stage: StageRecords, name: str, most: float, factor: float) -> None:
    """The largest value allowed, by element, where the quantity comes near it; else its least in the legend."""
    arc, limit = _limit(stage, name)
    limit = factor * limit
    if not np.isfinite(limit).any():
        return
    least = float(limit[np.isfinite(limit)].min())
    style: dict[str, Any] = {"color": "C3", "linestyle": "--", "linewidth": 1.0}
    if most >= _NEAR_LIMIT * least:
        axes.stairs(np.where(np.isfinite(limit), limit, np.nan), arc, baseline=None, label="limit", **style)
    else:
        axes.plot([], [], label=f"limit, {least:.4g}: above the graph", **style)


def _limit(stage: StageRecords, name: str) -> tuple[Array, Array]:
    """Arc lengths (ne + 1,) [m] of the elements, and the largest value allowed (ne,) in SI units; infinite for any."""
    if _LIMITED in name:
        return stage.run.arc[[0, -1]], np.ones(1)
    none = stage.run.arc[[0, -1]], np.array([np.inf])
    if name not in ("curvature", "effective_tension"):
        return none
    try:
        elements = elements_of(stage.run.read_scene())
    except (RiserSoilError, OSError):
        return none
    allowed = elements.max_tension if name == "effective_tension" else 1.0 / np.where(
        elements.min_bend_radius > 0.0, elements.min_bend_radius, np.inf
    )
    return elements.arc, np.where(allowed > 0.0, allowed, np.inf)


def compare_ranges(axes: Axes, stages: dict[str, StageRecords], name: str) -> None:
    """Ranges of a quantity in several runs, by their labels, on one sheet: a band's edges in one colour for each."""
    words, factor = ALONG_ARC[name]
    spans = []
    for n, (label, stage) in enumerate(stages.items()):
        values, arc = factor * stage[name], stage.run.arc
        axes.plot(arc, values.max(axis=0), color=f"C{n}", linewidth=1.2, label=label)
        axes.plot(arc, values.min(axis=0), color=f"C{n}", linewidth=1.2, linestyle=":")
        spans.append(_span(arc, values))
    axes.set_xlim(min(low for low, _ in spans), max(high for _, high in spans))
    axes.set_xlabel(ARC)
    axes.set_ylabel(textwrap.fill(words, _LINE))
    legend_below(axes)


def mean_in_time(time: Array, values: Array) -> Array:
    """Mean over the time (nr,) [s] of values (nr, nn) that run straight from record to record."""
    gaps = np.diff(time)
    weights = np.concatenate([[0.0], gaps]) + np.concatenate([gaps, [0.0]])
    return np.average(values, axis=0, weights=weights if weights.sum() > 0.0 else None)


def _draw_band(axes: Axes, stage: StageRecords, name: str, values: Array) -> None:
    arc, least, most = stage.run.arc, values.min(axis=0), values.max(axis=0)
    axes.fill_between(arc, least, most, color="C0", alpha=0.2, linewidth=0.0)
    axes.plot(arc, most, color="C3", linewidth=1.2, label=f"max, {_place(stage, name, 'max', most)}")
    axes.plot(arc, mean_in_time(stage.time, values), color="k", linewidth=0.9, linestyle="--", label="mean")
    axes.plot(arc, least, color="C0", linewidth=1.2, label=f"min, {_place(stage, name, 'min', least)}")


def _place(stage: StageRecords, name: str, which: str, values: Array) -> str:
    """The extreme of a quantity and where it is: that of the summary, which knows it between nodes and records, so that
    there is one maximum; else that of the values (nn,) at nodes. Round-off beside the largest value counts as 0.
    """
    n = int(np.nanargmax(values) if which == "max" else np.nanargmin(values))
    value, arc = values[n], stage.run.arc[n]
    known = _of_summary(stage, f"{which}_{name}", which)
    if known is not None:
        value, arc = ALONG_ARC[name][1] * known[0], known[1]
    shown = value if abs(value) > _ROUND_OFF * np.nanmax(np.abs(values)) else 0.0
    return f"{'largest' if which == 'max' else 'least'} {shown:.4g} at {arc:.4g} m"


def _of_summary(stage: StageRecords, figure: str, which: str) -> tuple[float, float] | None:
    """An extreme of the summary with its arc length [m]; None where it has none."""
    if stage.timed:
        entry = (stage.summary["extremes"] or {}).get(figure)
        value, arc = (entry.get(which), entry.get(f"arc_{which}")) if isinstance(entry, dict) else (None, None)
    else:
        entry = (stage.summary["final"] or {}).get(figure)
        value, arc = (entry.get("value"), entry.get("arc")) if isinstance(entry, dict) else (None, None)
    return None if value is None or arc is None else (value, arc)


def _extremes(stage: StageRecords, name: str, values: Array) -> str:
    return f"{_place(stage, name, 'max', values)}, {_place(stage, name, 'min', values)}"


def _mark_touchdown(axes: Axes, stage: StageRecords) -> None:
    touchdown = stage["touchdown_arc"]
    if np.isnan(touchdown).all():
        return
    low, high = float(np.nanmin(touchdown)), float(np.nanmax(touchdown))
    words = f"TDP, {low:.4g} to {high:.4g} m" if high > low else f"TDP, {low:.4g} m"
    axes.axvspan(low, high, color="tan", alpha=0.35, linewidth=1.0, label=words)


def _span(arc: Array, values: Array) -> tuple[float, float]:
    """Range of the arc length [m] that is shown: all of it, or where the quantity acts if that is less than half."""
    acts = np.flatnonzero((np.nan_to_num(values) != 0.0).any(axis=0))
    if len(acts) == 0 or np.ptp(arc[acts]) > 0.5 * np.ptp(arc):
        return float(arc[0]), float(arc[-1])
    low, high = arc[max(acts[0] - 1, 0)], arc[min(acts[-1] + 1, len(arc) - 1)]
    side = _SIDE * (high - low)
    return float(max(low - side, arc[0])), float(min(high + side, arc[-1]))
