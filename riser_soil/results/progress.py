"""Progress line on the terminal during a run."""

from __future__ import annotations

from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.progress import Progress as Bar


class Progress:
    """Stage, time, time step, Newton iterations and seconds left; silent unless enabled and on a terminal.

    Goes to standard error, so that what the command prints can be piped. Use in a `with` statement.
    """

    def __init__(self, enabled: bool, console: Console | None = None) -> None:
        console = console or Console(stderr=True)
        self._bar = Bar(
            TextColumn("[bold]{task.description}"),
            BarColumn(),
            TextColumn("{task.fields[state]}"),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
            console=console,
            disable=not (enabled and console.is_terminal),
            refresh_per_second=4,
        )
        self._task = self._bar.add_task("", total=None, state="", visible=False)
        self._kind = "static"

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    def begin_stage(self, name: str, kind: str, end: float = 1.0) -> None:
        """kind: `static`, `quasi-static` or `dynamic`. end: t at the stage's end; in a static stage the load factor."""
        self._kind = kind
        self._bar.reset(self._task, total=end, description=name, state="", visible=True)

    def update(self, t: float, time_step: float, newton_iterations: int) -> None:
        """t: s since the stage began (static: load factor); time_step: of the step just accepted."""
        if self._bar.disable:
            return
        label = "load" if self._kind == "static" else "t"
        unit = "" if self._kind == "static" else " s"
        state = f"{label} {t:.4g}{unit}  step {time_step:.3g}{unit}  Newton {newton_iterations}"
        self._bar.update(self._task, completed=t, state=state)
