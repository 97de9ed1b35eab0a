"""Jobs that several processes do side by side, each job once: forks of this process, as many as there are cores.

A fork has all that this process has, a compiler's state too, so that it begins at once. What it makes must stay where
this process finds it: on disk. RISER_SOIL_COMPILERS in the environment says how many processes there are at most.
"""

from __future__ import annotations

import gc
import os
import signal
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Protocol

from riser_soil.core.environment import cores, rank, size

AT_MOST = "RISER_SOIL_COMPILERS"


class Job(Protocol):
    """Something that one of several processes does."""

    @property
    def free(self) -> bool:
        """Whether it has not been done and no process does it now."""

    def do(self) -> None:
        """Do it, or wait for the process that was quicker."""


def side_by_side(jobs: Sequence[Job]) -> None:
    """Do the jobs that are free, in this process and its forks; ranks share the cores. Some may still be done by other
    ranks at the end.
    """
    here = max(min(at_most() // size(), len(jobs)), 1)
    turned = [_turned(jobs, (here * rank() + n) / (here * size())) for n in range(here)]
    with _forks(turned[1:]):
        _do(turned[0], os.getppid())


def at_most() -> int:
    """How many processes there are at most: as many as this one may use cores, where the environment does not say it.
    """
    given = os.environ.get(AT_MOST, "")
    return int(given) if given.isdecimal() and int(given) > 0 else cores()


def _turned(jobs: Sequence[Job], share: float) -> list[Job]:
    """Jobs in turn, begun behind a share of them, so that processes do not meet soon."""
    first = int(len(jobs) * share)
    return [*jobs[first:], *jobs[:first]]


def _do(jobs: Sequence[Job], parent: int) -> None:
    """Do the jobs that are free, while this process has that parent."""
    for job in jobs:
        if job.free and os.getppid() == parent:
            job.do()


@contextmanager
def _forks(of_each: Sequence[Sequence[Job]]) -> Iterator[None]:
    """A fork for each sequence of jobs, meanwhile. They are waited for at the end, or ended where that fails."""
    forks = list[int]()
    try:
        for jobs in of_each:
            forks += _fork(jobs)
        yield
    except BaseException:
        for fork in forks:
            os.kill(fork, signal.SIGKILL)
        raise
    finally:
        for fork in forks:
            with suppress(ChildProcessError):  # a system that waits for all processes itself
                os.waitpid(fork, 0)


def _fork(jobs: Sequence[Job]) -> list[int]:
    """Start a fork that does jobs; its number, unless the system refuses it. It leaves this process' files and threads
    as they are: it ends without a word, whatever happens there, and soon when this process is gone.
    """
    parent = os.getpid()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # beside threads, of which none is needed there
            fork = os.fork()
    except OSError:
        return []
    if fork:
        return [fork]
    try:
        gc.disable()  # all that it leaves behind goes with it: to look for garbage takes a compiler a tenth of its time
        _do(jobs, parent)
    finally:
        os._exit(0)
