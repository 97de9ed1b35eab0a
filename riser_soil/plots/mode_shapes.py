"""Matplotlib plots of mode shapes: displacement along the riser, a panel for each mode, over the shape at rest."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from riser_soil.core.arrays import Array
from riser_soil.plots.curves import save, sheet

COMPONENTS = ("x", "y", "z")
LARGEST = 0.08  # of the riser's extent: the largest displacement as it is drawn over the shape at rest
UNSEEN = 1e-6  # of the largest displacement: a component that is left out


def draw_modes(png: Path, arc: Array, position: Array, shape: Array, titles: Sequence[str]) -> Path:
    """By the riser at rest and how it moves, side by side for each mode; seen from above where it moves out of plane.

    arc (nn,), position (nn, 3) [m] at rest; shape (n, nn, 3): displacements, the largest 1.
    """
    figure, panels = sheet(len(shape), 2, width=10.0, height=2.3)
    horizontal = _horizontal(position)
    for moved, title, left, right in zip(shape, titles, panels[::2], panels[1::2], strict=True):
        _draw_view(left, position, moved, horizontal)
        left.set_title(title, fontsize=9, loc="left")
        for component, name in enumerate(COMPONENTS):
            if np.abs(moved[:, component]).max() > UNSEEN:
                right.plot(arc, moved[:, component], f"C{component}", label=name)
        right.set_xlabel("arc length from the start [m]", fontsize=8)
        right.set_ylabel("displacement\nover the largest [-]", fontsize=8)
        if right.lines:
            right.legend(fontsize=7, loc="upper right")
    return save(figure, png)


def _draw_view(axes: Axes, position: Array, moved: Array, horizontal: Array) -> None:
    """The riser at rest and both extremes of the mode, in the vertical plane from its start or from above."""
    extent = float(np.ptp(position, axis=0).max())
    across = np.cross([0.0, 0.0, 1.0], horizontal)
    above = np.abs(moved @ across).max() > np.abs(moved - np.outer(moved @ across, across)).max()
    upwards = across if above else np.array([0.0, 0.0, 1.0])
    origin = position[0] if above else position[0] * [1.0, 1.0, 0.0]
    for factor, style in ((0.0, "k-"), (LARGEST * extent, "C3-"), (-LARGEST * extent, "C3--")):
        seen = position + factor * moved - origin
        axes.plot(seen @ horizontal, seen @ upwards, style, linewidth=0.9)
    axes.set_xlabel("horizontal distance from the start [m]", fontsize=8)
    axes.set_ylabel("from above:\nto the left [m]" if above else "z [m], upwards", fontsize=8)


def _horizontal(position: Array) -> Array:
    """Unit vector (3,) in plan from the start to the farthest place."""
    plan = (position - position[0]) * [1.0, 1.0, 0.0]
    farthest = plan[np.linalg.norm(plan, axis=1).argmax()]
    size = float(np.linalg.norm(farthest))
    return farthest / size if size > 0.0 else np.array([1.0, 0.0, 0.0])
