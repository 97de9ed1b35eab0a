"""Atomic file updates: a growing file that is whole at every moment, also for readers and after a kill.

Two copies alternate. An update is written to the hidden one, which is then renamed to the visible name; the other gets
the same update before the next one. So the cost of an update depends on its size, not on that of the file. An HDF5 file
can't be appended to in place: torn in mid-write it cannot be opened at all.
"""

from __future__ import annotations

import fcntl
import os
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

import h5py
import numpy as np
from h5py import h5s

from riser_soil.errors import ResultsError, RiserSoilError
from riser_soil.results.folder import draft_of, synchronise, write_atomically

_PAGE = 4096


class GrowingFile:
    """Owner of the file at `path`, which it makes anew with this content, or takes over as it is; `close` removes the
    second copy. ResultsError where there is none to take over.

    A reader that holds an HDF5 file open, and so keeps HDF5's lock on it, is not disturbed: it keeps its copy, and the
    writer makes itself another. Raises OSError where the disk does; the file is then whole as before the update.
    """

    def __init__(self, path: Path, content: bytes | None) -> None:
        self.path = path
        self._lacking: Mapping[int, bytes] | None = None  # of the second copy; None where there is no second copy
        self._lasting = False
        if content is not None:
            write_atomically(path, content)
        elif not path.exists():
            raise behind(path)
        self.size = path.stat().st_size

    def outlast_power(self) -> None:
        """From now on the file is whole after a power loss, too: an update is on the disk before it gets its name."""
        if not self._lasting:
            synchronise(self.path)
        self._lasting = True

    def update(self, changes: Mapping[int, bytes], size: int) -> None:
        """changes: bytes by their offset; size: of the file after them."""
        draft = draft_of(self.path)
        try:
            self._catch_up(draft)
            _write(draft, changes, size)
            if self._lasting:
                synchronise(draft)
            self._lacking = changes if _exchange(draft, self.path) else None
        except OSError as err:
            self._lacking = None
            draft.unlink(missing_ok=True)
            raise OSError(err.errno, err.strerror, str(self.path)) from err
        self.size = size

    def close(self) -> None:
        self._lacking = None
        draft_of(self.path).unlink(missing_ok=True)

    def _catch_up(self, draft: Path) -> None:
        if self._lacking is None or _open_elsewhere(draft):
            draft.unlink(missing_ok=True)
            shutil.copyfile(self.path, draft)
        else:
            _write(draft, self._lacking, self.size)


def _write(path: Path, changes: Mapping[int, bytes], size: int) -> None:
    with path.open("r+b") as file:
        for offset, content in changes.items():
            file.seek(offset)
            file.write(content)
        file.truncate(size)


def _open_elsewhere(path: Path) -> bool:
    """Whether a reader has the file open; not known where there are no locks."""
    with path.open("r+b") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        except OSError:
            return False
    return False


def _exchange(draft: Path, path: Path) -> bool:
    """Give the draft the file's name; whether the file's former self could be kept under the draft's."""
    former = draft.with_suffix(".former")
    former.unlink(missing_ok=True)
    try:
        os.link(path, former)
    except OSError:  # a file system without hard links
        draft.replace(path)
        return False
    draft.replace(path)
    former.replace(draft)
    return True


@contextmanager
def appending(file: GrowingFile) -> Iterator[h5py.File]:
    """The HDF5 file, to be changed; what has been written in the block becomes one update of it."""
    with file.path.open("rb") as base:
        pages = _MemoryFile(base, file.size)
        with h5py.File(pages, "r+") as store:
            yield store
    file.update(pages.changes(), pages.size)


def append_rows(dataset: h5py.Dataset, rows: object) -> None:
    """Rows behind those of a dataset, by HDF5's own calls, which take half the time of h5py's."""
    new, (count, *row) = np.ascontiguousarray(rows), dataset.id.shape
    dataset.id.set_extent((count + len(new), *row))
    place = dataset.id.get_space()
    place.select_hyperslab((count, *(0 for _ in row)), new.shape)
    dataset.id.write(h5s.create_simple(new.shape), place, new)


@contextmanager
def cutting_back(file: GrowingFile) -> Iterator[h5py.File]:
    """The HDF5 file of a run that resumes, to be changed; ResultsError where it is damaged, for which HDF5
    raises all kinds of errors.
    """
    try:
        with appending(file) as store:
            yield store
    except RiserSoilError:
        raise
    except Exception as err:
        if isinstance(err, OSError) and err.errno is not None:  # of the disk
            raise
        reason = str(err).partition("\n")[0]
        raise ResultsError(f"{file.path}: is damaged, and can't go on ({reason}); begin anew by --force") from err


def reading(path: Path) -> h5py.File:
    """The HDF5 file, beside whoever else reads it, in this process too; OSError where it can't be read.

    HDF5's lock shows the reader to the writer, unless there are no locks or others have opened it without.
    """
    try:
        return h5py.File(path, "r")
    except OSError:
        return h5py.File(path, "r", locking=False)


def behind(path: Path) -> ResultsError:
    """The error of a file that lacks what its run had written when it was saved."""
    return ResultsError(f"{path}: lacks records made before the checkpoint beside it; begin anew by --force")


class _MemoryFile:
    """In-memory file for HDF5, which neither reports a full disk nor survives it: a base, pages of it that were written
    to, and what is behind it.
    """

    def __init__(self, base: BinaryIO, size: int) -> None:
        self.size = size
        self._base, self._of_base, self._at = base, size, 0
        self._pages: dict[int, bytearray] = {}
        self._added = bytearray()

    def changes(self) -> dict[int, bytes]:
        """Bytes that were written to, by their offset, up to the file's end."""
        pages = {number * _PAGE: page[: self._of_base - number * _PAGE] for number, page in self._pages.items()}
        parts = sorted((pages | {self._of_base: self._added}).items())
        return {at: bytes(part[: self.size - at]) for at, part in parts if at < self.size}

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        self._at = offset + {os.SEEK_SET: 0, os.SEEK_CUR: self._at, os.SEEK_END: self.size}[whence]
        return self._at

    def tell(self) -> int:
        return self._at

    def flush(self) -> None:
        """Do nothing: `changes` has all that was written."""

    def truncate(self, size: int) -> int:
        self.size = size
        return size

    def read(self, count: int) -> bytes:
        content = bytearray(count)
        self.readinto(memoryview(content))
        return bytes(content)

    def readinto(self, buffer: memoryview) -> int:
        into = memoryview(buffer).cast("B")
        old, behind = self._split(len(into))
        for number, within, at in _cut(self._at, old):
            page = self._pages.get(number) or self._read(number)
            into[at] = page[within]
        into[old:] = self._added[behind]
        self._at += len(into)
        return len(into)

    def write(self, data: memoryview) -> int:
        content = memoryview(data).cast("B")
        old, behind = self._split(len(content))
        for number, within, at in _cut(self._at, old):
            if number not in self._pages:
                self._pages[number] = self._read(number)
            self._pages[number][within] = content[at]
        self._added[behind] = content[old:]
        self._at += len(content)
        self.size = max(self.size, self._at)
        return len(content)

    def _split(self, count: int) -> tuple[int, slice]:
        """How many of the next `count` bytes are of the base, and where those are that come behind it."""
        old = min(max(self._of_base - self._at, 0), count)
        first = max(self._at - self._of_base, 0)
        end = first + count - old
        if end > len(self._added):
            self._added.extend(bytes(end - len(self._added)))
        return old, slice(first, end)

    def _read(self, number: int) -> bytearray:
        self._base.seek(number * _PAGE)
        return bytearray(self._base.read(_PAGE).ljust(_PAGE, b"\0"))


def _cut(offset: int, count: int) -> Iterator[tuple[int, slice, slice]]:
    """Page by page: its number, the part of it, and the part of the `count` bytes that begin at `offset`."""
    first = 0
    while first < count:
        number, start = divmod(offset + first, _PAGE)
        size = min(_PAGE - start, count - first)
        yield number, slice(start, start + size), slice(first, first + size)
        first += size
