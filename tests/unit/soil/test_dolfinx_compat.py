"""What the rest of the package expects of dolfinx_compat, whatever the version of dolfinx."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import dolfinx
import gmsh
import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core import compiled
from riser_soil.soil import dolfinx_compat
from riser_soil.soil.block import BlockSpec, make_block
from riser_soil.soil.dolfinx_compat import Nodes
from riser_soil.soil.grid import silent_gmsh
from tests.support.on_ranks import HANGS

COMPILES = dolfinx.__version__.startswith("0.5.")  # code that numbers nodes; later versions need no compiler for it
REFERENCE_EDGES = {4: (2, 3), 5: (1, 3), 6: (1, 2), 7: (0, 3), 8: (0, 2), 9: (0, 1)}


def nodes_of(kind: str, degree: int) -> Nodes:
    with silent_gmsh():
        unit = make_block(BlockSpec((0.0, 2.0), (0.0, 1.0), 1.0, 0.5, 0.5, kind="tet" if kind == "tet" else "hex"))
        mesh, group = dolfinx_compat.mesh_from_gmsh(gmsh.model, MPI.COMM_SELF, unit)
    assert group.size > 0
    assert np.all(group == 1)
    return dolfinx_compat.lagrange_nodes(mesh, degree, MPI.COMM_SELF)


@pytest.mark.parametrize(("kind", "degree", "count"), [("hex", 1, 8), ("tet", 1, 4), ("tet", 2, 10)])
def test_tables_have_plain_arrays(kind: str, degree: int, count: int) -> None:
    nodes = nodes_of(kind, degree)
    assert nodes.cells.shape[1] == count
    assert nodes.cells.dtype == nodes.number.dtype == np.int64
    assert nodes.points.shape == (nodes.owned, 3)
    np.testing.assert_array_equal(np.sort(nodes.number), np.arange(nodes.owned))
    np.testing.assert_array_equal(np.unique(nodes.cells), np.arange(nodes.owned))
    np.testing.assert_allclose(nodes.points.min(axis=0), [0.0, 0.0, -1.0], atol=1e-12)
    np.testing.assert_allclose(nodes.points.max(axis=0), [2.0, 1.0, 0.0], atol=1e-12)


def test_vertices_of_a_hexahedron_are_lexicographic() -> None:
    nodes = nodes_of("hex", 1)
    p = nodes.points[nodes.cells]
    for a, b, c, d in ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 4, 5), (0, 2, 4, 6)):
        np.testing.assert_allclose(p[:, b] - p[:, a], p[:, d] - p[:, c], atol=1e-12)


def test_nodes_of_a_quadratic_tetrahedron_are_vertices_then_edges() -> None:
    nodes = nodes_of("tet", 2)
    p = nodes.points[nodes.cells]
    for place, (a, b) in REFERENCE_EDGES.items():
        np.testing.assert_allclose(p[:, place], 0.5 * (p[:, a] + p[:, b]), atol=1e-12)


def test_stale_locks_are_removed_and_fresh_ones_kept(tmp_path: Path) -> None:
    """A killed compilation leaves a source without its `cached` mark; another job may compile now."""
    old, done, fresh = (tmp_path / f"libffcx_elements_{name}.c" for name in ("old", "done", "fresh"))
    for file in (old, done, fresh):
        file.touch()
    done.with_suffix(".c.cached").touch()
    for file in (old, done):
        os.utime(file, times=(time.time() - 1e4,) * 2)
    dolfinx_compat.remove_stale_locks(MPI.COMM_SELF, tmp_path)
    assert [f.exists() for f in (old, done, fresh)] == [False, True, True]


def test_a_cache_that_cannot_be_written_is_replaced_and_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setattr(dolfinx_compat, "jit_cache", lambda: tmp_path / "file" / "fenics")
    monkeypatch.setattr(compiled, "FOLDER", tmp_path / "kernels")
    assert nodes_of("hex", 1).owned == 5 * 3 * 3
    assert bool(list((tmp_path / "kernels" / "fenics").glob("libffcx_*.so"))) == COMPILES
    (line,) = capfd.readouterr().err.splitlines()
    assert str(tmp_path / "file") in line
    assert line.endswith(f"{tmp_path / 'kernels' / 'fenics'} is used")


def test_first_compilation_is_silent(tmp_path: Path) -> None:
    """In a process of its own, with an empty cache: 0.5 logs each compiler command unless told not to."""
    code = (
        "from mpi4py import MPI; from riser_soil.soil.block import BlockSpec\n"
        "from riser_soil.soil.grid import block_grid\n"
        "block_grid(MPI.COMM_SELF, BlockSpec((0.0, 1.0), (0.0, 1.0), 1.0, 1.0, 1.0))"
    )
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path), "HOME": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=HANGS)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert bool(list(tmp_path.rglob("libffcx_*.so"))) == COMPILES
