"""Work-precision plot: error against processor time, a line for each setting of a study, and the Pareto front."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter

from riser_soil.plots.curves import sheet

LEAST = 1e-7  # relative error below which a point is drawn there
MARKERS = "osD^v"


@dataclass(frozen=True, eq=False)
class SettingLine:
    """One setting's refinement series from coarse to fine: processor time (n,) [s], relative error (n,), whether timed
    alone (n,).
    """

    words: str
    order: str
    seconds: Sequence[float]
    errors: Sequence[float]
    alone: Sequence[bool]


@dataclass(frozen=True, eq=False)
class WorkPrecision:
    """Data of a work-precision plot. other, front: further points, and the Pareto front from cheap to expensive, by
    processor time [s] and relative error.

    scene: processor time and error of the scene. uncertainty: relative, of the reference. targets: relative errors.
    """

    lines: Sequence[SettingLine]
    other_seconds: Sequence[float]
    other_errors: Sequence[float]
    front_seconds: Sequence[float]
    front_errors: Sequence[float]
    scene: tuple[float, float]
    uncertainty: float
    targets: Sequence[float]


def drawn_work_precision(shown: WorkPrecision) -> str:
    """The plot as the text of an SVG image."""
    figure, (axes,) = sheet(1, 1, width=9.0, height=5.6)
    for number, line in enumerate(shown.lines):
        _draw_line(axes, line, f"C{number}", MARKERS[number % len(MARKERS)])
    axes.plot(shown.other_seconds, _drawn(shown.other_errors), "k*", markersize=9, label="several settings at once")
    axes.step(shown.front_seconds, _drawn(shown.front_errors), "k-", where="post", linewidth=0.8, label="Pareto front")
    axes.plot(*[[each] for each in (shown.scene[0], max(shown.scene[1], LEAST))], "ko", fillstyle="none", markersize=15)
    axes.annotate("scene as it is", (shown.scene[0], max(shown.scene[1], LEAST)), (12, 8), textcoords="offset points")
    if shown.uncertainty > LEAST:
        axes.axhline(shown.uncertainty, color="0.4", linestyle=":", label="largest uncertainty of a reference")
    for target in shown.targets:
        axes.axhline(target, color="C2", linewidth=0.6)
    axes.set(xscale="log", yscale="log", xlabel="processor time [s]")
    axes.set_ylabel("largest relative error of a key result")
    axes.yaxis.set_major_formatter(FuncFormatter(lambda part, _: f"{100.0 * part:g} %"))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda seconds, _: f"{seconds:g}"))
    labelled_digits = "123456789" if _span(shown) < 6.0 else "25" if _span(shown) < 30.0 else ""
    axes.xaxis.set_minor_formatter(FuncFormatter(lambda s, _: f"{s:g}" if f"{s:.0e}"[0] in labelled_digits else ""))
    axes.legend(fontsize=9)
    text = io.StringIO()
    figure.savefig(text, format="svg")
    return text.getvalue()


def _draw_line(axes: Axes, line: SettingLine, color: str, marker: str) -> None:
    errors = _drawn(line.errors)
    axes.plot(line.seconds, errors, "-", color=color, marker=marker, label=f"{line.words}: {line.order}")
    beside = [n for n, alone in enumerate(line.alone) if not alone]
    places = [line.seconds[n] for n in beside], [errors[n] for n in beside]
    axes.plot(*places, color=color, marker=marker, markerfacecolor="white", linestyle="none", zorder=3)


def _drawn(errors: Sequence[float]) -> list[float]:
    return [max(error, LEAST) for error in errors]


def _span(shown: WorkPrecision) -> float:
    seconds = [s for line in shown.lines for s in line.seconds] + [*shown.other_seconds]
    return max(seconds) / min(seconds)
