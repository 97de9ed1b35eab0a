"""Half of a symmetric soil unfolded to the whole, and why a scene keeps the whole."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import sized
from riser_soil.assembly.soil_block import why_all
from riser_soil.checks.inventory import inventory
from riser_soil.core.arrays import Array
from riser_soil.core.numbering import Numbering
from riser_soil.core.part import Forces, State
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.soil.grading import BlockSpec
from riser_soil.soil.grid import DistributedMesh, block_grid
from riser_soil.soil.law import PLASTIC_STRAIN, STRESS
from riser_soil.soil.mirror import Mirror
from riser_soil.soil.slices import slice_grid
from riser_soil.soil.soil import Soil
from tests.support.driven_stage import built_of
from tests.support.said import line_with
from tests.support.scenes import Mapping, touchdown
from tests.support.soil_bench import assemble
from tests.support.soil_cases import CLAY

MAKE = pytest.mark.parametrize("make", [block_grid, slice_grid])
ALONG = pytest.mark.parametrize("along", [0, 1])
STRIP = pytest.mark.parametrize("strip", [0.6, 2.0])  # an odd number of cells across; an even one
Make = Callable[[MPI.Intracomm, BlockSpec], DistributedMesh]


def pair(make: Make, along: int, strip: float) -> tuple[Soil, Soil]:
    """Half of the soil and all of it, the riser along x or y and not through the origin."""
    line, ranges = np.full((2, 2), 3.0), [(0.0, 2.0), (2.2, 3.8)]
    line[:, along] = [0.0, 2.0]
    x, y = ranges if along == 0 else ranges[::-1]
    first, second = ((float(p[0]), float(p[1])) for p in line)
    spec = BlockSpec(x, y, 1.0, 0.2, 0.4, riser=(first, second), along=0.5, strip=strip)
    half, whole = (
        Soil(make(MPI.COMM_SELF, replace(spec, half=half)), CLAY, level=0.0, unit_weight=5e3) for half in (True, False)
    )
    return half, whole


def order(points: Array) -> Array:
    return np.lexsort(np.round(points, 9).T)


@MAKE
@ALONG
@STRIP
def test_half_of_the_mesh_unfolds_to_the_whole(make: Make, along: int, strip: float) -> None:
    half, whole = pair(make, along, strip)
    assert len(half.grid.nodes.cells) < 0.7 * len(whole.grid.nodes.cells)
    for points in (lambda soil: soil.mesh.points, lambda soil: soil.mesh.points[soil.mesh.cells].mean(axis=1)):
        a, b = points(half), points(whole)
        np.testing.assert_allclose(a[order(a)], b[order(b)], atol=1e-12)
    assert half.cells.volumes.sum() == pytest.approx(whole.cells.volumes.sum(), rel=1e-12)
    np.testing.assert_allclose([half.grid.low, half.grid.high], [whole.grid.low, whole.grid.high], atol=1e-12)
    top, all_of = half.surface, whole.surface
    np.testing.assert_allclose(top.points[order(top.points)], all_of.points[order(all_of.points)], atol=1e-12)
    assert len(top.facets) == len(all_of.facets)


@MAKE
@ALONG
@STRIP
def test_images_of_cells_are_right_side_out(make: Make, along: int, strip: float) -> None:
    half, _ = pair(make, along, strip)
    corners = half.mesh.points[half.mesh.cells]
    axes = [corners[:, k] - corners[:, 0] for k in ((1, 2) if half.grid.family.plane else (1, 2, 4))]
    third = axes[2] if len(axes) == 3 else np.eye(3)[along]
    turned = np.sign(np.einsum("ci,ci->c", np.cross(axes[0], axes[1]), np.broadcast_to(third, axes[0].shape)))
    own = len(half.grid.nodes.cells)
    np.testing.assert_array_equal(turned[own:], turned[half.mesh.unfolding.cells])


@MAKE
@ALONG
@STRIP
def test_forces_and_stiffness_are_those_of_the_whole(make: Make, along: int, strip: float) -> None:
    """In an increment that is symmetric, well into the plastic range: energy, and forces on the unknowns."""
    half, whole = pair(make, along, strip)
    energies, work = [], []
    for soil in (half, whole):
        x = soil.field.points
        s, w, z = x[:, along], x[:, 1 - along] - 3.0, x[:, 2]
        u = np.zeros_like(x)
        u[:, along], u[:, 1 - along], u[:, 2] = np.sin(s) * w**2, np.sin(2.0 * w) * (1.0 + s), np.cos(w) * (z + 1.0)
        u[soil.field.prescribed.reshape(-1, 3)] = 0.0
        state = State(1.0, 4e-3 * u.ravel(), u.ravel(), u.ravel(), dt=1.0)
        forces = Forces.zeros(soil.field.size)
        soil.residual(state, forces)
        energies.append([soil.energy(state).strain, soil.energy(state).potential, soil.work(state, state).dissipated])
        K = assemble(soil, state)
        work.append([forces.end @ u.ravel(), u.ravel() @ (K @ u.ravel())])
    np.testing.assert_allclose(energies[0], energies[1], rtol=1e-10, atol=1e-9)
    np.testing.assert_allclose(work[0], work[1], rtol=1e-10)


def test_images_view_minus_the_displacement_across_the_plane() -> None:
    """Unknowns come to local arrays with the sign turned, and forces on images go to their twins with it."""
    soil = pair(block_grid, 0, 0.6)[0]
    numbering, field = Numbering(MPI.COMM_SELF, [soil.field]), soil.field
    x = np.random.default_rng(1).normal(size=numbering.free)
    u: Array = np.zeros(field.size)
    numbering.to_local(x, u)
    points, u = field.points, u.reshape(-1, 3)
    images = np.flatnonzero(points[:, 1] < 3.0)
    assert images.size
    for image in images:
        place = points[image] * [1.0, -1.0, 1.0] + [0.0, 6.0, 0.0]
        twin = np.flatnonzero(np.abs(points - place).max(axis=1) < 1e-9)
        np.testing.assert_array_equal(u[image] * [1.0, -1.0, 1.0], u[twin[0]])
    np.testing.assert_array_equal(numbering.to_global(u.ravel()), x)
    f = np.random.default_rng(2).normal(size=field.size)
    assert numbering.add_to_global(f) @ x == pytest.approx(f @ u.ravel(), rel=1e-12)
    assert (numbering.sizes_to_global(np.abs(f)) > 0.0).all()


def test_the_image_of_a_history_has_shear_across_the_plane_turned() -> None:
    columns = (*STRESS, PLASTIC_STRAIN)
    np.testing.assert_array_equal(Mirror(1, 0.0, 1e-9).turned(columns), [1, 1, 1, -1, 1, -1, 1])
    np.testing.assert_array_equal(Mirror(0, 0.0, 1e-9).turned(columns), [1, 1, 1, -1, -1, 1, 1])
    np.testing.assert_array_equal(Mirror(0, 0.0, 1e-9).turned(("slope_x", "slope_y")), [-1, 1])


def on_soil(**more: Any) -> Mapping:
    scene = touchdown()
    scene["soil"] |= more
    return scene


BLOCK = {"x": [2.0, 9.0], "depth": 1.0}
ELASTIC = {"kind": "linear-elastic", "E": 1e6, "nu": 0.3}
KEPT = {
    "soil.symmetry is whole": on_soil(symmetry="whole"),
    "it is no block of hexahedra": on_soil(mesh={"kind": "tet", "size_at_riser": 0.5, "size_far": 1.0}),
    "it is linear, and may be condensed": on_soil(law=ELASTIC),
    "the riser moves in three dimensions": on_soil() | {"dimension": 3},
    "the riser does not lie in the middle of soil.block.y": on_soil(block=BLOCK | {"y": [-1.0, 1.5]}),
}


@pytest.mark.parametrize("why", KEPT)
def test_a_scene_keeps_the_whole(why: str) -> None:
    scene = scene_from_mapping(KEPT[why])
    assert scene.soil is not None
    assert why_all(scene, scene.soil) == why
    assert "half of the soil" not in inventory(built_of(scene)).left_out


def test_a_riser_askew_keeps_the_whole() -> None:
    scene = on_soil(block={"x": [2.0, 9.0], "y": [2.0, 9.0], "depth": 1.0})
    scene["riser"]["end"]["position"] = [15.91, 15.91, 15.0]
    made = scene_from_mapping(scene)
    assert made.soil is not None
    line_with(why_all(made, made.soil), "across x and y")


def test_half_is_left_out_where_all_is_symmetric() -> None:
    scene = sized(scene_from_mapping(on_soil(block="auto", mesh="auto")))
    assert inventory(built_of(scene)).left_out["half of the soil"] == "by symmetry"
