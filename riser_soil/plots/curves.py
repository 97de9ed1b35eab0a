"""Matplotlib plots of a run: shapes, quantities along the arc length, time histories of reactions and tension.

Each function draws on axes that the caller has made, from the files of a finished or unfinished run; `sheet` and `save`
make and write a figure. Records are counted as in results.nc: 0 is the first, −1 the last.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from riser_soil.core.arrays import Array
from riser_soil.core.outputs import ALONG_RISER
from riser_soil.plots.scales import axis_words
from riser_soil.results import Run
from riser_soil.results.stage_records import along, reactions

# Along the arc: what the axis says, and the factor that makes it so; the text and unit of the table of outputs, where
# it is not said better here.
ALONG_ARC: dict[str, tuple[str, float]] = {
    **{output.name: axis_words(output.text, output.units) for output in ALONG_RISER if not output.vector},
    "effective_tension": ("effective tension [kN], + pulls", 1e-3),
    "wall_tension": ("true wall tension [kN], + pulls", 1e-3),
    "stress_utilisation": ("von Mises stress over the allowable stress [-]", 1.0),
    "bend_utilisation": ("allowable over actual bend radius [-]", 1.0),
    "tension_utilisation": ("effective tension over the allowable tension [-]", 1.0),
    "bending_moment": ("bending moment, magnitude [kN m]", 1e-3),
    "curvature": ("curvature, magnitude [1/m]", 1.0),
    "code_utilisation": ("code checks, largest utilisation [-]", 1.0),
    "contact_force": ("contact force per length [kN/m], + pushes", 1e-3),
    "penetration": ("penetration into the ground as it is [mm]", 1e3),
    "embedment": ("greatest depth yet below the ground's first level [mm]", 1e3),
    "soil_settlement": ("settlement of the soil under the riser [mm], + down", 1e3),
}
_REACTIONS = {
    "H1": "H at end A [kN], + towards end A",
    "H2": "H at end B [kN], + towards end B",
    "V1": "V at end A [kN], + upwards",
    "V2": "V at end B [kN], + upwards",
}
ARC, TIME = "arc length from end A [m]", "time [s]"
PAGE = 6.7  # in, width of the text on A4: pictures of this width are printed as large as they are
STYLE: dict[str, Any] = {  # style of pictures of this width; "small" is 7.5 pt then, the least that reads well on paper
    "font.size": 9.0, "axes.labelsize": 8.5, "axes.titlesize": 9.0, "xtick.labelsize": 8.0, "ytick.labelsize": 8.0,
    "legend.fontsize": 7.5, "axes.spines.top": False, "axes.spines.right": False, "lines.linewidth": 1.2,
}  # fmt: skip


def sheet(rows: int, columns: int, width: float = 9.0, height: float = 3.2) -> tuple[Figure, list[Axes]]:
    """A figure and its axes, row by row; height [in] of each row."""
    figure = Figure(figsize=(width, height * rows), layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False)
    for axes in panels.flat:
        axes.grid(alpha=0.3)
    return figure, list(panels.flat)


def legend_below(axes: Axes) -> None:
    """A legend of many names below the panel, in as many columns as the page is wide for."""
    longest = max((len(label) for label in axes.get_legend_handles_labels()[1]), default=0)
    columns = max(1, min(4, _LETTERS // (longest + _HANDLE)))
    place: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.2), "frameon": False}
    axes.legend(ncols=columns, fontsize="small", **place)


_LETTERS, _HANDLE = 100, 8  # of a legend's line on a page; what a line's sample and the gap take
_UNSTAMPED = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}


def save(figure: Figure, file: Path | str) -> Path:
    """Save a figure in the format of the file's ending: PNG, SVG or PDF; the same run gives the same file, but for the
    library.
    """
    with rc_context({"svg.hashsalt": "riser_soil"}):
        figure.savefig(file, dpi=120, metadata=_UNSTAMPED.get(Path(file).suffix))
    return Path(file)


@dataclass(frozen=True, eq=False)
class Curves:
    """A sheet of curves that is drawn when its content is asked for, in the style of a printed page."""

    draw: Callable[[], Figure]
    endings: tuple[str, ...] = (".svg", ".png")
    dpi: int = 200

    def content(self, ending: str) -> bytes:
        """Bytes of a file with this ending; letters of an SVG are drawn, so that no font is needed."""
        stream = io.BytesIO()
        with rc_context(STYLE | {"svg.hashsalt": "riser_soil"}):
            self.draw().savefig(stream, format=ending[1:], dpi=self.dpi, metadata=_UNSTAMPED.get(ending))
        return stream.getvalue()


def shapes(axes: Axes, run: Run, at: Sequence[int] = (-1,), labels: Sequence[str] = (), **style: Any) -> None:
    """The axis in the vertical plane from start to end, at some records; out-of-plane motion is not seen."""
    position = run["position"]
    direction = along(position[0])
    names = labels or [f"t = {run.time[i]:.3g} s" for i in at]
    for i, name in zip(at, names, strict=True):
        axes.plot((position[i] - position[0, 0]) @ direction, position[i, :, 2], label=name, **style)
    axes.set_xlabel("horizontal distance from end A [m]")
    axes.set_ylabel("z [m], upwards")
    axes.set_aspect("equal")
    axes.legend()


def along_arc(axes: Axes, run: Run, name: str, at: int = -1, label: str | None = None, **style: Any) -> None:
    """A quantity of ALONG_ARC at one record, node by node."""
    words, factor = ALONG_ARC[name]
    axes.plot(run.arc, factor * run[name][at], label=label, **style)
    _name(axes, ARC, words)


def envelope(axes: Axes, run: Run, name: str, since: float = 0.0, label: str | None = None) -> None:
    """Smallest and largest value of a quantity of ALONG_ARC at each node, over the records from `since` [s] on."""
    words, factor = ALONG_ARC[name]
    values = factor * run[name][run.time >= since]
    least, most = values.min(axis=0), values.max(axis=0)
    # A band has no width where nothing changes: its edge is a line.
    axes.fill_between(run.arc, least, most, alpha=0.5, label=label, linewidth=1.0, edgecolor="face")
    _name(axes, ARC, words)


def end_reactions(panels: Sequence[Axes], runs: Mapping[str, Run], since: float = 0.0) -> None:
    """H1, H2, V1, V2 in time on four axes: forces of the supports on the riser, runs by their labels."""
    for label, run in runs.items():
        forces, window = reactions(run), run.time >= since
        for axes, (name, words) in zip(panels, _REACTIONS.items(), strict=True):
            axes.plot(run.time[window], 1e-3 * getattr(forces, name)[window], label=label, linewidth=1.0)
            axes.set_xlabel(TIME)
            axes.set_ylabel(words)
    if len(runs) > 1:
        panels[0].legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(runs), frameon=False)


def end_tension(axes: Axes, run: Run, since: float = 0.0, label: str | None = None) -> None:
    """Effective tension at the end in time."""
    window = run.time >= since
    axes.plot(run.time[window], 1e-3 * run["effective_tension"][window, -1], label=label, linewidth=1.0)
    _name(axes, TIME, "effective tension at end B [kN], + pulls")


def instants(run: Run, since: float, until: float, count: int) -> list[int]:
    """Records nearest to `count` instants evenly spread from `since` to `until` [s]."""
    wanted: Array = np.linspace(since, until, count)
    return [int(np.abs(run.time - t).argmin()) for t in wanted]


def _name(axes: Axes, x: str, y: str) -> None:
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    if axes.get_legend_handles_labels()[0]:
        axes.legend()
