"""Matplotlib plots of mode shapes: displacement along the riser, a panel for each mode, over the shape at rest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from riser_soil.core.arrays import Array
from riser_soil.plots.curves import ARC, PAGE, STYLE, save, sheet

LineMoved = tuple[Array, Array, Array]  # arc (nn,), position (nn, 3) at rest [m], displacements (n, nn, 3)
STYLES = ("-", "--", ":", "-.")  # line styles, in turn
WITHIN: dict[str, Any] = {"fontsize": 7.5, "loc": "upper right"}  # legends: within the panel, of many curves above it
ABOVE: dict[str, Any] = {
    "fontsize": 7.5, "loc": "lower right", "bbox_to_anchor": (1.0, 0.98), "ncols": 9, "columnspacing": 0.8,
    "frameon": False, "handlelength": 1.5, "handletextpad": 0.4,
}  # fmt: skip
COMPONENTS = ("x", "y", "z")
LARGEST = 0.08  # of the riser's extent: the largest displacement as it is drawn over the shape at rest
UNSEEN = 1e-6  # of the largest displacement: a component that is left out


def draw_modes(png: Path, lines: Mapping[str, LineMoved], titles: Sequence[str]) -> Path:
    """Draw modes: the lines at rest and how they move, side by side for each mode; seen from above where they move out
    of plane.

    lines: by name, "" the only one; their displacements are at most 1.
    """
    with rc_context(STYLE):
        return save(mode_sheet(lines, titles), png)


def mode_sheet(lines: Mapping[str, LineMoved], titles: Sequence[str]) -> Figure:
    """A figure of the lines at rest and how they move, side by side for each mode; arguments as of `draw_modes`."""
    figure, panels = sheet(len(titles), 2, width=PAGE, height=1.8)
    position = np.concatenate([place for _, place, _ in lines.values()])
    horizontal = _horizontal(position)
    for n, (title, left, right) in enumerate(zip(titles, panels[::2], panels[1::2], strict=True)):
        _draw_view(left, [(place, shape[n]) for _, place, shape in lines.values()], position, horizontal)
        left.set_title(title, loc="left")
        for (name, (arc, _, shape)), style in zip(lines.items(), cycle(STYLES)):
            for component, axis in enumerate(COMPONENTS):
                if np.abs(shape[n, :, component]).max() > UNSEEN:
                    right.plot(arc, shape[n, :, component], f"C{component}{style}", label=f"{name} {axis}".strip())
        right.set_xlabel(ARC)
        right.set_ylabel("displacement\nover the largest [-]")
        if right.lines:
            right.legend(**(ABOVE if len(lines) > 1 else WITHIN))
    for axes in panels[:-2]:
        axes.set_xlabel("")
    return figure


def _draw_view(axes: Axes, lines: Sequence[tuple[Array, Array]], position: Array, horizontal: Array) -> None:
    """Lines at rest and both extremes of the mode, in a vertical plane or from above. lines: their places and
    displacements (nn, 3); position: of all nodes.
    """
    extent = float(np.ptp(position, axis=0).max())
    across, moved = np.cross([0.0, 0.0, 1.0], horizontal), np.concatenate([moved for _, moved in lines])
    above = np.abs(moved @ across).max() > np.abs(moved - np.outer(moved @ across, across)).max()
    upwards = across if above else np.array([0.0, 0.0, 1.0])
    origin = position[0] if above else position[0] * [1.0, 1.0, 0.0]
    for factor, style in ((0.0, "k-"), (LARGEST * extent, "C3-"), (-LARGEST * extent, "C3--")):
        for place, moves in lines:
            shown = place + factor * moves - origin
            axes.plot(shown @ horizontal, shown @ upwards, style, linewidth=0.9)
    axes.set_xlabel("horizontal distance from end A [m]")
    axes.set_ylabel("from above:\nto the left [m]" if above else "z [m], upwards")


def _horizontal(position: Array) -> Array:
    """Unit vector (3,) in plan from the start to the farthest place."""
    plan = (position - position[0]) * [1.0, 1.0, 0.0]
    farthest = plan[np.linalg.norm(plan, axis=1).argmax()]
    size = float(np.linalg.norm(farthest))
    return farthest / size if size > 0.0 else np.array([1.0, 0.0, 0.0])
