"""Tensors and histories of a run's soil files: by VTK's readers and meshio, behind a mirror, and on two ranks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
from ruamel.yaml import YAML

from demos.own_law.run import HERE
from riser_soil.core.arrays import Array
from riser_soil.results import Run
from tests.support.run_on_ranks import ran
from tests.support.runs import run_of
from tests.support.scenes import Mapping
from tests.support.vtk_reading import read_by_vtk

TENSORS = ("stress", "effective_stress", "strain", "plastic_strain")
NUMBERS = ("pressure", "preconsolidation", "pore_pressure")
ATTRACTION = 4.0e3  # Pa, the scene's


def scene(*stages: int) -> Mapping:
    """The worked law's, on coarse cells, in these of its stages."""
    given: Mapping = YAML(typ="safe").load(HERE / "scene.yaml")
    law: dict[str, Any] = given["soil"]["law"]
    law["from"] = f"{HERE / 'my_clay.py'}:CamClay"
    given["soil"]["mesh"]["size_at_riser"] |= {"across": 0.0625}
    given["stages"] = [given["stages"][n] for n in stages]
    return given | {"output": {"soil_fields": [*TENSORS, "histories"]}}


@pytest.fixture(scope="module")
def pressed(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Half of the clay is computed, at large strain."""
    return run_of(scene(0, 1), tmp_path_factory.mktemp("fields") / "one")


def test_vtk_and_meshio_read_what_the_run_has(pressed: Run) -> None:
    fields = pressed.soil_frame().fields
    _, frames = read_by_vtk(pressed.folder / "soil.xdmf")
    with meshio.xdmf.TimeSeriesReader(pressed.folder / "soil.xdmf") as reader:
        reader.read_points_cells()
        _, _, on_cells = reader.read_data(reader.num_steps - 1)
    cells = len(pressed.soil_frame().cells)
    for name in (*TENSORS, *NUMBERS):
        assert fields[name].shape == ((cells, 9) if name in TENSORS else (cells,))
        np.testing.assert_array_equal(frames[-1][f"cell:{name}"], fields[name])
        np.testing.assert_array_equal(np.asarray(on_cells[name][0]).reshape(fields[name].shape), fields[name])


def test_scalars_of_all_soil_are_those_of_the_tensors(pressed: Run) -> None:
    """Means; the von Mises stress of a cell's mean tensor is at most the mean of its points'."""
    fields = pressed.soil_frame().fields
    stress, effective = (fields[name].reshape(-1, 3, 3) for name in ("stress", "effective_stress"))
    np.testing.assert_allclose(-np.trace(stress, axis1=1, axis2=2) / 3.0, fields["mean_stress"], rtol=1e-9)
    s = stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3.0 * np.eye(3)
    q = np.sqrt(1.5 * np.einsum("nij,nij->n", s, s))
    assert np.all(q <= fields["von_mises_stress"] * (1.0 + 1e-9))
    mean = -np.trace(effective, axis1=1, axis2=2) / 3.0
    np.testing.assert_allclose(mean, fields["pressure"] - ATTRACTION, atol=1e-6 * ATTRACTION)
    np.testing.assert_allclose(np.trace(fields["strain"].reshape(-1, 3, 3), axis1=1, axis2=2), 0.0, atol=5e-3)
    assert np.abs(fields["plastic_strain"]).max() > 0.02
    assert np.abs(fields["pore_pressure"]).max() > 100.0


def test_the_mirror_s_image_shears_the_other_way(pressed: Run) -> None:
    frame = pressed.soil_frame()
    middle = frame.points[frame.cells].mean(axis=1)
    image = np.array([int(np.abs(middle - place * [1.0, -1.0, 1.0]).sum(axis=1).argmin()) for place in middle])
    sides = np.outer([1.0, -1.0, 1.0], [1.0, -1.0, 1.0]).ravel()
    for name in TENSORS:
        values = frame.fields[name]
        np.testing.assert_allclose(values[image], sides * values, atol=1e-6 * np.abs(values).max())
        assert np.abs(values[:, 5]).max() > 1e-3 * np.abs(values).max()  # yz


def by_place(run: Run, name: str) -> Array:
    """At the end of the first stage."""
    frame = run.soil_frame(0)
    middle = frame.points[frame.cells].mean(axis=1).round(6)
    return frame.fields[name][np.lexsort(middle.T)]


def test_two_ranks_write_the_same_fields(pressed: Run, tmp_path: Path) -> None:
    other = ran(scene(0), tmp_path / "two", 2)
    for name in (*TENSORS, *NUMBERS):
        fields, wanted = by_place(other, name), by_place(pressed, name)
        assert np.abs(wanted).max() > 0.0
        np.testing.assert_allclose(fields, wanted, atol=1e-4 * float(np.abs(wanted).max()), err_msg=name)
