"""Load cases from their file to their table."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from riser_soil import __version__
from riser_soil.cases.case_folder import ATTEMPTS, CASE, CASES, FILES, Outcome, clear_attempts, found, place
from riser_soil.cases.case_table import CaseTable, case_table
from riser_soil.cases.expansion import Case, read_cases
from riser_soil.cases.work import Task
from riser_soil.errors import Interruption, SceneError
from riser_soil.results.folder import FolderLock
from riser_soil.results.ownership import sealed
from riser_soil.results.whole_file import refuse_file, unusable


@dataclass(frozen=True)
class Workers:
    """Who computes: `jobs` worker processes on this machine, or those of a Dask scheduler at an address.

    limit: s that one case may take, from its start to its end; None: as long as it likes.
    """

    jobs: int = 1
    scheduler: str | None = None
    limit: float | None = None


def run_cases(
    file: Path, folder: Path, workers: Workers, overrides: Sequence[str] = (), says: Callable[[str], None] = print
) -> CaseTable:
    """Run the cases of a file that are not done yet, and leave their table in the folder.

    overrides: of the base scene, beside those of the file. Cases that fail are rows with their reasons. Raises
    SceneError before the first case is run; Interruption leaves what has ended, and a further call goes on.
    """
    reported, cases = read_cases(file, overrides)
    folder = folder.absolute()
    with _held(folder, cases):
        outcomes = {case.name: known for case in cases if (known := found(folder, case.name, case.key))}
        todo = [_task(case, folder, workers.limit) for case in cases if case.name not in outcomes]
        says(f"{len(cases)} cases, {len(outcomes)} of them done already" if outcomes else f"{len(cases)} cases")
        outcomes |= _computed(todo, workers, len(cases), folder) if todo else {}
        table = case_table(f"Load cases of {file.name}", folder, cases, outcomes, reported.statistics.since)
        from riser_soil.cases.case_files import write_files

        write_files(table, folder)
    return table


def _computed(todo: Sequence[Task], workers: Workers, count: int, folder: Path) -> dict[str, Outcome]:
    from riser_soil.cases.pool import outcomes

    found = {}

    def begin() -> None:
        """The tables of an earlier call go before the first case changes."""
        try:
            clear_attempts(folder)
            (folder / CASES / ATTEMPTS).mkdir(parents=True)
            for name in FILES:
                (folder / name).unlink(missing_ok=True)
        except OSError as err:
            raise unusable(folder, err) from err

    with CaseProgress(count, count - len(todo)) as progress:
        try:
            for outcome in outcomes(todo, min(workers.jobs, len(todo)), workers.scheduler, begin):
                found[outcome.name] = outcome
                progress.take(outcome)
        except Interruption as end:
            end.place = f"when {progress.ended} of {count} cases had ended; {folder} keeps them, call again to go on"
            raise
    return found


def _task(case: Case, folder: Path, limit: float | None) -> Task:
    task = {"name": case.name, "key": case.key, "scene": sealed(case.scene), "folder": str(folder)}
    return task | {"limit": limit, "version": __version__}


@contextmanager
def _held(folder: Path, cases: Sequence[Case]) -> Iterator[None]:
    """The folder for this call alone. Attempts do not outlast it; nor does a folder that it has made, if empty."""
    _refuse(folder, cases)
    there = folder.is_dir()
    try:
        lock = FolderLock(folder)
    except OSError as err:
        raise unusable(folder, err) from err
    try:
        with lock:
            try:
                yield
            finally:
                clear_attempts(folder)
    finally:
        if not there:
            with suppress(OSError):  # holds something
                folder.rmdir()


def _refuse(folder: Path, cases: Sequence[Case]) -> None:
    """Only an empty folder, or one with cases, takes cases; of these only what was written as one is replaced."""
    refuse_file(folder)
    there = [entry.name for entry in folder.iterdir()] if folder.is_dir() else []
    if there and CASES not in there:
        raise SceneError(f"{folder}: holds something else than load cases, {min(there)}; choose another with -o FOLDER")
    for case in cases:
        at = place(folder, case.name)
        if at.exists() and not (at / CASE).is_file():
            raise SceneError(f"{at}: is no case's folder, and would be replaced; move it away, or choose another (-o)")


class CaseProgress:
    """Cases that have ended, and the time left. Use in a `with` statement.

    The bar goes to standard error, so that what the command prints can be piped; lines go to standard output, on a
    terminal those of failed cases alone.
    """

    def __init__(self, count: int, known: int, console: Console | None = None) -> None:
        console = console or Console(stderr=True)
        self._count, self._ended, self._failed = count, known, 0
        self._on_terminal = console.is_terminal
        self._bar = Progress(
            TextColumn("[bold]cases"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[failed]}"),
            TimeElapsedColumn(), TextColumn("{task.fields[left]}"),
            console=console, disable=not self._on_terminal, refresh_per_second=4,
        )  # fmt: skip
        self._task = self._bar.add_task("", total=count, completed=known, failed="", left="")
        self._known, self._start = known, time.monotonic()

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    @property
    def ended(self) -> int:
        """Cases that have ended, those of earlier calls included."""
        return self._ended

    def take(self, outcome: Outcome) -> None:
        """One more has ended."""
        self._ended += 1
        self._failed += not outcome.done
        failed = f"{self._failed} failed" if self._failed else ""
        self._bar.update(self._task, completed=self._ended, failed=failed, left=self._left())
        if not (outcome.done and self._on_terminal):
            print(f"{self._ended} of {self._count}: {outcome.name}: {_reported(outcome)}", flush=True)

    def _left(self) -> str:
        """By the mean over this call: cases that run side by side end in bunches."""
        seconds = (time.monotonic() - self._start) / (self._ended - self._known) * (self._count - self._ended)
        return f"{timedelta(seconds=round(seconds))} left"


def _reported(outcome: Outcome) -> str:
    if outcome.done:
        return f"done in {outcome.seconds:.3g} s"
    return f"failed with status {outcome.status}: {outcome.reason}"
