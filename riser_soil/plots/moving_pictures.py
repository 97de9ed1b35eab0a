"""Moving pictures: frames to an animated GIF by Pillow, or to MP4 by the program ffmpeg where it is installed."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

from PIL import Image

from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError

SHORTEST, LONGEST = 0.04, 0.5  # s that a frame is shown; as long as it lasts in between


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
        reported = running.communicate(b"".join(frame.tobytes() for frame in (first, *frames)))[1]
    if running.returncode != 0:
        reason = reported.decode(errors="replace").strip().splitlines()[-1:] or ["no message"]
        raise ResultsError(f"ffmpeg could not write the film: {reason[0]}; write a .gif instead")


def ffmpeg() -> str:
    """Path of the program; ResultsError where there is none."""
    found = shutil.which("ffmpeg")
    if found is None:
        raise ResultsError("an MP4 needs the program ffmpeg, which is not there (Debian: ffmpeg); write a .gif instead")
    return found
