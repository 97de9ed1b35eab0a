"""Film of a riser without soil: its shape in the plane of its ends, coloured by bending moment, frame by frame.

Frames go to an animated GIF by Pillow, or to MP4 by the program ffmpeg where it is installed.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from PIL import Image

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import ResultsError
from riser_soil.plots.curves import sheet
from riser_soil.plots.progress import OnProgress, in_turn, silent
from riser_soil.plots.scales import colour_scale
from riser_soil.plots.shape import filmed_records, seabed_under
from riser_soil.results import Run
from riser_soil.results.cycles import cycles, timed_stage
from riser_soil.results.stage_records import along, stage_records

MOST_FRAMES = 120
SHORTEST, LONGEST = 0.04, 0.5  # s that a frame is shown; as long as it lasts in between
_INCHES, _DPI = (9.6, 5.4), 100


def film_riser(
    run: Run, file: Path, stage: str | None = None, period: float | None = None, on_progress: OnProgress = silent
) -> None:
    """The last whole cycle of a stage along t, by default the last one; of motion without one period the records around
    the largest moment. on_progress: hears of each frame.
    """
    number = timed_stage(run, stage)
    of_stage = stage_records(run, run.stage_names[number])
    records = filmed_records(of_stage, MOST_FRAMES) if period is None else cycles(run, number, period)[-1].records
    if len(records) < 2:
        raise ResultsError(
            f'{run.place}: stage "{of_stage.name}" has {len(records)} record(s) to film, and a film takes two; '
            "shorten output.interval of the scene and run again"
        )
    write_film(file, _pictures(run, records, on_progress), float(np.diff(run.time[records]).mean()))


def _pictures(run: Run, records: IntArray, on_progress: OnProgress) -> Iterator[Array]:
    """Frames (height, width, 3), bytes of red, green and blue."""
    position = run["position"]
    moment = 1e-3 * (run["bending_moment"] if "bending_moment" in run.variables else np.zeros(position.shape[:2]))
    origin, ahead = position[0, 0], along(position[0])
    x, z = (position - origin) @ ahead, position[..., 2]
    figure, (axes,) = sheet(1, 1, *_INCHES)
    canvas = FigureCanvasAgg(figure)
    figure.set_dpi(_DPI)
    axes.set(xlabel="horizontal distance from end A [m]", ylabel="z [m], upwards")
    axes.set_aspect("equal", adjustable="datalim")
    axes.plot(x[records].T, z[records].T, color="0.85", linewidth=0.8)
    ground = np.linspace(x[records].min(), x[records].max(), 100)
    level = seabed_under(run, origin + ground[:, None] * ahead)
    if level is not None:
        axes.plot(ground, level, color="saddlebrown")
    top, _ = colour_scale(moment[records])
    line = LineCollection([], cmap="viridis", linewidth=4.0, clim=(0.0, top))
    axes.add_collection(line)
    figure.colorbar(line, ax=axes, label="bending moment [kN m]")
    for n in in_turn(records.tolist(), lambda _: "film: frames", on_progress):
        points = np.column_stack([x[n], z[n]])
        line.set_segments(list(np.stack([points[:-1], points[1:]], axis=1)))
        line.set_array(0.5 * (moment[n, :-1] + moment[n, 1:]))
        axes.set_title(f"{run.summary['title']}, t = {run.time[n]:.5g} s")
        canvas.draw()
        yield np.array(canvas.buffer_rgba())[..., :3]


def write_film(file: Path, frames: Iterator[Array], interval: float) -> None:
    """Frames (height, width, 3) of bytes, shown for about `interval` [s] each, in the format of the file's ending."""
    shown = min(max(interval, SHORTEST), LONGEST)
    if file.suffix == ".gif":
        _write_gif(file, frames, shown)
    else:
        _write_mp4(file, frames, shown)


def _write_gif(file: Path, frames: Iterator[Array], shown: float) -> None:
    first, *rest = (Image.fromarray(frame).quantize(128) for frame in frames)
    first.save(file, save_all=True, append_images=rest, duration=round(100 * shown) * 10, loop=0)


def _write_mp4(file: Path, frames: Iterator[Array], shown: float) -> None:
    program = ffmpeg()
    first = next(frames)
    size = f"{first.shape[1]}x{first.shape[0]}"
    given = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", f"{1.0 / shown:.6g}", "-i", "-"]
    call = [program, "-loglevel", "error", "-y", *given, "-pix_fmt", "yuv420p", str(file)]
    with subprocess.Popen(call, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as running:
        messages = running.communicate(b"".join(frame.tobytes() for frame in (first, *frames)))[1]
    if running.returncode != 0:
        reason = messages.decode(errors="replace").strip().splitlines()[-1:] or ["no message"]
        raise ResultsError(f"ffmpeg could not write the film: {reason[0]}; write a .gif instead")


def ffmpeg() -> str:
    """Path of the program; ResultsError where there is none."""
    program = shutil.which("ffmpeg")
    if program is None:
        raise ResultsError("an MP4 needs the program ffmpeg, which is not there (Debian: ffmpeg); write a .gif instead")
    return program
