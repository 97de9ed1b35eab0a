"""A riser alone needs neither PETSc nor MPI: same results; soil says what it lacks; several ranks are known."""

from __future__ import annotations

import importlib.util
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.assembly import build
from riser_soil.checks.plausibility import physical_warnings
from riser_soil.core import banded, communicator
from riser_soil.core.communicator import Alone
from riser_soil.core.csr_matrix import CsrMatrix
from riser_soil.errors import SceneError
from riser_soil.scene.reader import read_scene
from riser_soil.whole_run import run
from tests.support.line_scenes import mooring, shaken
from tests.support.on_ranks import ROOT
from tests.support.said import line_with, telling
from tests.support.without_packages import FOR_USERS, SOIL, riser_soil_without

SCENE = "tests/scenes/catenary.yaml"
SHORT = ("dimension=2", "riser.segments.0.elements=15", "stages.1.duration=1.0")
LAUNCHED = {"OMPI_COMM_WORLD_SIZE": "4", "PMI_SIZE": "2", "SLURM_STEP_NUM_TASKS": "3", "PMIX_RANK": "0"}


def figures(folder: Path) -> dict[str, float]:
    """All numbers of a run's stages, but for times."""
    values: dict[str, float] = {}

    def collect(path: str, value: Any) -> None:
        if isinstance(value, dict | list):
            for key, each in value.items() if isinstance(value, dict) else enumerate(value):
                collect(f"{path}.{key}", each)
        elif isinstance(value, float) and "energy" not in path:
            values[path] = value

    collect("", json.loads((folder / "summary.json").read_text())["stages"])
    return values


def test_a_riser_alone_gives_what_snes_gives_without_petsc_mpi_and_scipy(tmp_path: Path) -> None:
    """In statics, which laying leads to, and in time steps; to the solver's tolerance."""
    overrides = [text for override in SHORT for text in ("--set", override)]
    done = riser_soil_without((*SOIL, *FOR_USERS), "run", SCENE, "-o", str(tmp_path / "alone"), *overrides)
    assert done.returncode == 0, done.stderr
    run(read_scene(str(ROOT / SCENE), [*SHORT, "solver.newton=snes"]), tmp_path / "snes")
    alone, expected = figures(tmp_path / "alone"), figures(tmp_path / "snes")
    assert len(expected) > 20
    assert alone == pytest.approx(expected, rel=1e-5, abs=1e-5)


def test_lines_and_bodies_give_what_snes_gives_without_petsc_and_mpi(tmp_path: Path) -> None:
    """Statics and time steps of a buoy on three chains; joints take LAPACK, as SciPy has it."""
    given, hidden = tmp_path / "lines.json", [name for name in FOR_USERS if name != "scipy"]
    given.write_text(json.dumps(mooring(shaken(duration=0.2), elements=8)))
    done = riser_soil_without((*SOIL, *hidden), "run", str(given), "-o", str(tmp_path / "alone"))
    assert done.returncode == 0, done.stderr
    run(read_scene(str(given), ["solver.newton=snes"]), tmp_path / "snes")
    alone, expected = figures(tmp_path / "alone"), figures(tmp_path / "snes")
    assert len(expected) > 20
    assert alone == pytest.approx(expected, rel=1e-5, abs=1e-5)


def test_joints_say_that_they_need_scipy(tmp_path: Path) -> None:
    given = tmp_path / "lines.json"
    given.write_text(json.dumps(mooring(shaken(duration=0.2), elements=8)))
    done = riser_soil_without(["scipy"], "check", str(given))
    assert done.returncode == SceneError.exit_status
    line_with(done.stderr, "joints: needs scipy")


def test_soil_says_in_one_line_what_it_lacks_and_who_has_it(tmp_path: Path) -> None:
    done = riser_soil_without(SOIL, "run", "demos/touchdown_clay/scene.yaml", "-o", str(tmp_path / "soil"))
    assert done.returncode == SceneError.exit_status
    (line,) = done.stderr.strip().splitlines()
    assert line.startswith("demos/touchdown_clay/scene.yaml")
    line_with([line], "soil:", "dolfinx, PETSc, MPI, gmsh", "scipy", "not installed", "apt install python3-dolfinx")
    line_with([line], "conda-forge:", "conda install fenics-dolfinx petsc4py", "mpi4py python-gmsh;", "Docker:")
    assert not (tmp_path / "soil").exists()


def test_snes_asked_for_says_that_it_needs_petsc(tmp_path: Path) -> None:
    done = riser_soil_without(["petsc4py"], "check", SCENE, "--set", "solver.newton=snes")
    assert done.returncode == SceneError.exit_status
    line_with(done.stderr, "solver.newton:", "snes:", "needs PETSc and MPI", "PETSc is not installed")


def test_options_of_petsc_say_that_they_need_it() -> None:
    done = riser_soil_without(["petsc4py"], "check", SCENE, "--set", "solver.petsc_options.snes_monitor=true")
    assert done.returncode == SceneError.exit_status
    line_with(done.stderr, "solver.petsc_options: needs PETSc and MPI")


def test_options_of_petsc_hand_all_steps_to_snes(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    run(read_scene(str(ROOT / SCENE), [*SHORT, "solver.petsc_options={snes_monitor: true, snes_rtol: 1e-9}"]), tmp_path)
    printed = capfd.readouterr().out.splitlines()
    stages = json.loads((tmp_path / "summary.json").read_text())["stages"]
    begun = sum(line.startswith("  0 SNES Function norm") for line in printed)
    assert begun == sum(stage["steps"] for stage in stages), stages[-1].keys()


@pytest.mark.parametrize("overrides", [[], ["solver.petsc_options.snes_max_it=30"]], ids=["alone", "by SNES"])
def test_options_of_the_environment_that_nothing_reads_are_warned_of(
    overrides: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PETSC_OPTIONS", "-log_view -riser_soil_snes_monitor -no_signal_handler")
    warned = [*physical_warnings(build(read_scene(str(ROOT / SCENE), overrides), Alone()))]
    unread = [each for each in warned if each.startswith("PETSC_OPTIONS: -riser_soil_snes_monitor: not used")]
    assert len(unread) == (0 if overrides else 1)


@pytest.mark.parametrize(("command", "extra"), [("plot", "plots"), ("report", "report")])
def test_a_command_says_which_extra_brings_all_that_it_needs(command: str, extra: str) -> None:
    done = riser_soil_without(["matplotlib", "jinja2"], command, "results")
    assert done.returncode == SceneError.exit_status
    line_with(done.stderr.splitlines(), "matplotlib:", "not installed", f"pip install 'riser_soil[{extra}]'")


def test_a_motion_table_says_that_it_needs_scipy(tmp_path: Path) -> None:
    table = tmp_path / "surge.csv"
    rows = "".join(f"{t},{0.1 * t},0,0,0,0,0\n" for t in range(200))
    table.write_text(f"t [s],x [m],y [m],z [m],rx [deg],ry [deg],rz [deg]\n{rows}")
    motion = f'stages.1.motion={{"end": {{"table": "{table}"}}}}'
    done = riser_soil_without(["scipy"], "check", SCENE, "--set", motion)
    assert done.returncode == SceneError.exit_status
    (line,) = done.stderr.strip().splitlines()
    line_with([line], "scipy:", "not installed", "pip install 'riser_soil[tables]'")


@pytest.fixture
def no_mpi_yet(monkeypatch: pytest.MonkeyPatch) -> None:
    """A process that was started alone and has not imported MPI."""
    monkeypatch.delitem(sys.modules, "mpi4py.MPI", raising=False)
    for name in (*communicator.SIZES, *communicator.RANKS):
        monkeypatch.delenv(name, raising=False)


def test_a_process_that_was_started_alone_is_alone(no_mpi_yet: None, monkeypatch: pytest.MonkeyPatch) -> None:
    assert isinstance(communicator.world(), communicator.Alone)
    monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "1")
    monkeypatch.setenv("PMIX_RANK", "0")
    assert isinstance(communicator.world(), communicator.Alone)


@pytest.mark.parametrize("name", LAUNCHED)
def test_one_of_several_needs_mpi4py(no_mpi_yet: None, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """Each would take itself for the only one, and write the same results."""
    monkeypatch.setenv(name, LAUNCHED[name])
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(SceneError, match=telling(f"{name}={LAUNCHED[name]}:", "one of several")):
        communicator.world()


def test_where_mpi_has_been_imported_it_decides() -> None:
    from mpi4py import MPI

    assert communicator.world() == MPI.COMM_WORLD


def symmetric_band(n: int, b: int) -> tuple[np.ndarray, np.ndarray]:
    """A random matrix, indefinite, dense and as scipy's upper band."""
    random = np.random.default_rng(3)
    dense = np.triu(np.tril(random.normal(size=(n, n)), b))
    dense = dense + dense.T + np.diag(np.linspace(-4.0, 4.0, n))
    upper = np.zeros((b + 1, n))
    for d in range(b + 1):
        upper[b - d, d:] = np.diag(dense, d)
    return dense, upper


@pytest.mark.parametrize(("n", "b"), [(1, 1), (2, 3), (12, 1), (30, 5)])
def test_symmetric_bands_are_solved(n: int, b: int) -> None:
    dense, upper = symmetric_band(n, b)
    loads = np.random.default_rng(4).normal(size=(n, 2))
    assert banded.solve_symmetric(upper, loads) == pytest.approx(np.linalg.solve(dense, loads), rel=1e-8, abs=1e-10)


@pytest.mark.parametrize(("n", "b"), [(12, 1), (30, 5)])
def test_negative_pivots_are_negative_eigenvalues(n: int, b: int) -> None:
    dense, _ = symmetric_band(n, b)
    band = np.zeros((n + b, 3 * b + 1))
    for i in range(n):
        for j in range(max(0, i - b), min(n, i + b + 1)):
            band[i, j - i + b] = dense[i, j]
    negative = int((np.linalg.eigvalsh(dense) < 0.0).sum())
    assert 0 < negative < n
    none = np.zeros((n, 0)), np.zeros((0, 0))
    assert banded.count_negative_pivots(band, n, np.zeros(b), *none) == negative


def test_rows_of_one_rank_are_those_that_petsc_sees() -> None:
    dense = np.array([[2.0, -1.0, 0.0], [-1.0, 3.0, 0.5], [0.0, 0.5, 0.0]])
    keys = np.array([0, 1, 3, 4, 5, 7, 8])
    matrix = CsrMatrix(keys, 3, dense.ravel()[keys], symmetric=True)
    x = np.array([1.0, -2.0, 3.0])
    for _ in range(2):
        assert matrix.times(x) == pytest.approx(dense @ x)
        assert matrix.mat.getValues(range(3), range(3)) == pytest.approx(dense)
        matrix.set_diagonal(matrix.diagonal() + 1.0)
        dense = dense + np.eye(3)
    matrix.destroy()
