"""What commands tell: quiet, into a log file, without colours; completion of shells."""

from __future__ import annotations

import os
import pty
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from rich.console import Console
from typer.testing import CliRunner

from riser_soil.commands.app import app
from riser_soil.errors import SolveError
from riser_soil.results.screen import Progress
from tests.support.case_files import SMALL
from tests.support.on_ranks import HANGS, ROOT, environment
from tests.support.said import line_with

STAMP = r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d "
TOLD, COMPILING, RESULT = "this takes about 3 s", "compiling kernels (once, about a minute)", "top tension 3 kN"
WARNED, FAILED = "warning: the pipe is bent beyond its min_bend_radius", "no convergence at arc 3 m"


@pytest.fixture
def invoke(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[..., Any]:
    """`riser-soil run small.yaml` in an empty folder with a computation that tells, warns, draws and fails."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "small.yaml").write_text(SMALL, encoding="utf-8")

    def compute(*given: object) -> None:
        print(TOLD)
        print(COMPILING, file=sys.stderr)
        with Progress(enabled=True) as progress:
            progress.begin_stage("hang", "static")
            progress.update(1.0, 1.0, 4)
            print(WARNED)
        Console().print(f"[red]{RESULT}[/red]")
        raise SolveError(FAILED)

    monkeypatch.setitem(sys.modules, "riser_soil.accuracy.chosen_run", SimpleNamespace(run_as_asked=compute))
    return lambda *options: CliRunner().invoke(app, ["run", "small.yaml", *options])


def test_all_is_reported_by_default(invoke: Callable[..., Any]) -> None:
    done = invoke()
    assert done.stdout.splitlines() == [TOLD, WARNED, RESULT]
    assert done.stderr.splitlines() == [COMPILING, FAILED]
    assert done.exit_code == 3


@pytest.mark.parametrize("option", ["-q", "--quiet"])
def test_quiet_tells_warnings_and_errors_alone(invoke: Callable[..., Any], option: str) -> None:
    done = invoke(option)
    assert (done.stdout, done.stderr) == (f"{WARNED}\n", f"{FAILED}\n")
    assert done.exit_code == 3


def test_the_log_file_has_all_that_is_reported_with_times(invoke: Callable[..., Any], tmp_path: Path) -> None:
    """Also where the command is quiet; a second call appends."""
    invoke("--log-file", "log.txt")
    invoke("--log-file", "log.txt", "-q")
    lines = (tmp_path / "log.txt").read_text(encoding="utf-8").splitlines()
    assert all(re.match(STAMP, line) for line in lines)
    messages = [re.sub(STAMP, "", line) for line in lines]
    assert messages[0].startswith("riser-soil ")
    assert messages[1:6] == [TOLD, COMPILING, WARNED, RESULT, FAILED]
    assert messages[7:] == messages[1:6]


def test_a_log_file_that_cannot_be_written_is_bad_input(invoke: Callable[..., Any], tmp_path: Path) -> None:
    done = invoke("--log-file", "nowhere/log.txt")
    assert (done.exit_code, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    line_with([line], "--log-file", "nowhere/log.txt:", "cannot be written:", "No such file")


def test_a_log_on_a_full_disk_ends_alone(invoke: Callable[..., Any], capfd: pytest.CaptureFixture[str]) -> None:
    done = invoke("--log-file", "/dev/full")
    assert done.exit_code == 3
    assert RESULT in done.stdout
    (line,) = capfd.readouterr().err.splitlines()
    line_with([line], "warning:", "--log-file", "/dev/full:", "ends here", "No space left")


DRAWS = """
import sys, time
from riser_soil.commands.logging import logged
from riser_soil.results.screen import Progress
from rich.console import Console
def command():
    with Progress(enabled=True) as progress:
        progress.begin_stage("hang", "static")
        print("laid in 3 steps")
        progress.update(1.0, 1.0, 4)
    Console().print("[red]top tension[/red] 3 kN")
logged(command)(quiet=False, log_file=__import__("pathlib").Path(sys.argv[1]))
"""


@pytest.mark.parametrize("no_color", [False, True])
def test_on_a_terminal_colours_are_shown_unless_unwanted_and_never_logged(no_color: bool, tmp_path: Path) -> None:
    ours, theirs = pty.openpty()
    given = environment() | {"TERM": "xterm-256color", "COLUMNS": "80"} | ({"NO_COLOR": "1"} if no_color else {})
    call = [sys.executable, "-c", DRAWS, str(tmp_path / "log.txt")]
    with subprocess.Popen(call, env=given, cwd=ROOT, stdout=theirs, stderr=theirs) as process:
        os.close(theirs)
        shown = b""
        while chunk := _read(ours):
            shown += chunk
        assert process.wait(timeout=HANGS) == 0
    os.close(ours)
    assert b"\x1b[?25l" in shown  # the bar hides the cursor
    assert bool(re.search(rb"\x1b\[(3|4|9)[0-9]", shown)) is not no_color
    messages = [re.sub(STAMP, "", line) for line in (tmp_path / "log.txt").read_text(encoding="utf-8").splitlines()]
    assert messages[1] == "laid in 3 steps"
    assert messages[-1] == "top tension 3 kN"
    assert "\x1b" not in "".join(messages)


def _read(terminal: int) -> bytes:
    try:
        return os.read(terminal, 65536)
    except OSError:  # nobody writes there any more
        return b""


def test_no_colours_where_there_is_no_terminal() -> None:
    call = [sys.executable, "-m", "riser_soil", "run", "--help"]
    given = {name: value for name, value in environment().items() if name not in ("FORCE_COLOR", "GITHUB_ACTIONS")}
    done = subprocess.run(call, env=given, cwd=ROOT, capture_output=True, text=True, timeout=HANGS, check=True)
    assert "--log-file" in done.stdout
    assert "\x1b" not in done.stdout


LIGHT = """
import sys
sys.argv[0] = "riser-soil"
from riser_soil.__main__ import main
try:
    main()
except SystemExit as leave:
    assert not leave.code
heavy = {"numpy", "numba", "petsc4py", "mpi4py", "dolfinx", "matplotlib", "distributed", "xarray"}
assert not heavy & set(sys.modules), heavy & set(sys.modules)
"""


def lightly(*arguments: str, **given: str) -> str:
    """What riser-soil prints, without numerics."""
    call = [sys.executable, "-c", LIGHT, *arguments]
    done = subprocess.run(call, env=environment() | given, cwd=ROOT, capture_output=True, text=True, timeout=HANGS)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


@pytest.mark.parametrize(
    ("words", "completed"),
    [("riser-soil ca", {"cases", "calibrate"}), ("riser-soil run --err", {"--error-bars"})],
)
def test_shells_complete_commands_and_options(words: str, completed: set[str]) -> None:
    asked = {"_RISER_SOIL_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    assert set(lightly(**asked).split()) == completed


def test_the_script_for_a_shell_is_shown() -> None:
    shown = lightly("--show-completion", "bash", _TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION="1")
    assert shown.strip().endswith("-F _riser_soil_completion riser-soil")
