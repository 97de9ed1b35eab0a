"""Python commands under mpirun, for tests of what several ranks do together."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from uuid import uuid4

ROOT = Path(__file__).parents[2]
SHARED_CORES = {  # more ranks than cores, in the words of OpenMPI 4 and 5
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
}
ENVIRONMENT = {
    "OMP_NUM_THREADS": "1",
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_btl": "^tcp",  # OpenMPI 5 complains of network interfaces, which ranks of one machine don't use
    "PYTHONPATH": str(ROOT),
} | SHARED_CORES
# A process that has started MPI alone hands these on to its children, in which mpirun then fails without a word.
OF_ANOTHER_JOB = ("PMIX_", "OMPI_", "ORTE_", "PRTE_")
MARK = "RISER_SOIL_TEST_JOB"
PATIENCE = 10.0  # s for mpirun to end its ranks and remove its files
HANGS = 900.0  # s: more than anything here takes on a machine busy with other things


def environment() -> dict[str, str]:
    """This process's environment for a new MPI job or a process on its own."""
    mine = {name: value for name, value in os.environ.items() if not name.startswith(OF_ANOTHER_JOB)}
    return mine | ENVIRONMENT


class Job:
    """A command and all that it starts; what is left of it at the end of the `with` is killed.

    Ranks outlive an mpirun that is killed, and are neither its children then nor in its session. So a mark in their
    environment tells them.
    """

    def __init__(self, command: Sequence[str], folder: Path, given: dict[str, str] | None = None, **streams: Any):
        self._mark = uuid4().hex
        marked = (environment() if given is None else given) | {MARK: self._mark}
        self.process = subprocess.Popen(command, cwd=folder, env=marked, text=True, **streams)

    def __enter__(self) -> Job:
        return self

    def __exit__(self, *failure: object) -> None:
        self.process.terminate()
        try:
            self.process.communicate(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            self.kill()
            self.process.communicate()
        self.kill()

    def kill(self) -> None:
        """All of it at once, as an operating system does that runs out of memory."""
        while remaining := self.processes():
            for pid in remaining:
                _kill(pid)
            time.sleep(0.01)

    def processes(self) -> list[int]:
        """Processes that are alive; one that has ended has no environment any more."""
        mark = f"{MARK}={self._mark}".encode()
        return [int(entry.name) for entry in Path("/proc").glob("[0-9]*") if mark in _environment_of(entry)]


def _environment_of(process: Path) -> list[bytes]:
    try:
        return (process / "environ").read_bytes().split(b"\0")
    except OSError:  # ended since, or another user's
        return []


def _kill(pid: int) -> None:
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        return


def finished(
    command: Sequence[str], folder: Path, given: dict[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """What a command has said and its exit status; an error, and nothing left of it, if it hangs."""
    with Job(command, folder, given, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as job:
        out, err = job.process.communicate(timeout=HANGS)
    return subprocess.CompletedProcess(command, job.process.returncode, out, err)


def mpirun(ranks: int, *command: str, folder: Path = ROOT) -> subprocess.CompletedProcess[str]:
    """Run `python COMMAND` on this many ranks from a folder."""
    launch = ["mpirun", "-n", str(ranks), "--bind-to", "none", sys.executable, *command]
    return finished(launch, folder)
