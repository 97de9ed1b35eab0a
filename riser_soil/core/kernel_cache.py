"""numba's cache on disk, a folder for each signature.

numba keeps one index for a function, with all types that it was ever called with, and imports the modules of the
NamedTuples among them to read it. A kernel that is called with the data of any law or part would import all of them;
and fail where one is gone, as one of a test is in the next run. Two processes that compile a function for different
types at the same time may even give the machine code of one the other's place in the index. With one signature in a
folder they write the same.

What one process compiles, others that need it wait for, and read: ranks and workers that start together ask for the
same kernels in the same order, and would all compile them.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

from numba import config
from numba.core.caching import FunctionCache

PACKAGE = Path(__file__).parents[1]
PATIENCE = 120.0  # s for which a kernel of another process is waited for: that may have been stopped


class CacheByTypes:
    """Cache of one function, in the place of numba's own. Looks for nothing on disk before the function is called."""

    def __init__(self, function: Callable[..., object]) -> None:
        self._function, self._folder = function, config.CACHE_DIR
        self._known: dict[str, FunctionCache] = {}  # by the word for the types

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """What isn't there is compiled here next, unless another process has done so until it is this one's turn."""
        found = self._of(sig).load_overload(sig, target_context)
        if found is None:
            self._turn(sig).take()
            found = self._of(sig).load_overload(sig, target_context)
            if found is not None:
                self._turn(sig).leave()
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        self._of(sig).save_overload(sig, data)
        self._turn(sig).leave()

    def _turn(self, sig: Any) -> Turn:
        function = self._function
        return Turn(self._folder, f"{function.__module__}.{function.__qualname__} {mark(sig)}")

    def _of(self, sig: Any) -> FunctionCache:
        word = mark(sig)
        if word not in self._known:
            with caching_in(str(Path(self._folder, word))):
                self._known[word] = FunctionCache(self._function)
        return self._known[word]


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
    done = folder / "done" / name
    if done.exists():
        yield
        return
    turn = Turn(str(folder), name)
    turn.take()
    try:
        yield
        with suppress(OSError):
            done.parent.mkdir(exist_ok=True)
            done.touch()
    finally:
        turn.leave()


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


def mark(kinds: Iterable[Any]) -> str:
    """A word for types of numba; another one where a source outside the package is edited."""
    return hashlib.sha256(" ".join([*map(str, kinds), _word(kinds)]).encode()).hexdigest()[:12]


def _word(kinds: Iterable[Any]) -> str:
    """A word for the NamedTuples among types, "" without any; another one where their source is edited."""
    found = sorted(f"{each.__module__}.{each.__qualname__} {_source(each)}" for each in set(_named(kinds)))
    return hashlib.sha256("\n".join(found).encode()).hexdigest()[:12] if found else ""


def _named(types: Iterable[Any]) -> Iterator[type]:
    """NamedTuples among types of numba, and among what they consist of."""
    for given in types:
        if hasattr(given, "instance_class"):
            yield given.instance_class
        yield from _named(getattr(given, "types", ()))
        yield from _named(getattr(given, "field_dict", {}).values())


def _source(named: type) -> str:
    """Of a class outside the package, as those within have cache folders by their sources."""
    path = getattr(sys.modules[named.__module__], "__file__", None)
    if path is None or PACKAGE in Path(path).parents:
        return ""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()
