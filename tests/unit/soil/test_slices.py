"""Soil in sections: slices in plane strain, not joined, under one surface."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.part import State
from riser_soil.errors import MeshError
from riser_soil.soil.grading import BlockSpec
from riser_soil.soil.large_strain import carried_rows, nearest_rows
from riser_soil.soil.slices import slice_grid
from riser_soil.soil.soil import Soil
from riser_soil.soil.soil_cells import SoilCells
from tests.support.sinking_pipe import CLAY, sink, sinking
from tests.support.soil_bench import assemble
from tests.support.soil_cases import ELASTIC, slices_spec

ALONG = pytest.mark.parametrize("along", [0, 1])


def soil_of(along: int, law: Any = ELASTIC) -> Soil:
    return Soil(slice_grid(MPI.COMM_SELF, slices_spec(along)), law, level=0.0, unit_weight=5.0e3)


@ALONG
def test_slices_fill_the_block(along: int) -> None:
    soil = soil_of(along)
    assert soil.cells.volumes.sum() == pytest.approx(2.0 * 2.0 * 1.0, rel=1e-12)
    places = np.unique(soil.grid.nodes.points[:, along])
    np.testing.assert_allclose(places, [0.25, 0.75, 1.25, 1.75])
    mesh = soil.output_mesh()
    corners = mesh.points[mesh.cells]
    assert np.ptp(corners, axis=1).prod(axis=1).sum() == pytest.approx(4.0, rel=1e-12)
    assert len(soil.output_fields().displacement) == len(mesh.points)


@ALONG
def test_slices_take_nothing_from_each_other(along: int) -> None:
    """A new mesh of thin slices whose nodes lie nearer to those of the next one than to their own neighbours."""
    soil = Soil(slice_grid(MPI.COMM_SELF, slices_spec(along, length=0.2)), ELASTIC, level=0.0, unit_weight=5.0e3)
    before = soil.cells.at_points(soil.points)
    number = np.round(before[:, along] / 0.05 - 0.5)
    assert set(number) == {0.0, 1.0, 2.0, 3.0}
    after = before + 0.05 * np.random.default_rng(7).uniform(-1.0, 1.0, before.shape)
    after[:, along] = before[:, along]
    for result in (
        carried_rows(soil.grid, before, after, number[:, None], ("number",)),
        nearest_rows(soil.grid, before, after, number[:, None], ("number",))[0],
    ):
        np.testing.assert_array_equal(result[:, 0], number)


@ALONG
def test_linear_displacement_strains_askew_cells_alike(along: int) -> None:
    """Nodes are moved at random within their slices."""
    grid, across = slice_grid(MPI.COMM_SELF, slices_spec(along)), 1 - along
    points, u = grid.nodes.points.copy(), np.zeros((len(grid.nodes.points), 3))
    points[:, [across, 2]] += 0.06 * np.random.default_rng(3).uniform(-1.0, 1.0, (len(points), 2))
    u[:, across] = 1e-3 * points[:, across] - 4e-4 * points[:, 2]
    u[:, 2] = 7e-4 * points[:, across] + 2e-3 * points[:, 2]
    strain, exact = SoilCells(replace(grid, nodes=replace(grid.nodes, points=points))).strain(u.ravel()), np.zeros(6)
    exact[[across, 2, 4 + across]] = 1e-3, 2e-3, 3e-4 / np.sqrt(2.0)
    np.testing.assert_allclose(strain, np.broadcast_to(exact, strain.shape), atol=1e-15)


@ALONG
def test_the_top_is_one_level_surface_seen_from_above(along: int) -> None:
    top = soil_of(along).surface
    a, b, c, d = np.moveaxis(top.points[top.facets], 1, 0)
    area = 0.5 * np.cross(c - a, d - b)
    assert (area[:, 2] > 0.0).all()
    assert area[:, 2].sum() == pytest.approx(4.0, rel=1e-12)
    assert not area[:, :2].any()
    nodes = top.global_index.reshape(6, -1)  # of four slices
    np.testing.assert_array_equal(nodes[[0, -1]], nodes[[1, -2]])
    assert len(np.unique(nodes)) == nodes[:4].size


@ALONG
def test_slices_answer_alone_and_not_along_the_riser(along: int) -> None:
    """A force on one of them moves no other one."""
    soil = soil_of(along)
    K = assemble(soil, State.at_rest(0.0, soil.field.size))
    which = np.repeat(np.round(soil.grid.nodes.points[:, along] * 2.0), 3)
    apart = which[:, None] != which[None]
    assert not K[apart].any()
    assert soil.field.prescribed.reshape(-1, 3)[:, along].all()
    assert not soil.field.prescribed.reshape(-1, 3)[:, 2].all()


def test_a_riser_askew_has_no_sections() -> None:
    with pytest.raises(MeshError, match="along x or y"):
        slice_grid(MPI.COMM_SELF, BlockSpec((0.0, 2.0), (-1.0, 1.0), 1.0, 0.25, 0.5, riser=((0.0, 0.0), (2.0, 0.5))))


@pytest.mark.parametrize(
    ("kind", "strain"),
    [
        *(("von-mises", "small"), ("kinematic-hardening", "large")),
        pytest.param("von-mises", "large", marks=pytest.mark.verify),
        pytest.param("kinematic-hardening", "small", marks=pytest.mark.verify),
    ],
)
def test_one_section_is_a_slice_of_one_cell(kind: str, strain: str) -> None:
    """Pressed in by D/12, on new meshes at large strain; where cells come to touch round-off is magnified, and their
    gradients are made anew from a strain of 1e-4 on.
    """
    law = CLAY | {"kind": kind}
    scenes = [sinking(6, 1.0 / 12.0, 10, law, strain=strain, model=model) for model in ("block", "sections")]
    runs = [sink(scene | {"solver": {"load_steps": 10, "tolerance": 1e-11}}) for scene in scenes]
    np.testing.assert_allclose(runs[1].V, runs[0].V, rtol=2e-4)
    assert runs[0].renewals == runs[1].renewals
    assert (runs[0].renewals > 0) == (strain == "large")
