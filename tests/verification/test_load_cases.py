"""Load cases in processes and by workers: none is lost and none done twice when one of these is killed."""

from __future__ import annotations

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import xarray
from distributed import LocalCluster

from riser_soil import __version__
from tests.support.case_files import case_file
from tests.support.on_ranks import HANGS, Job, finished
from tests.support.said import line_with


def sweep(folder: Path, *options: str) -> Job:
    """`riser-soil cases sweep.yaml -o out` in a folder; all that is left of it is killed at the end of the `with`."""
    call = [sys.executable, "-m", "riser_soil", "cases", "sweep.yaml", "-o", "out", *options]
    return Job(call, folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


class Watched:
    """Progress of a sweep as a watcher records it.

    attempts: names of all folders in which a case was begun.
    """

    def __init__(self, job: Job, folder: Path) -> None:
        self.attempts: set[str] = set()
        self._job, self._place = job, folder / "out" / "cases"

    def until(self, reached: Callable[[], bool]) -> None:
        """Look until it is so, or the command has ended."""
        since = time.monotonic()
        while not reached() and self._job.process.poll() is None:
            assert time.monotonic() - since < HANGS
            place = self._place / ".attempts"
            self.attempts |= {entry.split(".former")[0] for entry in _entries(place)}
            time.sleep(0.02)

    def until_ended(self, process: int) -> None:
        """Look until a process has ended, whether somebody has waited for it or not."""
        self.until(lambda: not _read(process, "cmdline"))

    def ended(self) -> bool:
        return self._job.process.poll() is not None

    @property
    def done(self) -> list[str]:
        """Names of the cases that have their places."""
        return [name for name in _entries(self._place) if name != ".attempts"]

    def runs(self) -> dict[int, int]:
        """Processes that run cases, each with the process that began it: the command, or a worker."""
        mark, alive = str(self._place / ".attempts").encode(), (int(p.name) for p in Path("/proc").glob("[0-9]*"))
        of_case = (pid for pid in alive if mark in _read(pid, "cmdline"))
        return {pid: parent for pid in of_case if (parent := _parent(pid))}


def _entries(folder: Path) -> list[str]:
    try:
        return os.listdir(folder)
    except OSError:
        return []


def _parent(pid: int) -> int:
    fields = _read(pid, "stat").rpartition(b")")[2].split()
    return int(fields[1]) if fields else 0


def _read(pid: int, name: str) -> bytes:
    try:
        return Path(f"/proc/{pid}/{name}").read_bytes()
    except OSError:
        return b""


pytestmark = pytest.mark.verify

MANY = [100.0, 200.0, 300.0, 400.0], [8.0, 8.5, 9.0]
FEW = [100.0, 200.0, 300.0], [8.0, 9.0]


def product(EI: list[float], x: list[float]) -> str:
    return f"product: {{line_types.pipe.EI: {json.dumps(EI)}, riser.end.position.0: {json.dumps(x)}}}"


def rows(folder: Path) -> list[dict[str, str]]:
    with (folder / "out" / "cases.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def names(EI: list[float], x: list[float]) -> list[str]:
    return [f"EI={a:g}-position_0={b:g}" for a in EI for b in x]


def test_cases_side_by_side_are_not_mixed_up(tmp_path: Path) -> None:
    """Two at a time, one killed in mid-run: that one is a row with its reason, and a second call computes it alone.

    The top tension grows with the span and falls with the stiffness.
    """
    case_file(tmp_path, product(*MANY))
    with sweep(tmp_path, "--jobs", "2") as job:
        watched = Watched(job, tmp_path)
        watched.until(lambda: len(watched.done) >= 3 and len(watched.runs()) == 2)
        (run, command), *_ = watched.runs().items()
        assert command == job.process.pid
        os.kill(run, signal.SIGKILL)
        watched.until(watched.ended)
        _, err = job.process.communicate(timeout=HANGS)
    (killed,) = (row for row in rows(tmp_path) if row["status"] != "0")
    assert (job.process.returncode, killed["status"]) == (3, "137")
    line_with([killed["reason"]], "killed by SIGKILL", "memory")
    line_with(err, "failed:", killed["case"])
    with sweep(tmp_path, "--jobs", "2") as again:
        out, err = again.process.communicate(timeout=HANGS)
    assert (again.process.returncode, err) == (0, "")
    line_with(out, "12 cases", "11 of them done")
    assert [row["case"] for row in rows(tmp_path)] == names(*MANY)
    assert not (tmp_path / "out" / "cases" / ".attempts").exists()
    with xarray.open_dataset(tmp_path / "out" / "cases.nc", engine="h5netcdf") as dataset:
        tension = dataset["hang_top_tension"].values.reshape(4, 3)
        assert (np.diff(tension, axis=1) > 0.0).all()
        assert (np.diff(tension, axis=0) < 0.0).all()


@contextmanager
def workers(count: int) -> Iterator[str]:
    """Address of a Dask scheduler with so many workers, each a process that is begun again when it dies."""
    with LocalCluster(n_workers=count, threads_per_worker=1, host="127.0.0.1", dashboard_address=None) as cluster:
        yield cluster.scheduler_address


def test_a_case_whose_worker_dies_is_done_again(tmp_path: Path) -> None:
    """Each case has one row and one folder, and only the dead worker's was begun twice."""
    case_file(tmp_path, product(*FEW))
    with workers(2) as address, sweep(tmp_path, "--scheduler", address) as job:
        watched = Watched(job, tmp_path)
        watched.until(lambda: len(watched.done) >= 1 and len(watched.runs()) == 2)
        (run, worker), *_ = watched.runs().items()
        os.kill(worker, signal.SIGKILL)
        watched.until_ended(run)
        watched.until(watched.ended)
        _, err = job.process.communicate(timeout=HANGS)
    assert (job.process.returncode, err) == (0, "")
    assert {row["case"]: row["status"] for row in rows(tmp_path)} == dict.fromkeys(names(*FEW), "0")
    begun = [name.rpartition(".")[0] for name in watched.attempts]
    assert (len(begun), set(begun)) == (7, set(names(*FEW)))


def test_ctrl_c_stops_all_and_a_second_call_goes_on(tmp_path: Path) -> None:
    case_file(tmp_path, product(*FEW))
    with sweep(tmp_path, "--jobs", "2") as job:
        watched = Watched(job, tmp_path)
        watched.until(lambda: len(watched.done) >= 2 and len(watched.runs()) > 0)
        job.process.send_signal(signal.SIGINT)
        _, err = job.process.communicate(timeout=HANGS)
        assert job.processes() == []
    assert job.process.returncode == 130
    (line,) = err.splitlines()
    line_with([line], "ended by SIGINT", "6 cases", "out keeps them", "call again")
    done = watched.done
    assert 2 <= len(done) < 6
    assert not list((tmp_path / "out").glob("*.csv"))
    before = {name: (tmp_path / "out/cases" / name / "case.json").stat().st_mtime_ns for name in done}
    with sweep(tmp_path, "--jobs", "2") as again:
        out, err = again.process.communicate(timeout=HANGS)
    assert (again.process.returncode, err) == (0, "")
    line_with(out, "6 cases", f"{len(done)} of them done")
    assert {name: (tmp_path / "out/cases" / name / "case.json").stat().st_mtime_ns for name in done} == before
    assert [row["case"] for row in rows(tmp_path)] == names(*FEW)


def test_a_command_that_is_killed_is_called_again_and_goes_on(tmp_path: Path) -> None:
    """Its runs end with it; cases that are done are not computed again."""
    case_file(tmp_path, product(*FEW))
    with sweep(tmp_path, "--jobs", "2") as job:
        watched = Watched(job, tmp_path)
        watched.until(lambda: len(watched.done) >= 2 and len(watched.runs()) > 0)
        job.process.kill()
        since = time.monotonic()
        while job.processes():
            assert time.monotonic() - since < 60.0
            time.sleep(0.05)
    done = {name: (tmp_path / "out/cases" / name / "case.json").stat().st_mtime_ns for name in watched.done}
    assert 2 <= len(done) < 6
    with sweep(tmp_path, "--jobs", "2") as again:
        out, err = again.process.communicate(timeout=HANGS)
    assert (again.process.returncode, err) == (0, "")
    line_with(out, "6 cases", f"{len(done)} of them done")
    assert [row["status"] for row in rows(tmp_path)] == ["0"] * 6
    assert {name: (tmp_path / "out/cases" / name / "case.json").stat().st_mtime_ns for name in done} == done


ON_A_SMALL_DISK = """
mount -t tmpfs -o size={small}k none out || exit 99
"$@"; status=$?
ls out/cases > done.txt
mount -o remount,size=100m out
"$@" && cp -r out kept && exit $status
"""


def test_a_full_disk_loses_nothing(tmp_path: Path) -> None:
    """A disk that has room for some of six cases: one line, status 4; when it has more the others are computed."""
    case_file(tmp_path, product(*FEW))
    with sweep(tmp_path, "--jobs", "1") as job:
        assert job.process.wait(HANGS) == 0
    size = sum(file.stat().st_size for file in (tmp_path / "out/cases").rglob("*") if file.is_file()) // 1024
    shutil.rmtree(tmp_path / "out")
    (tmp_path / "out").mkdir()
    call = [sys.executable, "-m", "riser_soil", "cases", "sweep.yaml", "-o", "out", "--jobs", "1"]
    alone = ["unshare", "--map-root-user", "--mount", "sh", "-c", ON_A_SMALL_DISK.format(small=size // 2), "sh"]
    ended = finished([*alone, *call], tmp_path)
    assert ended.returncode == 4, ended.stderr
    line_with(ended.stderr, "of 6 cases had ended", "out keeps them", "call again")
    done = (tmp_path / "done.txt").read_text().split()
    assert 1 <= len(done) < 6
    line_with(ended.stdout, "6 cases", f"{len(done)} of them done")
    with (tmp_path / "kept/cases.csv").open(newline="", encoding="utf-8") as file:
        assert [row["status"] for row in csv.DictReader(file)] == ["0"] * 6


def test_a_case_that_kills_its_workers_is_a_row(tmp_path: Path) -> None:
    case_file(tmp_path, product([100.0], [8.0]))
    with workers(1) as address, sweep(tmp_path, "--scheduler", address) as job:
        watched = Watched(job, tmp_path)
        for _ in range(4):
            watched.until(lambda: len(watched.runs()) == 1)
            ((run, worker),) = watched.runs().items()
            os.kill(worker, signal.SIGKILL)
            watched.until_ended(run)
        _, err = job.process.communicate(timeout=HANGS)
    assert job.process.returncode == 3
    assert err == line_with(err, "failed:", "EI=100-position_0=8", "out/cases.csv") + "\n"
    (row,) = rows(tmp_path)
    assert row["status"] == "137"
    line_with([row["reason"]], "worker died 4 times", "memory")


def test_a_scheduler_that_is_lost_is_reported_in_one_line(tmp_path: Path) -> None:
    case_file(tmp_path, product(*FEW))
    with (
        LocalCluster(n_workers=1, threads_per_worker=1, host="127.0.0.1", dashboard_address=None) as cluster,
        sweep(tmp_path, "--scheduler", address := cluster.scheduler_address) as job,
    ):
        watched = Watched(job, tmp_path)
        watched.until(lambda: len(watched.done) >= 1)
        cluster.close()
        _, err = job.process.communicate(timeout=HANGS)
    assert job.process.returncode == 3
    assert err == line_with(err, f"--scheduler {address}:", "does not answer", "call again") + "\n"


def test_workers_of_another_scheduler(tmp_path: Path) -> None:
    """Its workers outlive the command, also one that is killed: then they stop the cases that nobody waits for."""
    case_file(tmp_path, product(*FEW))
    with LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None) as cluster:
        address = cluster.scheduler_address
        with sweep(tmp_path, "--scheduler", address) as job:
            watched = Watched(job, tmp_path)
            watched.until(lambda: len(watched.done) >= 1)
            job.process.kill()
        with sweep(tmp_path, "--scheduler", address) as again:
            _, err = again.process.communicate(timeout=HANGS)
            assert (again.process.returncode, err) == (0, "")
        assert len(cluster.scheduler_info["workers"]) == 2
    assert [row["case"] for row in rows(tmp_path)] == names(*FEW)
    assert {row["status"] for row in rows(tmp_path)} == {"0"}


STRANGER = """
import asyncio, sys
from distributed import Worker

sys.modules["riser_soil"] = None  # as where it is not installed

async def work():
    async with Worker(sys.argv[1], nthreads=1) as worker:
        await worker.finished()

asyncio.run(work())
"""


def test_a_worker_that_lacks_the_package_is_reported_before_it_gets_a_case(tmp_path: Path) -> None:
    """It could not even read what it is sent, and the command would wait for it."""
    case_file(tmp_path, product(*FEW))
    with LocalCluster(n_workers=0, host="127.0.0.1", dashboard_address=None) as cluster:
        address = cluster.scheduler_address
        with subprocess.Popen([sys.executable, "-c", STRANGER, address], stderr=subprocess.DEVNULL) as stranger:
            try:
                while not cluster.scheduler_info["workers"]:
                    time.sleep(0.05)
                with sweep(tmp_path, "--scheduler", address) as job:
                    _, err = job.process.communicate(timeout=HANGS)
            finally:
                stranger.kill()
    (line,) = err.splitlines()
    assert job.process.returncode == 2
    assert line.startswith(f"--scheduler {address}: its worker tcp://127.0.0.1:")
    assert f"has no riser_soil; install {__version__} there, or end it" in line
    assert not (tmp_path / "out").exists()
