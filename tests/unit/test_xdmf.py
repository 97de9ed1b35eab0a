"""XDMF files, read back by VTK's own reader."""

from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

from riser_soil.arrays import IntArray
from riser_soil.xdmf import Frame, XdmfFile, polyline
from tests.recorded_run import block, record

LINE = np.random.default_rng(1).uniform(-1e5, 1e5, (7, 3))


def frames_of(path: Path) -> list[pv.DataSet]:
    reader = pv.XdmfReader(path)
    frames = []
    for time in reader.time_values:
        reader.set_active_time_value(time)
        frames.append(reader.read())
    return frames


def a_line(path: Path, times: list[float]) -> XdmfFile:
    file = XdmfFile(path, "riser", polyline(7), polyline=True)
    for time in times:
        file.add(Frame(time, {"tension": LINE[:, 0] + time, "position": LINE + time}, geometry="position"))
    file.flush()
    return file


def test_a_moving_line_comes_back_in_all_digits(tmp_path: Path) -> None:
    times = [0.0, 1e-6, 1.0 / 3.0, 140.0]
    a_line(tmp_path / "riser.xdmf", times)
    assert pv.XdmfReader(tmp_path / "riser.xdmf").time_values == times
    for time, frame in zip(times, frames_of(tmp_path / "riser.xdmf"), strict=True):
        assert frame.n_cells == 1
        assert frame.get_cell(0).type == pv.CellType.POLY_LINE
        assert frame.points.dtype == np.float64
        np.testing.assert_array_equal(frame.points, LINE + time)
        np.testing.assert_array_equal(frame.point_data["position"], LINE + time)
        np.testing.assert_array_equal(frame.point_data["tension"], LINE[:, 0] + time)


@pytest.mark.parametrize(
    ("cells", "kind"),
    [
        (np.arange(8)[None, :], pv.CellType.HEXAHEDRON),
        (np.array([[0, 1, 3, 4], [6, 5, 7, 2]]), pv.CellType.TETRA),
        (np.arange(10)[None, :], pv.CellType.QUADRATIC_TETRA),
    ],
)
def test_a_mesh_that_stays_with_values_on_points_and_cells(
    tmp_path: Path, cells: IntArray, kind: pv.CellType
) -> None:
    points = np.random.default_rng(2).uniform(size=(10, 3))
    file = XdmfFile(tmp_path / "soil.xdmf", "soil", cells, points)
    stress = np.linspace(1.0, 2.0, len(cells))
    for time in (0.0, 2.5):
        file.add(Frame(time, {"displacement": points * time}, {"stress": stress + time}))
    file.flush()
    last = frames_of(tmp_path / "soil.xdmf")[-1]
    assert set(last.celltypes) == {kind}
    np.testing.assert_array_equal(last.points, points)
    np.testing.assert_array_equal(last.point_data["displacement"], points * 2.5)
    np.testing.assert_array_equal(last.cell_data["stress"], stress + 2.5)


def test_the_block_fills_its_volume_right_way_round(tmp_path: Path) -> None:
    mesh = block(4, 3, 2)
    file = XdmfFile(tmp_path / "soil.xdmf", "soil", mesh.cells, mesh.points)
    file.add(Frame(0.0))
    file.flush()
    sizes = frames_of(tmp_path / "soil.xdmf")[0].compute_cell_sizes()
    np.testing.assert_allclose(sizes.cell_data["Volume"], 40.0 * 5.0 * 2.5 / 24)


def test_frames_are_readable_after_each_flush_and_not_before(tmp_path: Path) -> None:
    file = a_line(tmp_path / "riser.xdmf", [0.0])
    file.add(Frame(1.0, {"tension": LINE[:, 0], "position": LINE}, geometry="position"))
    assert pv.XdmfReader(tmp_path / "riser.xdmf").number_time_points == 1
    file.flush()
    assert pv.XdmfReader(tmp_path / "riser.xdmf").number_time_points == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["riser.h5", "riser.xdmf"]


def test_frames_are_copies(tmp_path: Path) -> None:
    file = XdmfFile(tmp_path / "riser.xdmf", "riser", polyline(7), polyline=True)
    reused = LINE.copy()
    file.add(Frame(0.0, {"position": reused}, geometry="position"))
    reused[:] = 0.0
    file.flush()
    np.testing.assert_array_equal(frames_of(tmp_path / "riser.xdmf")[0].points, LINE)


def test_riser_and_soil_share_one_time_axis_that_grows(tmp_path: Path) -> None:
    record(tmp_path, mesh=block(4, 3, 2), picture_interval=0.5)
    riser, soil = (pv.XdmfReader(tmp_path / f"{name}.xdmf").time_values for name in ("riser", "soil"))
    assert riser == soil
    np.testing.assert_allclose(riser, [0.0, 0.5, 1.0, 1.5, 2.0], atol=1e-12)


def test_the_names_that_paraview_shows(tmp_path: Path) -> None:
    record(tmp_path, mesh=block(4, 3, 2))
    riser, soil = (frames_of(tmp_path / f"{name}.xdmf")[-1] for name in ("riser", "soil"))
    assert {"effective_tension", "bending_moment", "curvature", "contact_force", "position"} <= set(
        riser.point_data
    )
    assert set(soil.point_data) == {"displacement"}
    assert set(soil.cell_data) == {"von_mises_stress", "equivalent_plastic_strain"}
