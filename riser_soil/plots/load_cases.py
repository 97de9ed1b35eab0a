"""Matplotlib plot of load cases: one panel for each quantity, its value case by case."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from riser_soil.core.arrays import Array
from riser_soil.plots.curves import save, sheet

FEW = 40  # cases that are drawn as large points
_SCALES = {"N": ("kN", 1e-3), "N.m": ("kN m", 1e-3)}


@dataclass(frozen=True, eq=False)
class Panel:
    """names of the cases; a quantity with its unit in SI; its values (n,), nan where a case failed."""

    names: Sequence[str]
    quantity: str
    unit: str
    values: Array


def draw_load_cases(png: Path, title: str, panels: Sequence[Panel]) -> Path:
    """Points by the cases' numbers, largest and least named; a cross below where one failed or has none."""
    if not panels:
        return save(_empty(title), png)
    columns = min(2, len(panels))
    figure, places = sheet(-(-len(panels) // columns), columns, width=6.5 * columns, height=2.6)
    for axes, panel in zip(places, panels, strict=False):
        _draw(axes, panel)
    for axes in places[len(panels) :]:
        axes.remove()
    for axes in places[max(0, len(panels) - columns) : len(panels)]:
        _name_cases(axes, panels[0].names)
    figure.suptitle(title, fontsize=10)
    return save(figure, png)


def _name_cases(axes: Axes, names: Sequence[str]) -> None:
    """Names below the points of few cases; of many their numbers."""
    if len(names) > FEW:
        axes.set_xlabel("case, by its row in cases.csv")
        return
    axes.set_xticks(range(1, len(names) + 1), names, rotation=90, fontsize=min(8.0, 200.0 / len(names)))


def _empty(title: str) -> Figure:
    figure, (axes,) = sheet(1, 1)
    axes.set_title(f"{title}: no case is done", fontsize=10)
    return figure


def _draw(axes: Axes, panel: Panel) -> None:
    unit, scale = _SCALES.get(panel.unit, (panel.unit, 1.0))
    number, values = np.arange(1, len(panel.names) + 1), scale * panel.values
    axes.plot(number, values, "o", markersize=4 if len(number) <= FEW else 2.5)
    failed = number[np.isnan(values)]
    if failed.size:  # the layout fails where there is a line without points beyond the panel
        axes.plot(failed, np.zeros(failed.size), "x", color="C3", transform=axes.get_xaxis_transform(), clip_on=False)
    ends = [int(np.nanargmax(values)), int(np.nanargmin(values))]
    extremes = (
        f"{word} {values[n]:.4g} in {panel.names[n]}" for word, n in zip(("largest", "least"), ends, strict=True)
    )
    axes.plot(number[ends], values[ends], "o", color="k", fillstyle="none", markersize=8)
    axes.set_title("; ".join(extremes), fontsize=8, loc="left")
    axes.set_ylabel(f"{panel.quantity}\n[{unit}]", fontsize=8)
    axes.set_xlim(0.5, len(number) + 0.5)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.tick_params(axis="x", labelsize=8)
