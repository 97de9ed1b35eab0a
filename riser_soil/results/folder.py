"""The results folder of a run: file names, lock, and replacement of an earlier run."""

from __future__ import annotations

import fcntl
import json
import os
import socket
from contextlib import suppress
from pathlib import Path
from typing import Self

from riser_soil.errors import SceneError

SCENE = "scene.yaml"
SUMMARY = "summary.json"
SERIES = "results.nc"
RISER_XDMF = "riser.xdmf"
SOIL_XDMF = "soil.xdmf"
RISER_NUMBERS = "riser.vtkhdf"
SOIL_NUMBERS = "soil.vtkhdf"
FORMER_RISER_NUMBERS = "riser.h5"  # of earlier versions, as the next one
FORMER_SOIL_NUMBERS = "soil.h5"
FORMER = (FORMER_RISER_NUMBERS, FORMER_SOIL_NUMBERS)
CHECKPOINT = "checkpoint.npz"
NAMES = (SUMMARY, SERIES, RISER_XDMF, RISER_NUMBERS, SOIL_XDMF, SOIL_NUMBERS, *FORMER, CHECKPOINT, SCENE)
OF_LINE = "line_{}.xdmf"  # of one of several lines
_WORKSHOP = ".riser_soil"  # in the run's folder, while it is written: drafts of its files, and the lock
_LOCK = "lock"


def names_in(folder: Path) -> list[str]:
    """Names of a run's files, those of several lines included that are there."""
    of_lines = (folder.glob(OF_LINE.format("*").replace("xdmf", kind)) for kind in ("xdmf", "vtkhdf"))
    return [*NAMES, *sorted(path.name for each in of_lines for path in each)]


def write_atomically(path: Path, content: str | bytes | memoryview, lasting: bool = False) -> None:
    """Replaces the file at once: a reader, or a kill, finds the old content or the new one.

    lasting: so does who comes after a power loss.
    """
    draft = draft_of(path)
    try:
        draft.write_bytes(content.encode() if isinstance(content, str) else content)
        if lasting:
            synchronise(draft)
        draft.replace(path)
    except OSError as err:
        draft.unlink(missing_ok=True)
        raise OSError(err.errno, err.strerror, str(path)) from err


def synchronise(path: Path) -> None:
    """Brings a file, or the names in a folder, to the disk itself."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def draft_of(path: Path) -> Path:
    """Path at which a file of the folder is written before it is renamed."""
    workshop = path.parent / _WORKSHOP
    workshop.mkdir(exist_ok=True)
    return workshop / path.name


def is_finished(folder: Path) -> bool:
    """Whether the folder has a run that is marked as finished."""
    try:
        summary = json.loads((folder / SUMMARY).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return isinstance(summary, dict) and summary.get("finished") is True


class FolderLock:
    """A run's lock on its folder, from its beginning to `release` or the process's end, however that comes.

    Raises SceneError where another run has it. On NFS the lock is the server's, so that runs on several machines see
    one another; where a file system has no locks at all, nobody is refused.
    """

    def __init__(self, folder: Path) -> None:
        self._workshop = folder / _WORKSHOP
        self._lock: int | None = _locked(folder, self._workshop / _LOCK)

    @classmethod
    def try_out(cls, folder: Path) -> None:
        """Raises SceneError where another run has the folder."""
        if (folder / _WORKSHOP / _LOCK).exists():
            cls(folder).release()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def clear(self) -> None:
        """Removes the drafts of a killed run."""
        for path in self._workshop.iterdir():
            if path.name != _LOCK:
                path.unlink()

    def release(self) -> None:
        """The lock goes before its file is free, so that nobody can lock a file that has no name any more."""
        if self._lock is not None:
            with suppress(OSError):  # what stays is a few bytes, as after a kill
                self.clear()
                (self._workshop / _LOCK).unlink(missing_ok=True)
                self._workshop.rmdir()
            os.close(self._lock)
            self._lock = None


def _locked(folder: Path, path: Path) -> int:
    """The open, locked file. Another run may have removed the one that was opened: then there is a new one to open."""
    while True:
        with suppress(FileExistsError):  # exist_ok=True would ask again, and the folder may have gone by then
            path.parent.mkdir(parents=True)
        try:
            lock = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        except FileNotFoundError:
            continue
        if not _lock(lock):
            owner = os.read(lock, 200).decode(errors="replace").strip()
            os.close(lock)
            raise SceneError(
                f"{folder}: another run{f' ({owner})' if owner else ''} is writing there; wait for its end, or choose "
                "another folder (-o)"
            )
        if _is_at(path, lock):
            with suppress(OSError):  # a full disk: only the name in a message is missing
                os.ftruncate(lock, 0)
                os.write(lock, f"process {os.getpid()} on {socket.gethostname()}".encode())
            return lock
        os.close(lock)


def _is_at(path: Path, descriptor: int) -> bool:
    try:
        return os.path.samestat(path.stat(), os.fstat(descriptor))
    except FileNotFoundError:
        return False


def _lock(lock: int) -> bool:
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks
        return True
    return True
