"""Riser and soil as bodies to draw: radius of the pipe, grid of the soil, what the riser sinks with, colour bars."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable

import numpy as np
import pyvista as pv

from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError
from riser_soil.results import Run, SoilFrame

UP = np.array([0.0, 0.0, 1.0])
_CELL_TYPES = {4: pv.CellType.TETRA, 8: pv.CellType.HEXAHEDRON, 10: pv.CellType.QUADRATIC_TETRA}


def exit_status(draw: Callable[[], None]) -> int:
    """Exit status of a process that draws: 0, or 1 after a failure, which is one line on standard error."""
    try:
        draw()
    except (ResultsError, OSError) as err:
        print(err, file=sys.stderr)
        return 1
    return 0


def pipe_radius(run: Run) -> float:
    """m, half the largest outer diameter in the scene; a thin line's where the scene cannot be read."""
    try:
        return 0.5 * max(float(line["outer_diameter"]) for line in run.scene["line_types"].values())
    except (ResultsError, KeyError, TypeError, AttributeError, ValueError):
        return 1e-3 * float(run.arc[-1])


def touchdown_place(arc_length: float, arc: Array, position: Array) -> Array:
    """The touchdown point (3,) m of an axis (nn, 3); its lowest point where nothing touches."""
    if math.isnan(arc_length):
        return np.asarray(position[position[:, 2].argmin()])
    return np.array([np.interp(arc_length, arc, position[:, i]) for i in range(3)])


def require(frame: SoilFrame, what: str, *names: str) -> None:
    """ResultsError where a field that `what` needs was left out of the run."""
    missing = set(names) - frame.fields.keys()
    if missing:
        raise ResultsError(f"{what} needs {min(missing)}: add it to output.fields of the scene and run again")


def soil_grid(frame: SoilFrame) -> pv.UnstructuredGrid:
    """The soil as it lay at first, with its displacement."""
    grid = pv.UnstructuredGrid({_CELL_TYPES[frame.cells.shape[1]]: frame.cells}, frame.points)
    grid.point_data["displacement"] = frame.fields["displacement"]
    return grid


def carried_down(soil: pv.UnstructuredGrid, position: Array, arc: Array, radius: float) -> Array:
    """The soil's displacement (nn, 3) m under each node of the riser; 0 beside the block.

    Averaged along a few diameters: magnified, the soil's steps from cell to cell would kink the pipe.
    """
    inside = soil.bounds[5] - 1e-6 * soil.length
    below = pv.PolyData(np.column_stack([position[:, :2], np.full(len(position), inside)]))
    under = np.asarray(below.sample(soil).point_data["displacement"])
    apart = (arc[:, None] - arc) / (6.0 * radius)
    weights = np.exp(-(apart**2))
    return np.asarray(weights @ under / weights.sum(axis=1, keepdims=True))


def colour_bar(title: str, left: float, labels: int) -> dict[str, object]:
    """Arguments of pyvista's scalar bar that begins at this share of the width."""
    place = {"position_x": left, "position_y": 0.03, "width": 0.4, "height": 0.11}
    fonts = {
        "title_font_size": 22,
        "label_font_size": 18,
        "color": "black",
        "fmt": "%.3g",
        "n_labels": labels,
    }
    # The blank line keeps the title clear of the labels.
    return {"title": title + "\n", **place, **fonts}
