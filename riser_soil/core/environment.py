"""Environment of a run: versions of its packages, and variables of a process that this one starts for itself."""

from __future__ import annotations

import os
import platform
import sys
from contextlib import suppress
from functools import cache

# A child that saw its parent's MPI rank in these would take itself for that rank.
_MPI = ("OMPI_", "PMIX_", "PMI_", "HYDRA_", "SLURM_")
_PACKAGES = ("numpy", "scipy", "numba", "petsc4py", "mpi4py", "h5py", "dolfinx")


def environment_alone() -> dict[str, str]:
    """This process's environment without the variables that MPI has set."""
    return {name: value for name, value in os.environ.items() if not name.startswith(_MPI)}


def versions() -> dict[str, str]:
    """Version by name; of the packages those that this process has imported: a riser without soil has no dolfinx."""
    there = {name: sys.modules[name] for name in _PACKAGES if name in sys.modules}
    return {"python": platform.python_version()} | {name: module.__version__ for name, module in there.items()}


def rank() -> int:
    """This process's number under mpirun, without importing MPI; 0 alone."""
    return _from_environment("OMPI_COMM_WORLD_RANK", "PMI_RANK") or 0


def size() -> int:
    """Number of processes under mpirun, without importing MPI; 1 alone."""
    return _from_environment("OMPI_COMM_WORLD_SIZE", "PMI_SIZE") or 1


def _from_environment(*names: str) -> int | None:
    return next((int(os.environ[name]) for name in names if os.environ.get(name, "").isdecimal()), None)


def cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0))


@cache
def processor() -> str:
    """Name of the processor, and what it can do where the system says so: the same where machine code is the same."""
    known = [platform.machine()]
    with suppress(OSError), open("/proc/cpuinfo", encoding="utf-8", errors="replace") as file:
        first = file.read().split("\n\n")[0].splitlines()
        known += [line for line in first if line.startswith(("model name", "flags", "Features", "CPU part"))]
    return "\n".join(known)
