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
        axes.set_xlabel("case, by its row in cases.csv")
    figure.suptitle(title, fontsize=10)
    return save(figure, png)


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
    reported = (
        f"{word} {values[n]:.4g} in {panel.names[n]}" for word, n in zip(("largest", "least"), ends, strict=True)
    )
    axes.plot(number[ends], values[ends], "o", color="k", fillstyle="none", markersize=8)
    axes.set_title("; ".join(reported), fontsize=8, loc="left")
    axes.set_ylabel(f"{panel.quantity}\n[{unit}]", fontsize=8)
    axes.set_xlim(0.5, len(number) + 0.5)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))


DECADES = 8.0  # below the largest damage that the axis reaches
_ARC, _DAMAGE = "arc length from the start [m]", "damage in a year [1/year]"


def draw_damage(
    png: Path,
    arc: Array,
    angles: Array,
    damage: Array,
    touchdown: tuple[float, float] | None,
    reported: Sequence[str],
) -> Path:
    """damage (ns, np) a year at arc lengths (ns,) [m] and angles (np,) [deg]; touchdown: arc lengths between which the
    touchdown point moved [m]; reported: lines above.
    """
    figure, (along, near, around) = sheet(3, 1, width=8.0, height=3.0)
    figure.suptitle("\n".join(reported), fontsize=9, x=0.02, ha="left")
    section = int(damage.max(axis=1).argmax())
    _draw_along(along, arc, damage, touchdown)
    _draw_near(near, arc, angles, damage, touchdown, section)
    around.plot([*angles, 360.0], [*damage[section], damage[section, 0]], "o-", color="C3", markersize=3.0)
    at = f"around the section at {arc[section]:.5g} m [deg]: 0 y (left), 90 z (up, where the riser is level)"
    around.set(xlabel=at, ylabel=_DAMAGE, xlim=(0.0, 360.0), ylim=(0.0, None), xticks=np.arange(0.0, 361.0, 45.0))
    return save(figure, png)


def _draw_along(axes: Axes, arc: Array, damage: Array, touchdown: tuple[float, float] | None) -> None:
    largest = damage.max(axis=1)
    axes.semilogy(arc, np.where(largest > 0.0, largest, np.nan), color="C3", label="largest around")
    _shade(axes, touchdown)
    top = float(damage.max()) or 1.0
    axes.set(xlabel=_ARC, ylabel=_DAMAGE, ylim=(top * 10.0**-DECADES, 3.0 * top))
    axes.legend(fontsize=8)


def _draw_near(
    axes: Axes, arc: Array, angles: Array, damage: Array, touchdown: tuple[float, float] | None, section: int
) -> None:
    """The touchdown zone; without one, what is beside the largest damage."""
    low, high = touchdown or (arc[section], arc[section])
    beside = max(high - low, 0.05 * float(np.ptp(arc)))
    axes.plot(arc, damage.max(axis=1), color="C3", marker=".", label="largest around")
    for angle, style in ((90.0, "--"), (270.0, ":")):
        found = np.flatnonzero(np.isclose(angles, angle))
        if found.size:
            axes.plot(arc, damage[:, found[0]], style, color="0.3", label=f"at {angle:g} degrees")
    _shade(axes, touchdown)
    left, right = max(low - beside, float(arc.min())), min(high + beside, float(arc.max()))
    shown = damage[(arc >= left) & (arc <= right)]
    top = float(shown.max()) if shown.size and shown.max() > 0.0 else 1.0
    axes.set(xlabel=_ARC, ylabel=_DAMAGE, xlim=(left, right), ylim=(0.0, 1.05 * top))
    axes.legend(fontsize=8)


def _shade(axes: Axes, touchdown: tuple[float, float] | None) -> None:
    if touchdown is not None:
        axes.axvspan(*touchdown, color="C0", alpha=0.15, label="touchdown point")
