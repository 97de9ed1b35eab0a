"""Error against processor time: a panel for each figure, a line for each method, the reference's uncertainty dotted."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.colors import TABLEAU_COLORS
from matplotlib.ticker import FuncFormatter

from benchmarks.soil_precision.errors import Row, series, uncertainty
from benchmarks.soil_precision.ladders import LADDERS
from demos.page import block
from riser_soil.plots.curves import save, sheet

COLUMNS = 4
SECONDS, ERRORS = (1.0, 250.0), (4.0e-4, 12.0)  # that are drawn


class Panel(NamedTuple):
    """A figure of a scene, by a norm; told: whether the page's table has it."""

    scene: str
    figure: str
    norm: str
    title: str
    told: bool = False


PANELS = (
    Panel("pushed", "capacity at 0.05 D", "relative", "pushed pipe: capacity at 0.05 D", True),
    Panel("pushed", "capacity at 0.2 D", "relative", "pushed pipe: capacity at 0.2 D", True),
    Panel("pushed", "trough", "RMS", "pushed pipe: trough across it, RMS"),
    Panel("laid", "settlement", "relative", "laid riser: settlement", True),
    Panel("laid", "settlement along", "RMS", "laid riser: settlement along it, RMS"),
    Panel("laid", "trench depth", "relative", "heaved riser: trench depth", True),
    Panel("laid", "trench along", "largest", "heaved riser: trench along it, largest"),
    Panel("laid", "largest stress", "relative", "laid riser: largest von Mises stress", True),
    Panel("laid", "largest moment", "relative", "heaved riser: largest moment", True),
    Panel("elastic", "settlement", "relative", "laid on elastic soil: settlement"),
    Panel("elastic", "largest stress", "relative", "laid on elastic soil: largest von Mises stress"),
)
METHODS = list(dict.fromkeys(method for ladder in LADDERS.values() for method in ladder.methods))
OWN = "the reference's own uncertainty"
MARKERS = "osD^vP*Xd<p"
COLOURS = [*TABLEAU_COLORS, "black"]
SHADES = ("black", "tab:red", "tab:blue", "tab:green")  # of programs


def draw(rows: Sequence[Row], peers: str, file: Path) -> None:
    """peers: the page that compares other programs."""
    figure, panels = sheet(3, COLUMNS, width=15.0, height=3.3)
    for axes, panel in zip(panels, PANELS, strict=False):
        _draw_panel(axes, rows, panel)
    _draw_peers(panels[len(PANELS)], peers)
    for axes in panels:
        axes.set(xscale="log", yscale="log", xlim=SECONDS, ylim=ERRORS)
        axes.xaxis.set_major_formatter(FuncFormatter(lambda seconds, _: f"{seconds:g}"))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda part, _: f"{100.0 * part:g} %"))
    for axes in panels[::COLUMNS]:
        axes.set_ylabel("error")
    for axes in panels[-COLUMNS:]:
        axes.set_xlabel("processor time [s]")
    drawn = [axes.get_legend_handles_labels() for axes in panels[: len(PANELS)]]
    known = {label: line for lines, labels in drawn for line, label in zip(lines, labels, strict=True)}
    names = [name for name in (*METHODS, OWN) if name in known]
    figure.legend([known[name] for name in names], names, loc="outside lower center", ncols=6)
    save(figure, file)


def _draw_panel(axes: Axes, rows: Sequence[Row], panel: Panel) -> None:
    for method, known in series(rows, *panel[:3]).items():
        number = METHODS.index(method)
        seconds = [row.seconds for row in known]
        errors = [max(row.error, ERRORS[0]) for row in known]
        axes.plot(seconds, errors, f"-{MARKERS[number]}", color=COLOURS[number], label=method, markersize=5)
    axes.axhline(uncertainty(rows, *panel[:3]), color="0.3", linestyle=":", label=OWN)
    axes.set_title(panel.title, fontsize=10)


def _draw_peers(axes: Axes, peers: str) -> None:
    """Plot from the table of a pipe pressed into clay: how far each program's force is off the finest mesh's."""
    curve_points: dict[str, list[tuple[float, float]]] = {}
    for line in block(peers, "clay").splitlines()[2:]:
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        curve_points.setdefault(cells[1], []).append((float(cells[-1]), 0.01 * float(cells[-3].removesuffix("%"))))
    for number, (program, points) in enumerate(curve_points.items()):
        seconds, errors = zip(*(point for point in points if point[1] > 0.0), strict=True)
        axes.plot(seconds, errors, ".--", color=SHADES[number], linewidth=1.2, label=program)
    axes.legend(fontsize=8, loc="upper right")
    axes.set_title("pressed pipe beside CalculiX: force", fontsize=10)
