"""XDMF and VTKHDF files, read back by VTK's own readers: `read_by_vtk` holds what both find against each other."""

from pathlib import Path
from xml.etree import ElementTree

import h5py
import meshio
import numpy as np
import pytest

from riser_soil.core.arrays import IntArray
from riser_soil.results import vtkhdf
from riser_soil.results.xdmf import Frame, XdmfFile, polyline
from tests.support.recorded_run import CATENARY_ARC, block, record
from tests.support.vtk_reading import read_by_vtk

LINE = np.random.default_rng(1).uniform(-1e5, 1e5, (7, 3))
POLY_LINE, TETRA, HEXAHEDRON, QUADRATIC_TETRA = 4, 10, 12, 24  # VTK's numbers for cell types


def a_line(path: Path, times: list[float]) -> XdmfFile:
    file = XdmfFile(path, "riser", polyline(7), polyline=True)
    for time in times:
        file.add(Frame(time, {"tension": LINE[:, 0] + time, "position": LINE + time}, geometry="position"))
    file.flush()
    return file


def frames_in(path: Path) -> int:
    return len(ElementTree.parse(path).findall("Domain/Grid/Grid"))


def test_a_moving_line_comes_back_in_all_digits(tmp_path: Path) -> None:
    written = [0.0, 1e-6, 1.0 / 3.0, 140.0]
    a_line(tmp_path / "riser.xdmf", written)
    times, frames = read_by_vtk(tmp_path / "riser.xdmf")
    assert times == written
    for time, frame in zip(times, frames, strict=True):
        assert frame["cell_types"].tolist() == [POLY_LINE]
        assert frame["points"].dtype == np.float64
        np.testing.assert_array_equal(frame["points"], LINE + time)
        np.testing.assert_array_equal(frame["point:position"], LINE + time)
        np.testing.assert_array_equal(frame["point:tension"], LINE[:, 0] + time)


@pytest.mark.parametrize(
    ("cells", "kind"),
    [
        (np.arange(8)[None, :], HEXAHEDRON),
        (np.array([[0, 1, 3, 4], [6, 5, 7, 2]]), TETRA),
        (np.arange(10)[None, :], QUADRATIC_TETRA),
    ],
)
def test_a_mesh_that_stays_with_values_on_points_and_cells(
    tmp_path: Path, cells: IntArray, kind: int
) -> None:
    points = np.random.default_rng(2).uniform(size=(10, 3))
    file = XdmfFile(tmp_path / "soil.xdmf", "soil", cells, points)
    stress = np.linspace(1.0, 2.0, len(cells))
    for time in (0.0, 2.5):
        file.add(Frame(time, {"displacement": points * time}, {"stress": stress + time}))
    file.flush()
    last = read_by_vtk(tmp_path / "soil.xdmf")[1][-1]
    assert set(last["cell_types"]) == {kind}
    np.testing.assert_array_equal(last["points"], points)
    np.testing.assert_array_equal(last["point:displacement"], points * 2.5)
    np.testing.assert_array_equal(last["cell:stress"], stress + 2.5)


def test_the_block_fills_its_volume_right_way_round(tmp_path: Path) -> None:
    mesh = block(4, 3, 2)
    file = XdmfFile(tmp_path / "soil.xdmf", "soil", mesh.cells, mesh.points)
    file.add(Frame(0.0))
    file.flush()
    np.testing.assert_allclose(read_by_vtk(tmp_path / "soil.xdmf")[1][0]["volumes"], 40.0 * 5.0 * 2.5 / 24)


def test_frames_are_readable_after_each_flush_and_not_before(tmp_path: Path) -> None:
    file = a_line(tmp_path / "riser.xdmf", [0.0])
    file.add(Frame(1.0, {"tension": LINE[:, 0], "position": LINE}, geometry="position"))
    assert frames_in(tmp_path / "riser.xdmf") == 1
    file.flush()
    assert len(read_by_vtk(tmp_path / "riser.xdmf")[1]) == frames_in(tmp_path / "riser.xdmf") == 2
    assert sorted(p.name for p in tmp_path.iterdir() if p.is_file()) == ["riser.vtkhdf", "riser.xdmf"]


def test_frames_are_copies(tmp_path: Path) -> None:
    file = XdmfFile(tmp_path / "riser.xdmf", "riser", polyline(7), polyline=True)
    reused = LINE.copy()
    file.add(Frame(0.0, {"position": reused}, geometry="position"))
    reused[:] = 0.0
    file.flush()
    np.testing.assert_array_equal(read_by_vtk(tmp_path / "riser.xdmf")[1][0]["points"], LINE)


def test_riser_and_soil_share_one_time_axis_and_have_the_names_that_paraview_shows(tmp_path: Path) -> None:
    record(tmp_path, mesh=block(4, 3, 2), picture_interval=0.5)
    (riser_times, riser), (soil_times, soil) = (
        read_by_vtk(tmp_path / f"{n}.xdmf") for n in ("riser", "soil")
    )
    assert riser_times == soil_times
    np.testing.assert_allclose(riser_times, [0.0, 0.5, 1.0, 1.5, 2.0], atol=1e-12)
    names = ("effective_tension", "bending_moment", "curvature", "contact_force", "position")
    assert {f"point:{name}" for name in names} <= set(riser[-1])
    fields = {"mean_stress", "von_mises_stress", "strength_used", "equivalent_plastic_strain"}
    assert {key for key in soil[-1] if ":" in key} == {"point:displacement", *(f"cell:{name}" for name in fields)}


@pytest.mark.parametrize("layers", [(4, 3, 2), (13, 13, 13)], ids=["small", "large"])
def test_meshio_finds_what_vtk_finds(tmp_path: Path, layers: tuple[int, int, int]) -> None:
    """Cells in rows of their points; values of each instant by themselves, also where chunks hold several."""
    mesh = block(*layers)
    record(tmp_path, mesh=mesh, picture_interval=0.5)
    cells = {"riser": ("line", np.arange(len(CATENARY_ARC))[None, :]), "soil": ("hexahedron", mesh.cells)}
    for name, (kind, expected) in cells.items():
        times, frames = read_by_vtk(tmp_path / f"{name}.xdmf")
        with meshio.xdmf.TimeSeriesReader(tmp_path / f"{name}.xdmf") as reader:
            points, (block_of_cells,) = reader.read_points_cells()
            assert reader.num_steps == len(times) == 5
            for number, (time, frame) in enumerate(zip(times, frames, strict=True)):
                time_read, on_points, on_cells = reader.read_data(number)
                assert time_read == time
                values = {f"point:{key}": of for key, of in on_points.items()}
                values |= {f"cell:{key}": of for key, (of,) in on_cells.items()}
                assert values.keys() == {key for key in frame if ":" in key}
                for key, of in values.items():
                    np.testing.assert_array_equal(of, frame[key], err_msg=key)
        assert block_of_cells.type == kind
        np.testing.assert_array_equal(block_of_cells.data, expected)
        np.testing.assert_array_equal(points, frames[0]["points"])


@pytest.mark.parametrize("count", [1, 3000], ids=["copies", "views"])
def test_vtkhdf_is_cut_back_and_goes_on(tmp_path: Path, count: int) -> None:
    """Instants that were taken away leave nothing, and others take their place; each is there by itself, too."""
    points, cells = np.random.default_rng(2).uniform(size=(8, 3)), np.tile(np.arange(8), (count, 1))
    number = np.arange(count)
    with h5py.File(tmp_path / "soil.vtkhdf", "w") as store:
        vtkhdf.lay_out(store, cells, points, polyline=False)
        for times in ([0.0], [1.0, 9.0], [2.0]):
            if times == [2.0]:
                vtkhdf.cut_back(store, 2)
            on_cells = {"stress": np.add.outer(times, number), "p": np.full((len(times), count), 3.0)}
            vtkhdf.append(store, times, {"displacement": np.array([points + time for time in times])}, on_cells)
        assert vtkhdf.times(store).tolist() == [0.0, 1.0, 2.0]
        np.testing.assert_array_equal(vtkhdf.mesh(store)[1], cells)
        for time in (0, 1, 2):
            frames = vtkhdf.values_at(store, time)
            by_itself = {name: store[vtkhdf.instant(name, f"{time:06d}")] for name in frames}
            assert {each.is_virtual for name, each in by_itself.items() if name != "displacement"} == {count == 3000}
            for values in (frames, by_itself):
                np.testing.assert_array_equal(values["displacement"], points + time)
                np.testing.assert_array_equal(values["stress"], number + time)
                np.testing.assert_array_equal(values["p"], np.full(count, 3.0))
        assert vtkhdf.instant("stress", "000003") not in store
        steps = store[vtkhdf.ROOT]["Steps"]
        assert steps["PointDataOffsets"]["displacement"][...].tolist() == [0, 8, 16]
        assert {len(rows) for rows in steps.values() if isinstance(rows, h5py.Dataset)} == {3}


def test_a_run_that_goes_on_with_a_file_of_its_own_refers_to_what_is_in_it(tmp_path: Path) -> None:
    file = XdmfFile(tmp_path / "riser.xdmf", "riser", polyline(7), polyline=True)
    file.restore({"frames": np.array(300)})
    for time in (5.0, 6.0):
        file.add(Frame(time, {"tension": LINE[:, 0] + time, "position": LINE + time}, geometry="position"))
    file.flush()
    times, frames = read_by_vtk(tmp_path / "riser.xdmf")
    for time, frame in zip(times, frames, strict=True):
        np.testing.assert_array_equal(frame["points"], LINE + time)
        np.testing.assert_array_equal(frame["point:tension"], LINE[:, 0] + time)


def test_numbers_that_are_not_double_come_back_too(tmp_path: Path) -> None:
    points, layer = np.random.default_rng(2).uniform(size=(8, 3)), np.array([7])
    file = XdmfFile(tmp_path / "soil.xdmf", "soil", np.arange(8)[None, :], points)
    for time in (0.0, 1.0):
        file.add(Frame(time, {"displacement": points}, {"layer": layer}))
    file.flush()
    assert [frame["cell:layer"].tolist() for frame in read_by_vtk(tmp_path / "soil.xdmf")[1]] == [[7], [7]]
