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

NAMED = 24  # cases at most whose names stand below the panels, and not their numbers
_SCALES = {"N": ("kN", 1e-3), "N.m": ("kN m", 1e-3)}


@dataclass(frozen=True, eq=False)
class Panel:
    """names of the cases; a quantity with its unit; its values (n,), nan where a case failed."""

    names: Sequence[str]
    quantity: str
    unit: str
    values: Array


def draw_load_cases(png: Path, title: str, panels: Sequence[Panel]) -> Path:
    """Points by case, least and largest named; a cross at the lower edge where a case failed."""
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


def _empty(title: str) -> Figure:
    figure, (axes,) = sheet(1, 1)
    axes.set_title(f"{title}: no case is done", fontsize=10)
    return figure


def _draw(axes: Axes, panel: Panel) -> None:
    unit, scale = _SCALES.get(panel.unit, (panel.unit, 1.0))
    number, values = np.arange(1, len(panel.names) + 1), scale * panel.values
    axes.plot(number, values, "o", markersize=4 if len(number) <= NAMED else 2.5)
    failed = number[np.isnan(values)]
    axes.plot(failed, np.zeros(failed.size), "x", color="C3", transform=axes.get_xaxis_transform(), clip_on=False)
    ends = [(word, int(place)) for word, place in (("largest", np.nanargmax(values)), ("least", np.nanargmin(values)))]
    told = "; ".join(f"{word} {values[n]:.4g} in {panel.names[n]}" for word, n in ends)
    axes.plot([number[n] for _, n in ends], [values[n] for _, n in ends], "o", color="k", fillstyle="none", markersize=8)
    axes.set_title(told, fontsize=8, loc="left")
    axes.set_ylabel(f"{panel.quantity}\n[{unit}]", fontsize=8)
    axes.set_xlim(0.5, len(number) + 0.5)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))


def _name_cases(axes: Axes, names: Sequence[str]) -> None:
    axes.set_xlabel("case" + (", in the order of the table" if len(names) > NAMED else ""))
    if len(names) <= NAMED:
        axes.set_xticks(range(1, len(names) + 1), names, rotation=60, ha="right", fontsize=7)
