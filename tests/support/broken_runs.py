"""Runs that are ended from outside, and what can be said of the folders that they leave."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from riser_soil.errors import ResultsError
from riser_soil.results import Run
from riser_soil.results.ownership import refuse
from tests.support.on_ranks import ROOT, environment
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
class Left:
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


def look(folders: list[Path]) -> list[Left]:
    """Reads all files of unfinished runs; AssertionError where one isn't whole, or says that it is finished."""
    drawn = [path for folder in folders if (path := folder / "riser.xdmf").exists()]
    times = dict(zip(drawn, times_by_vtk(drawn), strict=True))
    return [_look(folder, times.get(folder / "riser.xdmf")) for folder in folders]


def _look(folder: Path, drawn: list[float] | None) -> Left:
    refuse(folder, force=False, goes_on=True)  # the next run may have it
    if not (folder / "results.nc").exists():
        assert not (folder / "summary.json").exists()
        assert _is_refused(folder)
        return Left(None, None if drawn is None else len(drawn))
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
    return Left(len(time), None if drawn is None else len(drawn))


def _is_refused(folder: Path) -> bool:
    try:
        Run(folder)
    except ResultsError:
        return True
    return False
