"""Runs by the workers of a Dask scheduler, on this machine or others.

A worker that dies is replaced, and the run that it had is done again; one whose worker dies time after time fails.
"""

from __future__ import annotations

import logging
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from pkgutil import get_data
from typing import Any
from uuid import uuid4

import dask
from distributed import Client, as_completed, get_worker
from distributed.scheduler import KilledWorker

from riser_soil import __version__
from riser_soil.errors import SceneError, SolveError
from riser_soil.variants.one_run import Task, run_variant
from riser_soil.variants.runs_folder import Outcome

CONNECTING = "10s"
PACKAGE = "riser_soil"
KILLED = 128 + signal.SIGKILL
SETTINGS = {"distributed.scheduler.worker-saturation": 1.0}  # a worker gets a run when it is free for it


def outcomes_by_dask(tasks: Sequence[Task], scheduler: str, begin: Callable[[], None]) -> Iterator[Outcome]:
    """Outcomes of tasks, as they end. When the caller closes the generator, runs are stopped.

    scheduler: its address. begin: called when the workers are there, before they get a task.
    """
    with dask.config.set(SETTINGS), _quiet_logs(), _connected(scheduler) as client:
        _refuse_strangers(client, scheduler)
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
            with suppress(OSError, CancelledError):  # the scheduler is lost
                client.cancel(list(futures), force=True)


def on_worker(task: Task) -> dict[str, Any]:
    """`run_variant` in a worker's thread, as long as somebody waits for it."""
    worker = get_worker()
    key = worker.get_current_task()

    def wanted() -> bool:
        known = worker.state.tasks.get(key)
        return known is not None and known.state == "executing"

    return run_variant(task, wanted)


def _outcome(future: Any, task: Task) -> Outcome:
    try:
        return Outcome.of(future.result())
    except KilledWorker as err:
        reason = f"its worker died {err.allowed_failures + 1} times; is memory enough?"
        return Outcome(task["name"], task["key"], KILLED, reason)


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
    contents = client.run(get_data, PACKAGE, "py.typed")  # a question in terms that all workers know
    for worker, content in contents.items():
        if content is None:
            raise SceneError(
                f"--scheduler {address}: its worker {worker} has no {PACKAGE}; install {__version__} there, or end it"
            )


@contextmanager
def _quiet_logs() -> Iterator[None]:
    """No log of workers that come and go: the outcomes of runs have what matters of it."""
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(logging.NOTSET)
