"""Columns of elastic soil's compliance, kept on disk from one run to the next, in the folder of the compiled kernels.

A soil has a folder, named by a hash of all that decides its columns to the last bit, and each group of columns a file
in it, which begins with a checksum: a damaged file counts as none. Files are written beside their place and moved
there, so that runs at once don't meet half a file. With RISER_SOIL_COMPLIANCE=off nothing is kept or read.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

import llvmlite.binding
import numpy as np
from petsc4py import PETSc

from riser_soil.core import compiled
from riser_soil.core.arrays import Array, IntArray

FORMAT = 1  # of the files, and of how columns are found and grouped
SWITCH = "RISER_SOIL_COMPLIANCE"
MOST = 1 << 30  # bytes of all files; soils that were not asked for longest go first
LEFT = 1 << 30  # bytes of the disk that stay free
CHECKSUM = 64  # bytes, at the beginning of a file


def key_of(arrays: Iterable[Array | IntArray]) -> str:
    """Name of a soil by arrays that decide its columns, and by what decides their last digits: solver, processor and
    threads.
    """
    threads = os.environ.get("OMP_NUM_THREADS", os.cpu_count())
    made_by = (FORMAT, PETSc.Sys.getVersion(), llvmlite.binding.get_host_cpu_name(), threads)
    digest = hashlib.sha256(repr(made_by).encode())
    for array in arrays:
        digest.update(f"{array.dtype}{array.shape}".encode())
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()[:32]


class KeptColumns:
    """Groups of columns (k, n) of the soil of a key, by number."""

    def __init__(self, key: str) -> None:
        self._folder = _root() / key
        self._reads = self._writes = os.environ.get(SWITCH) != "off"

    def find(self, group: int, shape: tuple[int, int]) -> Array | None:
        """A group of columns as the file has them, which is mapped, not read; None where there is no whole one."""
        if not self._reads:
            return None
        try:
            with self._file(group).open("rb") as file:
                checksum = file.read(CHECKSUM)
                columns: Array = np.asarray(np.memmap(file, float, mode="r", offset=CHECKSUM, shape=shape))
        except (OSError, ValueError):  # ValueError: the file is too short
            return None
        if checksum != self._checksum(group, columns):
            return None
        with suppress(OSError):
            os.utime(self._folder)
        return columns

    def keep(self, group: int, columns: Array) -> Array:
        """The same columns: those in the file, which take no memory, where they could be written."""
        if self._writes:
            try:
                self._write(group, columns)
            except OSError as err:
                self._writes = False
                compiled.tell(f"the soil's compliance is not kept for other runs ({err})")
        found = self.find(group, (columns.shape[0], columns.shape[1]))
        return columns if found is None else found

    def holds_any(self) -> bool:
        """Whether columns are there, whole or not."""
        return self._reads and any(self._folder.glob("*.columns"))

    def _write(self, group: int, columns: Array) -> None:
        self._folder.mkdir(parents=True, exist_ok=True)
        _make_room(self._folder, columns.nbytes)
        with tempfile.TemporaryDirectory(dir=self._folder, prefix=".") as place:
            part = Path(place) / "part"
            with part.open("wb") as file:
                file.write(self._checksum(group, columns))
                file.write(columns.data)
            part.replace(self._file(group))

    def _file(self, group: int) -> Path:
        return self._folder / f"{group}.columns"

    def _checksum(self, group: int, columns: Array) -> bytes:
        digest = hashlib.sha256(f"{self._folder.name}/{group}".encode())
        digest.update(columns.data)
        return digest.hexdigest().encode()


def _root() -> Path:
    """Beside the folders of the kernels' versions; in the kernels' own where that is a temporary one, alone."""
    beside = compiled.FOLDER.parent
    return (beside if beside.name.startswith(compiled.NAME) else compiled.FOLDER) / "compliance"


def _make_room(folder: Path, size: int) -> None:
    """Remove other soils' folders, those that were not used for longest first, until so many bytes more may be kept;
    OSError where they may not.
    """
    others = sorted((path for path in folder.parent.iterdir() if path != folder), key=_last_use)
    while _taken(folder.parent) + size > MOST and others:
        shutil.rmtree(others.pop(0), ignore_errors=True)
    if _taken(folder.parent) + size > MOST or shutil.disk_usage(folder).free < size + LEFT:
        raise OSError(f"{folder.parent} may take {MOST >> 20} MB and leaves {LEFT >> 20} MB of the disk free")


def _last_use(path: Path) -> float:
    """Another run may have removed it meanwhile."""
    with suppress(OSError):
        return path.stat().st_mtime
    return 0.0


def _taken(root: Path) -> int:
    sizes = 0
    for place, _, names in os.walk(root):
        for name in names:
            with suppress(OSError):
                sizes += (Path(place) / name).stat().st_size
    return sizes
