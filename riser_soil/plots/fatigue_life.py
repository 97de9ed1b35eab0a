"""Matplotlib plots of fatigue: life along the pipe with the required life and the hotspot, and damage around it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from riser_soil.core.arrays import Array
from riser_soil.plots.curves import ARC, PAGE, STYLE, save, sheet

DECADES = 4.0  # of life above the shortest one: what lasts longer does not matter
_LIFE, _DAMAGE = "fatigue life [years]", "damage in a year [1/year]"


@dataclass(frozen=True, eq=False)
class Damage:
    """What is drawn: damage (ns, np) a year at arc lengths (ns,) [m] and angles (np,) [deg].

    touchdown: arc lengths between which the touchdown point moved [m]; required: years that the pipe must last, times
    the design fatigue factor; None for none.
    """

    arc: Array
    angles: Array
    per_year: Array
    touchdown: tuple[float, float] | None = None
    required: float | None = None

    @property
    def largest(self) -> Array:
        """(ns,), around each section."""
        return np.asarray(self.per_year.max(axis=1))

    @property
    def hotspot(self) -> int:
        """Section of the largest damage."""
        return int(self.largest.argmax())


def draw_damage(png: Path, damage: Damage, title_lines: Sequence[str]) -> Path:
    """Life along the pipe, damage in the touchdown zone and around the hotspot. title_lines: above them."""
    with rc_context(STYLE):
        figure = life_sheet(damage)
        figure.suptitle("\n".join(title_lines), x=0.02, ha="left", fontsize="small")
        return save(figure, png)


def life_sheet(damage: Damage) -> Figure:
    """A figure without a title: life along the pipe, damage in the touchdown zone and around the hotspot."""
    figure, (along, near, around) = sheet(3, 1, width=PAGE, height=2.5)
    _draw_life(along, damage)
    _draw_near(near, damage)
    values = damage.per_year[damage.hotspot]
    around.plot([*damage.angles, 360.0], [*values, values[0]], "o-", color="C3", markersize=3.0)
    at = f"angle around the section at {damage.arc[damage.hotspot]:.5g} m [°]: 0 left, 90 up, 270 down"
    around.set(xlabel=at, ylabel=_DAMAGE, xlim=(0.0, 360.0), ylim=(0.0, None), xticks=np.arange(0.0, 361.0, 45.0))
    return figure


def _draw_life(axes: Axes, damage: Damage) -> None:
    """Life over the arc length, logarithmic, within the decades that matter."""
    largest = damage.largest
    if not largest.max() > 0.0:
        axes.set(xlabel=ARC, ylabel=_LIFE, title="no damage")
        return
    with np.errstate(divide="ignore"):
        life = 1.0 / largest
    shortest = float(life.min())
    axes.semilogy(damage.arc, np.where(np.isfinite(life), life, np.nan), color="C0", label="shortest life around")
    _shade(axes, damage.touchdown)
    axes.plot(damage.arc[damage.hotspot], shortest, "o", color="C3", markersize=5.0, label=_hotspot(damage, shortest))
    levels = [shortest]
    if damage.required is not None:
        levels.append(damage.required)
        words = f"required life times DFF, {damage.required:.4g} years"
        axes.axhline(damage.required, color="C3", linestyle="--", linewidth=1.0, label=words)
    top = max(min(float(life.max()), shortest * 10.0**DECADES), 10.0 * max(levels))
    ends = float(damage.arc.min()), float(damage.arc.max())
    axes.set(xlabel=ARC, ylabel=_LIFE, xlim=ends, ylim=(min(levels) / 3.0, top))
    axes.legend(loc="best")


def _hotspot(damage: Damage, shortest: float) -> str:
    return f"hotspot, {shortest:.4g} years at {damage.arc[damage.hotspot]:.5g} m"


def _draw_near(axes: Axes, damage: Damage) -> None:
    """The touchdown zone; without one, what is beside the largest damage."""
    arc, place = damage.arc, damage.arc[damage.hotspot]
    low, high = damage.touchdown or (place, place)
    low, high = min(low, place), max(high, place)
    beside = max(high - low, 0.05 * float(np.ptp(arc)))
    axes.plot(arc, damage.largest, color="C3", marker=".", label="largest around")
    for angle, style in ((90.0, "--"), (270.0, ":")):
        points = np.flatnonzero(np.isclose(damage.angles, angle))
        if points.size:
            axes.plot(arc, damage.per_year[:, points[0]], style, color="0.3", label=f"at {angle:g}°")
    _shade(axes, damage.touchdown)
    left, right = max(low - beside, float(arc.min())), min(high + beside, float(arc.max()))
    top = float(damage.largest[(arc >= left) & (arc <= right)].max(initial=0.0)) or 1.0
    axes.set(xlabel=ARC, ylabel=_DAMAGE, xlim=(left, right), ylim=(0.0, 1.1 * top))
    axes.plot(place, damage.largest[damage.hotspot], "o", color="C3", markersize=6.0, fillstyle="none", label="hotspot")
    axes.legend()


def _shade(axes: Axes, touchdown: tuple[float, float] | None) -> None:
    if touchdown is not None:
        axes.axvspan(*touchdown, color="tan", alpha=0.35, label="range of the TDP")
