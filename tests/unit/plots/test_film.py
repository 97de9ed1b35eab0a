"""Films from result files, opened by Pillow."""

from __future__ import annotations

import os
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image, ImageSequence
from typer.testing import CliRunner

from riser_soil.__main__ import app
from riser_soil.errors import ResultsError, WriteError
from riser_soil.plots import film
from riser_soil.plots.progress import DrawingProgress
from tests.support.recorded_run import block, record
from tests.support.said import line_with, telling

FAKE = """#!/bin/sh
for last; do :; done
echo "$@" > "$last"
wc -c >> "$last"
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A run of 0.4 s with a frame of the soil each 0.2 s of it, and one before."""
    record(tmp_path / "run", mesh=block(8, 4, 2), duration=0.4, picture_interval=0.2)
    return tmp_path / "run"


def frames(gif: Path) -> list[np.ndarray]:
    with Image.open(gif) as image:
        images = []
        for frame in ImageSequence.Iterator(image):
            assert frame.info["duration"] == 200
            images.append(np.asarray(frame.convert("RGB")).astype(int))
    return images


def test_a_film_shows_every_frame_of_the_stage(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    progress: list[tuple[str, int, int]] = []
    monkeypatch.setattr(DrawingProgress, "show", lambda _, *given: progress.append(given))
    done = CliRunner().invoke(app, ["film", str(folder), "-o", str(folder / "film.gif"), "--stage", "heave"])
    assert (done.exit_code, done.output.strip()) == (0, str(folder / "film.gif"))
    images = frames(folder / "film.gif")
    assert progress == [("film: frames", n, 3) for n in range(3)]
    assert [image.shape for image in images] == [(540, 960, 3)] * 3
    drawing = [image[80:400] for image in images]  # without caption and colour bar
    for this, following in pairwise(drawing):
        assert (np.abs(this - following).sum(axis=2) > 60).mean() > 1e-4
    blue = np.abs(drawing[0] - np.array([60, 110, 150])).sum(axis=2) < 60
    assert blue.mean() > 0.005, "the riser"
    assert (np.ptp(drawing[0], axis=2) > 100).mean() > 0.002, "the soil that settled"
    assert not [*folder.glob(".*part*")]


@pytest.mark.verify
def test_the_field_and_the_magnification_count(folder: Path) -> None:
    plain = frames(film(folder, folder / "a.gif", period=0.2))
    stressed = frames(film(folder, folder / "b.gif", period=0.2, field="strength_used"))
    true = frames(film(folder, folder / "c.gif", period=0.2, magnify=1.0))
    assert (len(plain), len(stressed), len(true)) == (2, 2, 2), "the last cycle alone"
    for other in (stressed, true):
        assert np.abs(plain[0] - other[0])[80:400].max() > 50


def test_an_mp4_is_ffmpeg_s(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A stand-in for ffmpeg notes its arguments and how many bytes of frames it got."""
    nowhere = folder / "bin"
    nowhere.mkdir()
    monkeypatch.setenv("PATH", str(nowhere))
    with pytest.raises(ResultsError, match=telling("MP4", "ffmpeg", ".gif instead")):
        film(folder, folder / "film.mp4", period=0.2)
    assert not [*folder.glob("*.mp4"), *folder.glob(".*part*")]
    program = nowhere / "ffmpeg"
    program.write_text(FAKE, encoding="utf-8")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", os.pathsep.join([str(nowhere), os.defpath]))
    call, size = film(folder, folder / "film.mp4", period=0.2).read_text(encoding="utf-8").splitlines()
    assert int(size) == 2 * 960 * 540 * 3
    line_with(call, "-s 960x540", "-r 5", "-i -", "-pix_fmt yuv420p")


@pytest.mark.parametrize(
    ("name", "choice", "says"),
    [
        ("film.avi", {}, r"a film is a \.gif or \.mp4 file"),
        ("film.gif", {"stage": "lay"}, '"lay" is no quasi-static or dynamic stage of the run'),
        ("film.gif", {"field": "warmth"}, '"warmth" is no field of a film; allowed: settlement, '),
        ("film.gif", {"period": 5.0}, "no whole cycle of 5 s"),
    ],
)
def test_what_cannot_be_filmed_is_said_and_leaves_no_file(
    folder: Path, name: str, choice: dict[str, Any], says: str
) -> None:
    with pytest.raises(ResultsError, match=says) as caught:
        film(folder, folder / name, **choice)
    assert "\n" not in str(caught.value)
    assert not [*folder.glob("*.gif"), *folder.glob(".*part*")]


def test_no_soil_or_no_folder_is_said(tmp_path: Path) -> None:
    record(tmp_path, duration=0.3)
    with pytest.raises(ResultsError, match=telling(f"{tmp_path}:", "no soil", "magnify")):
        film(tmp_path, tmp_path / "film.gif", magnify=5.0)
    with pytest.raises(WriteError, match="there is no folder"):
        film(tmp_path, tmp_path / "nowhere" / "film.gif")
    assert CliRunner().invoke(app, ["film", str(tmp_path), "--magnify", "0"]).exit_code == 2
