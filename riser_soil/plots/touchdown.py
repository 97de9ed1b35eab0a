"""Picture of the touchdown zone, drawn off screen: python -m riser_soil.plots.touchdown FOLDER PNG [MAGNIFY].

Over soil: the block cut open along the riser in a parallel projection, so that one scale holds all over it, the whole
riser, and a section across the riser where the soil has settled most. A riser alone: its touchdown zone and all of it.
Colours are not shaded, so that they can be read off their bars.
"""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyvista as pv
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec
from matplotlib.patches import Circle
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation
from scipy.interpolate import CubicSpline

from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError
from riser_soil.plots.bodies import (
    UP,
    carried_down,
    exit_status,
    pipe_radius,
    require,
    soil_grid,
    touchdown_place,
)
from riser_soil.plots.scales import colour_scale, magnification, metres
from riser_soil.plots.shape import seabed_under, surface_level
from riser_soil.results import Run, SoilFrame
from riser_soil.results.stage_records import along

_SIZE, _DPI = (16.0, 9.0), 100  # in, dots per inch
_MOMENT, _STRESS = "bending moment [kN m]", "von Mises stress [kPa]"
_MOMENT_COLOURS, _STRESS_COLOURS = "viridis", "YlOrBr"
_VIEW = (1960, 1180)  # dots of the view in space, twice as many as are shown
_LENGTH_SHOWN = 0.5, 3.2  # of the block: share of its length, and over its depth, whichever is less
_TILT, _TURN = 24.0, 14.0  # degrees: how steeply, and from how far aside, the view looks at the cut
_ZONE = 0.06  # of the riser's length, to either side of the touchdown point of a riser alone
_BETWEEN = 400  # points of a smooth line through the nodes
_ACROSS = 5.0  # radii to either side of the pipe in the section
_INK, _GROUND = "0.25", "saddlebrown"


@dataclass(frozen=True, eq=False)
class _Frame:
    """Data of one picture: arc (nn,) m, axis (nn, 3) m, moment (nn,) N.m, touchdown point (3,) m.

    Where nothing touches, the riser's lowest point stands in for the touchdown point, and its arc is nan.
    """

    run: Run
    title: str
    time: float
    arc: Array
    position: Array
    moment: Array
    radius: float
    touchdown: Array
    touchdown_arc: float
    soil: pv.UnstructuredGrid | None

    @property
    def touches(self) -> bool:
        return not math.isnan(self.touchdown_arc)

    @property
    def moments(self) -> Normalize:
        """Colour scale of the moment, in kN m."""
        return Normalize(0.0, colour_scale(1e-3 * self.moment)[0])

    @property
    def stresses(self) -> Normalize:
        """Colour scale of the stress, in kPa."""
        assert self.soil is not None
        return Normalize(0.0, colour_scale(self.soil.point_data[_STRESS])[0])

    @property
    def ahead(self) -> Array:
        """Unit vector (3,) in plan from the riser's start to its end."""
        return along(self.position)

    def in_plane(self, points: Array) -> Array:
        """Horizontal distances (n,) [m] of points (n, 3) from the riser's start, along the riser."""
        return np.asarray((points - self.position[0]) @ self.ahead)


def draw(folder: Path, png: Path, magnify: float | None = None) -> None:
    """Draw the picture of the touchdown zone into a file; arguments as of `riser_soil.plots.picture`."""
    still = _read(Run(folder))
    figure = Figure(figsize=_SIZE, dpi=_DPI)
    if still.soil is None:
        _draw_alone(figure, still)
    else:
        _draw_over_soil(figure, still, still.soil, _factor(still.soil) if magnify is None else magnify)
    figure.savefig(png)


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
        run=run,
        title=run.summary["title"],
        time=float(run.time[at]),
        arc=run.arc,
        position=position,
        moment=run["bending_moment"][at],
        radius=pipe_radius(run),
        touchdown=touchdown_place(touchdown_arc, run.arc, position),
        touchdown_arc=touchdown_arc,
        soil=None if frame is None else _grid(frame),
    )


def _grid(frame: SoilFrame) -> pv.UnstructuredGrid:
    """The soil as it lay at first, with displacement and stress [kPa] at its nodes."""
    require(frame, "the picture", "displacement", "von_mises_stress")
    grid = soil_grid(frame)
    grid.cell_data[_STRESS] = 1e-3 * frame.fields["von_mises_stress"]
    return grid.cell_data_to_point_data()


def _factor(soil: pv.UnstructuredGrid) -> float:
    largest = float(np.linalg.norm(soil.point_data["displacement"], axis=1).max())
    return magnification(largest, soil.bounds[5] - soil.bounds[4])


def _draw_over_soil(figure: Figure, still: _Frame, soil: pv.UnstructuredGrid, factor: float) -> None:
    panels = GridSpec(2, 2, figure, left=0.015, right=0.975, bottom=0.075, top=0.86, width_ratios=[5, 3], hspace=0.32)
    view = figure.add_axes((0.015, 0.2, 0.6, 0.66))
    _draw_view(view, still, soil, factor)
    _draw_whole(figure.add_subplot(panels[0, 1]), still)
    _draw_section(figure.add_subplot(panels[1, 1]), still, soil)
    _add_bar(figure, (0.03, 0.1, 0.26, 0.028), _MOMENT, _MOMENT_COLOURS, still.moments)
    _add_bar(figure, (0.33, 0.1, 0.26, 0.028), _STRESS, _STRESS_COLOURS, still.stresses)
    x0, x1, y0, y1, z0, z1 = soil.bounds
    block = f"soil block {x1 - x0:.3g} \u00d7 {y1 - y0:.3g} \u00d7 {z1 - z0:.3g} m"
    _write_head(figure, still, f"{block}, cut open along the riser; left: soil displacement \u00d7 {factor:g}")


def _draw_alone(figure: Figure, still: _Frame) -> None:
    panels = GridSpec(1, 2, figure, left=0.06, right=0.97, bottom=0.22, top=0.86, width_ratios=[5, 3], wspace=0.18)
    _draw_zone(figure.add_subplot(panels[0]), still)
    _draw_whole(figure.add_subplot(panels[1]), still)
    _add_bar(figure, (0.06, 0.1, 0.3, 0.028), _MOMENT, _MOMENT_COLOURS, still.moments)
    _write_head(figure, still, "left: heights are drawn larger than lengths")


def _write_head(figure: Figure, still: _Frame, words: str) -> None:
    figure.text(0.015, 0.945, still.title, fontsize=17, weight="bold")
    pipe = f"pipe of {2.0 * still.radius:.3g} m"
    figure.text(0.015, 0.905, f"t = {still.time:.4g} s, {pipe}; {words}", fontsize=12, color=_INK)


def _add_bar(figure: Figure, place: tuple[float, float, float, float], title: str, colours: str, of: Normalize) -> None:
    axes = figure.add_axes(place)
    bar = figure.colorbar(ScalarMappable(of, colours), cax=axes, orientation="horizontal")
    bar.ax.xaxis.set_major_locator(MaxNLocator(6))
    bar.set_label(title, fontsize=12)


@dataclass(frozen=True, eq=False)
class _View:
    """A parallel projection: its middle (3,) m, unit vectors (3,) to the right and up in the picture, the one (3,) from
    the middle to the eye, and the height of the picture [m].
    """

    middle: Array
    right: Array
    up: Array
    eye: Array
    height: float

    def dots(self, points: Array) -> Array:
        """Where points (n, 3) [m] are in the picture (n, 2), in dots from its upper left corner."""
        scale, away = _VIEW[1] / self.height, np.atleast_2d(points) - self.middle
        across, upwards = away @ self.right, away @ self.up
        return np.column_stack((0.5 * _VIEW[0] + scale * across, 0.5 * _VIEW[1] - scale * upwards))


def _view_of(still: _Frame, shown: pv.DataSet) -> _View:
    """The view at a part of the block and the riser above it: looking at the cut from aside and above."""
    ahead, side = still.ahead, np.cross(UP, still.ahead)
    tilt, turn = math.radians(_TILT), math.radians(_TURN)
    level = -math.cos(turn) * side - math.sin(turn) * ahead
    eye = math.cos(tilt) * level + math.sin(tilt) * UP
    up = math.cos(tilt) * UP - math.sin(tilt) * level
    right = np.cross(up, eye)
    corners = shown.points - still.touchdown
    low, high = corners @ up, corners @ right
    wide, tall = float(np.ptp(high)), float(np.ptp(low))
    height = max(1.12 * wide * _VIEW[1] / _VIEW[0], 1.2 * tall)
    middle = still.touchdown + 0.5 * (low.min() + low.max()) * up + 0.5 * (high.min() + high.max()) * right
    return _View(middle, right, up, eye, height)


def _draw_view(axes: Axes, still: _Frame, soil: pv.UnstructuredGrid, factor: float) -> None:
    """The block cut open along the riser, part of its length, with the riser that its displacement carries along."""
    ahead, side = still.ahead, np.cross(UP, still.ahead)
    block = soil.clip(normal=-side, origin=still.touchdown)
    at = (soil.points - still.touchdown) @ ahead
    length = min(_LENGTH_SHOWN[0] * float(np.ptp(at)), _LENGTH_SHOWN[1] * (soil.bounds[5] - soil.bounds[4]))
    begin = float(np.clip(-0.5 * length, at.min(), at.max() - length))
    for sign, place in ((1.0, begin), (-1.0, begin + length)):
        block = block.clip(normal=-sign * ahead, origin=still.touchdown + place * ahead)
    moved = block.warp_by_vector("displacement", factor=factor)
    carried = still.position + (factor - 1.0) * carried_down(soil, still.position, still.arc, still.radius)
    tube = _tube(still, carried, begin, begin + length)
    view = _view_of(still, moved.merge(tube))
    axes.imshow(_rendered(still, moved, tube, view), interpolation="lanczos")
    axes.set_axis_off()
    _add_lengths(axes, still, moved, view, (begin, begin + length))
    if still.touches:
        _mark_touchdown(axes, still, view, touchdown_place(still.touchdown_arc, still.arc, carried))


def _tube(still: _Frame, position: Array, begin: float, end: float) -> pv.PolyData:
    """The riser between two distances [m] along it from the touchdown point, smooth between its nodes."""
    at = (position - still.touchdown) @ still.ahead
    first, last = np.interp([begin, end], at, still.arc)
    arcs = np.linspace(float(first), float(last), _BETWEEN)
    line = pv.lines_from_points(CubicSpline(still.arc, position)(arcs))
    line.point_data[_MOMENT] = 1e-3 * np.interp(arcs, still.arc, still.moment)
    return line.tube(radius=still.radius, n_sides=48)


def _rendered(still: _Frame, soil: pv.UnstructuredGrid, tube: pv.PolyData, view: _View) -> Array:
    """The picture (height, width, 3) of soil and riser."""
    # VTK tries a display first and warns when there is none, although it then draws without.
    with pv.vtk_verbosity("error"):
        plotter = pv.Plotter(off_screen=True, window_size=list(_VIEW), lighting="none")
        plotter.set_background("white")
        plain = {"lighting": False, "show_scalar_bar": False}
        stresses, moments = still.stresses, still.moments
        plotter.add_mesh(
            soil, scalars=_STRESS, cmap=_STRESS_COLOURS, clim=(stresses.vmin, stresses.vmax), show_edges=True,
            edge_color="black", edge_opacity=0.22, **plain,
        )  # fmt: skip
        plotter.add_mesh(
            tube, scalars=_MOMENT, cmap=_MOMENT_COLOURS, clim=(moments.vmin, moments.vmax), silhouette=True, **plain
        )
        plotter.enable_parallel_projection()
        plotter.camera.focal_point = view.middle
        plotter.camera.position = view.middle + 10.0 * view.height * view.eye
        plotter.camera.up = view.up
        plotter.camera.parallel_scale = 0.5 * view.height
        plotter.reset_camera_clipping_range()
        image = np.asarray(plotter.screenshot(None, return_img=True))
        plotter.close()
    return image


def _add_lengths(axes: Axes, still: _Frame, soil: pv.DataSet, view: _View, shown: tuple[float, float]) -> None:
    """Distances along the lower edge of the cut, and depths along its upright one."""
    origin, ahead = still.touchdown, still.ahead
    bottom, level = float(soil.bounds[4]), float(soil.points[:, 2].max())
    foot = np.array([*origin[:2], bottom])
    first = still.in_plane(origin[None])[0]
    for distance in _round_values(first + shown[0], first + shown[1], 6):
        at = foot + (distance - first) * ahead
        _tick(axes, view, at, -0.012 * view.height * UP, f"{distance:g}", "center", "top")
    _name_edge(axes, view, foot + 0.5 * sum(shown) * ahead - 0.07 * view.height * UP, "along the riser [m]", ahead)
    edge = foot + shown[1] * ahead
    for depth in _round_values(0.0, level - bottom, 4):
        at = edge + (level - bottom - depth) * UP
        _tick(axes, view, at, 0.012 * view.height * ahead, f"{depth:g}", "left", "center")
    _name_edge(axes, view, edge + 0.5 * (level - bottom) * UP + 0.1 * view.height * ahead, "depth [m]", UP)


def _mark_touchdown(axes: Axes, still: _Frame, view: _View, place: Array) -> None:
    top = place + still.radius * UP
    (x, y), (_, lifted) = view.dots(np.array([top, top + 0.15 * view.height * view.up]))
    _point_at(axes, still, (x, y), (x, lifted))


def _point_at(axes: Axes, still: _Frame, place: tuple[float, float], words_at: tuple[float, float]) -> None:
    words, arrow = f"TDP at arc {still.touchdown_arc:.4g} m", {"arrowstyle": "-|>", "color": _INK}
    axes.annotate(words, place, words_at, ha="right", fontsize=12, arrowprops=arrow)


def _tick(axes: Axes, view: _View, at: Array, outwards: Array, text: str, ha: str, va: str) -> None:
    (x0, y0), (x1, y1), (x, y) = view.dots(np.array([at, at + outwards, at + 1.6 * outwards]))
    axes.plot([x0, x1], [y0, y1], color=_INK, linewidth=1.0, clip_on=False)
    axes.text(x, y, text, ha=ha, va=va, fontsize=11, color=_INK)


def _name_edge(axes: Axes, view: _View, at: Array, text: str, ahead: Array) -> None:
    (x, y), (x1, y1) = view.dots(np.array([at, at + ahead]))
    turned = math.degrees(math.atan2(y - y1, x1 - x))
    axes.text(x, y, text, rotation=turned, rotation_mode="anchor", ha="center", va="center", fontsize=12, color=_INK)


def _round_values(low: float, high: float, most: int) -> list[float]:
    """Round values from low to high."""
    slack = 1e-9 * (high - low)
    values = MaxNLocator(most, steps=[1, 2, 5, 10]).tick_values(low, high)
    return [float(value) for value in values if low - slack <= value <= high + slack]


def _draw_section(axes: Axes, still: _Frame, soil: pv.UnstructuredGrid) -> None:
    """Across the riser where the soil has settled most, true to scale."""
    node = int(carried_down(soil, still.position, still.arc, still.radius)[:, 2].argmin())
    ahead = along(still.position[max(node - 1, 0) : node + 2])
    flat = ahead - (ahead @ UP) * UP
    across = np.cross(UP, flat / np.linalg.norm(flat))
    cut = soil.slice(normal=flat, origin=still.position[node])
    moved = cut.points + cut.point_data["displacement"]
    y, z = (moved - still.position[node]) @ across, moved[:, 2]
    triangles = cut.triangulate().faces.reshape(-1, 4)[:, 1:]
    axes.tripcolor(
        Triangulation(y, z, triangles), cut.point_data[_STRESS], norm=still.stresses, cmap=_STRESS_COLOURS,
        shading="gouraud",
    )  # fmt: skip
    cells = [np.column_stack((y, z))[cell] for cell in cut.irregular_faces]
    axes.add_collection(PolyCollection(cells, facecolors="none", edgecolors="0.3", linewidths=0.3, alpha=0.6))
    centre = float(still.position[node, 2])
    axes.add_patch(Circle((0.0, centre), still.radius, facecolor="white", edgecolor="black", linewidth=2.0))
    axes.set_aspect("equal", adjustable="box")
    axes.set(xlim=(-_ACROSS * still.radius, _ACROSS * still.radius))
    axes.set(ylim=(centre - 4.0 * still.radius, centre + 1.3 * still.radius))
    axes.set(xlabel="across the riser [m]", ylabel="z [m]")
    axes.set_title(f"across at arc {still.arc[node]:.4g} m, true to scale", fontsize=12)


def _draw_zone(axes: Axes, still: _Frame) -> None:
    """The pipe near the touchdown point, or its lowest one, over the ground, in the vertical plane of the riser."""
    reach, at = _ZONE * float(still.arc[-1]), still.in_plane(still.touchdown[None])[0]
    x, position = _smooth(still)
    shown = np.abs(x - at) <= reach
    z = position[shown, 2]
    low, high = float(z.min()) - still.radius, float(z.max()) + still.radius
    _add_pipe(axes, still, x, position[:, 2])
    margin = 0.06 * (high - low)
    axes.set(xlim=(at - reach, at + reach), ylim=(low - 2.0 * margin, high + margin))
    _add_ground(axes, still, x, position)
    if still.touches:
        top = float(still.touchdown[2]) + still.radius
        _point_at(axes, still, (at, top), (at, top + 0.3 * (high - low)))
    axes.set(xlabel="horizontal distance from end A [m]", ylabel="z [m], upwards")
    axes.set_title("touchdown zone" if still.touches else "lowest point", fontsize=12)
    axes.grid(alpha=0.3)


def _smooth(still: _Frame) -> tuple[Array, Array]:
    """A smooth line through the nodes: distances (n,) and places (n, 3) [m]."""
    arcs = np.interp(np.linspace(0.0, len(still.arc) - 1.0, 20 * len(still.arc)), np.arange(len(still.arc)), still.arc)
    position = CubicSpline(still.arc, still.position)(arcs)
    return still.in_plane(position), np.asarray(position)


def _add_pipe(axes: Axes, still: _Frame, x: Array, z: Array) -> None:
    """The pipe as wide as it is, coloured by its moment."""
    at = still.in_plane(still.position)
    moment = 1e-3 * np.interp(0.5 * (x[1:] + x[:-1]), at, still.moment)
    low, high = np.column_stack((x, z - still.radius)), np.column_stack((x, z + still.radius))
    pieces = np.stack((low[:-1], low[1:], high[1:], high[:-1]), axis=1)
    pipe = PolyCollection(list(pieces), array=moment, norm=still.moments, cmap=_MOMENT_COLOURS, edgecolors="face")
    axes.add_collection(pipe)


def _draw_whole(axes: Axes, still: _Frame) -> None:
    x, position = _smooth(still)
    points = np.column_stack((x, position[:, 2]))
    moment = 1e-3 * np.interp(x, still.in_plane(still.position), still.moment)
    pieces = np.stack((points[:-1], points[1:]), axis=1)
    line = LineCollection(list(pieces), linewidths=3.0, capstyle="round", norm=still.moments, cmap=_MOMENT_COLOURS)
    line.set_array(moment[1:])
    axes.add_collection(line)
    axes.set_aspect("equal", adjustable="box")
    axes.autoscale_view()
    _add_ground(axes, still, x, position)
    _add_surface(axes, still)
    if still.soil is not None:
        at = still.in_plane(still.soil.points)
        low, high = still.soil.bounds[4:]
        axes.plot(
            [at.min(), at.max(), at.max(), at.min(), at.min()], [low, low, high, high, low], color="C3", linewidth=1.5,
            label="soil block",
        )  # fmt: skip
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="upper left", fontsize=10)
    axes.set(xlabel="horizontal distance from end A [m]", ylabel="z [m], upwards")
    wide, high = float(np.ptp(x)), float(np.ptp(position[:, 2]))
    axes.set_title(f"whole riser, {metres(wide)} by {metres(high)}", fontsize=12)
    axes.grid(alpha=0.3)


def _add_ground(axes: Axes, still: _Frame, x: Array, position: Array) -> None:
    """The undeformed ground below the riser, within the axes' limits."""
    ground = seabed_under(still.run, position[:: max(1, len(x) // _BETWEEN)])
    if ground is None:
        return
    view, low = axes.get_xlim(), axes.get_ylim()
    at = x[:: max(1, len(x) // _BETWEEN)]
    at, ground = np.append(view[0], np.append(at, view[1])), np.append(ground[0], np.append(ground, ground[-1]))
    bottom = min(low[0], float(ground.min()) - 0.04 * (low[1] - low[0]))
    axes.fill_between(at, ground, bottom, color="tan", alpha=0.5, linewidth=0.0, zorder=0)
    axes.plot(at, ground, color=_GROUND, linewidth=1.0, label="seabed", zorder=0)
    axes.set(xlim=view, ylim=(bottom, low[1]))


def _add_surface(axes: Axes, still: _Frame) -> None:
    level = surface_level(still.run)
    if level is not None:
        axes.axhline(level, color="C0", linewidth=1.2, label="water surface", zorder=0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
