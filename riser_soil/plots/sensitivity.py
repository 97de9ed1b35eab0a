"""Matplotlib plot of a sensitivity: a tornado, how much a result changes with each parameter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from matplotlib.figure import Figure

from riser_soil.plots.curves import PAGE, sheet

_GAP = 0.01  # of the span of all values: between a bar and its name


class Bar(NamedTuple):
    """A parameter, and the values of the result with the names of their cases."""

    parameter: str
    values: Sequence[tuple[str, float]]


def tornado(words: str, unit: str, reference: float, bars: Sequence[Bar]) -> Figure:
    """Bars from the reference's value to those of the cases, the parameter with the largest span on top."""
    ordered = sorted(bars, key=lambda bar: _width(bar, reference))
    figure, (axes,) = sheet(1, 1, width=PAGE, height=max(1.6, 0.75 + 0.42 * len(ordered)))
    reach = [value for bar in bars for _, value in bar.values] + [reference]
    room = (max(reach) - min(reach)) or abs(reference) or 1.0
    for n, bar in enumerate(ordered):
        for _, value in bar.values:
            axes.barh(n, value - reference, left=reference, height=0.55, color="C3" if value > reference else "C0")
        for side, ha in ((-1.0, "right"), (1.0, "left")):
            beyond = {name: value for name, value in bar.values if side * (value - reference) > 0.0}
            if beyond:  # names of all values on this side, the farthest one first
                names = sorted(beyond, key=lambda name: -abs(beyond[name] - reference))
                at = beyond[names[0]] + side * _GAP * room
                axes.text(at, n, "; ".join(names), ha=ha, va="center", fontsize=7.5)
    axes.axvline(reference, color="k", linewidth=1.0)
    axes.set_yticks(range(len(ordered)), [bar.parameter for bar in ordered])
    axes.set_xlim(min(reach) - 0.3 * room, max(reach) + 0.3 * room)
    axes.set_xlabel(f"{words} [{unit}]" if unit not in ("", "-") else words)
    axes.grid(axis="y", alpha=0.0)
    axes.ticklabel_format(axis="x", useOffset=False)
    return figure


def _width(bar: Bar, reference: float) -> float:
    values = [reference, *(value for _, value in bar.values)]
    return max(values) - min(values)
