"""Film of a stage's last cycle, drawn off screen: python -m riser_soil.plots.film --help."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyvista as pv

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import ResultsError
from riser_soil.plots.bodies import (
    UP,
    carried_down,
    colour_bar,
    exit_status,
    pipe_radius,
    require,
    soil_grid,
    touchdown_place,
)
from riser_soil.plots.riser_film import write_film
from riser_soil.plots.scales import colour_scale, magnification
from riser_soil.results import Run, SoilFrame
from riser_soil.results.cycles import beginning, cycles, period_of, timed_stage
from riser_soil.results.stage_records import along

_SIZE = (960, 540)
_SLACK = 1e-6  # of the time filmed


@dataclass(frozen=True)
class FilmedField:
    """A field of the soil that colours it: its title, the output that it follows from, and how."""

    title: str
    output: str
    of: Callable[[Array], Array]


FIELDS = {
    "settlement": FilmedField("settlement [mm]", "displacement", lambda u: -1e3 * u[:, 2]),
    "strength_used": FilmedField("share of strength used", "strength_used", lambda share: share),
    "plastic_strain": FilmedField("plastic strain [%]", "equivalent_plastic_strain", lambda strain: 1e2 * strain),
    "von_mises_stress": FilmedField("von Mises stress [kPa]", "von_mises_stress", lambda q: 1e-3 * q),
}


@dataclass(frozen=True, eq=False)
class _Film:
    """What all frames share: the run, the number of its soil's frames (n,), colours, magnification, camera."""

    run: Run
    frames: IntArray
    field: FilmedField
    top: float
    labels: int
    factor: float
    radius: float
    focus: Array


def film(run: Run, file: Path, stage: str | None, period: float | None, field: str, magnify: float | None) -> None:
    """Draw the film of a stage into a file, every `period` [s]; arguments as of `riser_soil.plots.film`."""
    if field not in FIELDS:
        raise ResultsError(f'"{field}" is no field of a film; allowed: {", ".join(FIELDS)}')
    times = _filmed(run, stage, period)
    scene = _prepared(run, times, FIELDS[field], magnify)
    shown = run.soil_times[scene.frames]
    with pv.vtk_verbosity("error"):
        write_film(file, _pictures(scene), float(np.diff(shown).mean()))


def _filmed(run: Run, stage: str | None, period: float | None) -> tuple[float, float]:
    """Time [s] that is filmed: the last whole cycle of the stage; all of it where it has no one period."""
    number = timed_stage(run, stage)
    try:
        last = cycles(run, number, period_of(run, number) if period is None else period)[-1]
        length = period_of(run, number) if period is None else period
    except ResultsError:
        if period is not None:
            raise
        since = beginning(run, number)
        return since, since + float(run.summary["stages"][number]["time"])
    return last.end - length, last.end


def _prepared(run: Run, times: tuple[float, float], field: FilmedField, magnify: float | None) -> _Film:
    if not run.has_soil:
        raise ResultsError(f"{run.place}: the run has no soil, so there is nothing to film")
    slack = _SLACK * (times[1] - times[0])
    frames = np.flatnonzero((run.soil_times >= times[0] - slack) & (run.soil_times <= times[1] + slack))
    if len(frames) < 2:
        raise ResultsError(
            f"{run.place}: soil.vtkhdf has {len(frames)} frame(s) of {times[0]:g} to {times[1]:g} s; a film takes "
            "two; shorten output.xdmf_interval of the scene and run again"
        )
    require(run.soil_frame(int(frames[0])), "the film", "displacement", field.output)
    coloured, moved = zip(*(_extent(run.soil_frame(int(n)), field) for n in frames), strict=True)
    top, labels = colour_scale(np.array(coloured))
    points = run.soil_frame(int(frames[0])).points
    factor = magnification(max(moved), float(np.ptp(points[:, 2]))) if magnify is None else magnify
    at = _record(run, int(frames[0]))
    focus = touchdown_place(float(run["touchdown_arc"][at]), run.arc, run["position"][at])
    return _Film(run, frames, field, top, labels, factor, pipe_radius(run), focus)


def _extent(frame: SoilFrame, field: FilmedField) -> tuple[float, float]:
    """Largest value of the field, and largest displacement [m]."""
    moved = np.linalg.norm(frame.fields["displacement"], axis=1)
    return float(field.of(frame.fields[field.output]).max()), float(moved.max())


def _record(run: Run, frame: int) -> int:
    """Number of the record in results.nc of a frame of the soil."""
    return int(np.abs(run.time - run.soil_times[frame]).argmin())


def _pictures(scene: _Film) -> Iterator[Array]:
    """Frames (height, width, 3), bytes of red, green and blue; how many are done goes to standard output."""
    position, ahead = scene.run["position"], along(scene.run["position"][0])
    for done, n in enumerate(scene.frames):
        print(done, len(scene.frames), flush=True)
        plotter = pv.Plotter(off_screen=True, window_size=list(_SIZE), border=False)
        plotter.set_background("white")
        frame = scene.run.soil_frame(int(n))
        _draw(plotter, scene, frame, position[_record(scene.run, int(n))], ahead)
        yield np.asarray(plotter.screenshot(return_img=True))[..., :3]
        plotter.close()


def _draw(plotter: pv.Plotter, scene: _Film, frame: SoilFrame, position: Array, ahead: Array) -> None:
    soil, side = soil_grid(frame), np.cross(UP, ahead)
    values = scene.field.of(frame.fields[scene.field.output])
    (soil.point_data if len(values) == len(frame.points) else soil.cell_data)[scene.field.title] = values
    opened = soil.clip(normal=-side, origin=scene.focus).warp_by_vector("displacement", factor=scene.factor)
    plotter.add_mesh(
        opened,
        scalars=scene.field.title,
        cmap="YlOrBr",
        clim=(0.0, scene.top),
        show_edges=True,
        edge_opacity=0.25,
        ambient=0.55,
        diffuse=0.5,
        scalar_bar_args=colour_bar(scene.field.title, 0.55, scene.labels),
    )
    sunk = carried_down(soil, position, scene.run.arc, scene.radius)
    line = pv.lines_from_points(position + (scene.factor - 1.0) * sunk)
    plotter.add_mesh(line.tube(radius=scene.radius, n_sides=24), color="steelblue", smooth_shading=True)
    plotter.add_text(_caption(scene, frame.time), position="upper_left", font_size=10, color="black")
    _look(plotter, scene.focus, soil.bounds, ahead)


def _caption(scene: _Film, time: float) -> str:
    words = f"{scene.run.summary['title']}\nt = {time:.5g} s\nsoil cut open along the riser; its deformation is drawn"
    return f"{words} \u00d7 {scene.factor:g} and carries it along"


def _look(plotter: pv.Plotter, focus: Array, bounds: tuple[float, ...], ahead: Array) -> None:
    """Point the camera at the focus, the same way in all frames. bounds: of the soil [m]; ahead: direction along the
    riser.
    """
    reach = 0.4 * max(bounds[1] - bounds[0], bounds[3] - bounds[2])
    side = np.cross(UP, ahead)
    plotter.camera.focal_point = focus + 0.05 * reach * UP
    plotter.camera.position = focus + reach * (0.6 * UP - 1.2 * side - 0.2 * ahead)
    plotter.camera.up = UP
    plotter.reset_camera_clipping_range()


def main(arguments: list[str]) -> int:
    """A failure is one line on standard error."""
    asked = _parser().parse_args(arguments)
    wanted = asked.stage, asked.period, asked.field, asked.magnify
    return exit_status(lambda: film(Run(asked.folder), asked.file, *wanted))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m riser_soil.plots.film", description="Film the last cycle of a dynamic stage."
    )
    parser.add_argument("folder", type=Path, help="folder of the run")
    parser.add_argument("file", type=Path, help="GIF or MP4 to write")
    parser.add_argument("--stage", help="dynamic stage; by default the last")
    parser.add_argument("--period", type=float, help="length of a cycle [s]; by default that of the stage's motion")
    parser.add_argument("--field", default="settlement", help=f"what colours the soil: {', '.join(FIELDS)}")
    parser.add_argument("--magnify", type=float, help="factor on the soil's displacement; visible by default")
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
