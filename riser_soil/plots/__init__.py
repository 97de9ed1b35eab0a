"""Plots of a run, drawn from the files in its folder.

They are drawn by a process of their own: VTK aborts where dolfinx was imported before it (their copies of
std::regex get mixed up), and a machine without means to draw must not bring a run down.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from riser_soil.core.environment import environment_alone
from riser_soil.errors import ResultsError
from riser_soil.plots.progress import OnProgress, silent
from riser_soil.results import Run
from riser_soil.results.whole_file import written_whole

FORMATS = (".gif", ".mp4")


def picture(folder: Path | str, png: Path | str, magnify: float | None = None) -> Path:
    """Draws the last recorded instant: the touchdown zone from close by, and the whole riser beside it.

    The riser is coloured by bending moment, the soil by von Mises stress. The soil is cut open along the
    riser, and its displacement is drawn `magnify` times (None: by a round factor that makes it visible); the
    riser sinks with it.
    Raises ResultsError when the folder holds nothing to draw, or drawing fails.
    """
    command = ["touchdown", str(folder), str(png)]
    if magnify is not None:
        command.append(repr(float(magnify)))
    _draw(command)
    return Path(png)


def film(
    folder: Path | str,
    file: Path | str,
    *,
    stage: str | None = None,
    period: float | None = None,
    field: str | None = None,
    magnify: float | None = None,
    on_progress: OnProgress = silent,
) -> Path:
    """Films the last whole cycle of a dynamic stage: the riser over its soil, coloured by a field, frame by frame; of a
    run without soil the riser's shape, coloured by bending moment.

    file: GIF, or MP4 where ffmpeg is installed. stage: by default the last dynamic one. period: s, by default that of
    the stage's motion; without any the whole stage is filmed (without soil: the records around the largest bending
    moment). field: of `riser_soil.plots.film.FIELDS`, by default the
    settlement. magnify: as of `picture`. on_progress: hears of each frame.
    Raises ResultsError when the folder holds nothing to film, or drawing fails; a file is then left as it was.
    """
    file = Path(file)
    if file.suffix not in FORMATS:
        raise ResultsError(f"{file}: a film is a {' or '.join(FORMATS)} file; change its ending")
    run = Run(folder)
    with written_whole(file) as part:
        if run.has_soil:
            given = {"--stage": stage, "--period": period, "--field": field, "--magnify": magnify}
            options = [f"{name}={value}" for name, value in given.items() if value is not None]
            _draw(["film", str(folder), str(part), *options], on_progress)
        elif field is not None or magnify is not None:
            raise ResultsError(f"{run.place}: the run has no soil, so there is nothing to colour or to magnify")
        else:
            from riser_soil.plots.riser_film import film_riser

            film_riser(run, part, stage, period, on_progress)
    return file


def _draw(command: list[str], on_progress: OnProgress = silent) -> None:
    """Runs a module of this folder with its arguments; each line that it prints is how many frames are done, and of how
    many.
    """
    module, *arguments = command
    call = [sys.executable, "-m", f"riser_soil.plots.{module}", *arguments]
    with tempfile.TemporaryFile("w+") as errors:
        with subprocess.Popen(call, env=environment_alone(), stdout=subprocess.PIPE, stderr=errors, text=True) as child:
            assert child.stdout is not None
            for line in child.stdout:
                done, count = map(int, line.split())
                on_progress("film: frames", done, count)
        if child.returncode != 0:
            errors.seek(0)
            raise ResultsError(_reason(child.returncode, errors.read()))


def _reason(status: int, output: str) -> str:
    last = output.strip().splitlines()[-1:] or ["no message"]
    if status > 0:
        return last[0]
    return f"drawing was killed by signal {-status}; is EGL there (Debian: libegl1 libgl1-mesa-dri)?"
