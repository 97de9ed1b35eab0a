"""Whose files are in a result folder, and who may write there."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import h5py
import pytest

from riser_soil.errors import SceneError, WriteError
from riser_soil.results.folder import CHECKPOINT, FORMER, NAMES, FolderLock
from riser_soil.results.ownership import prepare, refuse, sealed
from tests.support.recorded_run import a_recorder, block, record, step
from tests.support.said import telling

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("force", [False, True])
@pytest.mark.parametrize("name", NAMES)
def test_nothing_that_others_have_written_is_replaced(name: str, force: bool, tmp_path: Path) -> None:
    (tmp_path / name).write_text("title: mine\n")
    with pytest.raises(SceneError, match=telling(f"{name}:", "not written by riser_soil", "move it away")):
        record(tmp_path, force=force)
    assert [p.name for p in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "title: mine\n"


@pytest.mark.parametrize("name", ["results.nc", "riser.vtkhdf", "soil.vtkhdf", "riser.h5", "soil.h5"])
def test_another_program_s_hdf5_file_stays(name: str, tmp_path: Path) -> None:
    with h5py.File(tmp_path / name, "w") as file:
        file["numbers"] = [1.0]
    with pytest.raises(SceneError, match="not written by riser_soil"):
        refuse(tmp_path, force=True)


@pytest.mark.parametrize("name", NAMES)
def test_links_and_folders_stay(name: str, tmp_path: Path) -> None:
    record(tmp_path / "kept", mesh=block(4, 3, 2))
    for other in ("link", "folder"):
        (tmp_path / other).mkdir()
    (tmp_path / "link" / name).symlink_to(tmp_path / "kept" / name)
    (tmp_path / "folder" / name).mkdir()
    for other in ("link", "folder"):
        with pytest.raises(SceneError, match="not written by riser_soil"):
            refuse(tmp_path / other, force=True)


def test_all_that_a_run_leaves_is_its_own(tmp_path: Path) -> None:
    for _ in range(2):
        record(tmp_path, mesh=block(4, 3, 2), duration=0.2, force=True)
    assert {p.name for p in tmp_path.iterdir()} == {*NAMES} - {*FORMER, CHECKPOINT}


def test_a_scene_that_was_edited_in_the_folder_stays(tmp_path: Path) -> None:
    record(tmp_path, duration=0.2)
    with (tmp_path / "scene.yaml").open("a") as scene:
        scene.write("gravity: 9.8\n")
    with pytest.raises(SceneError, match=telling("scene.yaml:", "not written by riser_soil", "changed since")):
        record(tmp_path, force=True)


def test_the_scene_is_there_until_the_next_is(tmp_path: Path) -> None:
    record(tmp_path, duration=0.2)
    before = (tmp_path / "scene.yaml").read_text()
    with prepare(tmp_path, force=True):
        assert [p.name for p in tmp_path.iterdir() if p.is_file()] == ["scene.yaml"]
        assert (tmp_path / "scene.yaml").read_text() == before


def test_a_folder_of_an_earlier_version_is_known(tmp_path: Path) -> None:
    """An earlier folder has neither the seal nor the signature; an edit shows by its time."""
    record(tmp_path, duration=0.2)
    text = (tmp_path / "scene.yaml").read_text()
    (tmp_path / "scene.yaml").write_text(text.split("\n", 1)[1])
    with pytest.raises(SceneError, match=r"scene\.yaml"):
        refuse(tmp_path, force=True)
    with h5py.File(tmp_path / "riser.h5", "w") as numbers:
        numbers["cells"] = [[0, 1]]
    written = (tmp_path / "results.nc").stat().st_mtime
    os.utime(tmp_path / "scene.yaml", (written - 1.0, written - 1.0))
    refuse(tmp_path, force=True)
    os.utime(tmp_path / "scene.yaml", (written + 1.0, written + 1.0))
    with pytest.raises(SceneError, match=r"scene\.yaml"):
        refuse(tmp_path, force=True)


def test_the_seal_is_a_comment() -> None:
    first, *rest = sealed("title: a\n").splitlines()
    assert first.startswith("# ")
    assert rest == ["title: a"]


@pytest.mark.parametrize("force", [False, True])
def test_a_second_run_is_refused_while_the_first_writes(force: bool, tmp_path: Path) -> None:
    with a_recorder(tmp_path) as recorder:
        step(recorder, 0.1)
        message = rf"another run \(process {os.getpid()} on .*\) is writing there; wait for its end, or choose another"
        for attempt in (refuse, prepare):
            with pytest.raises(SceneError, match=message):
                attempt(tmp_path, force)
        step(recorder, 0.2)
        recorder.finish()
    assert json.loads((tmp_path / "summary.json").read_text())["stages"][0]["steps"] == 2
    record(tmp_path, force=True)


def test_a_dead_run_holds_nothing(tmp_path: Path) -> None:
    hold = (
        "import time\nfrom pathlib import Path\nfrom riser_soil.results.folder import FolderLock\n"
        f"lock = FolderLock(Path({str(tmp_path)!r}))\nprint('locked', flush=True)\ntime.sleep(60)"
    )
    with subprocess.Popen([sys.executable, "-c", hold], cwd=ROOT, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "locked\n"
        with pytest.raises(SceneError, match=f"process {other.pid}"):
            FolderLock(tmp_path)
        other.send_signal(signal.SIGKILL)
    FolderLock(tmp_path).release()
    assert list(tmp_path.iterdir()) == []


def test_of_many_runs_one_gets_the_folder(tmp_path: Path) -> None:
    """Each holds it for a moment, and removes the lock's file at its end: nobody may hold a file that has gone."""
    take = (
        "import sys, time\nfrom pathlib import Path\nfrom riser_soil.errors import SceneError\n"
        "from riser_soil.results.folder import FolderLock\n"
        f"folder = Path({str(tmp_path)!r})\nend = time.monotonic() + 1.0\n"
        "while time.monotonic() < end:\n"
        "    try:\n        lock = FolderLock(folder)\n    except SceneError:\n        continue\n"
        "    mark = folder / 'mark'\n    mark.touch(exist_ok=False)\n    mark.unlink()\n    lock.release()\n"
    )
    running = [subprocess.Popen([sys.executable, "-c", take], cwd=ROOT) for _ in range(3)]
    assert [process.wait(60) for process in running] == [0, 0, 0]


def test_drafts_of_a_killed_run_go(tmp_path: Path) -> None:
    (tmp_path / ".riser_soil").mkdir()
    (tmp_path / ".riser_soil" / "results.nc").write_text("half of it")
    record(tmp_path, duration=0.2)
    assert not (tmp_path / ".riser_soil").exists()


def test_names_too_long_are_reported(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=telling("cannot be used", "File name too long")):
        refuse(tmp_path / ("x" * 300), force=False)


def test_a_disk_that_is_full_from_the_beginning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(self: Path, content: bytes) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", fail)
    with pytest.raises(WriteError, match=telling("scene.yaml:", "cannot be written:", "No space left")):
        record(tmp_path)
    assert list(tmp_path.iterdir()) == []
