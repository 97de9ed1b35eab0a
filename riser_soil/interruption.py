"""Signal handling: Ctrl-C and SIGTERM end a run between two steps, never within a record.

Python calls a signal's handler between two of its own instructions, so its exception can be raised anywhere. A single
process raises it at once, unless it is accepting or recording a step, or is to leave a checkpoint: that is the state
after a step, so that the step in hand is taken first. Several ranks would deadlock if each left its own loop: they
agree on the step after which all leave. A second signal takes effect at once.
"""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any, NoReturn

from riser_soil.errors import Interruption, RiserSoilError

OURS = (signal.SIGINT, signal.SIGTERM)


class _Pending:
    """Signals that this process has received and not yet handled."""

    def __init__(self) -> None:
        self.number = 0  # number of the signal not yet obeyed; 0 for none
        self.busy = 0  # how many blocks forbid to leave now
        self.agreeing = False  # whether to leave between two steps alone, all ranks at the same one
        self.latest: Interruption | None = None

    def receive(self, number: int, frame: FrameType | None = None) -> None:
        again, self.number = self.number != 0, self.number or number
        if not self.busy and (again or not self.agreeing):
            self.interrupt()

    def interrupt(self, together: bool = False) -> NoReturn:
        self.latest, self.number = Interruption(self.number, together), 0
        raise self.latest

    def restore(self) -> None:
        """An interruption that got lost is raised again at the end of the next block that no signal interrupts."""
        if self.latest is not None:
            self.number, self.latest = self.latest.number, None


def latest() -> Interruption | None:
    """The last that was raised: who takes it for a common KeyboardInterrupt may have swallowed it."""
    return _pending.latest


_pending = _Pending()


@contextmanager
def handling_signals() -> Iterator[None]:
    """Signals that would end the process raise Interruption in the block; those that other code handles don't.

    A pipe that is closed is an error of its writer again, and no signal, which PETSc makes of it.
    """
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    mine = [number for number in OURS if _is_free(number)]
    if mine:
        _pending.number, _pending.latest = 0, None
    former = {number: signal.signal(number, _pending.receive) for number in mine}
    try:
        with unmasked(), _unraisable_kept():
            yield
    finally:
        for number, handler in former.items():
            signal.signal(number, handler)


@contextmanager
def interrupted(place: str) -> Iterator[None]:
    """Interruption that is raised in the block says where the program was. place: and what is in its folder."""
    try:
        yield
    except Interruption as end:
        end.place = place
        raise


@contextmanager
def _unraisable_kept() -> Iterator[None]:
    """Keeps signals that come within a function that C calls back, as LLVM does when a kernel is compiled or read: it
    can raise nothing, and Python prints what it would have raised.
    """
    usual = sys.unraisablehook

    def keep(lost: Any) -> None:
        if isinstance(lost.exc_value, Interruption):
            _pending.restore()
        else:
            usual(lost)

    sys.unraisablehook = keep
    try:
        yield
    finally:
        sys.unraisablehook = usual


@contextmanager
def _unprinted() -> Iterator[None]:
    """Prints no traceback of signals that come while a compiled module is imported: numpy's `import_array` prints what
    it meets, and raises an ImportError.
    """
    usual = sys.excepthook

    def leave_out(kind: type[BaseException], raised: BaseException, trace: TracebackType | None) -> None:
        if not isinstance(raised, Interruption):
            usual(kind, raised, trace)

    sys.excepthook = leave_out
    try:
        yield
    finally:
        sys.excepthook = usual


@contextmanager
def unmasked() -> Iterator[None]:
    """Raises the Interruption of a signal where another exception has taken its place, and keeps it from being printed.

    One that came within compiled code makes a SystemError of its caller, one within the import of a compiled module an
    ImportError, one within pydantic's making of a model a SchemaError; where an import was cut off and its caller tried
    another way, anything may have followed.
    """
    try:
        with _unprinted():
            yield
    except (RiserSoilError, OSError):
        raise
    except Exception as err:
        end = _interruption_behind(err) or _pending.latest
        if end is not None and not end.concluded:
            raise end from None
        raise


def _interruption_behind(err: BaseException) -> Interruption | None:
    """The one that an error came of, or in whose handling it was raised."""
    behind: BaseException | None = err
    while behind is not None and not isinstance(behind, Interruption):
        behind = behind.__cause__ or behind.__context__
    return behind


@contextmanager
def restoring_signal_handlers() -> Iterator[None]:
    """Restores the handler of Ctrl-C after the block: gmsh replaces it when it is imported, or a session begins."""
    usual = signal.getsignal(signal.SIGINT)
    try:
        yield
    finally:
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGINT, usual)


def default_signal_handlers() -> None:
    """Let signals end this process at once and without a message."""
    for number in OURS:
        signal.signal(number, signal.SIG_DFL)


def _is_free(number: int) -> bool:
    """Only a process's main thread may handle signals."""
    usual = signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler)
    return usual and threading.current_thread() is threading.main_thread()


@contextmanager
def uninterrupted() -> Iterator[None]:
    """A block that no signal interrupts: Interruption is raised at its end."""
    _pending.busy += 1
    try:
        yield
    finally:
        _pending.busy -= 1
    if _pending.number and not _pending.busy and not _pending.agreeing:
        _pending.interrupt()


@contextmanager
def agreeing(comm: Any) -> Iterator[None]:
    """A block in which the ranks, if there are several, leave together: at `check`."""
    _pending.agreeing = comm.size > 1
    try:
        yield
    finally:
        _pending.agreeing = False


def leave_between_steps() -> None:
    """Let a process alone leave an `agreeing` block at `check`, too."""
    _pending.agreeing = True


def check(comm: Any) -> None:
    """Raises Interruption on all ranks if one has received a signal; collective in an `agreeing` block, nothing alone.
    """
    if asked_to_end(comm):
        end_together()


def asked_to_end(comm: Any) -> bool:
    """Whether a rank has received a signal, so that all are to `end_together`; collective as `check`."""
    if not _pending.agreeing:
        return False
    number = max(comm.allgather(_pending.number)) if comm.size > 1 else _pending.number
    if number:
        _pending.number = number
    return bool(number)


def end_together() -> NoReturn:
    """Raises the Interruption that `asked_to_end` has told of."""
    _pending.interrupt(together=True)
