"""Signals that end a run: between two steps, with one line, and the last accepted state in the files."""

from __future__ import annotations

import ctypes
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace

import pytest
import typer

from riser_soil.commands.exit_status import expected_errors
from riser_soil.errors import Interruption
from riser_soil.interruption import agreeing, asked_to_end, check, handling_signals, leave_between_steps, uninterrupted
from riser_soil.results import Run
from tests.support.on_ranks import environment
from tests.support.said import line_with

ROOT = Path(__file__).parents[2]
# The command in a scene that goes on for ever, which sends itself a signal after some accepted steps.
ENDLESS = """
import os, signal, sys
from riser_soil.__main__ import main
from riser_soil.errors import Interruption
from riser_soil.results.observer import Observer

usual, taken = Observer.record, []

def record(self, stepper, step, last):
    usual(self, stepper, step, last)
    taken.append(step.t)
    if len(taken) == 14:
        os.kill(os.getpid(), signal.SIGNAL)

Observer.record = record
sys.argv = ["riser-soil", "run", "demos/first_scene.yaml", "-o", sys.argv[1], "--set", "stages.1.duration=1e4"]
main()
"""


BETWEEN = "os.kill(os.getpid(), signal.SIGNAL)"
# What the caller of compiled code raises if the signal came in there.
WITHIN = "raise SystemError('returned a result with an exception set') from Interruption(signal.SIGNAL)"


def nothing_done(number: signal.Signals) -> tuple[str, ...]:
    return f"ended by {number.name}", "before the first stage", "nothing was computed"


@pytest.fixture(autouse=True)
def forgotten() -> Iterator[None]:
    """What a test raises is not taken for what another one meets."""
    yield
    with handling_signals():
        pass


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_comes_as_an_interruption(number: signal.Signals) -> None:
    before = signal.getsignal(number)
    with pytest.raises(Interruption) as end, handling_signals():
        signal.raise_signal(number)
    assert end.value.exit_status == 128 + number
    line_with([str(end.value)], *nothing_done(number))
    assert signal.getsignal(number) == before


def test_a_signal_within_compiled_code_is_one_all_the_same() -> None:
    with pytest.raises(Interruption) as end, handling_signals():
        raise SystemError("returned a result with an exception set") from Interruption(signal.SIGINT)
    assert end.value.number == signal.SIGINT
    with pytest.raises(SystemError, match="another one"), handling_signals():
        raise SystemError("another one")


def test_a_signal_within_an_import_is_one_all_the_same(capsys: pytest.CaptureFixture[str]) -> None:
    """A compiled module that can't be imported for a signal prints what was raised, as this function of Python's does,
    and says that it can't be imported, and not why.
    """

    app = typer.Typer()  # which has a hook of its own for what is printed

    @app.command()
    def fails() -> None:
        with expected_errors():
            ctypes.pythonapi.PyRun_SimpleString(b"import signal; signal.raise_signal(signal.SIGTERM)")
            raise ImportError("numpy failed to import")

    with handling_signals():
        assert app([], standalone_mode=False) == 128 + signal.SIGTERM
    (line,) = capsys.readouterr().err.splitlines()
    line_with([line], *nothing_done(signal.SIGTERM))
    with pytest.raises(ImportError, match="no such module"), handling_signals(), expected_errors():
        raise ImportError("no such module")


def test_a_signal_within_a_model_in_the_making_is_one_all_the_same() -> None:
    """pydantic makes an error of its own of whatever is raised there, and keeps its text alone."""

    def fails() -> None:
        with suppress(Interruption):
            signal.raise_signal(signal.SIGINT)
        raise ValueError("Error building `literal` serializer: Interruption")

    with pytest.raises(Interruption), handling_signals():
        fails()
    with pytest.raises(ValueError, match="another one"), handling_signals():
        raise ValueError("another one")


@pytest.mark.parametrize("concluded", [False, True])
def test_what_follows_of_an_import_cut_off_by_a_signal_is_the_signal(concluded: bool) -> None:
    """h5py tries another of its modules where one fails; numpy is left half imported then."""

    def tries_another_way() -> None:
        raise AttributeError("module 'numpy' has no attribute 'ndarray'")

    def fails() -> None:
        try:
            signal.raise_signal(signal.SIGTERM)
        except Interruption as end:
            if concluded:
                end.place = "at time 1 s of stage 'surge'"
            tries_another_way()

    with pytest.raises(AttributeError if concluded else Interruption), handling_signals():
        fails()


def test_no_signal_divides_a_record() -> None:
    done: list[str] = []

    def record() -> None:
        with uninterrupted():
            with uninterrupted():
                signal.raise_signal(signal.SIGTERM)
                done.append("inner")
            done.append("outer")

    with handling_signals():
        with pytest.raises(Interruption):
            record()
        with uninterrupted():
            done.append("told once")
    assert done == ["inner", "outer", "told once"]


def test_what_fails_in_a_record_is_not_hidden_by_a_signal() -> None:
    def fail() -> None:
        with uninterrupted():
            signal.raise_signal(signal.SIGTERM)
            raise ZeroDivisionError

    with handling_signals(), pytest.raises(ZeroDivisionError):
        fail()


def test_ranks_leave_at_the_same_step() -> None:
    """This one was not told; the other one was."""
    others = SimpleNamespace(size=2, allgather=lambda number: [number, int(signal.SIGTERM)])
    with handling_signals(), agreeing(others), pytest.raises(Interruption) as end:
        check(others)
    assert (end.value.number, end.value.together) == (signal.SIGTERM, True)


def test_the_second_signal_is_obeyed_at_once() -> None:
    several = SimpleNamespace(size=2)
    with handling_signals(), agreeing(several):
        signal.raise_signal(signal.SIGINT)
        with pytest.raises(Interruption) as end:
            signal.raise_signal(signal.SIGINT)
    assert not end.value.together


def test_one_alone_may_leave_between_steps_too() -> None:
    alone = SimpleNamespace(size=1)
    with handling_signals(), agreeing(alone):
        leave_between_steps()
        check(alone)
        signal.raise_signal(signal.SIGINT)
        assert asked_to_end(alone)
        with pytest.raises(Interruption) as end:
            check(alone)
    assert (end.value.number, end.value.together) == (signal.SIGINT, True)


def test_alone_nobody_is_asked() -> None:
    with handling_signals(), agreeing(SimpleNamespace(size=1)):
        check(SimpleNamespace(size=1))


def test_signals_that_somebody_else_listens_to_are_left_to_him() -> None:
    heard: list[int] = []
    usual = signal.signal(signal.SIGTERM, lambda number, frame: heard.append(number))
    try:
        with handling_signals():
            signal.raise_signal(signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, usual)
    assert heard == [signal.SIGTERM]


def test_a_run_in_another_thread_listens_to_nothing() -> None:
    failures: list[Exception] = []

    def listen() -> None:
        try:
            with handling_signals():
                pass
        except ValueError as err:
            failures.append(err)

    thread = threading.Thread(target=listen)
    thread.start()
    thread.join()
    assert failures == []


MESHING = """
import os, signal, sys
from riser_soil.__main__ import main

sys.argv = ["riser-soil", "run", "tests/scenes/touchdown_on_block.yaml", "-o", sys.argv[1]]

def interrupt(frame, event, argument):
    if event == "call" and frame.f_code.co_name == "BEGIN" and "riser_soil" in frame.f_code.co_filename:
        sys.setprofile(None)
        os.kill(os.getpid(), signal.SIGINT)

sys.setprofile(interrupt)
main()
"""


@pytest.mark.parametrize("begin", [pytest.param("make_block", marks=pytest.mark.verify), "lagrange_nodes"])
def test_ctrl_c_is_heard_while_the_soil_is_meshed(begin: str, tmp_path: Path) -> None:
    """Within a session of gmsh, which would end the process without a word."""
    call = [sys.executable, "-c", MESHING.replace("BEGIN", begin), str(tmp_path / "out")]
    done = subprocess.run(call, cwd=ROOT, env=environment(), capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 128 + signal.SIGINT, done.stderr
    line_with(done.stderr.splitlines()[-1], *nothing_done(signal.SIGINT))


@pytest.mark.parametrize(
    ("number", "sent"),
    [
        (signal.SIGINT, BETWEEN),
        pytest.param(signal.SIGTERM, BETWEEN, marks=pytest.mark.verify),
        (signal.SIGINT, WITHIN),
    ],
)
def test_an_interrupted_run_keeps_its_last_accepted_step(number: signal.Signals, sent: str, tmp_path: Path) -> None:
    """13 steps of 0.1 s, of which every fifth is recorded, after one static step."""
    script, out = ENDLESS.replace(BETWEEN, sent).replace("SIGNAL", number.name), tmp_path / "out"
    call = [sys.executable, "-c", script, str(out)]
    done = subprocess.run(call, cwd=ROOT, env=environment(), capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 128 + number
    message = (
        f"ended by {number.name} in stage heave at t = 1.3 s; {out} has the results up to there, marked unfinished"
    )
    way_on = f"; go on with: riser-soil run {out}/scene.yaml -o {out} --restart" if sent == BETWEEN else ""
    assert done.stderr.splitlines()[-1] == message + way_on
    assert (out / "checkpoint.npz").exists() == (sent == BETWEEN), "within a step there is no state to go on from"
    assert len(done.stderr.splitlines()) <= 2, "but for the announcement of kernels"
    run = Run(out)
    assert not run.finished
    assert run.time == pytest.approx([0.0, 0.5, 1.0, 1.3])
    assert run.summary["stages"][1]["steps"] == 13


# The command, to which the signal comes within the library of the command line, before a command of ours has begun.
TOO_EARLY = """
import os, signal, sys
import typer.core
from riser_soil.__main__ import main

usual = typer.core.TyperGroup.invoke

def invoke(self, ctx):
    os.kill(os.getpid(), signal.SIGNAL)
    return usual(self, ctx)

typer.core.TyperGroup.invoke = invoke
sys.argv = ["riser-soil", "schema"]
main()
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interruption_that_a_library_takes_for_its_own_is_reported(number: signal.Signals) -> None:
    call = [sys.executable, "-c", TOO_EARLY.replace("SIGNAL", number.name)]
    done = subprocess.run(call, cwd=ROOT, env=environment(), capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 128 + number
    assert done.stdout == ""
    assert done.stderr == line_with(done.stderr, *nothing_done(number)) + "\n"


def test_a_signal_in_what_c_calls_back_is_reported_at_the_next_step(capsys: pytest.CaptureFixture[str]) -> None:
    """C calls back as LLVM calls numba: an exception ends nothing there."""
    called_back = ctypes.CFUNCTYPE(None)(lambda: signal.raise_signal(signal.SIGTERM))
    reached = []

    def begin() -> None:
        called_back()
        reached.append("what follows")
        with uninterrupted():
            reached.append("the step")
        reached.append("another step")

    with pytest.raises(Interruption, match="SIGTERM"), handling_signals():
        begin()
    assert reached == ["what follows", "the step"]
    assert capsys.readouterr().err == ""
