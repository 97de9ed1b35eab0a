"""Available memory and free disk space of the machine."""

from __future__ import annotations

import math
import resource
import shutil
from collections.abc import Iterator
from pathlib import Path

_MEMORY = Path("/proc/meminfo")
_STATUS = Path("/proc/self/status")
_GROUPS = (
    (Path("/sys/fs/cgroup"), "memory.max", "memory.current"),
    (Path("/sys/fs/cgroup/memory"), "memory.limit_in_bytes", "memory.usage_in_bytes"),
)


def available_memory() -> float:
    """Bytes that this process can still have: of the machine, of its control group, of its own limit; inf if it is not
    known.
    """
    return max(0.0, min([*_of_the_machine(), *_of_the_group(), *_of_the_process()], default=math.inf))


def free_disk(folder: Path) -> float:
    """Bytes left where a folder is, or is going to be."""
    there = next(place for place in (folder.absolute(), *folder.absolute().parents) if place.exists())
    return float(shutil.disk_usage(there).free)


def _of_the_machine() -> Iterator[float]:
    yield from _kilobytes(_MEMORY, "MemAvailable:")


def _of_the_group() -> Iterator[float]:
    """In a container; the file cache counts as available."""
    for folder, limit, used in _GROUPS:
        for most, now in zip(_number(folder / limit), _number(folder / used), strict=False):
            yield most - now + sum(_fields(folder / "memory.stat", "inactive_file"))


def _of_the_process() -> Iterator[float]:
    most, _ = resource.getrlimit(resource.RLIMIT_AS)
    if most != resource.RLIM_INFINITY:
        yield from (most - used for used in _kilobytes(_STATUS, "VmSize:"))


def _kilobytes(file: Path, name: str) -> Iterator[float]:
    yield from (1024.0 * value for value in _fields(file, name))


def _fields(file: Path, name: str) -> Iterator[float]:
    """The number after a name in a file of lines."""
    words = (line.split() for line in _text(file).splitlines())
    yield from (float(line[1]) for line in words if len(line) > 1 and line[0] == name)


def _number(file: Path) -> Iterator[float]:
    """The number that a file holds, if it holds one."""
    text = _text(file).strip()
    if text.isdecimal():
        yield float(text)


def _text(file: Path) -> str:
    try:
        return file.read_text(encoding="ascii", errors="replace")
    except OSError:
        return ""
