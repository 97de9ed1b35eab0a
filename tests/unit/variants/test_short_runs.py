"""Short runs that leave kernels compiled: of scenes, and of the drafts."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from riser_soil.commands.app import app
from riser_soil.drafts.every_kind import drafted
from riser_soil.drafts.wishes import KINDS
from riser_soil.scene.reader import read_scene
from riser_soil.scene.stages import DynamicStage, QuasiStaticStage, StaticStage
from riser_soil.variants.short_runs import compile_kernels, shortened
from tests.support.on_ranks import ROOT

FIRST = ROOT / "demos/first_scene.yaml"


def test_time_stages_are_two_steps_long() -> None:
    scene = read_scene(FIRST)
    slow = QuasiStaticStage(name="slow", kind="quasi-static", duration=1e4, time_step=0.1)
    scene = scene.model_copy(update={"stages": (*scene.stages, slow)})
    for before, after in zip(scene.stages, shortened(scene).stages, strict=True):
        if isinstance(before, StaticStage):
            assert after == before
        else:
            assert isinstance(before.time_step, float)
            assert after == before.model_copy(update={"duration": 2.0 * before.time_step})
    assert {type(stage) for stage in scene.stages} == {StaticStage, QuasiStaticStage, DynamicStage}


def test_scenes_are_run_by_their_names_and_leave_no_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    scene = read_scene(FIRST)
    results = list(compile_kernels({"a/b.yaml": scene, "c": scene}, jobs=2))
    assert sorted(outcome.name for outcome in results) == ["a/b.yaml", "c"]
    assert all(outcome.done for outcome in results)
    assert not list(tmp_path.iterdir())


def test_there_is_a_draft_of_each_kind() -> None:
    assert drafted().keys() == KINDS.keys()


def test_the_command_says_what_it_refuses(tmp_path: Path) -> None:
    none = tmp_path / "none.yaml"
    assert "--jobs 0: must be 1 or more" in refused("compile", str(FIRST), "--jobs", "0")
    assert f"{none}: there is no such file" in refused("compile", str(none))


def refused(*arguments: str) -> str:
    """What the command prints as it ends for bad input."""
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 2
    return done.output
