"""Mesh files as gmsh and others write them: what is accepted as it is meant, and what is refused in one line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.errors import MeshError
from riser_soil.soil.grid import DistributedMesh, file_grid
from tests.support.mesh_drawings import LEFT, RIGHT, Drawing, msh

COMM = MPI.COMM_SELF


def read(folder: Path, text: str) -> DistributedMesh:
    (folder / "mesh.msh").write_text(text)
    return file_grid(COMM, folder / "mesh.msh")


def twice(drawing: Drawing) -> Drawing:
    drawing.cells += [[*cell] for cell in drawing.cells]
    return drawing


ACCEPTED = {
    "as it is": msh(Drawing(LEFT, RIGHT)),
    "numbers with gaps": msh(Drawing(LEFT, RIGHT), lambda n: 7 * n + 100),
    "numbers downwards": msh(Drawing(LEFT, RIGHT), lambda n: 900 - n),
    "a node that no cell has": msh(Drawing(LEFT, RIGHT), extra=("500 9.0 9.0 9.0",)),
    "cells listed twice": msh(twice(Drawing(LEFT, RIGHT))),
}


@pytest.mark.parametrize("name", ACCEPTED)
def test_two_boxes_however_they_are_numbered(name: str, tmp_path: Path) -> None:
    grid = read(tmp_path, ACCEPTED[name])
    assert len(grid.nodes.cells) == 2
    points = np.round(grid.nodes.points, 12) + 0.0
    assert sorted((x, y, z) for x, y, z in points) == sorted(Drawing(LEFT, RIGHT).points)
    volumes = np.ptp(grid.nodes.points[grid.nodes.cells], axis=1).prod(axis=1)
    np.testing.assert_allclose(volumes, 1.0, rtol=1e-14)


HALF, QUARTER = (1.0, 1.5, 0.0, 1.0, -1.0, -0.5), (1.5, 2.0, 0.0, 1.0, -1.0, -0.5)
LOW, HIGH, ABOVE = (0.0, 1.0, 0.0, 1.0, -1.0, -0.5), (0.0, 1.0, 0.0, 1.0, -0.5, 0.0), (1.0, 2.0, 0.0, 1.0, -0.5, 0.0)
REFUSED = {
    "nodes that share a place": (Drawing(LEFT, RIGHT).torn(1.0), "4 pairs of nodes share a place, one at (1, "),
    "boxes apart": (Drawing(LEFT, (3.0, 4.0, 0.0, 1.0, -1.0, 0.0)), "in 2 pieces that no face joins, one at (3.5"),
    "three at a face": (Drawing(LEFT, RIGHT, (1.0, 3.0, 0.0, 1.0, -1.0, 0.0)), "3 cells share the face at (1, 0.5, "),
    "a hanging node": (Drawing(LOW, HIGH, ABOVE, HALF, QUARTER), "2 nodes lie within faces that they don't belong to"),
    "a far node": (Drawing(LEFT, (1.0, 1e300, 0.0, 1.0, -1.0, 0.0)), "a node lies 1e+300 m off"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_would_be_another_soil_is_refused_with_its_place(name: str, tmp_path: Path) -> None:
    drawing, says = REFUSED[name]
    with pytest.raises(MeshError) as caught:
        read(tmp_path, msh(drawing))
    assert str(caught.value).startswith("soil mesh: ")
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


def test_files_cut_short_are_refused_in_one_line(tmp_path: Path) -> None:
    text = ACCEPTED["as it is"]
    for length in (100, len(text) // 2, len(text) - 40):
        with pytest.raises(MeshError, match=r"^soil mesh .*mesh\.msh: ") as caught:
            read(tmp_path, text[:length])
        assert "\n" not in str(caught.value)


def test_a_node_that_is_not_there_is_reported(tmp_path: Path) -> None:
    with pytest.raises(MeshError, match=r"Wrong node index 99"):
        read(tmp_path, ACCEPTED["as it is"].replace("2 5 2 1 1 2 ", "2 5 2 1 1 99 "))
