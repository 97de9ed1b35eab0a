"""Mesh quality against cells whose ratios are known, and what `check` says of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.checks.check import describe
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.soil.block import BlockSpec
from riser_soil.soil.grid import DistributedMesh, block_grid
from riser_soil.soil.quality import MeshQuality, quality_of
from tests.support.mesh_drawings import LEFT, RIGHT, Drawing, msh
from tests.support.said import line_with
from tests.support.scenes import touchdown

CUBE = np.array([[i, j, k] for k in (0.0, 1.0) for j in (0.0, 1.0) for i in (0.0, 1.0)])
REGULAR = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]])


def of_one(corners: Any) -> MeshQuality:
    """Quality of a mesh of this cell alone."""
    kind: Any = "tet" if len(corners) == 4 else "hex"
    grid = block_grid(MPI.COMM_SELF, BlockSpec((0.0, 1.0), (0.0, 1.0), 1.0, 1.0, 1.0, kind=kind))
    return quality_of(with_cell(grid, np.asarray(corners)))


def with_cell(grid: DistributedMesh, corners: Any) -> DistributedMesh:
    cells = np.zeros((1, grid.nodes.cells.shape[1]), dtype=np.int64)
    cells[0, : len(corners)] = np.arange(len(corners))
    return replace(grid, nodes=replace(grid.nodes, points=corners, cells=cells))


def test_best_cells_have_ones() -> None:
    for corners in (CUBE, REGULAR, CUBE[::-1], REGULAR[::-1]):
        quality = of_one(corners)
        assert [quality.aspect, quality.jacobian] == pytest.approx([1.0, 1.0])
        assert quality.poor == 0
    assert of_one(3.0 * CUBE).smallest == of_one(3.0 * CUBE).largest == pytest.approx(3.0)


def test_stretched_and_sheared_hexahedra() -> None:
    assert of_one(CUBE * [20.0, 1.0, 1.0]).aspect == pytest.approx(20.0)
    assert of_one(CUBE * [20.0, 1.0, 1.0]).jacobian == pytest.approx(1.0)
    sheared = CUBE + np.outer(CUBE[:, 2], [1.0, 0.0, 0.0])
    assert of_one(sheared).jacobian == pytest.approx(np.sqrt(0.5))
    inverted = CUBE.copy()
    inverted[7] = [0.2, 0.2, 0.2]
    assert of_one(inverted).jacobian < 0.0
    assert of_one(inverted).poor == 1


def test_flat_tetrahedra() -> None:
    """A corner of a cube, of height h: inscribed radius 3V/A, longest edge √2."""
    h = 0.01
    corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, h]]
    area = 0.5 + h + np.sqrt(0.25 + 0.5 * h * h)
    quality = of_one(corners)
    assert quality.aspect == pytest.approx(np.sqrt(2.0) / (2.0 * np.sqrt(6.0) * 0.5 * h / area), rel=1e-12)
    assert quality.jacobian == pytest.approx(np.sqrt(2.0) * h / np.sqrt(2.0) / np.sqrt(1.0 + h * h), rel=1e-12)


def report(scene: dict[str, Any], folder: Path = Path()) -> str:
    return describe(scene_from_mapping(scene, folder))


def test_check_tells_the_quality() -> None:
    scene = touchdown()
    scene["soil"]["block"]["y"] = [-1.25, 1.25]
    scene["soil"]["mesh"] = {"kind": "hex", "size_at_riser": 0.5, "size_far": 0.5}
    line = "soil mesh: edges of 0.5 to 0.5 m, aspect ratios up to 1, scaled Jacobians from 1 (1 is best)"
    assert line in report(scene)


def drawn(folder: Path, *boxes: Any, **soil: Any) -> dict[str, Any]:
    """A scene on boxes of soil, one cell each."""
    (folder / "mesh.msh").write_text(msh(Drawing(*boxes)))
    scene = touchdown()
    scene["soil"] = {key: value for key, value in scene["soil"].items() if key != "block"}
    scene["soil"] |= {"mesh": {"file": "mesh.msh"}, **soil}
    return scene


def test_check_warns_of_long_cells(tmp_path: Path) -> None:
    text = report(drawn(tmp_path, (4.0, 9.0, -1.0, 1.0, -1.0, 0.0), (9.0, 9.0004, -1.0, 1.0, -1.0, 0.0)), tmp_path)
    line_with(text, "warning:", "soil mesh:", "(9, 0, -0.5) m", "aspect ratio of 5e+03", "above 1000")


def test_check_tells_where_layers_meet(tmp_path: Path) -> None:
    law = touchdown()["soil"]["law"]
    layers = {"layers": [{"to": 0.3, "law": law}, {"law": law}], "law": None}
    across = report(drawn(tmp_path, LEFT, RIGHT, **layers), tmp_path)
    line_with(across, "soil layers meet", "0.3 m", "2 cells lie across")
    block = touchdown()
    block["soil"] |= layers
    line_with(report(block), "soil layers meet", "0.3 m", "cells end there")
