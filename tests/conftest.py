"""What all tests share: a process that Ctrl-C interrupts. What a script starts in the background ignores it, and passes
that on to all that it starts; a handler, though, ends where another program begins.
"""

from __future__ import annotations

import signal
from collections.abc import Iterator

import pytest


@pytest.fixture(autouse=True, scope="session")
def interruptible() -> Iterator[None]:
    usual = signal.getsignal(signal.SIGINT)
    if usual == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, usual)
