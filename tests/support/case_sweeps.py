"""The command riser-soil cases as a process, watched from outside: its attempts, its workers and their runs."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from tests.support.on_ranks import HANGS, Job


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
