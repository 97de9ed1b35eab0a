"""New meshes of cells in no order: what is undisturbed stays, what is drawn aside comes back, volume is kept."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.soil.block import BlockSpec
from riser_soil.soil.families import point_volumes
from riser_soil.soil.field import gather, top_of
from riser_soil.soil.grid import block_grid
from riser_soil.soil.harmonic_mesh import HarmonicMesh
from riser_soil.soil.kernels import write_largest_strains
from riser_soil.soil.seabed_feature import TrenchSpec
from riser_soil.soil.sections import Pressing

FAR = Pressing(gaps=lambda points: np.full(len(points), 9.0), brought_to=lambda points, _: points, clear=0.01)
TRENCH = TrenchSpec(0.4, 0.5, 0.4, (2.0, 3.5), 1.0)


def mesh_of(kind: Any, **more: Any) -> HarmonicMesh:
    grid = block_grid(
        MPI.COMM_SELF, BlockSpec((0.0, 4.0), (-1.5, 1.5), 1.2, 0.25, 0.6, 1.0, kind, ((0.0, 0.0), (9.0, 0.0)), **more)
    )
    gathered = gather(grid)
    return HarmonicMesh.of(grid, gathered, top_of(grid, gathered, moves=True))


def volume(mesh: HarmonicMesh, points: Array) -> float:
    return float(point_volumes(mesh.family, points, mesh.cells).sum())


def strain(mesh: HarmonicMesh, points: Array) -> float:
    """Largest since the mesh was made."""
    out = np.empty(len(mesh.cells))
    write_largest_strains(mesh.first[mesh.cells], points, mesh.cells, out)
    return float(out.max())


def within(mesh: HarmonicMesh, radius: float) -> BoolArray:
    """Nodes so near to the middle of the top."""
    middle = np.array([2.0, 0.0, mesh.first[:, 2].max()])
    return np.asarray(np.linalg.norm(mesh.first - middle, axis=1) < radius)


@pytest.mark.parametrize(("kind", "more"), [("tet", {}), ("tet", {"feature": TRENCH}), ("hex", {})])
def test_what_is_undisturbed_stays(kind: Any, more: Any) -> None:
    """A trench with its slopes included."""
    mesh = mesh_of(kind, **more)
    renewed, made = mesh.renewed(mesh.first, within(mesh, 0.8), FAR)
    assert made.sum() > within(mesh, 0.8).sum()
    np.testing.assert_allclose(renewed, mesh.first, atol=1e-12)


def drawn(mesh: HarmonicMesh, size: float) -> Array:
    """Nodes near the middle of the top drawn along it and down, the way falling off to nothing at 0.8 m."""
    x = mesh.first - np.array([2.0, 0.0, mesh.first[:, 2].max()])
    share = np.clip(1.0 - np.einsum("ni,ni->n", x, x) / 0.8**2, 0.0, None) ** 2
    return np.asarray(mesh.first + size * share[:, None] * np.array([1.0, 0.6, -0.5]))


@pytest.mark.parametrize("kind", ["tet", "hex"])
def test_nodes_that_were_drawn_aside_come_back(kind: Any) -> None:
    """Cells come back to nearly what they were; the surface keeps the volume below it, the rest its nodes."""
    mesh = mesh_of(kind)
    points = drawn(mesh, 0.3)
    renewed, made = mesh.renewed(points, within(mesh, 0.8), FAR)
    assert strain(mesh, renewed) < 0.5 * strain(mesh, points)
    assert volume(mesh, renewed) == pytest.approx(volume(mesh, points), rel=2.5e-5)
    np.testing.assert_array_equal(renewed[~made], points[~made])
    aside = np.abs(renewed - mesh.first)[made, :2].max()
    assert aside < 0.25 * np.abs(points - mesh.first)[made, :2].max()


def test_a_side_stays_plane() -> None:
    mesh = mesh_of("tet")
    side = mesh.first[:, 1] > 1.5 - 1e-9
    points = mesh.first + 0.05 * np.sin(3.0 * mesh.first[:, :1]) * ~mesh.fixed
    renewed, _ = mesh.renewed(points, side, FAR)
    np.testing.assert_array_equal(renewed[side, 1], mesh.first[side, 1])
    assert np.abs(renewed[side] - points[side]).max() > 0.005


def test_nodes_at_the_pipe_keep_their_gap_and_are_not_raised() -> None:
    """The pipe here is a plane above the soil, and touches what is nearer to it than 0.1 m."""
    mesh = mesh_of("tet")
    points, level = drawn(mesh, 0.3), mesh.first[:, 2].max()
    asked = []

    def brought_to(at: Array, gaps: Array) -> Array:
        asked.append(gaps)
        return np.column_stack([at[:, :2], np.where(gaps < 0.1, level - gaps, at[:, 2])])

    plane = Pressing(gaps=lambda at: level - at[:, 2], brought_to=brought_to, clear=0.1)
    renewed, made = mesh.renewed(points, within(mesh, 0.8), plane)
    top = np.zeros(len(points), dtype=bool)
    top[mesh.facets] = True
    pressed = asked[0] < 0.1
    np.testing.assert_allclose(level - renewed[made & top, 2][pressed], asked[0][pressed], atol=1e-12)
    assert 0 < pressed.sum() < pressed.size


def test_a_mesh_that_would_fold_is_kept() -> None:
    mesh = mesh_of("tet")
    points = drawn(mesh, 0.3)
    below = FAR._replace(brought_to=lambda at, _: at - np.array([0.0, 0.0, 0.4]))
    renewed, made = mesh.renewed(points, within(mesh, 0.8), below)
    assert not made.any()
    np.testing.assert_array_equal(renewed, points)
