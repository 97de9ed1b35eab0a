"""What a command tells: all of it on the terminal, or warnings and errors alone; all in a log file, with times."""

from __future__ import annotations

import inspect
import re
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, Literal, TextIO

import typer

from riser_soil import __version__
from riser_soil.commands.exit_status import expected_errors
from riser_soil.core.environment import rank
from riser_soil.errors import ResultsError

Quiet = Annotated[bool, typer.Option("-q", "--quiet", help="print warnings and errors alone")]
LogFile = Annotated[
    Path | None,
    typer.Option("--log-file", metavar="FILE", help="also write all output to this file, with times; appends"),
]
_OPTIONS = {"quiet": (Quiet, False), "log_file": (LogFile, None)}
_WARNING, _NEWS = "warning: ", "compiling kernels"  # messages of quiet runs, and news that are no error
_DRAWN = re.compile(r".*(?:\r|\x1b\[[0-9;]*[ABKJ])")  # a progress line that has been drawn over
_STYLE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")


def logged(command: Callable[..., None]) -> Callable[..., None]:
    """The command with the options --quiet and --log-file."""

    @wraps(command)
    def with_options(*, quiet: bool, log_file: Path | None, **given: Any) -> None:
        with _with_log_file(quiet, log_file):
            command(**given)

    own = inspect.signature(command, eval_str=True)
    kind = inspect.Parameter.KEYWORD_ONLY
    more = [inspect.Parameter(name, kind, default=d, annotation=a) for name, (a, d) in _OPTIONS.items()]
    vars(with_options)["__signature__"] = own.replace(parameters=[*own.parameters.values(), *more])
    with_options.__annotations__ = command.__annotations__ | {name: a for name, (a, _) in _OPTIONS.items()}
    return with_options


@contextmanager
def _with_log_file(quiet: bool, log_file: Path | None) -> Iterator[None]:
    """Standard output and error as the options want them; as they were afterwards."""
    with expected_errors():
        log = None if log_file is None or rank() > 0 else _Log(log_file)
    former = sys.stdout, sys.stderr
    streams = [_Lines(former[0], quiet and _warns, log), _Lines(former[1], quiet and _errs, log)]
    sys.stdout, sys.stderr = streams
    try:
        yield
    finally:
        for stream in streams:
            stream.end()
        sys.stdout, sys.stderr = former
        if log is not None:
            log.close()


def _warns(line: str) -> bool:
    return line.startswith(_WARNING)


def _errs(line: str) -> bool:
    return not line.startswith(_NEWS)


class _Lines:
    """A stream whose lines go to the log, too.

    keeps: chooses the lines that are told, and the stream is no terminal then, so that nothing draws on it; False: all
    are told as they come.
    """

    def __init__(self, stream: TextIO, keeps: Callable[[str], bool] | Literal[False], log: _Log | None) -> None:
        self._stream, self._keeps, self._log, self._partial = stream, keeps, log, ""

    def write(self, text: str) -> int:
        if not self._keeps:
            self._stream.write(text)
        *whole, self._partial = (self._partial + text).split("\n")
        for line in whole:
            self._write(line)
        return len(text)

    def end(self) -> None:
        """Nothing more comes."""
        if self._partial:
            self._write(self._partial)
        self._stream.flush()

    def isatty(self) -> bool:
        return not self._keeps and self._stream.isatty()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def _write(self, line: str) -> None:
        if self._log is not None:
            self._log.write(line)
        if self._keeps and self._keeps(line):
            self._stream.write(f"{line}\n")


class _Log:
    """The log file: lines after date and time, without colours; begins with the call. A full disk ends the log alone.

    ResultsError where it can't be opened.
    """

    def __init__(self, file: Path) -> None:
        try:
            self._file: TextIO | None = file.open("a", encoding="utf-8", buffering=1)
        except OSError as err:
            raise ResultsError(f"--log-file {file}: cannot be written: {err.strerror}; choose another file") from err
        self.write(f"riser-soil {__version__}: {' '.join(sys.argv[1:])}")

    def write(self, line: str) -> None:
        text = _STYLE.sub("", _DRAWN.sub("", line)).rstrip()
        if text and self._file is not None:
            try:
                self._file.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')} {text}\n")
            except OSError as err:
                name, self._file = self._file.name, None
                print(f"warning: --log-file {name}: ends here: {err.strerror}", file=sys.__stderr__)

    def close(self) -> None:
        if self._file is not None:
            self._file.close()
