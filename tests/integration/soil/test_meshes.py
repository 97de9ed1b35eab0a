"""Soil meshes, supports, the top surface and the output mesh."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import gmsh
import numpy as np
import pytest
from mpi4py import MPI

from meshes.block import main as write_block
from riser_soil.core.part import State
from riser_soil.errors import MeshError, SceneError
from riser_soil.soil.families import point_volumes
from riser_soil.soil.grading import BlockSpec, graded, in_units
from riser_soil.soil.grid import DistributedMesh, block_grid, file_grid, silent_gmsh
from riser_soil.soil.sections import smoothed
from riser_soil.soil.soil import Soil
from tests.support.said import line_with, telling
from tests.support.soil_cases import CLAY, ELASTIC, KINDS, clay_block, small_block

COMM = MPI.COMM_SELF
DEMO = BlockSpec((10.0, 50.0), (-2.5, 2.5), 2.5, 0.5, 1.5, riser=((0.0, 0.0), (80.0, 0.0)))


def soil_on(grid: DistributedMesh) -> Soil:
    return Soil(grid, ELASTIC, level=0.0, unit_weight=5.0e3)


def test_graded_levels_are_fine_at_the_riser_and_reach_the_far_size() -> None:
    y = graded(-10.0, 10.0, (-0.25, 0.25), 0.5, 2.0)
    steps = np.diff(y)
    assert y[0] == -10.0
    assert y[-1] == 10.0
    assert np.isclose(steps[np.searchsorted(y, 0.0) - 1], 0.5)
    assert 1.5 < steps[0] < 2.0
    np.testing.assert_allclose(steps, steps[::-1])
    assert np.all(np.diff(steps[len(steps) // 2 + 1 :]) > 0.0)


def test_more_cells_in_a_row_than_anyone_means_are_refused() -> None:
    with pytest.raises(MeshError, match=telling("1e+09 m", "block", "at most 100,000")):
        graded(0.0, 1e9, (0.0, 0.5), 0.5, 2.0)


def test_a_section_one_cell_deep_has_no_inner_nodes_to_smooth() -> None:
    columns, layers = np.array([0.0, 1.0, 3.0]), np.array([-1.0, 0.0])
    at = np.stack(np.meshgrid([0.5], columns, layers, indexing="ij"), axis=-1)[0]
    np.testing.assert_array_equal(smoothed(at, columns, layers, 1), at)


def test_block_of_hexahedra_is_a_graded_grid_with_a_cell_centred_under_the_riser() -> None:
    grid = block_grid(COMM, DEMO)
    x, y, z = (np.unique(np.round(grid.nodes.points[:, i], 9)) for i in range(3))
    assert len(grid.nodes.cells) == (len(x) - 1) * (len(y) - 1) * (len(z) - 1)
    np.testing.assert_allclose(np.diff(x), 0.5)
    assert {-0.25, 0.25} <= set(y)
    assert z[-1] - z[-2] < 0.6 < z[1] - z[0]


LONG = BlockSpec((0.0, 4.0), (-2.5, 2.5), 2.5, 0.02, 1.0, riser=((0.0, 0.3), (80.0, 0.3)), along=0.5, strip=0.16)


@pytest.mark.parametrize("axis", [0, 1])
def test_cells_are_long_along_the_riser_and_fine_across(axis: int) -> None:
    """Nine of them across a strip of eight, and four downwards, before they grow."""
    spec = LONG
    if axis == 1:
        spec = replace(LONG, x=LONG.y, y=LONG.x, riser=((0.3, 0.0), (0.3, 80.0)))
    along, across, down = (np.diff(spec.coordinates(k)) for k in (axis, 1 - axis, 2))
    np.testing.assert_allclose(along, 0.5)
    assert np.count_nonzero(np.isclose(across, 0.02)) == 9
    assert np.count_nonzero(np.isclose(down, 0.02)) == 4
    assert across.max() == pytest.approx(1.0, rel=0.4)
    assert down[0] == pytest.approx(1.0, rel=0.4)
    assert -2.5 == spec.coordinates(2)[0] < spec.coordinates(2)[-1] == 0.0
    middle = 0.5 * (spec.coordinates(1 - axis)[1:] + spec.coordinates(1 - axis)[:-1])
    assert np.abs(middle - 0.3).min() < 1e-12
    assert spec.layers() == tuple(len(spec.coordinates(k)) - 1 for k in range(3))


@pytest.mark.parametrize("axis", [0, 1])
def test_cells_grow_along_the_riser_beyond_the_touchdown_zone(axis: int) -> None:
    """Cells grow to the size far off or four of their lengths, whichever is more; in sections, and where the zone is
    all, none.
    """
    spec = replace(LONG, x=(0.0, 20.0), size_far=1.0, touchdown=(6.0, 12.0))
    if axis == 1:
        spec = replace(spec, x=spec.y, y=spec.x, riser=((0.3, 0.0), (0.3, 80.0)))
    places = spec.coordinates(axis)
    lengths, middles = np.diff(places), 0.5 * (places[1:] + places[:-1])
    within = (middles > 6.0) & (middles < 12.0)
    np.testing.assert_allclose(lengths[within], 0.5)
    assert (places[0], places[-1]) == (0.0, 20.0)
    assert np.all(np.diff(lengths[middles < 6.0]) < 0.0)
    assert np.all(np.diff(lengths[middles > 12.0]) > 0.0)
    assert lengths[0] == pytest.approx(2.0, rel=0.3)
    assert lengths[-1] == pytest.approx(2.0, rel=0.3)
    assert {6.0, 12.0} <= {*places.tolist()}
    np.testing.assert_allclose(np.diff(replace(spec, touchdown=(-5.0, 90.0)).coordinates(axis)), 0.5)
    np.testing.assert_allclose(spec.coordinates(1 - axis), replace(spec, touchdown=None).coordinates(1 - axis))


def test_under_a_riser_across_the_axes_cells_are_fine_both_ways() -> None:
    spec = replace(LONG, riser=((0.0, 0.0), (80.0, 8.0)))
    assert np.diff(spec.coordinates(0)) == pytest.approx(0.02)
    assert np.diff(spec.coordinates(1)).min() == pytest.approx(0.02, rel=0.1)


def test_cells_that_grow_a_thousandfold_fill_the_block() -> None:
    spec = replace(LONG, size_at_riser=0.002, size_far=2.0, strip=0.016, y=(-4.0, 4.0), depth=4.0)
    grid = block_grid(COMM, spec)
    volumes = point_volumes(grid.family, grid.nodes.points, grid.nodes.cells)
    assert volumes.min() > 0.0
    assert volumes.sum() == pytest.approx(4.0 * 8.0 * 4.0, rel=1e-12)
    assert len(grid.nodes.cells) == np.prod(spec.layers())
    assert 500.0 < np.ptp(np.diff(spec.coordinates(1))) / 0.002 < 1000.0


def test_block_of_tetrahedra_grows_away_from_the_riser() -> None:
    spec = BlockSpec((0.0, 10.0), (-5.0, 5.0), 5.0, 0.5, 2.5, kind="tet", riser=((0.0, 0.0), (10.0, 0.0)))
    grid = block_grid(COMM, spec)
    volumes = point_volumes(grid.family, grid.nodes.points, grid.nodes.cells)
    volume, centre = volumes.sum(axis=1), grid.nodes.points[grid.nodes.cells[:, :4]].mean(axis=1)
    near = np.hypot(centre[:, 1], centre[:, 2]) < 0.7
    far = np.hypot(centre[:, 1], centre[:, 2]) > 4.0
    assert volume.sum() == pytest.approx(500.0, rel=1e-12)
    assert np.median(volume[far]) > 10.0 * np.median(volume[near])


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_is_printed(kind: str, capfd: pytest.CaptureFixture[str]) -> None:
    small_block(kind)
    with pytest.raises(MeshError):
        file_grid(COMM, Path("absent.msh"))
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("kind", KINDS)
def test_mesh_file_gives_the_same_soil_as_the_block(kind: str, tmp_path: Path) -> None:
    file = tmp_path / "block.msh"
    write_block(
        [str(file), "--x", "0", "4", "--depth", "2", "--size", "1", "--size-far", "2", "--kind", kind]
    )
    grid = file_grid(COMM, file)
    assert grid.family.corners == {"hex": 4, "tet": 3}[kind]
    np.testing.assert_allclose(np.r_[grid.low, grid.high], [0.0, -2.5, -2.0, 4.0, 2.5, 0.0], atol=1e-9)
    volumes = point_volumes(grid.family, grid.nodes.points, grid.nodes.cells)
    assert volumes.sum() == pytest.approx(40.0, rel=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_supports_hold_bottom_and_sides_and_leave_the_top_free(kind: str) -> None:
    field = soil_on(small_block(kind)).field
    prescribed, p = field.prescribed.reshape(-1, 3), field.points
    bottom = p[:, 2] < -1.0 + 1e-9
    assert prescribed[bottom].all()
    assert not prescribed[~bottom, 2].any()
    side = (p[:, 0] < 1e-9) | (p[:, 0] > 2.0 - 1e-9)
    np.testing.assert_array_equal(prescribed[~bottom, 0], side[~bottom])
    u = np.ones(field.size)
    field.prescribe(0.0, u, u.copy(), u.copy())
    assert not u[field.prescribed].any()
    assert u[~field.prescribed].all()


def test_messages_name_the_node() -> None:
    soil = soil_on(small_block("hex"))
    entry = 3 * int(np.argmin(np.linalg.norm(soil.field.points - [2.0, 0.0, -0.5], axis=1))) + 2
    line_with(soil.field.describe(entry), "soil node", "(2, 0, -0.5) m", "z displacement")
    surface_entry = 3 * int(np.argmin(np.linalg.norm(soil.surface.points - [2.0, 0.0, 0.0], axis=1)))
    line_with(soil.surface.describe(surface_entry), "soil surface", "(2, 0) m", "x displacement")


@pytest.mark.parametrize("kind", KINDS)
def test_surface_tiles_the_top_counter_clockwise(kind: str) -> None:
    surface = soil_on(small_block(kind)).surface
    corners = surface.points[surface.facets[:, : 4 if kind == "hex" else 3]]
    assert surface.facets.shape[1] == {"hex": 4, "tet": 6}[kind]
    np.testing.assert_allclose(surface.points[:, 2], 0.0, atol=1e-12)
    x, y = corners[..., 0], corners[..., 1]
    area = 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
    assert area.min() > 0.0
    assert area.sum() == pytest.approx(3.0, rel=1e-12)
    if kind == "tet":
        middle = 0.5 * (corners + np.roll(corners, -1, axis=1))
        np.testing.assert_allclose(surface.points[surface.facets[:, 3:]], middle, atol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_surface_entries_are_the_soil_dofs_at_the_same_place(kind: str) -> None:
    soil = clay_block(kind)
    surface, field = soil.surface, soil.field
    place = {int(n): i for i, n in enumerate(field.global_index)}
    local = np.array([place[int(n)] for n in surface.global_index])
    np.testing.assert_array_equal(field.points[local[::3] // 3], surface.points)
    np.testing.assert_array_equal(field.prescribed[local], surface.prescribed)
    assert not surface.owned.any()
    u = np.arange(float(surface.size))
    surface.commit(State(0.0, u, u, u))
    surface.commit(State(0.0, u, u, u))
    np.testing.assert_array_equal(surface.committed.ravel(), 2.0 * u)


def test_surface_of_a_trench_leaves_out_its_upright_walls(tmp_path: Path) -> None:
    with silent_gmsh():
        block = gmsh.model.occ.addBox(0.0, 0.0, -2.0, 4.0, 4.0, 2.0)
        trench = gmsh.model.occ.addBox(0.0, 1.5, -1.0, 4.0, 1.0, 1.0)
        gmsh.model.occ.cut([(3, block)], [(3, trench)])
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.7)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(tmp_path / "trench.msh"))
    soil = soil_on(file_grid(COMM, tmp_path / "trench.msh"))
    corners = soil.surface.points[soil.surface.facets[:, :3]]
    area = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    assert area.sum() == pytest.approx(16.0, rel=1e-12)
    assert set(np.round(corners[..., 2].ravel(), 9)) == {0.0, -1.0}


def test_output_cells_are_in_vtk_order() -> None:
    mesh = soil_on(small_block("hex")).output_mesh()
    p = mesh.points[mesh.cells]
    np.testing.assert_allclose(p[:, 0] - p[:, 1] + p[:, 2] - p[:, 3], 0.0, atol=1e-12)
    lift = p[:, 4:] - p[:, :4]
    np.testing.assert_allclose(lift - lift[:, :1], 0.0, atol=1e-12)
    mesh = soil_on(small_block("tet")).output_mesh()
    p = mesh.points[mesh.cells]
    for place, (a, b) in enumerate(((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)), start=4):
        np.testing.assert_allclose(p[:, place], 0.5 * (p[:, a] + p[:, b]), atol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_geostatic_start_is_in_equilibrium_and_undeformed(kind: str) -> None:
    soil = clay_block(kind, K0=0.9)
    fields, mesh = soil.output_fields(), soil.output_mesh()
    assert not fields.displacement.any()
    assert not fields.plastic_strain.any()
    assert len(fields.von_mises) == len(mesh.cells)
    depth = -mesh.points[mesh.cells].mean(axis=1)[:, 2]
    assert np.corrcoef(fields.von_mises, depth)[0, 1] > 0.99
    assert fields.von_mises.max() < 0.1 * 5.0e3 * 1.0


def test_invariants_of_a_geostatic_start() -> None:
    """p = (1 + 2 K0) gamma z/3, q = (1 - K0) gamma z, and of the strength q over √3 su, in the middle of hexahedra."""
    soil = Soil(small_block("hex"), CLAY, level=0.0, unit_weight=5.0e3, K0=0.7)
    fields, mesh = soil.output_fields(), soil.output_mesh()
    depth = -mesh.points[mesh.cells].mean(axis=1)[:, 2]
    np.testing.assert_allclose(fields.mean_stress, (1.0 + 2.0 * 0.7) * 5.0e3 * depth / 3.0, rtol=1e-12)
    np.testing.assert_allclose(fields.von_mises, (1.0 - 0.7) * 5.0e3 * depth, rtol=1e-12)
    z = depth[:, None] + 0.25 / np.sqrt(3.0) * np.array([-1.0, 1.0])  # of the points in cells 0.5 m high
    used = (0.3 * 5.0e3 * z / (np.sqrt(3.0) * (4.0e3 + 1.5e3 * z))).mean(axis=1)
    np.testing.assert_allclose(fields.strength_used, used, rtol=1e-12)
    assert not Soil(small_block("hex"), ELASTIC, level=0.0, unit_weight=5.0e3).output_fields().strength_used.any()


def test_initial_stress_beyond_yield_is_refused_with_numbers() -> None:
    with pytest.raises(SceneError, match=r"soil\.K0 = 0\.1: .* 0\.\d+ m .* 1\.\d+ times") as caught:
        Soil(small_block("hex"), CLAY, level=0.0, unit_weight=20.0e3, K0=0.1)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("level", [-1.0, 0.5])
def test_level_outside_the_mesh_is_refused(level: float) -> None:
    with pytest.raises(MeshError, match=r"misses seabed\.level"):
        Soil(small_block("hex"), ELASTIC, level=level, unit_weight=0.0)


def test_inverted_cell_is_refused() -> None:
    grid = small_block("hex")
    inside = int(np.argmin(np.linalg.norm(grid.nodes.points - [1.0, 0.5, -0.5], axis=1)))
    grid.nodes.points[inside] += [0.9, 0.0, 0.0]
    with pytest.raises(MeshError, match=r"cell at \(.*\) m .*inverted"):
        soil_on(grid)


def write_model(path: Path, shape: str) -> Path:
    """Meshes that can't be used."""
    with silent_gmsh():
        if shape == "plane":
            gmsh.model.occ.addRectangle(0.0, 0.0, 0.0, 1.0, 1.0)
        elif shape == "ball":
            gmsh.model.occ.addSphere(0.0, 0.0, -1.0, 1.0)
        else:
            gmsh.model.occ.addBox(0.0, 0.0, -1.0, 1.0, 1.0, 1.0)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(3)
        if shape == "second order":
            gmsh.model.mesh.setOrder(2)
        gmsh.write(str(path))
    return path


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        ("plane", "no volume"),
        ("second order", "first-order tetrahedra only or hexahedra only"),
        ("ball", "only 1 nodes on the plane"),
    ],
)
def test_unfit_mesh_is_refused_in_one_line(shape: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(MeshError, match=message) as caught:
        file_grid(COMM, write_model(tmp_path / "mesh.msh", shape))
    assert "\n" not in str(caught.value)


def test_missing_and_broken_files_are_refused_in_one_line(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "broken.msh").write_text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 9 nonsense\n")
    (tmp_path / "empty.msh").write_text("")
    for name in ("absent.msh", "broken.msh", "empty.msh", "."):
        with pytest.raises(MeshError, match=r"soil mesh") as caught:
            file_grid(COMM, tmp_path / name)
        assert "\n" not in str(caught.value)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("unit", [1e-3, 0.3048, 1.0, 1e3])
def test_as_many_layers_in_any_unit_of_length(unit: float) -> None:
    """A strip of two, four or six cells stands between two odd numbers of them: round-off must not choose."""
    for cells in (2, 4, 6):
        spec = BlockSpec((0.0, 0.7), (0.0, 0.9), 0.3, 0.01, 0.05, riser=((0.1, 0.4), (0.6, 0.4)), strip=0.01 * cells)
        assert in_units(spec, unit).layers() == spec.layers()
