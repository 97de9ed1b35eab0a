"""Progress of pictures, films and reports: what is drawn, how much of it is done, and the time left."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from types import TracebackType
from typing import Self, TypeVar

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TaskProgressColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

OnProgress = Callable[[str, int, int], None]
"""Takes the words for what is drawn now, how many pieces are done, and of how many."""

Piece = TypeVar("Piece")


def silent(words: str, done: int, count: int) -> None:
    """Progress that nobody follows."""


def in_turn(pieces: Sequence[Piece], words: Callable[[Piece], str], on_progress: OnProgress) -> Iterator[Piece]:
    """The pieces, each reported before it is drawn, and the last one after it, too."""
    for done, piece in enumerate(pieces):
        on_progress(words(piece), done, len(pieces))
        yield piece
    if pieces:
        on_progress(words(pieces[-1]), len(pieces), len(pieces))


class DrawingProgress:
    """A bar with words, `3/23`, per cent and the time left; silent off a terminal. Use in a `with` statement.

    Goes to standard error, so that what the command prints can be piped.
    """

    def __init__(self, console: Console | None = None) -> None:
        console = console or Console(stderr=True)
        self._bar = Bar(
            TextColumn("[bold]{task.description}"), BarColumn(), MofNCompleteColumn(), TaskProgressColumn(),
            TextColumn("left"), TimeRemainingColumn(),
            console=console, disable=not console.is_terminal, refresh_per_second=4, transient=True,
            redirect_stdout=sys.stdout.isatty(),
        )  # fmt: skip
        self._task = self._bar.add_task("", total=None, visible=False)
        self._count = 0

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    def show(self, words: str, done: int, count: int) -> None:
        """Show what is drawn now, a `OnProgress`; the time left begins anew with each number of pieces."""
        if count != self._count:
            self._bar.reset(self._task, total=count, description=words, visible=True)
            self._count = count
        self._bar.update(self._task, completed=done, description=words)
