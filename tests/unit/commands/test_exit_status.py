"""Failures under mpirun: told once, and no rank is left waiting."""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path

import pytest

from tests.support.on_ranks import Job, mpirun

ROOT = Path(__file__).parents[3]
SCENE = ROOT / "tests/scenes/catenary.yaml"

# The command with a computation that fails on some ranks while the others wait in a collective call.
DRIVER = f"""
import sys
from types import SimpleNamespace
from mpi4py import MPI
import riser_soil.commands.exit_status as endings
from riser_soil.__main__ import main
from riser_soil.errors import SolveError

def compute(scene, folder, force, restart):
    MPI.COMM_WORLD.Barrier()  # what ends a rank that still imports modules is another test's
    if MPI.COMM_WORLD.rank in FAILING:
        raise FAILURE
    MPI.COMM_WORLD.Barrier()

endings._PATIENCE = 2.0
sys.modules["riser_soil.whole_run"] = SimpleNamespace(run=compute)
sys.argv = ["riser-soil", "run", {str(SCENE)!r}]
main()
"""


def test_wrong_scene_is_reported_once(tmp_path: Path) -> None:
    (tmp_path / "case.yaml").write_text("title: [\n", encoding="utf-8")
    done = mpirun(2, "-m", "riser_soil", "run", "case.yaml", folder=tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("case.yaml:2: not valid YAML") == 1
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("failing", ["(0, 1)", pytest.param("(0,)", marks=pytest.mark.verify), "(1,)"])
def test_failed_solve_ends_all_ranks_and_is_reported_once(failing: str, tmp_path: Path) -> None:
    script = DRIVER.replace("FAILING", failing).replace("FAILURE", "SolveError('failed at 24 m')")
    done = mpirun(2, "-c", script, folder=tmp_path)
    assert done.returncode == 3
    assert done.stderr.count("failed at 24 m") == 1
    assert "Traceback" not in done.stderr


def test_unexpected_error_of_one_rank_ends_all(tmp_path: Path) -> None:
    script = DRIVER.replace("FAILING", "(1,)").replace("FAILURE", "ZeroDivisionError('bug')")
    done = mpirun(2, "-c", script, folder=tmp_path)
    assert done.returncode == 1
    assert "ZeroDivisionError: bug" in done.stderr


WITHIN = f"""
import signal
import sys
from mpi4py import MPI
from riser_soil.__main__ import main
from riser_soil.solve.time_stepper import TimeStepper

def commit(stepper, step, control):
    if MPI.COMM_WORLD.rank == 1:
        raise ZeroDivisionError("bug")
    MPI.COMM_WORLD.Barrier()

signal.alarm(120)  # s: ranks that wait for each other are ended
TimeStepper.commit = commit
sys.argv = ["riser-soil", "run", {str(SCENE)!r}, "-o", "results"]
main()
"""


def test_unexpected_error_of_one_rank_within_a_stage_ends_all(tmp_path: Path) -> None:
    """A rank holds factors then, which it can't give back without the others."""
    done = mpirun(2, "-c", WITHIN, folder=tmp_path)
    assert done.returncode == 1
    assert "ZeroDivisionError: bug" in done.stderr


STUBBORN = """
import os, signal, time
from pathlib import Path

signal.signal(signal.SIGTERM, signal.SIG_IGN)
Path(str(os.getpid())).touch()
time.sleep(600.0)
"""


def test_nothing_is_left_of_a_job_whose_mpirun_is_killed(tmp_path: Path) -> None:
    with Job(["mpirun", "-n", "2", "--bind-to", "none", sys.executable, "-c", STUBBORN], tmp_path) as job:
        while len(ranks := list(tmp_path.iterdir())) < 2:
            assert job.process.poll() is None
            time.sleep(0.05)
        assert {int(rank.name) for rank in ranks} < set(job.processes())
        os.kill(job.process.pid, signal.SIGKILL)
    assert not [rank for rank in ranks if _runs(rank.name)]


def _runs(process: str) -> bool:
    """Not gone, nor a zombie that nobody has asked for its exit status."""
    try:
        return ") Z " not in Path("/proc", process, "stat").read_text()
    except FileNotFoundError:
        return False
