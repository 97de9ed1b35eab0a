"""Runs that go on from their checkpoint, or begin with another run's end; what they refuse."""

from __future__ import annotations

import json
import re
import signal
from dataclasses import replace
from functools import cache
from pathlib import Path
from shutil import copytree
from typing import Any, NamedTuple

import numpy as np
import pytest
from typer.testing import CliRunner

from riser_soil import __version__
from riser_soil.__main__ import app
from riser_soil.assembly import Assembly
from riser_soil.core.saved_state import packed, unpacked
from riser_soil.errors import Interruption, ResultsError, SceneError, WriteError
from riser_soil.results import folder as run_folder
from riser_soil.results import record
from riser_soil.results.checkpoint import CheckpointSchedule
from riser_soil.results.checkpoint_file import FORMAT, About, read_checkpoint, write_checkpoint
from riser_soil.results.observer import Observer
from riser_soil.results.peaks import RunPeaks
from riser_soil.results.read import Run
from riser_soil.scene.identity import first_difference, identity_of
from riser_soil.scene.output import Checkpoint
from riser_soil.scene.reader import read_scene
from riser_soil.scene.scene import Scene
from riser_soil.whole_run import run
from tests.support.equal_runs import unlike
from tests.support.left_run import leave_after
from tests.support.said import line_with, telling

ROOT = Path(__file__).parents[3]
ALL_KINDS = (  # seabed with memory, friction, waves, steps found on the way
    "stages.1.duration=0.6",
    "stages.1.time_step=auto",
    "output.interval=0.2",
    "water.surface_level=95.0",
    "water.waves={airy: {height: 2.0, period: 6.0}, ramp: 0.5}",
)
WAY = "t [s], x [m], y [m], z [m]\n0, 0, 0, 0\n1, 0, 0, 0\n2, 0, 0, 0\n3, 0, 0, {}\n"


@cache
def scene_of(*overrides: str) -> Scene:
    return read_scene(ROOT / "tests/scenes/hysteretic.yaml", (*ALL_KINDS, *overrides))


class Alone(NamedTuple):
    """The run that nothing ended before its time."""

    folder: Path
    peaks: RunPeaks


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Alone:
    made = Alone(tmp_path_factory.mktemp("alone"), RunPeaks())
    run(scene_of(), made.folder, peaks=made.peaks)
    return made


def test_a_run_left_twice_ends_as_if_it_had_not_been_left(alone: Alone, tmp_path: Path) -> None:
    """Files, extremes, ledger; peaks, which error bars are told of."""
    folder, peaks = tmp_path / "left", RunPeaks()
    assert not (alone.folder / "checkpoint.npz").exists()
    end = leave_after(3, scene_of(), folder, RunPeaks())
    assert re.match(r"in stage heave[^;]*=\s\d", end.place)
    assert end.place.endswith(f"riser-soil run {folder}/scene.yaml -o {folder} --restart")
    assert len(unlike(alone.folder, folder)) > 10, "otherwise nothing is compared"
    leave_after(2, read_scene(folder / "scene.yaml"), folder, RunPeaks(), restart=True)
    run(scene_of(), folder, peaks=peaks, restart=True)
    assert unlike(alone.folder, folder) == []
    assert json.dumps(peaks.as_summary("smooth")) == json.dumps(alone.peaks.as_summary("smooth"))
    assert not (folder / "checkpoint.npz").exists()


def test_a_run_begins_with_another_ones_end(tmp_path: Path) -> None:
    whole = scene_of("output.checkpoint.keep=true")
    run(whole, tmp_path / "whole")
    run(whole.model_copy(update={"stages": whole.stages[:1]}), tmp_path / "lay")
    data = f"initial={{from: {tmp_path / 'lay'}}}"
    heave = scene_of(data)
    run(heave.model_copy(update={"stages": heave.stages[1:]}), tmp_path / "heave")
    one, other = (json.loads((tmp_path / name / "summary.json").read_text())["stages"] for name in ("whole", "heave"))
    assert one[1]["final"] == other[0]["final"]
    assert one[1]["extremes"] == other[0]["extremes"]
    assert one[1]["energy"] == other[0]["energy"]
    stiffer = scene_of(data, "line_types.flexible.EI=6.0e4")
    with pytest.raises(SceneError, match=telling("line_types.flexible.EI", "was 50000.0", "is 60000.0")):
        run(stiffer, tmp_path / "stiffer")
    assert not (tmp_path / "stiffer").exists()
    with pytest.raises(SceneError, match=telling("last stage", '"heave"', "dynamic")):
        run(scene_of(f"initial={{from: {tmp_path / 'whole'}}}"), tmp_path / "from motion")
    kept = read_checkpoint(tmp_path / "lay/checkpoint.npz")
    write_checkpoint(tmp_path / "lay/checkpoint.npz", replace(kept.about, ended=None), kept.shares)
    with pytest.raises(SceneError, match=telling("initial.from:", "has not kept")):
        run(heave, tmp_path / "from the way")


def test_a_current_is_there_in_full_after_another_run(tmp_path: Path) -> None:
    """At rest in it nothing moves any more: no load step has anything to solve."""
    current = "water.current={profile: [[0.0, 0.3, 0.0], [100.0, 0.6, 0.0]]}"
    scene = scene_of(current, "output.checkpoint.keep=true", "solver.load_steps=3")
    hang = scene.model_copy(update={"stages": scene.stages[:1]})
    run(hang, tmp_path / "hang")
    again = scene_of(current, "solver.load_steps=3", f"initial={{from: {tmp_path / 'hang'}}}")
    run(again.model_copy(update={"stages": again.stages[:1]}), tmp_path / "again")
    before, after = (Run(tmp_path / name) for name in ("hang", "again"))
    assert np.abs(after["position"][-1] - before["position"][-1]).max() < 1e-6
    (stage,) = after.summary["stages"]
    assert stage["newton_iterations"] <= stage["steps"]


@pytest.fixture(scope="module")
def left_once(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("left")
    leave_after(3, scene_of(), folder)
    return folder


@pytest.fixture
def left_run(left_once: Path, tmp_path: Path) -> Path:
    """A run that was left on its way."""
    return Path(copytree(left_once, tmp_path / "left"))


@pytest.fixture
def checkpoint(tmp_path: Path) -> Path:
    """A checkpoint of a run that has not begun."""
    path = tmp_path / run_folder.CHECKPOINT
    write_checkpoint(path, About(__version__, 1, identity_of(scene_of())), [{"stepper/before/u": np.arange(3.0)}])
    return path


def test_a_checkpoint_holds_what_was_written(checkpoint: Path) -> None:
    saved = read_checkpoint(checkpoint)
    assert saved.about.ranks == 1
    np.testing.assert_array_equal(saved.shares[0]["stepper/before/u"], np.arange(3.0))
    assert sorted(path.name for path in checkpoint.parent.iterdir()) == [".riser_soil", "checkpoint.npz"]


REFUSED = {
    "line_types.flexible.EI=6.0e4": ("line_types.flexible.EI", "was 50000.0", "is 60000.0"),
    "stages.1.duration=2.0": ("stages.1.duration", "was 0.6", "is 2.0"),
    "stages.1.name=surge": ("stages.1.name", 'was "heave"', 'is "surge"'),
    "seabed={kind: spring, stiffness: 1.0e5}": ("seabed.kind", 'was "hysteretic"', 'is "spring"'),
}


@pytest.mark.parametrize("override", REFUSED)
def test_a_checkpoint_of_another_scene_is_refused(override: str, checkpoint: Path) -> None:
    with pytest.raises(SceneError, match=telling(*REFUSED[override])):
        run(scene_of(override), checkpoint.parent, restart=True)
    assert checkpoint.exists()


def test_a_run_that_can_go_on_is_not_overwritten_by_mistake(left_run: Path) -> None:
    before = {path.name: path.read_bytes() for path in left_run.iterdir()}
    choice = f"{left_run}:", "unfinished run", "--restart", "--force"
    with pytest.raises(SceneError, match=telling(*choice)):
        run(scene_of(), left_run)
    by_command = CliRunner().invoke(app, ["run", str(left_run / "scene.yaml"), "-o", str(left_run)])
    assert by_command.exit_code == 2
    line_with(by_command.stderr, *choice)
    assert {path.name: path.read_bytes() for path in left_run.iterdir()} == before
    run(scene_of(), left_run, force=True)
    assert run_folder.is_finished(left_run)


@pytest.mark.parametrize(
    ("about", "says"),
    [
        ({"version": "0.0.9"}, ("riser_soil 0.0.9", f"this is {__version__}")),
        ({"ranks": 4}, ("4 rank(s)", "these are 1")),
        ({"format": 0}, ("format 0", f"reads {FORMAT}")),
    ],
)
def test_a_checkpoint_of_another_kind_is_refused(
    about: dict[str, object], says: tuple[str, ...], checkpoint: Path
) -> None:
    with np.load(checkpoint) as file:
        arrays = dict(file)
    arrays["about"] = packed(unpacked(arrays["about"]) | about)
    np.savez(checkpoint, **arrays)
    with pytest.raises((SceneError, ResultsError), match=telling(*says)):
        run(scene_of(), checkpoint.parent, restart=True)


def test_a_damaged_checkpoint_is_refused(checkpoint: Path) -> None:
    content = bytearray(checkpoint.read_bytes())
    content[content.index(np.arange(3.0).tobytes())] ^= 1
    checkpoint.write_bytes(content)
    with pytest.raises(ResultsError, match="not a whole checkpoint"):
        run(scene_of(), checkpoint.parent, restart=True)


def test_error_bars_can_not_begin_on_the_way(checkpoint: Path) -> None:
    with pytest.raises(SceneError, match="begun without error bars"):
        run(scene_of(), checkpoint.parent, peaks=RunPeaks(), restart=True)


def test_results_that_lack_what_they_had_are_refused(left_run: Path) -> None:
    """Another run's files, for instance, that somebody has put beside the checkpoint."""
    leave_after(1, scene_of(), left_run / "shorter")
    (left_run / "shorter" / "results.nc").replace(left_run / "results.nc")
    with pytest.raises(ResultsError, match=telling("results.nc:", "lacks records")):
        run(scene_of(), left_run, restart=True)


@pytest.mark.parametrize("name", ["results.nc", "riser.vtkhdf", "riser.xdmf"])
def test_a_run_whose_file_has_gone_is_refused(name: str, left_run: Path) -> None:
    (left_run / name).unlink()
    with pytest.raises(ResultsError, match=telling(f"{name}:", "lacks records", "begin anew")):
        run(scene_of(), left_run, restart=True)


def test_xml_that_is_cut_off_is_refused(left_run: Path) -> None:
    """The file's last frame is begun and has no end: what followed would stand within it."""
    content = (left_run / "riser.xdmf").read_bytes()
    (left_run / "riser.xdmf").write_bytes(content[: content.rindex(b"<Grid Name") + 30])
    with pytest.raises(ResultsError, match=r"riser\.xdmf: lacks records"):
        run(scene_of(), left_run, restart=True)


@pytest.mark.parametrize("name", ["results.nc", "riser.vtkhdf"])
def test_a_run_with_a_damaged_file_is_refused(name: str, left_run: Path) -> None:
    """The file's head is whole, so that it is taken for its writer's; what its groups hold can't be read."""
    content = (left_run / name).read_bytes()
    (left_run / name).write_bytes(content.replace(b"TREE", b"EERT"))
    with pytest.raises(ResultsError, match=telling(f"{name}:", "damaged", "begin anew", "--force")):
        run(scene_of(), left_run, restart=True)


def test_a_run_that_is_ended_before_it_went_on_stays_as_it_was(left_run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = {path.name: path.read_bytes() for path in left_run.iterdir()}
    monkeypatch.setattr(Assembly, "resume", lambda self: signal.raise_signal(signal.SIGTERM))
    with pytest.raises(Interruption) as end:
        run(scene_of(), left_run, restart=True)
    line_with(str(end.value), "SIGTERM", "before it went on", f"{left_run} is as it was", "riser-soil")
    assert {path.name: path.read_bytes() for path in left_run.iterdir()} == before


def test_a_file_that_changes_while_the_run_lasts_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The checkpoint is of the file that the run has read."""
    way, usual = tmp_path / "way.csv", Observer.begin_stage

    def begin_stage(self: Observer, *arguments: Any) -> None:
        usual(self, *arguments)
        way.write_text(WAY.format("0.2"), encoding="utf-8")

    way.write_text(WAY.format("0.1"), encoding="utf-8")
    scene = scene_of(f"stages.1.motion={{end: {{table: {{file: {way}}}}}}}")
    with monkeypatch.context() as patch:
        patch.setattr(Observer, "begin_stage", begin_stage)
        leave_after(3, scene, tmp_path / "out")
    with pytest.raises(SceneError, match=telling("stages.1.motion.end.table.file", "other content")):
        run(scene, tmp_path / "out", restart=True)


def test_a_full_disk_leaves_the_last_checkpoint(alone: Alone, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    often, usual, written = scene_of("output.checkpoint.every=1e-6"), record.write_checkpoint, 0

    def full(*arguments: Any) -> None:
        nonlocal written
        written += 1
        if written == 3:
            raise OSError(28, "No space left on device")
        usual(*arguments)

    with monkeypatch.context() as patch:
        patch.setattr(record, "write_checkpoint", full)
        with pytest.raises(WriteError, match=telling("riser-soil run", "--restart")):
            run(often, tmp_path)
    run(scene_of(), tmp_path, restart=True)
    assert unlike(alone.folder, tmp_path) == []


def test_what_may_differ() -> None:
    then = identity_of(scene_of())
    assert first_difference(then, identity_of(scene_of("output.checkpoint=null")), [("output", "checkpoint")]) is None
    changed = {"values": then["values"], "files": {"stages.1.motion.end.table": "a"}}
    difference = first_difference(then, changed)
    assert difference is not None
    assert difference.key == "stages.1.motion.end.table"


def test_checkpoints_are_due_by_time_at_ends_and_where_the_run_is_left() -> None:
    from mpi4py import MPI

    none = CheckpointSchedule(None, MPI.COMM_SELF)
    assert not none.due(last=True, ends_run=True, leaving=True)
    seldom = CheckpointSchedule(Checkpoint(every=1e4), MPI.COMM_SELF)
    assert not seldom.due(last=True, ends_run=True, leaving=False)
    assert seldom.due(last=False, ends_run=False, leaving=True)
    often = CheckpointSchedule(Checkpoint(every=1e-9), MPI.COMM_SELF)
    assert often.due(last=False, ends_run=False, leaving=False)
    assert not often.due(last=True, ends_run=True, leaving=False)
    assert CheckpointSchedule(Checkpoint(keep=True), MPI.COMM_SELF).due(last=True, ends_run=True, leaving=False)


def test_one_either_goes_on_or_overwrites() -> None:
    result = CliRunner().invoke(app, ["run", str(ROOT / "demos/first_scene.yaml"), "--restart", "--force"])
    assert result.exit_code == 2
    assert result.stderr == line_with(result.stderr, "--restart and --force:", "leave one out") + "\n"
