"""Progress of load cases: a bar on a terminal, else a line for each case that ends."""

from __future__ import annotations

import time
from datetime import timedelta
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from riser_soil.cases.case_folder import Outcome


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
        self._known, self._begun = known, time.monotonic()

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
            print(f"{self._ended} of {self._count}: {outcome.name}: {_told(outcome)}", flush=True)

    def _left(self) -> str:
        """By the mean over this call: cases that run side by side end in bunches."""
        seconds = (time.monotonic() - self._begun) / (self._ended - self._known) * (self._count - self._ended)
        return f"{timedelta(seconds=round(seconds))} left"


def _told(outcome: Outcome) -> str:
    if outcome.done:
        return f"done in {outcome.seconds:.3g} s"
    return f"failed with status {outcome.status}: {outcome.reason}"
