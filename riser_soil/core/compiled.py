"""Compiled kernels: numba's `njit`, with a cache on disk between runs.

The cache is a folder for each version of numba and Python and each kind of processor, under NUMBA_CACHE_DIR,
XDG_CACHE_HOME or ~/.cache, or a private temporary folder where that can't be written or is full, with a message. All
that is in it has its place by the sources it depends on, see `kernel_sources`. Division by zero gives inf or nan, as in
numpy. Multiply-adds may be fused and divisions by constants become products, which changes the last digit only. Kernels
are inlined where others call them: tuples then stay in registers, which halves the time of the elements in space.
"""

from __future__ import annotations

import errno
import hashlib
import os
import platform
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from inspect import signature
from pathlib import Path
from typing import Any

os.environ.setdefault("NUMBA_DISABLE_ERROR_MESSAGE_HIGHLIGHTING", "1")  # colorama, if there, writes to standard output

import numba
from llvmlite import binding as llvm
from numba.core import event

from riser_soil.core.kernel_cache import (
    CacheByTypes,
    caching_in,
    dependencies,
    first_alone,
    mark_used,
    remove_old,
    version_folder,
)
from riser_soil.core.kernel_sources import PACKAGE, SOURCES

NAME = PACKAGE.name
ROOM = 1 << 26  # bytes that all kernels need, and some more
OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract", "arcp"}}
ANNOUNCEMENT = "compiling kernels (once, about a minute)"


def njit(function: Callable[..., object], apart: bool = False) -> Any:
    """Compile a function when it is first called with arguments of new types; its machine code stays on disk.

    apart: not inlined where others call it, so that those that call many are compiled in a bearable time.
    """
    # numba asks for the signature again and again, which takes a twentieth of a start where it is found anew.
    vars(function)["__signature__"] = signature(function)
    made = numba.njit(forceinline=not apart, no_cpython_wrapper=True, **OPTIONS)(function)
    made.__class__ = _callable_from_python(made.__class__)
    return _cached(made, function, FOLDER)


def _cached(made: Any, function: Callable[..., object], folder: Path) -> Any:
    made._cache = CacheByTypes(function, folder)
    return made


@cache
def _callable_from_python(usual: Any) -> Any:
    """numba's class of compiled functions, of those without the code that takes their arguments from Python, which
    takes a third of all compilation: what Python calls all the same is compiled once more, with it.
    """

    def call(self: Any, *arguments: Any) -> Any:
        if "from_python" not in vars(self):
            folder = FOLDER / "from_python"
            folder.mkdir(parents=True, exist_ok=True)
            self.from_python = _cached(numba.njit(**OPTIONS)(self.py_func), self.py_func, folder)
        return self.from_python(*arguments)

    return type(usual.__name__, (usual,), {"__call__": call})


def entry(function: Callable[[int], None], kinds: Iterable[Any]) -> Any:
    """Compile a function of one address, to be called by its own; its machine code stays on disk.

    kinds: numba's types of what it finds there, on which it depends as on its module and on that of its caller.
    """
    since, counted, name = time.process_time(), _announcer.seconds, f"{function.__module__}.{function.__qualname__}"
    word = dependencies(function.__module__, kinds, f"{NAME}.core.bound")
    folder = version_folder(FOLDER / name, word)
    with caching_in(str(folder)), first_alone(FOLDER, f"{name} {word}"):
        made = numba.cfunc(numba.types.void(numba.types.intp), cache=True, **OPTIONS)(function)
    if _announcer.seconds > counted:  # it wasn't there
        _announcer.seconds = counted + time.process_time() - since
    return made


def version() -> str:
    """Fingerprint of what all compiled code depends on: versions, and the processor."""
    machine = f"{llvm.get_host_cpu_name()} {llvm.get_host_cpu_features().flatten()}"
    return hashlib.sha256(f"{numba.__version__} {platform.python_version()} {machine}".encode()).hexdigest()[:16]


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
    if _on_first_rank():
        print(message, file=sys.stderr, flush=True)


def _on_first_rank() -> bool:
    return os.environ.get("OMPI_COMM_WORLD_RANK", os.environ.get("PMI_RANK", "0")) == "0"


class _Announcer(event.Listener):
    """Tells on the first rank that kernels are being compiled, once for all sources as they are, and counts the time.

    seconds: processor time that compiling has taken in this process.
    """

    def __init__(self) -> None:
        self.seconds = 0.0
        self._within, self._since = 0, 0.0  # kernels are compiled within the compilation of those that call them

    def on_start(self, event: Any) -> None:
        if self._within == 0 and _on_first_rank() and _first(FOLDER / "announced" / _all_sources()):
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
