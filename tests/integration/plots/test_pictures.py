"""Pictures from result files, looked at by their pixels."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from riser_soil.errors import ResultsError
from riser_soil.plots import picture
from riser_soil.results.record import Recorder
from tests.support.recorded_run import FACTS, SCENE, block, record
from tests.support.said import telling


def pixels(png: Path) -> np.ndarray:
    with Image.open(png) as image:
        return np.asarray(image.convert("RGB")).astype(int)


def share(image: np.ndarray, colour: tuple[int, int, int], tolerance: int = 60) -> float:
    return float((np.abs(image - np.array(colour)).sum(axis=2) < tolerance).mean())


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run on a block of hexahedra, and its picture."""
    folder = tmp_path_factory.mktemp("recorded")
    record(folder, mesh=block(20, 6, 3))
    picture(folder, folder / "touchdown.png")
    return folder


def test_the_picture_shows_riser_and_soil(recorded: Path) -> None:
    shows_riser_and_soil(recorded / "touchdown.png")


@pytest.mark.verify
def test_the_picture_shows_tetrahedra(tmp_path: Path) -> None:
    record(tmp_path, mesh=block(20, 6, 3, tetrahedra=True))
    shows_riser_and_soil(picture(tmp_path, tmp_path / "touchdown.png"))


def shows_riser_and_soil(png: Path) -> None:
    image = pixels(png)
    assert image.shape == (900, 1600, 3)
    close = image[100:750, :1190]
    assert share(close, (255, 255, 255), 10) < 0.8  # not blank
    assert share(close, (68, 1, 84)) > 0.005  # the riser where its moment is zero
    assert share(close, (204, 76, 2), 90) > 0.002  # highly stressed soil
    assert share(image[100:, 1210:], (255, 255, 255), 10) < 0.999  # the whole riser beside it


def test_magnifying_the_soil_changes_the_picture(recorded: Path, tmp_path: Path) -> None:
    """By another factor than the one that is chosen."""
    small, large = pixels(recorded / "touchdown.png"), pixels(picture(recorded, tmp_path / "large.png", magnify=20.0))
    assert np.abs(small - large)[100:750].max() > 50


def test_a_riser_alone(tmp_path: Path) -> None:
    record(tmp_path)
    assert share(pixels(picture(tmp_path, tmp_path / "riser.png")), (68, 1, 84)) > 0.005


def test_nothing_recorded_is_said(tmp_path: Path) -> None:
    with Recorder.open(tmp_path, FACTS, {"": np.linspace(0.0, 1.0, 3)}, None, SCENE):
        pass
    with pytest.raises(ResultsError, match="nothing was recorded"):
        picture(tmp_path, tmp_path / "nothing.png")


def test_drawing_works_after_dolfinx_and_imports_no_vtk(tmp_path: Path) -> None:
    record(tmp_path, mesh=block(4, 3, 2))
    code = (
        "import sys, dolfinx\n"
        "from riser_soil.plots import picture\n"
        f"picture({str(tmp_path)!r}, {str(tmp_path / 'a.png')!r})\n"
        "assert not {'pyvista', 'vtk', 'vtkmodules', 'matplotlib'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
    assert (tmp_path / "a.png").is_file()


def test_a_picture_that_cannot_be_written(tmp_path: Path) -> None:
    record(tmp_path)
    with pytest.raises(ResultsError, match="nowhere"):
        picture(tmp_path, tmp_path / "nowhere" / "a.png")


def test_no_run_is_said(tmp_path: Path) -> None:
    with pytest.raises(ResultsError, match=telling(f"{tmp_path}:", "not the folder")):
        picture(tmp_path, tmp_path / "a.png")


def test_a_field_left_out_of_the_run_is_named(tmp_path: Path) -> None:
    record(tmp_path, mesh=block(4, 3, 2), fields=("bending_moment", "von_mises_stress"))
    with pytest.raises(ResultsError, match=telling("needs displacement", "output.fields")):
        picture(tmp_path, tmp_path / "no.png")
