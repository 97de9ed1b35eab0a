"""Compiled kernels: numba's `njit`, with a cache on disk between runs.

The cache is a folder for each version of numba and Python and each kind of processor, under NUMBA_CACHE_DIR,
XDG_CACHE_HOME or ~/.cache, or a private temporary folder where that can't be written or is full, with a message. All
that is in it has its place by the sources it depends on, see `kernel_sources`. Division by zero gives inf or nan, as in
numpy. Multiply-adds may be fused and divisions by constants become products, which changes the last digit only. Kernels
are inlined where others call them: tuples then stay in registers, which halves the time of the elements in space.
"""

from __future__ import annotations

import errno
import gc
import hashlib
import os
import platform
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache, update_wrapper
from pathlib import Path
from typing import Any, NamedTuple

os.environ.setdefault("NUMBA_DISABLE_ERROR_MESSAGE_HIGHLIGHTING", "1")  # colorama, if there, writes to standard output

import numba
from numba import config
from numba.core import event
from numba.extending import overload

from riser_soil.core.environment import processor, rank
from riser_soil.core.frame_room import with_room
from riser_soil.core.kernel_cache import (
    caching_in,
    dependencies,
    first_alone,
    is_done,
    is_free,
    mark_used,
    remove_old,
    version_folder,
)
from riser_soil.core.kernel_sources import PACKAGE, SOURCES
from riser_soil.core.kinds import BY_ADDRESS, Kind, classes, kind_of, mark

NAME = PACKAGE.name
ROOM = 1 << 26  # bytes that all kernels need, and some more
OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract", "arcp"}}
NO_ENTRY = OPTIONS | {"no_cfunc_wrapper": True}
"""For what nothing calls by address: numba else gives each function an entry for C, a tenth of all compilation."""
ANNOUNCEMENT = "compiling kernels (once, about a minute)"


class Kernel:
    """A function of compiled code, for which it is compiled into what calls it; called from Python it is compiled on
    its own. With NUMBA_DISABLE_JIT=1 it is the function of Python that it was written as.

    py_func: that function.
    """

    def __init__(self, function: Callable[..., Any], apart: bool) -> None:
        self.py_func = function
        self._made: dict[tuple[Any, ...], Any] = {}  # by numba's types of the arguments
        self._latest: dict[tuple[type, ...], Any] = {}
        update_wrapper(self, function)
        overload(self, jit_options=NO_ENTRY | {"forceinline": not apart}, strict=False)(lambda *_: function)

    def __call__(self, *arguments: Any) -> Any:
        """What was compiled for such types is called, and looked for anew where numba says with a TypeError that arrays
        are of other types: to find these takes as long as a short kernel.
        """
        if config.DISABLE_JIT:
            return self.py_func(*arguments)
        types = tuple(map(type, arguments))
        if latest := self._latest.get(types):
            try:
                return latest(*arguments)
            except TypeError:
                del self._latest[types]
        self._latest[types] = self._made_for(arguments)
        return self._latest[types](*arguments)

    @with_room
    def _made_for(self, arguments: tuple[Any, ...]) -> Any:
        """What is compiled for arguments; a kind, such as arrays that are not packed, may be of several types."""
        signature = tuple(map(numba.typeof, arguments))
        if signature not in self._made:
            if not BY_ADDRESS.isdisjoint(classes(kind := kind_of(arguments))):
                raise TypeError(f"{_name(self.py_func)}: bound kernels are among its arguments; it is called by Bound")
            with keeping(place_of(self.py_func, kind)):
                self._made[signature] = numba.njit([signature], cache=True, **NO_ENTRY)(self.py_func)
        return self._made[signature]


def njit(function: Callable[..., Any], apart: bool = False) -> Any:
    """Make a function one of compiled code.

    apart: not inlined where others call it, so that those that call many are compiled in a bearable time.
    """
    return Kernel(function, apart)


class Place(NamedTuple):
    """Where machine code stays on disk: its folder, and its name among those that one process makes at a time."""

    folder: Path
    name: str

    @property
    def filled(self) -> bool:
        """Whether a process has compiled it."""
        return is_done(FOLDER, self.name)

    @property
    def free(self) -> bool:
        """Whether none has compiled it, nor does now."""
        return is_free(FOLDER, self.name)


def place_of(function: Callable[..., Any], kind: Kind, *modules: str) -> Place:
    """The place of a function's machine code for arguments of a kind. modules: others than its own that it comes from.
    """
    word, mine = dependencies((function.__module__, *modules), kind), f"{_name(function)}_{mark(kind)}"
    return Place(FOLDER / mine / word, f"{mine} {word}")


def _name(function: Callable[..., Any]) -> str:
    return f"{function.__module__}.{function.__qualname__}"


@contextmanager
def keeping(place: Place) -> Iterator[None]:
    """What numba compiles meanwhile stays at a place, or is found there. One process does it at a time, see
    `first_alone`.
    """
    since, counted = time.process_time(), _announcer.seconds
    folder = version_folder(place.folder.parent, place.folder.name)
    with caching_in(str(folder)), first_alone(FOLDER, place.name), _uncollected():
        yield
    if _announcer.seconds > counted:  # it wasn't there
        _announcer.seconds = counted + time.process_time() - since


@contextmanager
def _uncollected() -> Iterator[None]:
    """Meanwhile garbage is not looked for: the compiler's many objects live, and looking at them takes a tenth of its
    time.
    """
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()


def version() -> str:
    """Fingerprint of what all compiled code depends on: versions, and the processor."""
    words = f"{numba.__version__} {platform.python_version()} {processor()}"
    return hashlib.sha256(words.encode()).hexdigest()[:16]


def fixed(n: int) -> tuple[int, ...]:
    """A tuple of length n, which compiled code knows beforehand: it unrolls loops over range(len(...))."""
    return (0,) * n


def choose_folder(version: str) -> Path:
    """A cache folder that can be written, made where it isn't there yet."""
    given = os.environ.get("NUMBA_CACHE_DIR") or os.environ.get("XDG_CACHE_HOME")
    try:
        root = (Path(given) if given else Path.home() / ".cache") / NAME
        return _make(root, version)
    except (OSError, RuntimeError) as err:  # RuntimeError: no home
        folder = _temporary(version)
        tell(f"the cache of compiled kernels can't be written ({err}); {folder} is used")
        return folder


def _temporary(version: str) -> Path:
    """In the folder that all may write, only one that nobody else can have filled."""
    root = Path(tempfile.gettempdir()) / f"{NAME}-{os.getuid()}"
    try:
        root.mkdir(mode=0o700, exist_ok=True)
        status = root.lstat()
        if root.is_symlink() or status.st_uid != os.getuid() or status.st_mode & 0o022:
            raise PermissionError(f"{root} is not ours alone")
        return _make(root, version)
    except OSError:
        return Path(tempfile.mkdtemp(prefix=f"{NAME}-"))


def _make(root: Path, name: str) -> Path:
    folder = root / name
    new = not folder.exists()
    require_room(folder, ROOM)
    mark_used(folder)
    if new:
        remove_old(root, keep=folder)
    return folder


def require_room(folder: Path, room: int) -> None:
    """Make the folder if it isn't there; OSError where it can't hold so many bytes, those that are there included."""
    folder.mkdir(parents=True, exist_ok=True)
    tempfile.TemporaryFile(dir=folder).close()
    disk = os.statvfs(folder)
    if disk.f_bavail * disk.f_frsize < room and _taken(folder) + disk.f_bavail * disk.f_frsize < room:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(folder))


def _taken(folder: Path) -> int:
    """Another process may remove files meanwhile."""
    sizes = 0
    for path in folder.iterdir():
        with suppress(OSError):
            sizes += path.stat().st_size if path.is_file() else _taken(path)
    return sizes


def tell(message: str) -> None:
    """Say something on the first rank, without MPI."""
    if rank() == 0:
        print(message, file=sys.stderr, flush=True)


class _Announcer(event.Listener):
    """Tells on the first rank that kernels are being compiled, once for all sources as they are, and counts the time.

    seconds: processor time that compiling has taken in this process.
    """

    def __init__(self) -> None:
        self.seconds = 0.0
        self._within, self._since = 0, 0.0  # kernels are compiled within the compilation of those that call them

    def on_start(self, event: Any) -> None:
        if self._within == 0 and rank() == 0 and _first(FOLDER / "announced" / _all_sources()):
            tell(ANNOUNCEMENT)
        if self._within == 0:
            self._since = time.process_time()
        self._within += 1

    def on_end(self, event: Any) -> None:
        self._within -= 1
        if self._within == 0:
            self.seconds += time.process_time() - self._since


@cache
def _all_sources() -> str:
    """A word for all modules of the package."""
    names = (str(path.relative_to(PACKAGE.parent).with_suffix("")) for path in PACKAGE.rglob("*.py"))
    return SOURCES.word(name.replace(os.sep, ".") for name in names)


def _first(marker: Path) -> bool:
    try:
        marker.parent.mkdir(exist_ok=True)
        marker.touch(exist_ok=False)
    except OSError:
        return False
    return True


FOLDER = choose_folder(version())
_announcer = _Announcer()
for _kind in ("numba:compile", "numba:run_pass"):
    event.register(_kind, _announcer)


@contextmanager
def compiling() -> Iterator[None]:
    """What another compiler does meanwhile is announced and counted as what numba does."""
    _announcer.on_start(None)
    try:
        yield
    finally:
        _announcer.on_end(None)


def seconds_of_work() -> float:
    """Processor time [s] of this process so far, compilation of kernels left out."""
    return time.process_time() - _announcer.seconds
