"""What a worker does with a case: run it in a process of its own and give the results their place.

Tasks and outcomes are plain data, so that a worker may be on another machine.
"""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from riser_soil import __version__
from riser_soil.cases.case_folder import SAID, Outcome, attempt, found, place, settle
from riser_soil.core.environment import environment_alone
from riser_soil.errors import ResultsError, WriteError
from riser_soil.results.folder import SCENE

Task = dict[str, Any]
"""name, key, scene (resolved, as text), folder (of all cases, absolute), limit [s] or None, version of the program."""

POLL, GRACE = 0.05, 20.0  # s between two looks at a run; s that one has to end in order
NOT_WANTED = 128 + signal.SIGTERM
STOPPED_BY_LIMIT = 124  # as of timeout(1)


def run_case(task: Task, wanted: Callable[[], bool] = lambda: True) -> dict[str, Any]:
    """Compute a case, unless its results are there; the outcome as plain data. wanted: asked while the case runs."""
    if task["version"] != __version__:
        return _refused(task, f"the worker has riser_soil {__version__}, not {task['version']}; install the same")
    known = found(Path(task["folder"]), task["name"], task["key"])
    if known is not None:
        return known.as_dict()
    try:
        return _computed(task, wanted).as_dict()
    except OSError as err:
        remedy = "; workers need the folder shared" if isinstance(err, FileNotFoundError) else ""
        return _refused(task, f"{err.filename or task['folder']}: {err.strerror}{remedy}", WriteError.exit_status)


def _refused(task: Task, reason: str, status: int = ResultsError.exit_status) -> dict[str, Any]:
    machine = socket.gethostname()
    return Outcome(task["name"], task["key"], status, f"on {machine}: {reason}", machine=machine).as_dict()


def _computed(task: Task, wanted: Callable[[], bool]) -> Outcome:
    folder, since = Path(task["folder"]), time.monotonic()
    made = attempt(folder, task["name"], task["scene"])
    process = _started(made)
    stopped = _watched(process, since + task["limit"] if task["limit"] else float("inf"), wanted)
    status, reason = stopped or _exit_status(process.returncode), ""
    if stopped == STOPPED_BY_LIMIT:
        reason = f"took longer than the limit of {task['limit']:g} s"
    elif status:
        reason = _last_words(process.returncode, made / SAID).replace(str(made), str(place(folder, task["name"])))
    seconds = time.monotonic() - since
    outcome = Outcome(task["name"], task["key"], status, reason, seconds, socket.gethostname())
    if status == WriteError.exit_status:  # what it has written would fill the disk
        shutil.rmtree(made, ignore_errors=True)
        return outcome
    return outcome if stopped == NOT_WANTED else settle(made, folder, outcome)


def _exit_status(returned: int) -> int:
    """By the convention of shells."""
    return returned if returned >= 0 else 128 - returned


def command(made: Path) -> list[str]:
    """What runs the scene in a folder and leaves its results there."""
    module = "riser_soil.cases.case_process"
    return [sys.executable, "-m", module, str(os.getpid()), str(made / SCENE), str(made)]


def _started(made: Path) -> subprocess.Popen[bytes]:
    """In a session of its own: Ctrl-C in the terminal ends the worker, and that the run."""
    with (made / SAID).open("wb") as said:
        return subprocess.Popen(
            command(made), env=environment_alone() | {"OMP_NUM_THREADS": "1"}, stdin=subprocess.DEVNULL, stdout=said,
            stderr=subprocess.STDOUT, start_new_session=True,
        )  # fmt: skip


def _watched(process: subprocess.Popen[bytes], until: float, wanted: Callable[[], bool]) -> int:
    """Wait for the run; 0 where it ended by itself, else why it was stopped."""
    while process.poll() is None:
        if not wanted():
            process.kill()
            process.wait()
            return NOT_WANTED
        if time.monotonic() > until:
            _stop(process)
            return STOPPED_BY_LIMIT
        time.sleep(POLL)
    return 0


def _stop(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(GRACE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _last_words(status: int, said: Path) -> str:
    if status < 0:
        name = signal.Signals(-status).name
        return f"killed by {name}{', as where memory runs out' if status == -signal.SIGKILL else ''}"
    lines = said.read_text(encoding="utf-8", errors="replace").strip().splitlines()
    return " ".join(lines[-1].split()) if lines else f"ended with status {status}"
