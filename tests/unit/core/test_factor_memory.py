"""Factorisations that find too little room get more; those that find no memory end the run in plain words."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI
from typer.testing import CliRunner

from riser_soil.__main__ import app
from riser_soil.assembly import build
from riser_soil.core import factor_memory
from riser_soil.core.arrays import Array
from riser_soil.core.factor_memory import Workspace
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.errors import MemoryShortageError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve import direct_solver, tangent_solver
from riser_soil.stages import LayingCounter, run_stage
from tests.support.said import line_with
from tests.support.scenes import LAY, Mapping, touchdown


def on_fine_soil() -> Mapping:
    """Enough of it that MUMPS does not work in the least memory that it takes."""
    scene = touchdown(LAY, su=1000.0, tolerance=1e-10)
    scene["soil"]["mesh"] = {"kind": "hex", "size_at_riser": 0.25, "size_far": 0.5}
    return scene


def laid() -> Array:
    """Increments since the start of all that a riser laid on soil has moved."""
    assembly = build(scene_from_mapping(on_fine_soil()), MPI.COMM_SELF)
    start = State.at_rest(0.0, assembly.size)
    run_stage(assembly, assembly.scene.stages[0], start, LayingCounter(), Timer.new())
    assert assembly.soil is not None
    return assembly.soil.whole.field.total.copy()


@pytest.mark.parametrize("place", [tangent_solver, pytest.param(direct_solver, marks=pytest.mark.verify)])
def test_too_little_workspace_grows_and_the_step_is_the_same(place: object, monkeypatch: pytest.MonkeyPatch) -> None:
    """Room below nothing is less than what MUMPS has foretold."""
    expected, rooms = laid(), []

    def tight() -> Workspace:
        rooms.append(Workspace(-90))
        return rooms[-1]

    monkeypatch.setattr(place, "Workspace", tight)
    np.testing.assert_allclose(laid(), expected, rtol=0.0, atol=1e-7 * np.abs(expected).max())
    assert 60 <= max(workspace.percent for workspace in rooms) < 960


def test_workspace_doubles_up_to_ten_times_what_is_foretold(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(factor_memory, "_said", lambda pc: (-9, 1))  # too little room
    monkeypatch.setattr(factor_memory, "_too_little", lambda *reported: "none left")
    workspace = Workspace()
    assert [workspace.percent for _ in range(4) if workspace.grows_after(None)] == [120, 240, 480, 960]
    with pytest.raises(MemoryShortageError, match="none left"):
        workspace.grows_after(None)


def test_a_run_without_memory_ends_in_plain_words(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """MUMPS is forbidden more than a megabyte (control 23)."""
    monkeypatch.setattr(Workspace, "controls", property(lambda workspace: {23: 1}))
    (tmp_path / "scene.yaml").write_text(json.dumps(on_fine_soil()), encoding="utf-8")
    done = CliRunner().invoke(app, ["run", str(tmp_path / "scene.yaml"), "-o", str(tmp_path / "out")])
    assert done.exit_code == 3
    (line,) = done.stderr.strip().splitlines()
    assert re.search(r"\d unknowns .*out of memory: .* \d", line)
    line_with([line], "INFOG(1) = -19", "larger cells", "smaller block")
