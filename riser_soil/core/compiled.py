"""Compiled kernels: numba's `njit`, with a cache on disk between runs.

numba's own cache doesn't notice an edit in another file whose functions it has inlined, and runs stale code. So each
version of the kernels has a cache folder of its own, under NUMBA_CACHE_DIR, XDG_CACHE_HOME or ~/.cache, or a private
temporary folder where that can't be written or is full, with a message. Division by zero gives inf or nan, as in numpy.
Multiply-adds may be fused and divisions by constants become products, which changes the last digit only. Kernels are
inlined where others call them: tuples then stay in registers, which halves the time of the elements in space.
"""

from __future__ import annotations

import errno
import hashlib
import math
import os
import platform
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from glob import glob
from inspect import signature
from pathlib import Path
from typing import Any

os.environ.setdefault("NUMBA_DISABLE_ERROR_MESSAGE_HIGHLIGHTING", "1")  # colorama, if there, writes to standard output

import numba
from llvmlite import binding as llvm
from numba.core import event

from riser_soil.core.kernel_cache import PACKAGE, CacheByTypes, caching_in, first_alone

NAME = PACKAGE.name
KEPT = 4  # cache folders of other versions, the latest ones, for those who go back and forth
IN_USE = 3600.0  # s since its last start within which a run of another version may still need its folder
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
    with caching_in(str(folder)):
        made._cache = CacheByTypes(function)
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


def entry(function: Callable[[int], None]) -> Any:
    """Compile a function of one address, to be called by its own; its machine code stays on disk."""
    since, counted = time.process_time(), _announcer.seconds
    with caching_in(str(FOLDER)), first_alone(FOLDER, f"{function.__module__}.{function.__qualname__}"):
        made = numba.cfunc(numba.types.void(numba.types.intp), cache=True, **OPTIONS)(function)
    if _announcer.seconds > counted:  # it wasn't there
        _announcer.seconds = counted + time.process_time() - since
    return made


def fixed(n: int) -> tuple[int, ...]:
    """A tuple of length n, which compiled code knows beforehand: it unrolls loops over range(len(...))."""
    return (0,) * n


def fingerprint(package: Path) -> str:
    """Fingerprint of all that compiled code depends on: sources of modules with kernels and of what they import,
    versions, and the processor.
    """
    machine = f"{llvm.get_host_cpu_name()} {llvm.get_host_cpu_features().flatten()}"
    digest = hashlib.sha256(f"{numba.__version__} {platform.python_version()} {machine}".encode())
    for name, text in sorted(_sources(package).items()):
        digest.update(f"{name}\n{text}".encode())
    return digest.hexdigest()[:16]


def _sources(package: Path) -> dict[str, str]:
    """Text by file name, within the package: names as strings, which are found ten times as fast as paths."""
    names = glob("**/*.py", root_dir=package, recursive=True)
    texts = {name: (package / name).read_text(encoding="utf-8") for name in names}
    needed, todo = set[str](), {name for name, text in texts.items() if f"{NAME}.core.compiled import" in text}
    while todo:
        needed |= todo
        todo = {name for known in todo for name in _imports(texts[known]) if name in texts} - needed
    return {name: texts[name] for name in needed}


def _imports(text: str) -> Iterable[str]:
    """Modules of the package that a source names in its import statements."""
    for module, names in re.findall(rf"from {NAME}\.?([\w.]*) import (\([^)]*\)|.*)", text):
        for dotted in (module, *(f"{module}.{name}".strip(".") for name in re.findall(r"\w+", names))):
            yield f"{dotted.replace('.', '/')}.py"


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


def _make(root: Path, version: str) -> Path:
    folder = root / version
    new = not folder.exists()
    require_room(folder, ROOM)
    _mark_used(folder)
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


def _mark_used(folder: Path) -> None:
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


class _Announcer(event.Listener):
    """Tells on the first rank that kernels are being compiled, once for a cache folder, and counts the time.

    seconds: processor time that compiling has taken in this process.
    """

    def __init__(self) -> None:
        self.seconds = 0.0
        self._within, self._since = 0, 0.0  # kernels are compiled within the compilation of those that call them

    def on_start(self, event: Any) -> None:
        if _on_first_rank() and _first(FOLDER / "announced"):
            tell(ANNOUNCEMENT)
        if self._within == 0:
            self._since = time.process_time()
        self._within += 1

    def on_end(self, event: Any) -> None:
        self._within -= 1
        if self._within == 0:
            self.seconds += time.process_time() - self._since


def _first(marker: Path) -> bool:
    try:
        marker.touch(exist_ok=False)
    except OSError:
        return False
    return True


FOLDER = choose_folder(fingerprint(PACKAGE))
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
