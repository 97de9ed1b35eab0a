"""Progress of load cases: a table on a terminal, a line for each case elsewhere."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Set
from datetime import timedelta
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.live import Live
from rich.markup import escape
from rich.table import Table

from riser_soil.variants.runs_folder import Outcome

FEWEST_ROWS, OTHER_LINES = 3, 8  # rows of a table on a low screen; lines of the screen that are not its rows
Labels = tuple[str, ...]


class CaseProgress:
    """Number of cases of each group that are done, run and wait, and the remaining time. Use in a `with` statement.

    groups: labels of each case by its name, without that of the seed; as many of the first ones make rows as the screen
    has room for. todo: names of the cases that are computed in this call. running: names of those that run now.

    The table goes to standard error, so that the command's output can be piped. Lines go to standard output, on a
    terminal those of failed cases alone.
    """

    def __init__(
        self,
        groups: Mapping[str, Labels],
        todo: Set[str],
        running: Callable[[], Set[str]],
        console: Console | None = None,
    ) -> None:
        console = console or Console(stderr=True)
        self.count = len(groups)
        self._todo, self._running = set(todo), running
        self._outcomes: dict[str, Outcome] = {}
        self._rows = _rows(groups, max(FEWEST_ROWS, console.height - OTHER_LINES))
        self._on_terminal = console.is_terminal
        self._live = Live(get_renderable=self.table, console=console, refresh_per_second=2)
        self._start = time.monotonic()

    def __enter__(self) -> Self:
        if self._on_terminal:
            self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._on_terminal:
            self._live.stop()

    @property
    def ended(self) -> int:
        """Number of cases that have ended, those of earlier calls included."""
        return self.count - len(self._todo) + len(self._outcomes)

    def add(self, outcome: Outcome) -> None:
        """Count a case that has ended."""
        self._outcomes[outcome.name] = outcome
        if not (outcome.done and self._on_terminal):
            print(f"{self.ended} of {self.count}: {outcome.name}: {_ending_in_words(outcome)}", flush=True)

    def table(self) -> Table:
        """Table with a row for each group, one for all of them, and the remaining time."""
        running = self._running() & self._todo - self._outcomes.keys()
        table = Table(title=f"cases: {self.ended} of {self.count} ended{self._remaining()}", title_justify="left")
        table.add_column("cases", no_wrap=True)
        for head in ("done", "running", "waiting", "failed", "s each"):
            table.add_column(head, justify="right")
        for name, cases in self._rows.items():
            table.add_row(escape(name), *self._cells(cases, running))
        if len(self._rows) > 1:
            table.add_section()
            table.add_row("all", *self._cells(set().union(*self._rows.values()), running))
        return table

    def _cells(self, cases: Set[str], running: Set[str]) -> list[str]:
        ended = [self._outcomes[name] for name in cases if name in self._outcomes]
        failed = sum(not outcome.done for outcome in ended)
        done = len(cases - self._todo) + len(ended) - failed
        runs = len(cases & running)
        waiting = len(cases & self._todo) - len(ended) - runs
        mean = f"{sum(outcome.seconds for outcome in ended) / len(ended):.3g}" if ended else ""
        return [str(done), str(runs or ""), str(waiting or ""), f"[red]{failed}[/]" if failed else "", mean]

    def _remaining(self) -> str:
        """Remaining time in words, by the mean over this call, as cases that run side by side end in bunches."""
        if not self._outcomes:
            return ""
        seconds = (time.monotonic() - self._start) / len(self._outcomes) * (len(self._todo) - len(self._outcomes))
        return f", {timedelta(seconds=round(seconds))} left"


def _rows(groups: Mapping[str, Labels], most: int) -> dict[str, set[str]]:
    """Names of the cases of each row; rows are by as many labels as give at most so many rows."""
    depth = max(map(len, groups.values()), default=0)
    while depth and len({labels[:depth] for labels in groups.values()}) > most:
        depth -= 1
    rows: dict[str, set[str]] = {}
    for name, labels in groups.items():
        rows.setdefault(", ".join(labels[:depth]) or "all", set()).add(name)
    return rows


def _ending_in_words(outcome: Outcome) -> str:
    if outcome.done:
        return f"done in {outcome.seconds:.3g} s"
    return f"failed with status {outcome.status}: {outcome.reason}"
