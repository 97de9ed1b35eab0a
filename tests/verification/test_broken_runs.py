"""Runs that are killed, told to end, or meet a full disk, at any moment: what they leave can be read and is honest."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from riser_soil.errors import ResultsError
from riser_soil.results import Run
from riser_soil.results.ownership import refuse
from tests.support.on_ranks import ROOT, environment
from tests.support.said import line_with
from tests.support.vtk_reading import times_by_vtk

SCENE = ROOT / "demos" / "first_scene.yaml"
# Every step is recorded, and the files grow all the time.
ENDLESS = ("--set", "stages.1.duration=1e4", "--set", "output.interval=0.1")
# Rows go to disk every hundredth of a second: what fits does not hang on how many a fast machine gathers in a second.
OFTEN = """
import sys
import riser_soil.whole_run
from riser_soil.__main__ import main
from riser_soil.results import record

record._FLUSH_EVERY, record._FLUSH_SHARE = 0.01, 1.0
"""
# The command, in a process that may write no file longer than so many bytes. MPI needs some when it starts.
ON_A_SMALL_DISK = f"""{OFTEN}
import resource

resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv.pop(1)),) * 2)
sys.argv[0] = "riser-soil"
main()
"""

# The command on a disk of its own that other files fill up to so many bytes once the run has begun; what it leaves
# there is copied, as the disk goes with its mount.
ON_A_FILLED_DISK = f"""
import contextlib, os, pathlib, shutil, subprocess, sys, time

OFTEN = {OFTEN + "main()"!r}

left, disk, kept = int(sys.argv.pop(1)), pathlib.Path(sys.argv.pop(1)), pathlib.Path(sys.argv[4])
subprocess.run(["mount", "-t", "tmpfs", "-o", "size=400m", "none", disk], check=True)
sys.argv[4] = str(disk / "out")
running = subprocess.Popen([sys.executable, "-c", OFTEN, *sys.argv[1:]])
while running.poll() is None and not (disk / "out" / "riser.xdmf").exists():
    time.sleep(0.01)
with contextlib.suppress(OSError), (disk / "others").open("wb", buffering=0) as others:
    while (room := os.statvfs(disk)).f_bavail * room.f_bsize > left:
        others.write(bytes(min(room.f_bavail * room.f_bsize - left, 1 << 20)))
status = running.wait()
shutil.copytree(disk / "out", kept)
sys.exit(status)
"""


@dataclass(frozen=True)
class Remains:
    """What a run has left: rows of its series, and frames of its riser; None where there is no file yet."""

    rows: int | None
    frames: int | None


def start(folder: Path, *command: str) -> subprocess.Popen[str]:
    return _start([sys.executable, *(command or ("-m", "riser_soil"))], folder, ENDLESS)


def start_on_a_filled_disk(folder: Path, disk: Path, free: int) -> subprocess.Popen[str]:
    """The run ends in want of room, or after 200 s of its own time. disk: an empty folder, where it is mounted."""
    alone = ["unshare", "--map-root-user", "--mount", sys.executable, "-c", ON_A_FILLED_DISK, str(free), str(disk)]
    return _start(alone, folder, (*ENDLESS, "--set", "stages.1.duration=200"))


def _start(command: list[str], folder: Path, settings: tuple[str, ...]) -> subprocess.Popen[str]:
    call = [*command, "run", str(SCENE), "-o", str(folder), *settings]
    pipe = subprocess.PIPE
    return subprocess.Popen(call, cwd=ROOT, env=environment(), stdout=pipe, stderr=pipe, text=True)


def look(folders: list[Path]) -> list[Remains]:
    """Reads all files of unfinished runs; AssertionError where one isn't whole, or says that it is finished."""
    drawn = [path for folder in folders if (path := folder / "riser.xdmf").exists()]
    times = dict(zip(drawn, times_by_vtk(drawn), strict=True))
    return [_look(folder, times.get(folder / "riser.xdmf")) for folder in folders]


def _look(folder: Path, drawn: list[float] | None) -> Remains:
    refuse(folder, force=False, goes_on=True)  # the next run may have it
    if not (folder / "results.nc").exists():
        assert not (folder / "summary.json").exists()
        assert _is_refused(folder)
        return Remains(None, None if drawn is None else len(drawn))
    run = Run(folder)
    time = run.time
    assert np.all(np.diff(time) > 0.0)
    assert all(len(run[name]) == len(time) for name in ("position", "bending_moment", "end_force", "stage"))
    assert np.all(np.isfinite(run["position"]))
    assert len(run["newton_iterations"]) == len(run["step_time"])
    if (folder / "summary.json").exists():
        assert not run.finished
    if drawn is not None:
        both = min(len(drawn), len(time))
        np.testing.assert_array_equal(drawn[:both], time[:both])
    return Remains(len(time), None if drawn is None else len(drawn))


def _is_refused(folder: Path) -> bool:
    try:
        Run(folder)
    except ResultsError:
        return True
    return False


AT_ONCE = 4


class Ended(NamedTuple):
    """A run that a signal has ended, and its lines on standard error."""

    folder: Path
    status: int
    output: list[str]


def end_by(number: signal.Signals, folder: Path, runs: int) -> list[Ended]:
    """Half of the runs get the signal within seconds of their start, the others when they are in motion; all by chance.

    Before its own first line is read the program can't listen: Python then answers.
    """
    chance = random.Random(int(number))

    def end(run: int, seconds: float) -> Ended:
        out = folder / f"{run}"
        process = start(out)
        while number != signal.SIGKILL and process.poll() is None and not listens(process.pid):
            time.sleep(0.02)
        while run % 2 and process.poll() is None and not in_motion(out):
            time.sleep(0.02)
        time.sleep(seconds)
        process.send_signal(number)
        _, output = process.communicate(timeout=300)
        return Ended(out, process.returncode, output.splitlines())

    with ThreadPoolExecutor(AT_ONCE) as pool:
        return list(pool.map(end, range(runs), [chance.uniform(0.0, 5.0) for _ in range(runs)]))


def in_motion(folder: Path) -> bool:
    """Whether the files have more than the static stage's frame."""
    frames = folder / "riser.xdmf"
    return frames.exists() and frames.read_bytes().count(b"<Time") > 1


def listens(process: int) -> bool:
    """Whether SIGTERM has a handler."""
    status = Path(f"/proc/{process}/status").read_text(encoding="ascii")
    caught = next(line for line in status.splitlines() if line.startswith("SigCgt:"))
    return bool(int(caught.split()[1], 16) >> (signal.SIGTERM - 1) & 1)


@pytest.mark.verify
def test_a_hundred_kills(tmp_path: Path) -> None:
    runs = end_by(signal.SIGKILL, tmp_path, 100)
    remains = look([run.folder for run in runs])
    print(f"nothing yet: {sum(x.rows is None for x in remains)}; rows: {sorted(x.rows or 0 for x in remains)}")
    assert {run.status for run in runs} == {-signal.SIGKILL}
    assert sum((x.frames or 0) > 1 for x in remains) >= 50


@pytest.mark.verify
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ten_signals(number: signal.Signals, tmp_path: Path) -> None:
    runs = end_by(number, tmp_path, 10)
    remains = look([run.folder for run in runs])
    print(f"rows: {[x.rows for x in remains]}")
    for run, outcome in zip(runs, remains, strict=True):
        assert run.status == 128 + number
        (line,) = run.output
        assert line.startswith(f"ended by {number.name} ")
        assert (outcome.rows or 0) == (outcome.frames or 0)
    assert sum((x.rows or 0) > 1 for x in remains) >= 5


@pytest.mark.verify
def test_twenty_disks_that_others_fill(tmp_path: Path) -> None:
    """Disks in memory; the scene would fit on them by its estimate."""

    def end(free: int) -> Ended:
        disk = tmp_path / f"disk-{free}"
        disk.mkdir()
        process = start_on_a_filled_disk(tmp_path / f"{free}", disk, free)
        _, output = process.communicate(timeout=300)
        return Ended(tmp_path / f"{free}", process.returncode, output.splitlines())

    with ThreadPoolExecutor(AT_ONCE) as pool:
        runs = list(pool.map(end, [400_000 * k for k in range(20)]))
    for run in runs:
        assert run.status == 4, run.output
        (line,) = run.output
        assert "No space left" in line
    remains = look([run.folder for run in runs])
    print(f"rows: {[x.rows for x in remains]}")
    assert all((x.rows or 0) > 1 for x in remains[-6:])


@pytest.mark.verify
def test_twenty_files_that_may_not_grow(tmp_path: Path) -> None:
    folders = []
    for size in [1000 * 2**k // 4 for k in range(20)][:14] + [3_000_000 + 300_000 * k for k in range(6)]:
        folders.append(tmp_path / f"{size}")
        process = start(folders[-1], "-c", ON_A_SMALL_DISK, str(size))
        _, output = process.communicate(timeout=120)
        assert process.returncode == 4, output
        (line,) = output.splitlines()
        line_with([line], "cannot be written:", "File too large")
    remains = look(folders)
    print(f"rows: {[x.rows for x in remains]}")
    assert all((x.rows or 0) > 1 for x in remains[-6:])
