"""Error against time for each case: every run, and the staircase of the accuracies that count."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter

from benchmarks.peers.judge import Judged, front
from riser_soil.plots.curves import save, sheet

MARKERS = "osPD^v*"
LARGEST = 2.0  # error that is drawn: one run of another program ended in numbers without meaning


def draw(cases: Mapping[str, Mapping[str, Sequence[Judged]]], least: Mapping[str, float], png: Path) -> None:
    """Each case's programs; least: the error of each case below which nothing can be told, a dotted line."""
    figure, panels = sheet(1, len(cases), width=12.0, height=5.0)
    for axes, (name, programs) in zip(panels, cases.items(), strict=True):
        for number, (program, runs) in enumerate(programs.items()):
            _draw_program(axes, program, runs, f"C{number}", MARKERS[number])
        axes.axhline(least[name], color="0.4", linestyle=":", label="distance between the finest runs")
        axes.set(xscale="log", yscale="log", title=name, xlabel="processor seconds per simulated second")
        axes.set_ylim(0.5 * least[name], LARGEST)
        axes.yaxis.set_major_formatter(FuncFormatter(lambda part, _: f"{100.0 * part:g} %"))
    panels[0].set_ylabel("largest error of a quantity")
    panels[0].legend(fontsize=8)
    save(figure, png)


def _draw_program(axes: Axes, name: str, runs: Sequence[Judged], color: str, marker: str) -> None:
    """Runs faint, what counts as a staircase."""
    axes.plot([run.seconds for run in runs], [run.error for run in runs], marker, color=color, alpha=0.3, markersize=4)
    seconds, kept = zip(*front(runs), strict=True)
    axes.step(seconds, kept, color=color, marker=marker, where="post", label=name, linewidth=1.2, markersize=5)
