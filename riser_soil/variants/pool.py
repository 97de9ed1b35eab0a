"""Pool of runs: processes of this machine, several at a time, or those of a Dask scheduler's workers."""

from __future__ import annotations

import threading
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from riser_soil.errors import WriteError
from riser_soil.variants.one_run import Task, known, run_variant
from riser_soil.variants.runs_folder import Outcome, prepare_attempts


@dataclass(frozen=True)
class Workers:
    """Who computes: `jobs` runs at a time on this machine, or the workers of a Dask scheduler at an address."""

    jobs: int = 1
    scheduler: str | None = None


def divided(tasks: Sequence[Task]) -> tuple[dict[str, Outcome], list[Task]]:
    """Outcomes of earlier runs by their names, and the tasks that have to be computed, each name once."""
    earlier = {each["name"]: outcome for each in tasks if (outcome := known(each)) is not None}
    return earlier, [*{each["name"]: each for each in tasks if each["name"] not in earlier}.values()]


def compute(
    tasks: Sequence[Task], workers: Workers, on_end: Callable[[Outcome], None], begin: Callable[[], None] = lambda: None
) -> None:
    """Compute tasks and call `on_end` as each ends. No run of this machine outlives the call, however that ends.

    begin: called when the workers are there, before they get a task. Raises WriteError where the disk is full, as the
    next runs would fail for it, too.
    """
    if not tasks:
        return

    def prepare() -> None:
        prepare_attempts(Path(tasks[0]["runs"]))
        begin()

    with closing(outcomes(tasks, workers, prepare)) as ended:
        for outcome in ended:
            if outcome.status == WriteError.exit_status:
                raise WriteError(f"{outcome.name}: {outcome.reason}")
            on_end(outcome)


def outcomes(tasks: Sequence[Task], workers: Workers, begin: Callable[[], None]) -> Generator[Outcome]:
    """Outcomes of tasks, as they end. Runs are stopped when the caller closes the generator, and none begins or goes on
    on this machine once one has found the disk full.
    """
    if workers.scheduler is not None:
        from riser_soil.variants.dask_workers import outcomes_by_dask

        yield from outcomes_by_dask(tasks, workers.scheduler, begin)
        return
    begin()
    stopped = threading.Event()

    def run(task: Task) -> Outcome:
        outcome = Outcome.of(run_variant(task, lambda: not stopped.is_set()))
        if outcome.status == WriteError.exit_status:  # before this thread begins another
            stopped.set()
        return outcome

    with ThreadPoolExecutor(workers.jobs) as pool:
        futures = [pool.submit(run, task) for task in tasks]
        try:
            for future in as_completed(futures):
                yield future.result()
        finally:
            stopped.set()
            pool.shutdown(cancel_futures=True)
