"""results.nc, read back by h5py and by xarray."""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import h5netcdf
import h5py
import numpy as np
import pytest
import xarray as xr

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.results import Run
from riser_soil.results.netcdf import HEALTH, SERIES, SeriesFile
from riser_soil.results.netcdf_layout import Variable, lay_out
from riser_soil.scene.reader import scene_from_mapping
from tests.support.line_scenes import with_line_named
from tests.support.recorded_run import CATENARY_ARC, Catenary, record
from tests.support.said import telling

ARC = np.linspace(0.0, 100.0, 11)


def a_row(time: float, value: float = 1.0) -> dict[str, Array]:
    """One row alone."""
    sizes = {"arc": ARC.size, "component": 3, "section": 2, "offset": 3}
    row = {name: np.full([1, *(sizes[d] for d in variable.dims[1:])], value) for name, variable in SERIES.items()}
    return row | {"time": np.array([time])}


def a_step(iterations: int = 2) -> dict[str, list[float]]:
    return {name: [0.1] for name in HEALTH} | {"newton_iterations": [iterations], "step_cuts": [0]}


def a_file(folder: Path) -> SeriesFile:
    file = SeriesFile(folder / "results.nc", {"": ARC}, "a title", "0.1.0", sections=2, offsets=(-1.0, 0.0, 1.0))
    file.begin_stage("lay down")
    return file


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of 1 s."""
    folder = tmp_path_factory.mktemp("recorded")
    record(folder, duration=1.0)
    return folder


@pytest.fixture(scope="module")
def data(recorded: Path) -> Iterator[xr.Dataset]:
    """Its file, held by xarray, which takes seconds to open it."""
    with xr.open_dataset(recorded / "results.nc", engine="h5netcdf") as held:
        yield held


def test_xarray_reads_what_was_recorded(data: xr.Dataset) -> None:
    arc = CATENARY_ARC
    assert dict(data.sizes) == {"time": 11, "step": 12, "arc": arc.size, "component": 3, "section": 1, "offset": 5}
    np.testing.assert_allclose(data["time"], 0.1 * np.arange(11), atol=1e-12)
    first = Catenary(32.0, 30.0).record(arc)
    np.testing.assert_array_equal(data["position"].sel(time=0.0), first.position)
    np.testing.assert_array_equal(data["effective_tension"][0], first.effective_tension)
    np.testing.assert_array_equal(data["end_force"][0], first.end_force)
    assert float(data["end_force"].sel(component="z")[0]) == first.end_force[2]
    assert data.attrs["finished"] == 1
    assert data.attrs["Conventions"].startswith("CF-")


def test_every_variable_has_unit_and_long_name(tmp_path: Path) -> None:
    a_file(tmp_path)
    with h5py.File(tmp_path / "results.nc") as file:
        for name in (*SERIES, *HEALTH, "arc", "offset"):
            assert file[name].attrs["units"], name
            assert file[name].attrs["long_name"], name
        energies = [name for name in HEALTH if name.startswith(("dissipated", "work")) or name.endswith("_energy")]
        assert len(energies) == 6
        assert all(file[name].attrs["units"] == "J" for name in energies)
        for name in ("start_force", "end_moment", "effective_tension", "moment_vector", "energy_residual"):
            assert file[name].attrs["sign_convention"], name


def test_no_line_has_the_name_of_what_is_at_the_root(tmp_path: Path) -> None:
    SeriesFile(tmp_path / "results.nc", {"east": ARC}, "t", "0", sections=2, offsets=(-1.0, 1.0))
    with h5py.File(tmp_path / "results.nc") as file:
        names = {*file} - {"east"}
    assert {"time", "component", "section", "offset", "step_stage"} < names
    for name in names:
        with pytest.raises(SceneError, match=telling(f"lines.{name}", "rename")):
            scene_from_mapping(with_line_named(name))


def test_the_file_on_disk_is_whole_after_each_flush(tmp_path: Path) -> None:
    file = a_file(tmp_path)
    for count in range(1, 4):
        file.record(a_row(0.5 * count))
        file.steps(a_step())
        file.flush()
        with h5py.File(tmp_path / "results.nc") as read:
            assert {len(read[name]) for name in (*SERIES, *HEALTH)} == {count}
            assert read.attrs["finished"] == 0


def test_a_reader_does_not_stop_the_writer(tmp_path: Path) -> None:
    file = a_file(tmp_path)
    path = str(tmp_path / "results.nc")
    hold = f"import h5py; f = h5py.File({path!r}, 'r'); print('open', flush=True); input()"
    with subprocess.Popen(
        [sys.executable, "-c", hold], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as reader:
        assert reader.stdout is not None
        assert reader.stdout.readline() == "open\n"
        file.record(a_row(0.0))
        file.flush()
        reader.communicate("done\n")
    with h5py.File(tmp_path / "results.nc") as read:
        assert len(read["time"]) == 1


def test_xarray_and_the_package_s_reader_hold_the_file_together(recorded: Path, data: xr.Dataset) -> None:
    run = Run(recorded)
    np.testing.assert_array_equal(run["effective_tension"], data["effective_tension"])
    assert [*run["component"]] == [*data["component"].values] == ["x", "y", "z"]


def test_rows_of_many_instants_are_those_of_each(tmp_path: Path) -> None:
    file = a_file(tmp_path)
    one, two = a_row(0.0, value=1.0), a_row(0.5, value=2.0)
    file.record({name: np.concatenate([one[name], two[name]]) for name in one})
    file.record(a_row(1.0, value=3.0))
    file.steps({name: [*values, *values] for name, values in a_step().items()})
    file.flush()
    with h5py.File(tmp_path / "results.nc") as read:
        assert read["time"][...].tolist() == [0.0, 0.5, 1.0]
        assert read["curvature"][:, 3].tolist() == [1.0, 2.0, 3.0]
        assert read["stage"][...].tolist() == [0, 0, 0]
        assert read["step"][...].tolist() == [0, 1]


def test_stages_are_named(tmp_path: Path) -> None:
    file = a_file(tmp_path)
    file.record(a_row(0.0))
    file.begin_stage("heave")
    file.record(a_row(0.1))
    file.flush(finished=True)
    with h5py.File(tmp_path / "results.nc") as read:
        assert read["stage"][...].tolist() == [0, 1]
        assert read["stage"].attrs["flag_meanings"].split() == ["lay_down", "heave"]
        assert read.attrs["finished"] == 1


def test_nan_and_all_digits_survive(tmp_path: Path) -> None:
    file = a_file(tmp_path)
    file.record(a_row(1.0 / 3.0, value=1e6 / 7.0) | {"touchdown_arc": np.array([np.nan])})
    file.flush()
    with h5py.File(tmp_path / "results.nc") as read:
        assert read["time"][0] == 1.0 / 3.0
        assert read["bending_moment"][0, 3] == 1e6 / 7.0
        assert np.isnan(read["touchdown_arc"][0])


def test_what_is_left_out_takes_no_workspace(tmp_path: Path) -> None:
    file = SeriesFile(tmp_path / "results.nc", {"": ARC}, "t", "0", unrecorded={"": {"curvature", "moment_vector"}})
    file.begin_stage("only")
    file.record(a_row(0.0))
    file.flush()
    with h5py.File(tmp_path / "results.nc") as read:
        assert "curvature" not in read
        assert "moment_vector" not in read
        assert len(read["bending_moment"]) == 1


def test_without_sections_there_is_nothing_of_them(tmp_path: Path) -> None:
    SeriesFile(tmp_path / "results.nc", {"": ARC}, "t", "0")
    with h5py.File(tmp_path / "results.nc") as file:
        assert "soil_settlement" in file
        assert not {"section", "offset", "section_arc", "settlement_across"} & set(file)


def test_the_layout_is_that_of_h5netcdf(tmp_path: Path) -> None:
    sizes = {"time": None, "arc": 4, "section": 2}
    variables = {
        "position": Variable(("time", "arc"), "m", "place", "up"),
        "trough": Variable(("time", "section"), "m", "depth"),
        "stage": Variable(("time",), "1", "number", dtype="i4"),
        "time": Variable(("time",), "s", "time"),
        "arc": Variable(("arc",), "m", "arc length"),
    }
    with h5py.File(tmp_path / "ours.nc", "w", track_order=True) as file:
        lay_out(file, sizes, variables)
    with h5netcdf.File(tmp_path / "theirs.nc", "w") as file:
        file.dimensions = sizes
        for name, variable in variables.items():
            made = file.create_variable(name, variable.dims, variable.dtype)
            for attribute, text in variable.attributes.items():
                made.attrs[attribute] = text
    assert described(tmp_path / "ours.nc") == described(tmp_path / "theirs.nc")


def described(path: Path) -> dict[str, object]:
    """Each dataset with its shape, type and attributes, and the scales that it points to."""
    with h5py.File(path) as file:
        return {name: (*_shape(made), _attributes(made)) for name, made in file.items()}


def _shape(made: h5py.Dataset) -> tuple[object, ...]:
    return made.shape, made.maxshape, made.dtype


def _attributes(made: h5py.Dataset) -> dict[str, object]:
    attributes = {name: np.asarray(value).tolist() for name, value in made.attrs.items() if not name.endswith("_LIST")}
    scales = [made.file[refs[0]].name for refs in made.attrs.get("DIMENSION_LIST", ())]
    users = sorted((made.file[ref].name, int(axis)) for ref, axis in made.attrs.get("REFERENCE_LIST", ()))
    return attributes | {"scales": scales, "users": users}
