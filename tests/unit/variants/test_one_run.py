"""One run of a variant without a solver: its results take their place once, and it is stopped when it has to be."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from riser_soil import __version__
from riser_soil.errors import SceneError, SolveError, WriteError
from riser_soil.variants import one_run
from riser_soil.variants.one_run import NOT_WANTED, STOPPED_BY_LIMIT, Task, known, run_variant, task
from riser_soil.variants.pool import Workers, compute
from riser_soil.variants.run_process import die_with
from riser_soil.variants.runs_folder import ATTEMPTS, OUTCOME, Outcome, attempt, claimed, settle
from riser_soil.variants.variant import Variant
from tests.support.case_files import SMALL
from tests.support.on_ranks import environment
from tests.support.said import line_with, telling

FINISHED = "import sys; open(sys.argv[1] + '/summary.json', 'w').write('{\"finished\": true}')"
Fake = Callable[[str], None]


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch) -> Fake:
    """Puts a piece of Python in the place of `riser-soil run`; its argument: the run's folder."""

    def put(code: str) -> None:
        monkeypatch.setattr(one_run, "command", lambda made: [sys.executable, "-c", code, str(made)])

    put(FINISHED)
    return put


def a_task(runs: Path, key: str = "1", name: str = "a", **changes: Any) -> Task:
    (runs / ATTEMPTS).mkdir(parents=True, exist_ok=True)
    return task(name, Variant(SMALL, key), runs) | changes


def test_results_take_their_place_when_the_run_has_ended(tmp_path: Path, fake: Fake) -> None:
    outcome = Outcome.of(run_variant(a_task(tmp_path)))
    assert outcome.done
    assert outcome.seconds > 0.0
    assert (tmp_path / "a/scene.yaml").read_text().endswith(f"\n{SMALL}")
    assert known(a_task(tmp_path)) == outcome
    assert not list((tmp_path / ATTEMPTS).iterdir())


def test_what_is_done_is_not_done_again(tmp_path: Path, fake: Fake) -> None:
    first = run_variant(a_task(tmp_path))
    fake("import sys; sys.exit(1)")
    assert run_variant(a_task(tmp_path)) == first
    assert run_variant(a_task(tmp_path, key="2"))["status"] == 1
    assert known(a_task(tmp_path)) is None


def test_the_first_of_two_attempts_that_finish_stays(tmp_path: Path, fake: Fake) -> None:
    """A worker that was given up may be alive all the same; an attempt that failed gives way."""
    run_variant(a_task(tmp_path))
    late, failed = attempt(tmp_path, "a", SMALL), attempt(tmp_path, "a", SMALL)
    (late / "late").touch()
    assert settle(late, tmp_path, Outcome("a", "1", 0, machine="late")).machine != "late"
    assert settle(failed, tmp_path, Outcome("a", "1", 3)).done
    assert not (tmp_path / "a/late").exists()
    assert settle(attempt(tmp_path, "a", SMALL), tmp_path, Outcome("a", "2", 3)).status == 3
    fake(FINISHED)
    assert run_variant(a_task(tmp_path))["status"] == 0
    assert [entry.name for entry in tmp_path.iterdir() if entry.name != ATTEMPTS] == ["a"]
    assert not list((tmp_path / ATTEMPTS).iterdir())


@pytest.mark.parametrize(
    ("code", "status", "reason"),
    [
        ("print('a'); print('no  convergence at arc 3 m'); raise SystemExit(3)", 3, "no convergence at arc 3 m"),
        ("raise SystemExit(7)", 7, "ended with status 7"),
        ("raise ZeroDivisionError('bug')", 1, "ZeroDivisionError: bug"),
        ("import os; os.kill(os.getpid(), 9)", 137, "killed by SIGKILL, as where memory runs out"),
        ("import os; os.abort()", 134, "killed by SIGABRT"),
    ],
)
def test_a_run_that_fails_tells_why(tmp_path: Path, fake: Fake, code: str, status: int, reason: str) -> None:
    fake(code)
    outcome = Outcome.of(run_variant(a_task(tmp_path)))
    assert (outcome.status, outcome.reason) == (status, reason)
    assert json.loads((tmp_path / "a" / OUTCOME).read_text())["reason"] == reason


def test_a_run_that_takes_too_long_is_stopped(tmp_path: Path, fake: Fake) -> None:
    fake("import time; time.sleep(600)")
    outcome = Outcome.of(run_variant(a_task(tmp_path, limit=0.2)))
    assert outcome.status == STOPPED_BY_LIMIT
    line_with([outcome.reason], "took longer", "limit of 0.2 s")


def test_a_run_that_nobody_waits_for_is_stopped_and_leaves_nothing(tmp_path: Path, fake: Fake) -> None:
    fake("import time; time.sleep(600)")
    assert run_variant(a_task(tmp_path), wanted=lambda: False)["status"] == NOT_WANTED
    assert not (tmp_path / "a").exists()


def test_workers_tell_what_they_lack(tmp_path: Path) -> None:
    other = run_variant(a_task(tmp_path, version="0.0.1"))
    assert other["status"] == 2
    line_with([other["reason"]], "worker", f"riser_soil {__version__}", "not 0.0.1", "install the same")
    away = run_variant(a_task(tmp_path) | {"runs": str(tmp_path / "elsewhere")})
    assert away["status"] == 4
    line_with([away["reason"]], "No such file", "workers", "folder shared")


def test_a_run_ends_with_its_worker(tmp_path: Path) -> None:
    """A run ends with the thread that began it; and one whose worker had ended before it could ask for that, by itself.
    """
    module = "from riser_soil.variants.run_process import die_with\n"
    begun: list[int] = []

    def worker() -> None:
        code = f"{module}import time\ndie_with({os.getpid()})\nopen('here', 'w').close()\ntime.sleep(60)"
        begun.append(os.posix_spawn(sys.executable, [sys.executable, "-c", code], os.environ))
        while not (tmp_path / "here").exists():
            time.sleep(0.01)

    former = Path.cwd()
    os.chdir(tmp_path)
    try:
        thread = threading.Thread(target=worker)
        thread.start()
        thread.join()
    finally:
        os.chdir(former)
    _, status = os.waitpid(begun[0], 0)
    assert os.WTERMSIG(status) == 9
    with pytest.raises(SystemExit) as ended:
        _in_child(lambda: die_with(1))
    assert ended.value.code == 137


def _in_child(do: Callable[[], None]) -> None:
    """In a forked process: the call would change this one for good."""
    if (pid := os.fork()) == 0:
        status = 0
        try:
            do()
        except SystemExit as leave:
            status = int(leave.code or 0)
        finally:
            os._exit(status)
    raise SystemExit(os.WEXITSTATUS(os.waitpid(pid, 0)[1]))


def test_files_that_are_not_kept_go(tmp_path: Path, fake: Fake) -> None:
    fake(f"{FINISHED}; open(sys.argv[1] + '/results.nc', 'w').close(); open(sys.argv[1] + '/mine', 'w').close()")
    run_variant(a_task(tmp_path, keep=["summary.json"]))
    assert sorted(os.listdir(tmp_path / "a")) == ["case.json", "mine", "said.txt", "summary.json"]


def test_a_failure_that_would_come_again_is_final(tmp_path: Path, fake: Fake) -> None:
    fake("import sys; sys.exit(3)")
    final, open_ended = a_task(tmp_path, final=[SolveError.exit_status]), a_task(tmp_path)
    failed = run_variant(final)
    assert run_variant(final) == failed
    assert known(open_ended) is None


def test_a_full_disk_ends_all(tmp_path: Path, fake: Fake) -> None:
    """The next runs would fail for it, too: none is begun, and the one beside it is stopped."""
    tasks, ended = [a_task(tmp_path, name=name) for name in "abc"], list[str]()
    fake(
        "import sys, time\n"
        "if '/b.' in sys.argv[1]: print('results.nc: No space left'); sys.exit(4)\n"
        "time.sleep(60)"
    )
    with pytest.raises(WriteError, match=telling("b: results.nc", "No space left")):
        compute(tasks, Workers(2), lambda outcome: ended.append(outcome.name))
    assert ended == []
    assert [entry.name for entry in tmp_path.iterdir() if entry.name != ATTEMPTS] == []


def test_runs_are_stopped_when_the_caller_leaves(tmp_path: Path, fake: Fake) -> None:
    fake(f"import time\nif '/a.' not in __import__('sys').argv[1]: time.sleep(60)\n{FINISHED}")

    def leave(outcome: Outcome) -> None:
        raise KeyboardInterrupt

    since = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        compute([a_task(tmp_path, name=name) for name in "abc"], Workers(2), leave)
    assert time.monotonic() - since < 60.0
    assert [entry.name for entry in tmp_path.iterdir() if entry.name != ATTEMPTS] == ["a"]


def test_a_folder_is_of_one_call_at_a_time_and_goes_if_it_is_empty(tmp_path: Path) -> None:
    with claimed(tmp_path / "out", "runs", "a study") as runs:
        assert runs == tmp_path / "out" / "runs"
        with pytest.raises(SceneError, match=telling("out: another run", "is writing there")):
            claimed(tmp_path / "out", "runs", "a study").__enter__()
    assert not (tmp_path / "out").exists()
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "letter.txt").touch()
    with pytest.raises(SceneError, match=telling("holds something else than a study, letter.txt")):
        claimed(tmp_path / "mine", "runs", "a study").__enter__()


def test_runs_of_this_machine_need_no_dask() -> None:
    code = "import sys; import riser_soil.cases.sweep; sys.exit('distributed' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], env=environment()).returncode == 0
