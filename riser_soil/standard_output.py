"""Standard output that may be closed or full, as by `| head`; the run itself goes on."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO


class _Outlet(io.RawIOBase):
    """A file descriptor that drops all output after the first failure."""

    def __init__(self, descriptor: int) -> None:
        super().__init__()
        self.failure: OSError | None = None
        self._descriptor = descriptor

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._descriptor

    def isatty(self) -> bool:
        return os.isatty(self._descriptor)

    def write(self, data: Any) -> int:
        content = memoryview(data)
        if self.failure is None:
            try:
                return os.write(self._descriptor, content)
            except OSError as err:
                self.failure = err
        return len(content)


class OutputStatus:
    """Status of standard output: failure is None as long as all was written."""

    def __init__(self, output: _Outlet | None) -> None:
        self._output = output

    @property
    def failure(self) -> OSError | None:
        return None if self._output is None else self._output.failure


@contextmanager
def failsafe_output() -> Iterator[OutputStatus]:
    """In the block, writing to standard output or error never raises; a failure of the former is kept in the status."""
    former = sys.stdout, sys.stderr
    outlets = [_outlet(stream) for stream in former]
    sys.stdout, sys.stderr = (_text(outlet, stream) for outlet, stream in zip(outlets, former, strict=True))
    try:
        yield OutputStatus(outlets[0])
    finally:
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
        sys.stdout, sys.stderr = former


def _outlet(stream: TextIO | None) -> _Outlet | None:
    """None for a stream that is closed from the beginning, or that is no file, as of a program that listens in."""
    try:
        return None if stream is None else _Outlet(stream.fileno())
    except io.UnsupportedOperation:
        return None


def _text(outlet: _Outlet | None, like: TextIO) -> TextIO:
    if outlet is None:
        return like
    buffered = io.BufferedWriter(outlet)
    return io.TextIOWrapper(buffered, like.encoding, like.errors, line_buffering=True)
