"""Folder of all runs of a call: each has a folder of its own, with its results and its outcome.

A run is computed in a folder of its own among the attempts, and is moved to its place when it has ended. So a run that
is begun twice, as its worker seemed dead, has one folder all the same, and what is at its place has come to an end.
"""

from __future__ import annotations

import errno
import json
import shutil
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self
from uuid import uuid4

from riser_soil.errors import SceneError
from riser_soil.results.folder import SCENE, FolderLock, is_finished
from riser_soil.results.whole_file import refuse_file, unusable

ATTEMPTS = ".attempts"
_FORMER = ".former"
OUTCOME, PRINTED = "case.json", "said.txt"  # files of a run: how it ended, and its screen output


@dataclass(frozen=True)
class Outcome:
    """How a run ended.

    status: exit status; reason: why it failed. seconds: from its start to its end. machine: where it was computed.
    alone: whether no other run of the call was beside it.
    """

    name: str
    key: str
    status: int
    reason: str = ""
    seconds: float = 0.0
    machine: str = ""
    alone: bool = True

    @property
    def done(self) -> bool:
        """Whether it has results."""
        return self.status == 0

    @classmethod
    def of(cls, content: Mapping[str, Any]) -> Self:
        """The outcome from plain data. TypeError where something of it is missing."""
        return cls(**{name: content[name] for name in cls.__dataclass_fields__ if name in content})

    def as_dict(self) -> dict[str, Any]:
        """The outcome as plain data."""
        return asdict(self)


def known_outcome(runs: Path, name: str, key: str, final: Collection[int] = ()) -> Outcome | None:
    """Outcome of a run of the scene with this key; None where there is none, or it has to be run again.

    final: exit statuses of failed runs that would fail again.
    """
    try:
        outcome = Outcome.of(json.loads((runs / name / OUTCOME).read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError):
        return None
    ended = is_finished(runs / name) if outcome.done else outcome.status in final
    return outcome if ended and outcome.key == key else None


def attempt(runs: Path, name: str, scene: str) -> Path:
    """A new folder in which a run can be computed, with its scene, as text, in it.

    Raises OSError, also where the folder of all runs isn't there, as on a machine that does not share it.
    """
    made = runs / ATTEMPTS / f"{name}.{uuid4().hex}"
    made.mkdir()
    (made / SCENE).write_text(scene, encoding="utf-8")
    return made


def running(runs: Path) -> set[str]:
    """Names of the runs that are being computed."""
    with suppress(OSError):
        attempts = [entry.name for entry in (runs / ATTEMPTS).iterdir()]
        return {name.rpartition(".")[0] for name in attempts if not name.endswith(_FORMER)}
    return set()


def settle(made: Path, runs: Path, outcome: Outcome) -> Outcome:
    """Move an attempt that has ended to its run's place. A finished run of the same scene stays there instead."""
    (made / OUTCOME).write_text(json.dumps(outcome.as_dict(), indent=1) + "\n", encoding="utf-8")
    target, former = runs / outcome.name, made.with_suffix(_FORMER)
    while (known := known_outcome(runs, outcome.name, outcome.key)) is None:
        with suppress(FileNotFoundError):
            target.rename(former)
        try:
            made.rename(target)
        except OSError as err:
            if err.errno not in (errno.ENOTEMPTY, errno.EEXIST):
                raise
            continue  # another attempt was quicker
        shutil.rmtree(former, ignore_errors=True)
        return outcome
    shutil.rmtree(made, ignore_errors=True)
    return known


def prepare_attempts(runs: Path) -> None:
    """Make an empty folder of attempts. Raises SceneError or WriteError where that can't be."""
    try:
        _clear_attempts(runs)
        (runs / ATTEMPTS).mkdir(parents=True)
    except OSError as err:
        raise unusable(runs.parent, err) from err


def _clear_attempts(runs: Path) -> None:
    """Remove all attempts; the folder of the runs, too, where none has ended."""
    shutil.rmtree(runs / ATTEMPTS, ignore_errors=True)
    with suppress(OSError):  # holds runs, or isn't there
        runs.rmdir()


@contextmanager
def claimed(folder: Path, runs: str, what: str) -> Iterator[Path]:
    """The folder of all runs, named `runs` in the call's folder, which is the call's alone within the block.

    Attempts are removed at its end; so is the call's folder, if it was made here and is empty. what: the call's folder
    holds, for messages: `load cases`. SceneError where it holds something else, or another call has it.
    """
    refuse_file(folder)
    FolderLock.try_out(folder)
    there = [entry.name for entry in folder.iterdir()] if folder.is_dir() else []
    if there and runs not in there:
        raise SceneError(f"{folder}: holds something else than {what}, {min(there)}; choose another with -o FOLDER")
    made = not folder.is_dir()
    try:
        lock = FolderLock(folder)
    except OSError as err:
        raise unusable(folder, err) from err
    try:
        with lock:
            try:
                yield folder / runs
            finally:
                _clear_attempts(folder / runs)
    finally:
        if made:
            with suppress(OSError):  # holds something
                folder.rmdir()
