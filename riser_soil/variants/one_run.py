"""One run of a variant, in a process of its own: started, watched, stopped, and moved to its place.

Tasks and outcomes are plain data, so that the run may be on another machine.
"""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Collection
from pathlib import Path
from typing import Any

from riser_soil import __version__
from riser_soil.core.environment import environment_alone
from riser_soil.core.side_by_side import AT_MOST
from riser_soil.errors import ResultsError, WriteError
from riser_soil.results.folder import SCENE, names_in
from riser_soil.results.ownership import sealed
from riser_soil.variants.runs_folder import PRINTED, Outcome, attempt, known_outcome, settle
from riser_soil.variants.variant import Variant

Task = dict[str, Any]
"""The arguments of `task` by name, as plain data; scene: the variant's text; version: of the program."""

POLL, GRACE = 0.05, 20.0  # s between two looks at a run; s that one has to end in order
NOT_WANTED = 128 + signal.SIGTERM
STOPPED_BY_LIMIT = 124  # the status of timeout(1)


def task(
    name: str, variant: Variant, runs: Path, *, limit: float | None = None, keep: Collection[str] | None = None,
    final: Collection[int] = (), alone: bool = True,
) -> Task:  # fmt: skip
    """A run to be computed. runs: the folder of all runs, absolute. limit: s that it may take, None for any time.

    keep: the result files that stay, all by default. final: exit statuses of failures that would come again: such a
    run is not computed again. alone: whether no other run is beside it.
    """
    return {
        "name": name, "key": variant.key, "scene": sealed(variant.text), "runs": str(runs), "limit": limit,
        "keep": None if keep is None else [*keep], "final": [*final], "alone": alone, "version": __version__,
    }  # fmt: skip


def known(task: Task) -> Outcome | None:
    """Outcome of an earlier run of the task; None where it has to be computed."""
    return known_outcome(Path(task["runs"]), task["name"], task["key"], task["final"])


def run_variant(task: Task, wanted: Callable[[], bool] = lambda: True) -> dict[str, Any]:
    """Compute a task, unless its outcome is known; the outcome as plain data. wanted: asked while it runs."""
    if task["version"] != __version__:
        return _refused(task, f"the worker has riser_soil {__version__}, not {task['version']}; install the same")
    before = known(task)
    if before is not None:
        return before.as_dict()
    try:
        return _computed(task, wanted).as_dict()
    except OSError as err:
        remedy = "; workers need the folder shared" if isinstance(err, FileNotFoundError) else ""
        return _refused(task, f"{err.filename or task['runs']}: {err.strerror}{remedy}", WriteError.exit_status)


def _refused(task: Task, reason: str, status: int = ResultsError.exit_status) -> dict[str, Any]:
    machine = socket.gethostname()
    return Outcome(task["name"], task["key"], status, f"on {machine}: {reason}", machine=machine).as_dict()


def _computed(task: Task, wanted: Callable[[], bool]) -> Outcome:
    runs, since = Path(task["runs"]), time.monotonic()
    made = attempt(runs, task["name"], task["scene"])
    process = _started(made, task["alone"])
    stopped = _watched(process, since + task["limit"] if task["limit"] else float("inf"), wanted)
    status, reason = stopped or _exit_status(process.returncode), ""
    if stopped == STOPPED_BY_LIMIT:
        reason = f"took longer than the limit of {task['limit']:g} s"
    elif status:
        reason = _last_words(process.returncode, made / PRINTED).replace(str(made), str(runs / task["name"]))
    seconds = time.monotonic() - since
    outcome = Outcome(task["name"], task["key"], status, reason, seconds, socket.gethostname(), task["alone"])
    if status == WriteError.exit_status:  # its files would fill the disk
        shutil.rmtree(made, ignore_errors=True)
        return outcome
    if stopped == NOT_WANTED:
        return outcome
    if task["keep"] is not None:
        for name in set(names_in(made)) - set(task["keep"]):
            (made / name).unlink(missing_ok=True)
    return settle(made, runs, outcome)


def _exit_status(returned: int) -> int:
    """Exit status by the convention of shells."""
    return returned if returned >= 0 else 128 - returned


def command(made: Path) -> list[str]:
    """Arguments of the process that runs the scene in a folder and leaves its results there."""
    module = "riser_soil.variants.run_process"
    return [sys.executable, "-m", module, str(os.getpid()), str(made / SCENE), str(made)]


def _started(made: Path, alone: bool) -> subprocess.Popen[bytes]:
    """Start the process in a session of its own: Ctrl-C in the terminal ends the command, and that the run."""
    given = environment_alone() | {"OMP_NUM_THREADS": "1"} | ({} if alone else {AT_MOST: "1"})
    with (made / PRINTED).open("wb") as printed:
        return subprocess.Popen(
            command(made), env=given, stdin=subprocess.DEVNULL, stdout=printed, stderr=subprocess.STDOUT,
            start_new_session=True,
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


def _last_words(status: int, printed: Path) -> str:
    """Why a run failed: the signal that killed it, or the last line that it printed."""
    if status < 0:
        name = signal.Signals(-status).name
        return f"killed by {name}{', as where memory runs out' if status == -signal.SIGKILL else ''}"
    lines = printed.read_text(encoding="utf-8", errors="replace").strip().splitlines()
    return " ".join(lines[-1].split()) if lines else f"ended with status {status}"
