"""Workers for cases, by Dask's distributed scheduler: processes of this machine, or those of a scheduler elsewhere.

A worker that dies is replaced, and the case that it had is done again; one whose worker dies time after time fails.
"""

from __future__ import annotations

import logging
import os
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from pkgutil import get_data
from typing import Any
from uuid import uuid4

import dask
from distributed import Client, LocalCluster, as_completed, get_worker
from distributed.scheduler import KilledWorker

from riser_soil import __version__
from riser_soil.cases.case_folder import Outcome
from riser_soil.cases.work import Task, run_case
from riser_soil.errors import SceneError, SolveError

CONNECTING = "10s"
PACKAGE = "riser_soil"
_HERE = "127.0.0.1"  # all that listens, does so here alone, at ports that are free
KILLED = 128 + signal.SIGKILL
SETTINGS = {"distributed.scheduler.worker-saturation": 1.0}  # a worker gets a case when it is free for it


def outcomes(
    tasks: Sequence[Task], jobs: int, scheduler: str | None, begin: Callable[[], None]
) -> Iterator[Outcome]:
    """What becomes of the cases, as they end. When the caller leaves, cases that run are stopped.

    scheduler: address of a Dask scheduler, whose workers are taken; None: `jobs` worker processes on this machine.
    begin: called when the workers are there, before they get a case.
    """
    with dask.config.set(SETTINGS), _client(jobs, scheduler) as client:
        begin()
        mark = uuid4().hex
        futures = {
            client.submit(on_worker, task, key=f"{task['name']}-{mark}", pure=False, priority=-n): task
            for n, task in enumerate(tasks)  # the first ones first
        }
        try:
            for future in as_completed(list(futures)):
                yield _outcome(future, futures.pop(future))
                future.release()
        except CancelledError as err:
            raise SolveError(
                f"--scheduler {scheduler}: does not answer any more; call again to go on: cases that are done are kept"
            ) from err
        finally:
            with suppress(OSError, CancelledError):  # of a scheduler that is lost
                client.cancel(list(futures), force=True)


def on_worker(task: Task) -> dict[str, Any]:
    """`run_case` in a worker's thread, as long as somebody waits for it."""
    worker = get_worker()
    key = worker.get_current_task()

    def wanted() -> bool:
        known = worker.state.tasks.get(key)
        return known is not None and known.state == "executing"

    return run_case(task, wanted)


def _outcome(future: Any, task: Task) -> Outcome:
    try:
        return Outcome.of(future.result())
    except KilledWorker as err:
        reason = f"its worker died {err.allowed_failures + 1} times; is memory enough?"
        return Outcome(task["name"], task["key"], KILLED, reason)


@contextmanager
def _client(jobs: int, scheduler: str | None) -> Iterator[Client]:
    with _quiet_logs():
        if scheduler is not None:
            with _connected(scheduler) as client:
                _refuse_strangers(client, scheduler)
                yield client
            return
        with (
            LocalCluster(
                n_workers=jobs, threads_per_worker=1, processes=True, memory_limit=0, silence_logs=logging.CRITICAL,
                host=_HERE, dashboard_address=f"{_HERE}:0", worker_dashboard_address=f"{_HERE}:0",
                scheduler_kwargs={"dashboard": False},
            ) as cluster,
            Client(cluster) as client,
        ):  # fmt: skip
            yield client


def _connected(address: str) -> Client:
    try:
        return Client(address, timeout=CONNECTING)
    except (OSError, ValueError) as err:
        reason = " ".join(str(err).split())
        raise SceneError(
            f"--scheduler {address}: nobody answers there ({reason}); start one by: dask scheduler"
        ) from err


def _refuse_strangers(client: Client, address: str) -> None:
    """SceneError where a worker lacks this package: it could not read what it is sent, and would fall silent."""
    found = client.run(get_data, PACKAGE, "py.typed")  # a question in terms that all workers know
    for worker, content in found.items():
        if content is None:
            raise SceneError(
                f"--scheduler {address}: its worker {worker} has no {PACKAGE}; install {__version__} there, or end it"
            )


@contextmanager
def _quiet_logs() -> Iterator[None]:
    """Dask tells of workers that come and go, which the table of cases tells as far as it matters."""
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(logging.NOTSET)


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0))
