"""Memory and disk limits: a scene that exceeds what the machine has is refused before anything is built."""

from __future__ import annotations

import math
import resource
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from riser_soil.checks.estimate import WITHIN, ProblemSize, riser_memory, size_of
from riser_soil.core.communicator import Communicator
from riser_soil.errors import DiskShortageError, SceneError
from riser_soil.scene.scene import Scene

NOTED, LONG = 20.0, 3600.0  # s: a run tells its estimate; a run is warned of
_REMEDIES = {
    "riser.segments": "take longer elements",
    "output.interval": "take a longer interval",
    "water.waves": "take fewer components or longer elements",
    "soil.mesh": "take larger cells or a smaller block, or solver: {linear: iterative}",
}
_UNITS = ((365.25 * 86400.0, "years"), (86400.0, "days"), (3600.0, "h"), (60.0, "min"), (0.0, "s"))
_MEMORY = Path("/proc/meminfo")
_STATUS = Path("/proc/self/status")
_GROUPS = (
    (Path("/sys/fs/cgroup"), "memory.max", "memory.current"),
    (Path("/sys/fs/cgroup/memory"), "memory.limit_in_bytes", "memory.usage_in_bytes"),
)


def size_that_fits(scene: Scene, folder: Path, comm: Communicator) -> ProblemSize:
    """The size of a scene whose results go to a folder; SceneError, with the numbers, where it exceeds the memory that
    is available, by more than the forecast may be off; DiskShortageError, the disk that is free. Collective: all ranks
    come to the same answer.
    """
    size = size_of(scene)
    most, free = _available_memory(comm), min(comm.allgather(free_disk(folder)))
    if size.memory(comm.size) > WITHIN * most:
        raise SceneError(_too_much_memory(size, comm.size, most))
    if size.disk > free:
        raise DiskShortageError(_too_much_disk(size, free))
    return size


def tight(size: ProblemSize, comm: Communicator) -> list[str]:
    """A warning of a run that may not fit into the memory that is available; to be asked for before it takes any.
    Collective.
    """
    most = _available_memory(comm)
    if WITHIN * size.memory(comm.size) <= most:
        return []
    return [f"the run may end for want of memory: {_too_much_memory(size, comm.size, most)}"]


def _available_memory(comm: Communicator) -> float:
    """Bytes that all ranks together can still have; collective."""
    return min(comm.allgather(available_memory() * _nodes(comm)))


def too_long(size: ProblemSize) -> Iterator[str]:
    """A warning of a long run."""
    if size.seconds > LONG:
        yield (
            f"the run takes about {in_words(size.seconds)}, {size.steps_in_words} of {_parts(size)}: check duration, "
            "time_step and load_steps, and what is meshed more finely than it needs to be"
        )


def announce(size: ProblemSize, comm: Communicator) -> None:
    """Announce a run that lasts a while, before it begins."""
    if size.seconds > NOTED and comm.rank == 0:
        print(f"this takes about {in_words(size.seconds)}, {size.steps_in_words} of {_parts(size)}", flush=True)


def in_words(seconds: float) -> str:
    """A time in a unit that suits it."""
    unit, name = next((unit, name) for unit, name in _UNITS if seconds >= 2.0 * unit)
    return f"{seconds / (unit or 1.0):.2g} {name}"


def in_bytes(number: float) -> str:
    return f"{number / 1e9:.3g} GB" if number >= 1e9 else f"{number / 1e6:.3g} MB"


def _nodes(comm: Any) -> float:
    """Number of machines on which the ranks run, each with memory of its own."""
    if comm.size == 1:
        return 1.0
    from mpi4py import MPI

    here: Any = comm.Split_type(MPI.COMM_TYPE_SHARED)
    share = comm.size / here.size
    here.Free()
    return float(share)


def _parts(size: ProblemSize) -> str:
    soil = f" and {size.cells:.4g} cells of soil" if size.cells else ""
    return f"{size.elements} elements{soil}"


def _too_much_memory(size: ProblemSize, ranks: int, most: float) -> str:
    path = _largest(size)
    need = f"{_parts(size)} need about {in_bytes(size.memory(ranks))} of memory"
    if path == "output.interval":
        need = f"automatic steps that hit {size.stops:.4g} output times need {in_bytes(size.memory(ranks))} of memory"
    return f"{path}: {need}, and {in_bytes(most)} are available; {_REMEDIES[path]}"


def _largest(size: ProblemSize) -> str:
    """Path of what takes most of the memory."""
    parts = {
        "riser.segments": riser_memory(1, size.riser_unknowns),
        "output.interval": size.memory_of_stops,
        "water.waves": size.memory_of_waves,
    }
    parts["soil.mesh"] = size.memory(1) - sum(parts.values())
    return max(parts, key=lambda path: parts[path])


def _too_much_disk(size: ProblemSize, free: float) -> str:
    what = f"{size.records:.4g} records and {size.pictures:.4g} pictures of {_parts(size)}, {size.steps_in_words}"
    remedy = "take longer intervals of output, a shorter duration or a longer time_step"
    return f"output.interval: {what}: about {in_bytes(size.disk)} on disk, and {in_bytes(free)} are free; {remedy}"


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
    """Memory of the process's control group, in a container; the file cache counts as available."""
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
