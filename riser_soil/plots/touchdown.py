"""Picture of the touchdown zone, drawn off screen: python -m riser_soil.plots.touchdown FOLDER PNG [MAGNIFY]."""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyvista as pv

from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError
from riser_soil.plots.bodies import (
    UP,
    carried_down,
    colour_bar,
    exit_status,
    flat_seabed,
    pipe_radius,
    require,
    soil_grid,
    touchdown_place,
)
from riser_soil.plots.scales import colour_scale, drawn_radius, magnification, metres
from riser_soil.results import Run, SoilFrame
from riser_soil.results.stage_records import along

_SIZE = (1600, 900)
_ABOVE = 0.045  # of what is shown across: the touchdown's label stands above the riser that rises behind it
_MOMENT = "bending moment [kN m]"
_STRESS = "von Mises stress [kPa]"
_MOMENT_COLOURS, _STRESS_COLOURS = "viridis", "YlOrBr"


@dataclass(frozen=True, eq=False)
class _Frame:
    """Data of one picture: arc (nn,) m, axis (nn, 3) m, moment (nn,) N.m, touchdown point (3,) m.

    Where nothing touches, the riser's lowest point stands in for the touchdown point, and its arc is nan.
    """

    title: str
    time: float
    arc: Array
    position: Array
    moment: Array
    radius: float
    touchdown: Array
    touchdown_arc: float
    soil: pv.UnstructuredGrid | None
    seabed: float | None  # m, level of a flat one

    @property
    def across(self) -> float:
        """m, what the close view shows from left to right, roughly."""
        if self.soil is None:
            return 0.2 * float(np.ptp(self.position, axis=0).max())
        x0, x1, y0, y1, _, _ = self.soil.bounds
        return 0.4 * max(x1 - x0, y1 - y0)

    @property
    def thickened(self) -> float:
        """Factor on the radius in the close view: a riser over soil is drawn as it is."""
        return 1.0 if self.soil is not None else drawn_radius(self.radius, self.across) / self.radius


def draw(folder: Path, png: Path, magnify: float | None = None) -> None:
    """Writes the picture; see `riser_soil.plots.picture`."""
    still = _read(Run(folder))
    factor = _factor(still.soil) if magnify is None else magnify
    # VTK tries a display first and warns when there is none, although it then draws without.
    with pv.vtk_verbosity("error"):
        tall = [([0, 1], 0), *([([0, 1], 1)] if still.soil is None else [])]
        plotter = pv.Plotter(
            off_screen=True,
            window_size=list(_SIZE),
            shape=(2, 2),
            col_weights=[5, 3],
            groups=tall,
            border=False,
        )
        plotter.set_background("white")
        plotter.subplot(0, 0)
        _draw_close(plotter, still, factor)
        plotter.subplot(0, 1)
        _draw_whole(plotter, still)
        if still.soil is not None:
            plotter.subplot(1, 1)
            _draw_section(plotter, still, still.soil)
        plotter.screenshot(str(png))
        plotter.close()


def main(arguments: list[str]) -> int:
    """FOLDER PNG [MAGNIFY]; a failure is one line on standard error."""
    asked = _parser().parse_args(arguments)
    return exit_status(lambda: draw(asked.folder, asked.png, asked.magnify))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m riser_soil.plots.touchdown", description="Draw the touchdown zone at a run's last instant."
    )
    parser.add_argument("folder", type=Path, help="folder of the run")
    parser.add_argument("png", type=Path, help="file to write")
    parser.add_argument(
        "magnify", type=float, nargs="?", help="factor on the soil's displacement; one that makes it visible by default"
    )
    return parser


def _read(run: Run) -> _Frame:
    if run.time.size == 0:
        raise ResultsError(f"{run.place}: nothing was recorded, so there is nothing to draw")
    frame = run.soil_frame() if run.has_soil and run.soil_times.size else None
    at = -1 if frame is None else int(np.abs(run.time - frame.time).argmin())
    position, touchdown_arc = run["position"][at], float(run["touchdown_arc"][at])
    return _Frame(
        title=run.summary["title"],
        time=float(run.time[at]),
        arc=run.arc,
        position=position,
        moment=run["bending_moment"][at],
        radius=pipe_radius(run),
        touchdown=touchdown_place(touchdown_arc, run.arc, position),
        touchdown_arc=touchdown_arc,
        soil=None if frame is None else _grid(frame),
        seabed=flat_seabed(run),
    )


def _grid(frame: SoilFrame) -> pv.UnstructuredGrid:
    require(frame, "the picture", "displacement", "von_mises_stress")
    grid = soil_grid(frame)
    grid.cell_data[_STRESS] = 1e-3 * frame.fields["von_mises_stress"]
    return grid


def _factor(soil: pv.UnstructuredGrid | None) -> float:
    if soil is None:
        return 1.0
    largest = float(np.linalg.norm(soil.point_data["displacement"], axis=1).max())
    return magnification(largest, soil.bounds[5] - soil.bounds[4])


def _draw_close(plotter: pv.Plotter, still: _Frame, factor: float) -> None:
    ahead = along(still.position)
    side = np.cross(UP, ahead)
    if still.soil is None:
        _add_seabed(plotter, still, ahead)
        _add_tube(plotter, still.position, still)
    else:
        opened = still.soil.clip(normal=-side, origin=still.touchdown)
        _add_soil(plotter, opened.warp_by_vector("displacement", factor=factor))
        sunk = carried_down(still.soil, still.position, still.arc, still.radius)
        _add_tube(plotter, still.position + (factor - 1.0) * sunk, still)
    plotter.add_text(_caption(still, factor), position="upper_left", font_size=12, color="black")
    if not math.isnan(still.touchdown_arc):
        _mark(
            plotter,
            still.touchdown + max(4.0 * still.thickened * still.radius, _ABOVE * still.across) * UP,
            f"touchdown at arc {still.touchdown_arc:.4g} m",
        )
    reach = still.across
    plotter.camera.focal_point = still.touchdown + 0.05 * reach * UP
    plotter.camera.position = still.touchdown + reach * (0.6 * UP - 1.2 * side - 0.2 * ahead)
    plotter.camera.up = UP
    plotter.reset_camera_clipping_range()


def _mark(plotter: pv.Plotter, where: Array, text: str) -> None:
    plotter.add_point_labels(
        [where], [text], font_size=18, text_color="black", shape=None, show_points=False, always_visible=True
    )


def _caption(still: _Frame, factor: float) -> str:
    words = f"{still.title}\nt = {still.time:.4g} s"
    if still.soil is None:
        thick = f"\nthe riser is drawn {still.thickened:.2g} times as thick as it is"
        return words + (thick if still.thickened > 1.0 else "")
    words += "\nsoil cut open along the riser"
    return f"{words}; its deformation is drawn \u00d7 {factor:g} and carries it along"


def _add_soil(plotter: pv.Plotter, soil: pv.UnstructuredGrid) -> None:
    top, labels = colour_scale(soil.cell_data[_STRESS])
    plotter.add_mesh(
        soil,
        scalars=_STRESS,
        cmap=_STRESS_COLOURS,
        clim=(0.0, top),
        show_edges=True,
        edge_opacity=0.25,
        ambient=0.55,
        diffuse=0.5,
        scalar_bar_args=colour_bar(_STRESS, 0.55, labels),
    )


def _add_seabed(plotter: pv.Plotter, still: _Frame, ahead: Array) -> None:
    """A plate under the riser: as much lower than the seabed as the riser is drawn too thick."""
    if still.seabed is None:
        return
    lower = (still.thickened - 1.0) * still.radius
    centre = [*still.touchdown[:2], still.seabed - lower]
    plate = pv.Plane(center=centre, direction=UP, i_size=2.0 * still.across, j_size=0.5 * still.across)
    turned = plate.rotate_z(math.degrees(math.atan2(ahead[1], ahead[0])), point=centre)
    plotter.add_mesh(turned, color="tan", ambient=0.6, diffuse=0.4)


def _add_tube(plotter: pv.Plotter, position: Array, still: _Frame) -> None:
    top, labels = colour_scale(1e-3 * still.moment)
    plotter.add_mesh(
        _tube(position, still.moment, still.thickened * still.radius),
        scalars=_MOMENT,
        cmap=_MOMENT_COLOURS,
        clim=(0.0, top),
        smooth_shading=True,
        scalar_bar_args=colour_bar(_MOMENT, 0.05, labels),
    )


def _tube(position: Array, moment: Array, radius: float) -> pv.PolyData:
    line = pv.lines_from_points(position)
    line.point_data[_MOMENT] = 1e-3 * moment
    return line.tube(radius=radius, n_sides=24)


def _draw_section(plotter: pv.Plotter, still: _Frame, soil: pv.UnstructuredGrid) -> None:
    """Across the riser where the soil has settled most, true to scale."""
    node = _deepest(still, soil)
    ahead = along(still.position[max(node - 1, 0) : node + 2])
    flat = ahead - (ahead @ UP) * UP
    section = soil.cell_data_to_point_data().slice(normal=flat, origin=still.position[node])
    moved = section.warp_by_vector("displacement", factor=1.0)
    top, _ = colour_scale(soil.cell_data[_STRESS])
    plotter.add_mesh(
        moved,
        scalars=_STRESS,
        cmap=_STRESS_COLOURS,
        clim=(0.0, top),
        show_edges=True,
        edge_opacity=0.2,
        lighting=False,
        show_scalar_bar=False,
    )
    pipe = pv.Disc(center=still.position[node], inner=0.93 * still.radius, outer=still.radius, normal=flat, c_res=72)
    plotter.add_mesh(pipe, color="black", lighting=False)
    plotter.add_text(f"across at arc {still.arc[node]:.4g} m, true to scale", font_size=12, color="black")
    plotter.enable_parallel_projection()
    plotter.camera.focal_point = still.position[node] - 0.8 * still.radius * UP
    plotter.camera.position = plotter.camera.focal_point - 10.0 * still.radius * flat
    plotter.camera.up = UP
    plotter.camera.parallel_scale = 2.4 * still.radius
    plotter.reset_camera_clipping_range()


def _deepest(still: _Frame, soil: pv.UnstructuredGrid) -> int:
    """The riser's node under which the soil has settled most."""
    sunk = carried_down(soil, still.position, still.arc, still.radius)
    return int(sunk[:, 2].argmin())


def _draw_whole(plotter: pv.Plotter, still: _Frame) -> None:
    lowest, highest = still.position.min(axis=0), still.position.max(axis=0)
    size = highest - lowest
    tube = _tube(still.position, still.moment, 0.006 * float(size.max()))
    plotter.add_mesh(tube, scalars=_MOMENT, cmap=_MOMENT_COLOURS, show_scalar_bar=False)
    if still.soil is not None:
        plotter.add_mesh(still.soil.outline(), color="saddlebrown", line_width=2)
    wide = float(np.linalg.norm(size[:2]))
    plotter.add_text(f"whole riser, {metres(wide)} by {metres(size[2])}", font_size=12, color="black")
    plotter.enable_parallel_projection()
    plotter.camera.focal_point = 0.5 * (lowest + highest)
    plotter.camera.position = 0.5 * (lowest + highest) - float(size.max()) * np.cross(
        UP, along(still.position)
    )
    plotter.camera.up = UP
    plotter.reset_camera()
    plotter.camera.zoom(1.25)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
