"""Trench and groove of a soil block: their shape, volume and cells, the surface that contact sees, scenes refused."""

from __future__ import annotations

from math import isclose
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from meshes.block import main as write_block
from riser_soil.contact.ground import DeformedSurface
from riser_soil.contact.integration_points import divisions
from riser_soil.core.arrays import Array
from riser_soil.errors import MeshError, SceneError
from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.seabed_features import Groove, Trench
from riser_soil.soil.block import BlockSpec
from riser_soil.soil.families import point_volumes
from riser_soil.soil.grid import DistributedMesh, block_grid, file_grid
from riser_soil.soil.seabed_feature import GrooveSpec, TrenchSpec
from riser_soil.soil.soil import Soil
from tests.support.scenes import touchdown
from tests.support.soil_bench import Bench
from tests.support.soil_cases import ELASTIC

ALONG_X, ALONG_Y = ((0.0, 0.2), (9.0, 0.2)), ((0.2, 0.0), (0.2, 9.0))
D = 0.3
TRENCH = Trench(depth=0.4, width=0.5, side_slope_deg=45.0, along=(2.0, 3.5), run_out=1.0)
IN_PLAIN = TrenchSpec(0.4, 0.5, 0.4, (2.0, 3.5), 1.0)


def dug(feature: Any, size: float = 0.25, riser: Any = ALONG_X, **more: Any) -> DistributedMesh:
    x, y = ((0.0, 6.0), (-1.5, 1.5)) if riser == ALONG_X else ((-1.5, 1.5), (0.0, 6.0))
    return block_grid(MPI.COMM_SELF, BlockSpec(x, y, 1.2, size, 0.6, 1.0, "tet", riser, feature=feature, **more))


def volume(grid: DistributedMesh) -> float:
    return float(point_volumes(grid.family, grid.nodes.points, grid.nodes.cells).sum())


def soil_on(grid: DistributedMesh) -> Soil:
    return Soil(grid, ELASTIC, level=1.0, unit_weight=6.0e3, K0=0.7)


def heights(grid: DistributedMesh, shape: Trench | Groove, across: int) -> tuple[Array, Array]:
    """z of the nodes at the top, and as the scene's formula says."""
    points = soil_on(grid).surface.points
    expected = [shape.height(point[1 - across], point[across] - 0.2, D) for point in points]
    return points[:, 2], 1.0 + np.array(expected)


@pytest.mark.parametrize(("riser", "across"), [(ALONG_X, 1), (ALONG_Y, 0)])
def test_trench_has_the_shape_that_the_scene_tells(riser: Any, across: int) -> None:
    grid = dug(IN_PLAIN, riser=riser)
    computed, expected = heights(grid, TRENCH, across)
    np.testing.assert_allclose(computed, expected, atol=1e-9)
    assert computed.min() == pytest.approx(0.6, abs=1e-12)
    floor, lid = 0.5 * 1.5, (0.5 + 0.8) * (1.5 + 2.0)
    middle = (0.5 + 0.4) * (1.5 + 1.0)
    assert volume(grid) == pytest.approx(6.0 * 3.0 * 1.2 - 0.4 * (floor + 4.0 * middle + lid) / 6.0, rel=1e-12)


def test_trench_through_the_block_and_its_layers() -> None:
    """A layer ends within the trench, the other below it: level faces of cells there, nothing loose above."""
    grid = dug(TrenchSpec(0.4, 0.5, 0.4), boundaries=(0.2, 0.7))
    assert volume(grid) == pytest.approx(6.0 * (3.0 * 1.2 - 0.9 * 0.4), rel=1e-12)
    z = grid.nodes.points[grid.nodes.cells[:, :4], 2]
    for boundary in (0.8, 0.3):
        assert np.all((z.min(axis=1) > boundary - 1e-9) | (z.max(axis=1) < boundary + 1e-9))


@pytest.mark.parametrize("embedment", [0.1, 0.3, 0.5])
def test_groove_touches_the_pipe_in_lines_and_is_nowhere_within_it(embedment: float) -> None:
    spec = GrooveSpec(embedment * D, 0.5 * D)
    section = spec.section(0.02)
    axis = np.array([0.0, 0.5 * D - embedment * D])
    a, b = section[:-1] - axis, section[1:] - axis
    off = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / np.linalg.norm(b - a, axis=1)
    np.testing.assert_allclose(off, 0.5 * D, rtol=1e-12)
    assert 0.0 < np.linalg.norm(section[1:-1] - axis, axis=1).max() / (0.5 * D) - 1.0 < 2e-2
    assert section[len(section) // 2, 1] == pytest.approx(-embedment * D)
    assert np.linalg.norm(b - a, axis=1).max() < 0.021 or spec.strips(0.02) == 9


@pytest.mark.parametrize("embedment", [0.2, 0.5])
def test_groove_is_meshed_and_all_of_it_is_surface(embedment: float) -> None:
    """Facets of steep walls belong to the surface too: their area is that of the section's outline."""
    spec = GrooveSpec(embedment * D, 0.5 * D)
    block = BlockSpec((0.0, 0.6), (-0.8, 1.2), 0.6, 0.06, 0.4, 1.0, "tet", ALONG_X, feature=spec)
    grid = block_grid(MPI.COMM_SELF, block)
    section = spec.section(0.06)
    outline = np.linalg.norm(np.diff(section, axis=0), axis=1).sum()
    surface = soil_on(grid).surface
    corners = surface.points[surface.facets[:, :3]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = 0.5 * np.linalg.norm(normal, axis=1).sum()
    assert area == pytest.approx(0.6 * (2.0 - np.ptp(section[:, 0]) + outline), rel=1e-9)
    below = 0.5 * np.sum(np.diff(section[:, 0]) * -(section[1:, 1] + section[:-1, 1]))
    assert volume(grid) == pytest.approx(0.6 * (2.0 * 0.6 - below), rel=1e-9)


def test_a_dug_block_is_in_equilibrium_from_the_start() -> None:
    """The soil is as it was under the level seabed: what has been dug out moves nothing."""
    soil = soil_on(dug(IN_PLAIN))
    force = Bench(soil, soil.field.prescribed).force(np.zeros(soil.field.size))
    assert np.abs(force).max() == 0.0
    depth = 1.0 - soil.cells.at_points(soil.points)[:, 2]
    np.testing.assert_allclose(soil._initial[:, 2], -6.0e3 * depth, atol=6.0e3 * 1e-12)  # of depths from 1 m


def test_points_of_contact_are_as_near_on_steep_walls() -> None:
    """One facet level and the same upright: as many points across; along the riser it takes fewer."""
    level = np.array([[0.0, 0.0, 0.0], [0.2, 0.0, 0.0], [0.0, 0.2, 0.0]])
    upright = level[:, [0, 2, 1]]
    facet = np.array([[0, 1, 2, 0, 1, 2]])
    for points in (level, upright):
        counts = divisions(points, facet, np.array([1.0, 0.0]), (0.05, 0.01))
        np.testing.assert_array_equal(counts[:, :2], [[20, 20]])


def test_points_along_the_riser_are_no_more_than_elements_and_cells_ask_for() -> None:
    """Twelve over the shorter of both; never more than the spacing asks for, and across as many as it does."""
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.0, 0.1, 0.0]])
    facet, along = np.array([[0, 1, 2, 3]]), np.array([1.0, 0.0])
    for element, wanted in ((0.0, 50), (0.5, 24), (1.0, 12), (7.0, 12), (0.1, 50)):
        counts = divisions(points, facet, along, (0.02, 0.01), element)
        np.testing.assert_array_equal(counts[:, :2], [[wanted, 10]])


def test_stretch_of_a_steep_wall_is_that_of_its_own_plane() -> None:
    surface = soil_on(dug(TrenchSpec(0.4, 0.5, 0.4 * np.tan(np.radians(10.0))), size=0.4)).surface
    steep = surface.facets[np.ptp(surface.points[surface.facets][..., 2], axis=1) > 0.1]
    at = DeformedSurface(surface)
    facets = np.flatnonzero(np.isin(at.facets, steep).all(axis=1))
    pushed = surface.points + np.array([0.0, 0.004, 0.0]) * (surface.points[:, 2:] - 0.6)
    assert at.stretch(pushed, facets) == pytest.approx(1.0, abs=1e-3)
    assert at.stretch(surface.points * [1.2, 1.0, 1.0], facets) == pytest.approx(1.2, rel=1e-9)


def test_script_writes_the_trench(tmp_path: Any) -> None:
    file = tmp_path / "trench.msh"
    write_block([str(file), "--kind", "tet", "--trench", "0.4", "0.5", "45"])
    assert volume(file_grid(MPI.COMM_SELF, file)) == pytest.approx(10.0 * (5.0 * 2.5 - 0.9 * 0.4), rel=1e-9)
    with pytest.raises(MeshError, match="meshed in tetrahedra"):
        write_block([str(file), "--trench", "0.4", "0.5", "45"])


def scene(feature: dict[str, Any], start_y: float = 0.0, **mesh: Any) -> dict[str, Any]:
    made = touchdown(kind="tet")
    made["soil"]["block"] |= feature
    made["soil"]["mesh"] |= mesh
    made["riser"]["start"]["position"][1] = start_y
    return made


CUT = {"depth": 0.3, "width": 0.4}
REFUSED = {
    "hexahedra": (scene({"trench": CUT}, kind="hex"), "meshed in tetrahedra; give mesh: {kind: tet"),
    "both": (scene({"trench": CUT, "groove": {"embedment": 0.2}}), "is given beside trench"),
    "too deep": (scene({"trench": {**CUT, "depth": 1.0}}), "is as deep as the block, 1 m"),
    "too wide": (scene({"trench": {**CUT, "width": 1.5}}), "2.539 m wide at the seabed about y = 0 m"),
    "askew": (scene({"trench": CUT}, start_y=1.0), "runs askew to both"),
    "elsewhere": (scene({"trench": {**CUT, "along": [20.0, 30.0]}}), "lies beyond the block's x, 2 to 9 m"),
    "run-out of none": (scene({"trench": {**CUT, "run_out": 1.0}}), "passes through the whole block"),
    "buried": (scene({"groove": {"embedment": 0.7}}), "must be at most 0.5"),
    "backwards": (scene({"trench": {**CUT, "along": [5.0, 4.0]}}), "first bound must be smaller"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_makes_no_sense_is_refused_in_one_line(name: str) -> None:
    given, says = REFUSED[name]
    with pytest.raises(SceneError) as caught:
        scene_from_mapping(given)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


def test_an_end_may_lie_in_the_trench() -> None:
    made = scene({"trench": {**CUT, "along": [2.5, 6.0]}})
    made["riser"]["start"]["position"] = [3.0, 0.0, -0.15]
    checked = scene_from_mapping(made)
    assert ground_height(checked, (3.0, 0.0, 0.0)) == pytest.approx(-0.3)
    assert isclose(ground_height(checked, (3.0, 0.9, 0.0)), 0.0)
    assert isclose(ground_height(checked, (1.0, 0.0, 0.0)), 0.0)
