"""Matplotlib plot of a sensitivity: a tornado, how much a result changes with each parameter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from matplotlib.figure import Figure

from riser_soil.plots.curves import PAGE, sheet


class Bar(NamedTuple):
    """A parameter, and the values of the result with the names of their cases."""

    parameter: str
    values: Sequence[tuple[str, float]]


def tornado(words: str, unit: str, reference: float, bars: Sequence[Bar]) -> Figure:
    """Bars from the reference's value to those of the cases, the parameter with the largest span on top."""
    ordered = sorted(bars, key=_span)
    figure, (axes,) = sheet(1, 1, width=PAGE, height=max(1.6, 0.75 + 0.42 * len(ordered)))
    reach = [value for bar in bars for _, value in bar.values] + [reference]
    room = (max(reach) - min(reach)) or abs(reference) or 1.0
    for n, bar in enumerate(ordered):
        for _, value in bar.values:
            axes.barh(n, value - reference, left=reference, height=0.55, color="C3" if value > reference else "C0")
        for side in (min, max):
            name, value = side(bar.values, key=lambda each: each[1])
            if value != reference and (value < reference) == (side is min):
                ha, shift = ("right", -0.01) if side is min else ("left", 0.01)
                axes.text(value + shift * room, n, name, ha=ha, va="center", fontsize=7.5)
    axes.axvline(reference, color="k", linewidth=1.0)
    axes.set_yticks(range(len(ordered)), [bar.parameter for bar in ordered])
    axes.set_xlim(min(reach) - 0.3 * room, max(reach) + 0.3 * room)
    axes.set_xlabel(f"{words} [{unit}]" if unit not in ("", "-") else words)
    axes.grid(axis="y", alpha=0.0)
    axes.ticklabel_format(axis="x", useOffset=False)
    return figure


def _span(bar: Bar) -> float:
    values = [value for _, value in bar.values]
    return max(values) - min(values)
