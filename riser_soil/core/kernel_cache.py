"""Machine code on disk: numba's own cache, in a folder for each function, kind of arguments, and state of the sources.

numba keeps one index for a function, with all types that it was ever called with, and imports the modules of the
NamedTuples among them to read it. A kernel that is called with the data of any law or part would import all of them;
and fail where one is gone, as one of a test is in the next run. Two processes that compile a function for different
types at the same time may even give the machine code of one the other's place in the index. With one kind in a folder
they write the same.

What one process compiles, others that need it wait for, and read: ranks and workers that start together ask for the
same kernels in the same order, and would all compile them.
"""

from __future__ import annotations

import fcntl
import hashlib
import math
import os
import re
import shutil
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from numba import config

from riser_soil.core.kernel_sources import SOURCES
from riser_soil.core.kinds import Kind, classes

KEPT = 4  # folders of other versions, the latest ones, for those who go back and forth
IN_USE = 3600.0  # s since its last start within which a run of another version may still need its folder
PATIENCE = 120.0  # s for which a kernel of another process is waited for: that may have been stopped


class Turn:
    """The turn of one process to do what has a name, among those with the same folder: a lock on a byte of a file.

    A process that ends leaves its turns, whatever ends it; one that has a turn may take it again.
    """

    def __init__(self, folder: str, name: str) -> None:
        self._folder = folder
        self._byte = int(hashlib.sha256(name.encode()).hexdigest()[:12], 16)

    def take(self) -> None:
        """Wait for it, unless the disk has no locks."""
        ends = time.monotonic() + PATIENCE
        with suppress(OSError):
            while not self._lock() and time.monotonic() < ends:
                time.sleep(0.01)

    @property
    def free(self) -> bool:
        """Whether no process has it."""
        try:
            free = self._lock()
        except OSError:
            return True
        if free:
            self.leave()
        return free

    def leave(self) -> None:
        with suppress(OSError):
            fcntl.lockf(_turns(self._folder), fcntl.LOCK_UN, 1, self._byte)

    def _lock(self) -> bool:
        try:
            fcntl.lockf(_turns(self._folder), fcntl.LOCK_EX | fcntl.LOCK_NB, 1, self._byte)
        except (BlockingIOError, PermissionError):  # of another process, in either of the standard's words
            return False
        return True


@contextmanager
def first_alone(folder: Path, name: str) -> Iterator[None]:
    """What has a name is done by one process until it has been done once in a folder; then by all at once."""
    if is_done(folder, name):
        yield
        return
    turn = Turn(str(folder), name)
    turn.take()
    try:
        yield
        done = _mark(folder, name)
        with suppress(OSError):
            done.parent.mkdir(exist_ok=True)
            done.touch()
    finally:
        turn.leave()


def is_done(folder: Path, name: str) -> bool:
    """Whether what has a name has been done in a folder."""
    return _mark(folder, name).exists()


def is_free(folder: Path, name: str) -> bool:
    """Whether it has not been done, nor does a process do it now."""
    return not is_done(folder, name) and Turn(str(folder), name).free


def _mark(folder: Path, name: str) -> Path:
    return folder / "done" / name


@cache
def _turns(folder: str) -> int:
    """The file with the locks, open until the process ends, which would lose them with it."""
    return os.open(Path(folder, "turns"), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)


@contextmanager
def caching_in(folder: str) -> Iterator[None]:
    """Caches that are made meanwhile are in this folder."""
    before, config.CACHE_DIR = config.CACHE_DIR, folder
    try:
        yield
    finally:
        config.CACHE_DIR = before


def dependencies(modules: Iterable[str], kind: Kind) -> str:
    """A word for the sources that a function for arguments of a kind depends on: those of modules, of the NamedTuples
    in the kind, and of kernels that are chosen by them where one of these sources calls them.
    """
    named = set(classes(kind))
    choices = {pair for one in named for pair in KERNELS_FOR.get(one, ())}
    needed = {*modules, *(one.__module__ for one in named)}
    while chosen := SOURCES.chosen(needed, choices) - needed:
        needed |= chosen
    return SOURCES.word(needed)


KERNELS_FOR: dict[type, set[tuple[str, str]]] = {}
"""Kernels that are chosen by a type, see `by_type`: the modules of the function that is called, and of the kernel."""


def version_folder(root: Path, word: str) -> Path:
    """The folder of a version in its root, made where it isn't there yet, in the place of those of old versions."""
    folder = root / word
    new = not folder.exists()
    folder.mkdir(parents=True, exist_ok=True)
    mark_used(folder)
    if new:
        remove_old(root, keep=folder)
    return folder


def mark_used(folder: Path) -> None:
    """A folder that another user has made is used all the same."""
    try:
        os.utime(folder)
    except PermissionError:
        return


def remove_old(root: Path, keep: Path) -> None:
    """Remove cache folders of other versions, except the latest and those that may be in use."""
    others = [path for path in root.iterdir() if re.fullmatch("[0-9a-f]{16}", path.name) and path != keep]
    used = sorted(((_last_use(path), path) for path in others), reverse=True)
    for last, path in used[KEPT:]:
        if time.time() - last > IN_USE:
            shutil.rmtree(path, ignore_errors=True)


def _last_use(folder: Path) -> float:
    """Another process may have removed the folder meanwhile."""
    try:
        return folder.stat().st_mtime
    except OSError:
        return math.inf
