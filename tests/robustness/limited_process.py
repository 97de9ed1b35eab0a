"""Process with limits on CPU time and memory in which one scene runs, and how it ended.

The processes are forked from this one, which has everything imported, MPI and the kernels' caches among it.
"""

from __future__ import annotations

import os
import resource
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

STATUSES = {0: "done", 2: "bad input", 3: "solve failed", 4: "results not written"}
LONG = "this takes about"

FORKING = threading.Lock()
"""Held while a process is forked. Who reads results in one thread while another forks holds it, too: a process that is
forked while a library's own lock is held, as h5py's, waits for it for ever.
"""

Job = Callable[[], int]
"""What a process does in its folder; gives its exit status."""


@dataclass(frozen=True)
class Limits:
    """Limits of one process. cpu, wall: s; wall is for one that waits for ever. memory: bytes of address space.

    reported_long: CPU time [s] of one that says itself that its computation is long; None: the same limit as of all
    others.
    """

    cpu: int = 60
    wall: float = 900.0
    memory: int = 6 * 2**30
    reported_long: int | None = None


@dataclass(frozen=True)
class Ending:
    """How a process ended: a word for it, whether that is one of the program's own ends, its CPU time [s], what it
    said.
    """

    word: str
    well: bool
    seconds: float
    output: str

    @property
    def finished(self) -> bool:
        return self.word == STATUSES[0]


def import_all() -> None:
    """Import what all processes need, once."""
    for name in ("riser_soil.checks.check", "riser_soil.whole_run", "riser_soil.soil.soil"):
        import_module(name)


def ended(job: Job, place: Path, limits: Limits) -> Ending:
    """Do a job in a process of its own, in a folder that is there; what it prints goes to the file `output`."""
    sys.stdout.flush()
    sys.stderr.flush()
    with FORKING:
        process = os.fork()
    if process == 0:
        _child(job, place, limits)
    status, seconds, long = _waited(process, place / "output", limits)
    output = (place / "output").read_text(errors="replace")
    word, well = _judged(status, output, long)
    return Ending(word, well, seconds, output)


def _child(job: Job, place: Path, limits: Limits) -> None:
    """Never returns."""
    status = 1
    try:
        os.chdir(place)
        _limit(limits)
        out = os.open("output", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        for stream in (1, 2):
            os.dup2(out, stream)
        sys.stdout, sys.stderr = (os.fdopen(stream, "w") for stream in (1, 2))
        status = job()
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def _limit(limits: Limits) -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (limits.cpu, limits.cpu + 5))
    resource.setrlimit(resource.RLIMIT_AS, (limits.memory, limits.memory))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _waited(process: int, output: Path, limits: Limits) -> tuple[int, float, bool]:
    """Wait status, CPU seconds, and whether the process was told to be long and so got less time."""
    long, start = False, time.monotonic()
    while True:
        done, status, usage = os.wait4(process, os.WNOHANG)
        if done:
            return status, usage.ru_utime + usage.ru_stime, long
        if limits.reported_long and not long and output.exists() and LONG in output.read_text(errors="replace"):
            long = True
            resource.prlimit(process, resource.RLIMIT_CPU, (limits.reported_long, limits.reported_long + 5))
        if time.monotonic() - start > limits.wall:
            os.kill(process, signal.SIGKILL)
        time.sleep(0.02)


def _judged(status: int, output: str, long: bool) -> tuple[str, bool]:
    if "Traceback" in output:
        return "traceback", False
    if os.WIFSIGNALED(status):
        name = signal.Signals(os.WTERMSIG(status)).name
        if name in ("SIGXCPU", "SIGKILL"):
            return ("long, as reported", True) if long else ("hang", False)
        return f"killed by {name}", False
    code = os.WEXITSTATUS(status)
    return STATUSES.get(code, f"status {code}"), code in STATUSES
