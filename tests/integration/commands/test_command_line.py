"""Exit statuses, the result folder and what the command line imports."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner, Result

from riser_soil.__main__ import app
from riser_soil.errors import Interruption, MeshError, ResultsError, RiserSoilError, SceneError, SolveError
from riser_soil.scene.scene import Scene
from tests.support.on_ranks import HANGS
from tests.support.said import line_with

ROOT = Path(__file__).parents[3]
SCENE = ROOT / "tests/scenes/catenary.yaml"
SUMMARY = '{"finished": %s, "version": "0.1.0", "parts": {}, "stages": []}'


class Calls:
    """Stands in for the computation: keeps what it is asked for."""

    def __init__(self, failure: BaseException | None = None) -> None:
        self.failure = failure
        self.folders: list[Path] = []
        self.scenes: list[Scene] = []
        self.forces: list[bool] = []
        self.restarts: list[bool] = []

    def run(self, scene: Scene, folder: Path, force: bool, restart: bool) -> None:
        self.scenes.append(scene)
        self.folders.append(folder)
        self.forces.append(force)
        self.restarts.append(restart)
        if self.failure:
            raise self.failure

    def describe(self, scene: Scene) -> str:
        self.scenes.append(scene)
        return "built: riser"


Invoke = Callable[..., tuple[Result, Calls]]


@pytest.fixture
def invoke(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Invoke:
    """Runs the command in an empty folder with the computation replaced."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments: str, failure: BaseException | None = None) -> tuple[Result, Calls]:
        calls = Calls(failure)
        monkeypatch.setitem(sys.modules, "riser_soil.whole_run", SimpleNamespace(run=calls.run))
        monkeypatch.setitem(sys.modules, "riser_soil.checks.check", SimpleNamespace(describe=calls.describe))
        return CliRunner().invoke(app, list(arguments)), calls

    return call


@pytest.mark.parametrize("restart", [False, True])
def test_run_hands_over_whether_it_goes_on(restart: bool, invoke: Invoke) -> None:
    result, calls = invoke("run", str(SCENE), *(["--restart"] if restart else []))
    assert result.exit_code == 0
    assert calls.restarts == [restart]


def test_run_hands_over_scene_folder_and_force(invoke: Invoke) -> None:
    result, calls = invoke("run", str(SCENE), "--set", "riser.segments.0.elements=70", "--force")
    assert result.exit_code == 0
    assert calls.folders == [Path("catenary")]
    assert calls.forces == [True]
    assert calls.scenes[0].line.segments[0].elements == 70


@pytest.mark.parametrize(
    ("options", "folder"),
    [
        (("-o", "a/b"), "a/b"),
        (("--output", "c"), "c"),
        (("--set", "output.directory=d"), "d"),
        (("--set", "output.directory=d", "-o", "e"), "e"),
        ((), "catenary"),
    ],
)
def test_result_folder(invoke: Invoke, options: tuple[str, ...], folder: str) -> None:
    _, calls = invoke("run", str(SCENE), *options)
    assert calls.folders == [Path(folder)]


@pytest.mark.parametrize(
    ("failure", "status"),
    [
        (SceneError("wrong scene"), 2),
        (MeshError("wrong mesh"), 2),
        (ResultsError("wrong folder"), 2),
        (SolveError("no convergence at arc 24.0 m"), 3),
    ],
)
def test_exit_status_tells_the_kind_of_failure(invoke: Invoke, failure: RiserSoilError, status: int) -> None:
    result, _ = invoke("run", str(SCENE), failure=failure)
    assert result.exit_code == status
    assert result.stderr == f"{failure}\n"
    assert result.stdout == ""


@pytest.mark.parametrize(
    ("message", "options", "line"),
    [
        ("riser.initial: catenary: too short", (), f"{SCENE}:21: riser.initial: catenary: too short"),
        ("riser: too long", (), f"{SCENE}:15: riser: too long"),
        ("gravity = 3: no", ("--set", "gravity=3"), "--set gravity=3: gravity = 3: no"),
        ("folder: is full", (), "folder: is full"),
    ],
)
def test_problems_found_by_the_parts_get_their_place(
    invoke: Invoke, message: str, options: tuple[str, ...], line: str
) -> None:
    result, _ = invoke("run", str(SCENE), *options, failure=SceneError(message))
    assert result.stderr == f"{line}\n"


def test_unexpected_errors_keep_their_traceback(invoke: Invoke) -> None:
    result, _ = invoke("run", str(SCENE), failure=ZeroDivisionError("bug"))
    assert isinstance(result.exception, ZeroDivisionError)


def test_finished_run_needs_force(invoke: Invoke, tmp_path: Path) -> None:
    (tmp_path / "catenary").mkdir()
    (tmp_path / "catenary/summary.json").write_text(SUMMARY % "true", encoding="utf-8")
    result, calls = invoke("run", str(SCENE))
    assert result.exit_code == 2
    assert calls.folders == []
    assert invoke("run", str(SCENE), "--force")[0].exit_code == 0


def test_unfinished_run_is_taken_over(invoke: Invoke, tmp_path: Path) -> None:
    (tmp_path / "catenary").mkdir()
    (tmp_path / "catenary/summary.json").write_text(SUMMARY % "false", encoding="utf-8")
    assert invoke("run", str(SCENE))[0].exit_code == 0


def test_check_prints_what_would_be_built(invoke: Invoke) -> None:
    result, calls = invoke("check", str(SCENE), "--set", "title=other")
    assert result.exit_code == 0
    assert result.stdout == "built: riser\n"
    assert calls.scenes[0].title == "other"


@pytest.mark.parametrize("target", ["/dev/full", "a closed pipe"])
@pytest.mark.parametrize("arguments", [["schema"], ["check", str(SCENE)]])
def test_standard_output_that_takes_no_more_is_reported_in_one_line(arguments: list[str], target: str) -> None:
    why = "No space left" if target == "/dev/full" else "Broken pipe"
    if target == "/dev/full":
        output = os.open(target, os.O_WRONLY)
    else:
        unread, output = os.pipe()
        os.close(unread)
    call = [sys.executable, "-m", "riser_soil", *arguments]
    done = subprocess.run(call, cwd=ROOT, stdout=output, stderr=subprocess.PIPE, text=True, timeout=120, check=False)
    os.close(output)
    assert done.returncode == 4
    assert done.stderr == line_with(done.stderr, "standard output:", "cannot be written:", why) + "\n"


def test_a_disk_that_is_full_elsewhere_is_reported_in_one_line(invoke: Invoke) -> None:
    result, _ = invoke("run", str(SCENE), failure=OSError(errno.ENOSPC, "No space left on device", "a/cache"))
    assert result.exit_code == 4
    assert result.stderr == line_with(result.stderr, "a/cache:", "cannot be written:", "No space left") + "\n"


def test_interruptions_have_the_status_of_their_signal(invoke: Invoke) -> None:
    result, _ = invoke("run", str(SCENE), failure=Interruption(signal.SIGINT))
    assert result.exit_code == 130
    assert result.stderr == line_with(result.stderr, "SIGINT", "before the first stage", "nothing was computed") + "\n"


@pytest.mark.parametrize("arguments", [["x" * 300 + ".yaml"], [str(SCENE), "-o", "x" * 300]])
def test_names_too_long_are_bad_input(invoke: Invoke, arguments: list[str]) -> None:
    result, calls = invoke("run", *arguments)
    assert result.exit_code == 2
    assert result.stderr.endswith("File name too long\n")
    assert result.stderr.count("\n") == 1
    assert calls.folders == []


def test_a_tmpdir_that_is_none_is_replaced_and_reported(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    given = os.environ | {"TMPDIR": str(tmp_path / "file")}
    call = [sys.executable, "-m", "riser_soil", "check", str(SCENE)]
    done = subprocess.run(call, cwd=ROOT, env=given, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0
    assert done.stderr == line_with(done.stderr, f"TMPDIR={tmp_path / 'file'}:", "no folder") + "\n"


def test_the_user_s_own_scene_is_not_replaced(invoke: Invoke, tmp_path: Path) -> None:
    (tmp_path / "scene.yaml").write_text(SCENE.read_text(encoding="utf-8"), encoding="utf-8")
    for options in ([], ["--force"]):
        result, calls = invoke("run", "scene.yaml", "-o", ".", *options)
        assert result.exit_code == 2
        assert result.stderr.startswith("scene.yaml: was not written")
        assert calls.folders == []


@pytest.mark.parametrize("arguments", [["run"], ["run", "a.yaml", "--colour"], ["fly"], ["run", "a", "b"]])
def test_wrong_usage_is_bad_input(invoke: Invoke, arguments: list[str]) -> None:
    assert invoke(*arguments)[0].exit_code == 2


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_help_imports_nothing_heavy(option: str) -> None:
    code = (
        "import sys\n"
        f"sys.argv = ['riser-soil', '{option}']\n"
        "from riser_soil.__main__ import main\n"
        "try:\n    main()\n"
        "except SystemExit as leave:\n    assert not leave.code\n"
        "heavy = {'numpy', 'scipy', 'numba', 'petsc4py', 'mpi4py', 'dolfinx', 'pydantic', 'ruamel.yaml'}\n"
        "assert not heavy & set(sys.modules), heavy & set(sys.modules)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=HANGS, check=False
    )
    assert done.returncode == 0, done.stderr


def test_a_command_looks_for_no_plugins_and_ends_without_looking_for_garbage(tmp_path: Path) -> None:
    """The one reads a file of each package that is installed, the other takes a seventh of the time of a short run."""
    plugin = tmp_path / "plugin-1.0.dist-info"
    plugin.mkdir()
    (plugin / "METADATA").write_text("Name: plugin\nVersion: 1.0\n", encoding="utf-8")
    (plugin / "entry_points.txt").write_text("[pydantic]\nours = no_such_module:plugin\n", encoding="utf-8")
    code = (
        "import gc, sys\n"
        f"sys.argv = ['riser-soil', 'check', {str(SCENE)!r}]\n"
        "from riser_soil.__main__ import main\n"
        "try:\n    main()\n"
        "except SystemExit as leave:\n    assert not leave.code\n"
        "assert gc.get_freeze_count() > 100_000\n"
    )
    given = os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}
    call = [sys.executable, "-c", code]
    done = subprocess.run(call, env=given, capture_output=True, text=True, timeout=HANGS, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""


def test_a_scene_is_read_without_numerics() -> None:
    code = (
        "import sys\n"
        "from riser_soil.scene.reader import read_scene\n"
        f"read_scene({str(SCENE)!r})\n"
        "assert not {'numpy', 'scipy', 'numba', 'petsc4py', 'mpi4py', 'dolfinx', 'gmsh'} & set(sys.modules)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=HANGS, check=False
    )
    assert done.returncode == 0, done.stderr
