"""The processes that take part in a run: MPI's communicator where there are several or soil, else one without MPI.

A riser alone needs no MPI, which takes its time to start and need not be installed. Whether a process is one of several
follows from the environment in which their launcher starts it.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Protocol

from riser_soil.errors import Interruption, RiserSoilError, SceneError

if TYPE_CHECKING:
    from riser_soil.core.arrays import IntArray

# How many processes were started together, by OpenMPI, MPICH and Intel MPI, MVAPICH, IBM's jsrun, Slurm's srun.
SIZES = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE", "JSM_NAMESPACE_SIZE", "SLURM_STEP_NUM_TASKS")
RANKS = ("PMIX_RANK", "PMI_RANK", "PALS_RANKID", "ALPS_APP_PE")  # of one among an unknown number
NAP = 0.01  # s between two looks whether all are there


class Communicator(Protocol):
    """Methods of mpi4py's communicators that a riser alone needs, too; collective but for rank and size."""

    @property
    def rank(self) -> int: ...

    @property
    def size(self) -> int: ...

    def bcast(self, value: Any, root: int = 0) -> Any: ...

    def gather(self, value: Any, root: int = 0) -> Any: ...

    def scatter(self, values: Any, root: int = 0) -> Any: ...

    def allgather(self, value: Any) -> Any: ...

    def allreduce(self, value: Any) -> Any:
        """The sum."""
        ...

    def exscan(self, value: Any) -> Any:
        """The sum over the ranks before; None on the first one."""
        ...


class Alone:
    """The communicator of one process."""

    rank, size = 0, 1

    def bcast(self, value: Any, root: int = 0) -> Any:
        return value

    def gather(self, value: Any, root: int = 0) -> list[Any]:
        return [value]

    def scatter(self, values: Any, root: int = 0) -> Any:
        return values[0]

    def allgather(self, value: Any) -> list[Any]:
        return [value]

    def allreduce(self, value: Any) -> Any:
        return value

    def exscan(self, value: Any) -> None:
        return None


def world(with_mpi: bool = False) -> Communicator:
    """All processes that were started together. with_mpi: MPI's communicator for one process, too, as the soil needs.

    SceneError where there are several and mpi4py is missing: each would take itself for the only one.
    """
    started = _started_together()
    if not (with_mpi or started or "mpi4py.MPI" in sys.modules):
        return Alone()
    if started and importlib.util.find_spec("mpi4py") is None:
        raise SceneError(
            f"{started}: this process is one of several, which can't be without mpi4py; install it with the MPI that "
            "has started them, or start one process alone"
        )
    comm: Communicator = importlib.import_module("mpi4py.MPI").COMM_WORLD
    return comm


def _started_together() -> str:
    """Variable of the environment by which there are several processes, or may be; "" where there is none."""
    environment = os.environ
    sizes = [name for name in SIZES if environment.get(name, "").isdecimal()]
    several = [name for name in sizes if int(environment[name]) > 1]
    among = [] if sizes else [name for name in RANKS if name in environment]
    return next((f"{name}={environment[name]}" for name in (*several, *among)), "")


def any_of(comm: Communicator, here: bool) -> bool:
    """Whether something is so on any rank; collective."""
    return here if comm.size == 1 else any(comm.allgather(here))


def all_of(comm: Communicator, here: bool) -> bool:
    """Whether something is so on all ranks; collective."""
    return here if comm.size == 1 else all(comm.allgather(here))


@contextmanager
def raised_on_all_ranks(comm: Communicator) -> Iterator[None]:
    """Raise an error of this program that a rank meets in the block on all ranks; collective."""
    failure: RiserSoilError | None = None
    try:
        yield
    except RiserSoilError as err:
        failure = err
    for error in comm.allgather(failure):
        if error is not None:
            raise error from (failure.__cause__ if failure is not None else None)


@contextmanager
def destroyed_together(comm: Communicator, *destroy: Callable[[], None]) -> Iterator[None]:
    """Call functions that free what all ranks share, as the block ends; collective.

    Not after an error that is not known to be all ranks': the one that met it would wait for the others, which are in
    the middle of their work, and its message would never be shown.
    """
    together = True
    try:
        yield
    except RiserSoilError:
        raise
    except BaseException as err:
        together = comm.size == 1 or (isinstance(err, Interruption) and err.together)
        raise
    finally:
        for each in destroy if together else ():
            each()


def wait_asleep(comm: Any) -> None:
    """Wait for all ranks without keeping a core busy that others need; collective."""
    if comm.size == 1:
        return
    barrier = comm.Ibarrier()
    while not barrier.Test():
        time.sleep(NAP)


def sum_of(comm: Communicator, values: Sequence[float]) -> list[float]:
    """Sums over all ranks, one for each value; collective."""
    if comm.size == 1:
        return list(values)
    return [float(each) for each in _reduced(comm, values, "SUM")]


def largest_of(comm: Communicator, values: IntArray) -> IntArray:
    """Largest entries on all ranks, of arrays of one shape; collective."""
    if comm.size == 1:
        return values
    largest: IntArray = _reduced(comm, values, "MAX")
    return largest


def _reduced(comm: Any, values: Any, operation: str) -> Any:
    import numpy as np
    from mpi4py import MPI

    reduced = np.array(values)
    comm.Allreduce(MPI.IN_PLACE, reduced, getattr(MPI, operation))
    return reduced
