"""Runs that fail, are killed, or meet the results of another: what they say and what they leave, on 1 and 2 ranks."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from riser_soil.results import Run
from tests.support.on_ranks import HANGS, Job, mpirun
from tests.support.runs import run_of
from tests.support.scenes import LAY, Mapping, heave, lying_pipe, touchdown
from tests.support.vtk_reading import read_by_vtk

ALONE = pytest.mark.parametrize("ranks", [1, pytest.param(2, marks=pytest.mark.verify)])
FAILED, REFUSED = 3, 2
FILES = {"scene.yaml", "summary.json", "results.nc", "riser.xdmf", "riser.vtkhdf", "soil.xdmf", "soil.vtkhdf"}


def command(folder: Path, ranks: int, scene: Mapping, *options: str) -> subprocess.CompletedProcess[str]:
    """riser-soil run on a scene, results in folder/out."""
    (folder / "scene.yaml").write_text(json.dumps(scene), encoding="utf-8")
    call = ["-m", "riser_soil", "run", "scene.yaml", "-o", "out", *options]
    return mpirun(ranks, *call, folder=folder)


def struck() -> Mapping:
    """At 0.5 s a force of 1 MN begins to act in the middle of the block; steps may be halved twice only."""
    blow = {"at": 4.0, "force": [0.0, 0.0, -1.0e6], "history": [[0.0, 0.0], [0.5, 0.0], [0.6, 1.0], [3.0, 1.0]]}
    scene = touchdown(LAY, heave(3.0) | {"loads": [blow]})
    scene["solver"]["min_time_step"] = 0.02
    return scene


def error_line(done: subprocess.CompletedProcess[str]) -> str:
    """The one line that a failed run tells; Open MPI adds its own about the rank that ended the job."""
    mine = [line for line in done.stderr.splitlines() if re.search(r"converge|relaxation|settle|finished run", line)]
    assert len(mine) == 1, done.stderr
    assert "Traceback" not in done.stderr
    return mine[0]


AT = r"at \([-\d., e]+\) m"
PLACE = re.compile(
    rf"sits at the (riser node at arc [\d.]+ m|soil (node|surface) {AT}), \w+|cell of the soil {AT} would fold"
)


@ALONE
def test_failed_step_is_reported_with_its_place_and_keeps_all_before(ranks: int, tmp_path: Path) -> None:
    done = command(tmp_path, ranks, struck())
    assert done.returncode == FAILED
    line = error_line(done)
    assert PLACE.search(line), line
    assert re.search(r"no convergence .*= 0\.5", line)
    assert "smallest step 0.025" in line
    run = Run(tmp_path / "out")
    assert {p.name for p in run.folder.iterdir()} == FILES
    assert not run.finished
    lay, blow = run.summary["stages"]
    assert lay["steps"] == 8
    assert blow["steps"] == 5 + round((blow["time"] - 0.5) / 0.025)
    assert 0.5 <= blow["time"] < 0.6
    last = [blow["time"]] if blow["time"] > 0.5 else []
    np.testing.assert_allclose(run.time, [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, *last], atol=1e-12)
    assert np.isfinite(run["effective_tension"]).all()
    np.testing.assert_allclose(run.soil_times, run.time)


@pytest.mark.verify
@pytest.mark.parametrize("ranks", [1, 2])
def test_soil_loaded_beyond_its_capacity_is_an_error(ranks: int, tmp_path: Path) -> None:
    """717 N/m lie on clay that bears some 46 N/m at its surface: no answer is right."""
    scene = lying_pipe(su=30.0)
    scene["solver"]["min_load_step"] = 0.06
    done = command(tmp_path, ranks, scene)
    assert done.returncode == FAILED
    line = error_line(done)
    bearing = re.search(r"bearing capacity is exceeded: at arc ([\d.]+) m, .* puts (\S+) N/m .* about (\S+) N/m,", line)
    assert bearing, line
    arc, load, capacity = (float(each) for each in bearing.groups())
    assert 0.0 < arc <= 8.0
    assert load >= 717.0
    assert capacity == pytest.approx((2.0 + np.pi) * 30.0 * 0.3, rel=1e-3)
    run = Run(tmp_path / "out")
    assert not run.finished
    (lay,) = run.summary["stages"]
    assert lay["steps"] < 2.0 / 0.06  # load steps, each of part of the weight


def test_soil_loaded_below_its_capacity_is_none(tmp_path: Path) -> None:
    assert run_of(lying_pipe(su=1000.0), tmp_path / "out").finished


@pytest.mark.verify
@pytest.mark.parametrize("ranks", [1, 2])
def test_killed_run_leaves_what_it_has_accepted(ranks: int, tmp_path: Path) -> None:
    (tmp_path / "scene.yaml").write_text(json.dumps(touchdown(LAY, heave(1000.0))), encoding="utf-8")
    launch = ["mpirun", "-n", str(ranks), "--bind-to", "none"] if ranks > 1 else []
    call = [*launch, sys.executable, "-m", "riser_soil", "run", "scene.yaml", "-o", "out"]
    quiet = subprocess.DEVNULL
    with Job(call, tmp_path, stdout=quiet, stderr=quiet) as job:
        wait_for_steps(tmp_path / "out", 20)
        job.kill()
    run = Run(tmp_path / "out")
    assert not run.finished
    steps = run.time.size
    assert steps > 20
    assert np.isfinite(run["position"]).all()
    assert run["newton_iterations"].size >= steps
    for name in ("riser", "soil"):
        times, frames = read_by_vtk(run.folder / f"{name}.xdmf")
        assert len(times) == len(frames) > 20
    again = command(tmp_path, 1, touchdown(LAY))
    assert again.returncode == 0, "an unfinished run may be replaced"
    assert Run(tmp_path / "out").finished


def wait_for_steps(folder: Path, steps: int) -> None:
    """Until results.nc holds this many output times."""
    ends = time.monotonic() + HANGS
    while time.monotonic() < ends:
        time.sleep(0.2)
        if (folder / "results.nc").is_file() and Run(folder).time.size > steps:
            return
    raise TimeoutError("the run has not come that far")


@pytest.mark.verify
@pytest.mark.parametrize("ranks", [1, 2])
def test_finished_run_is_replaced_by_force_alone(ranks: int, tmp_path: Path) -> None:
    first, second = touchdown(LAY), touchdown(LAY, su=2000.0)
    assert command(tmp_path, ranks, first).returncode == 0
    before = {p.name: p.read_bytes() for p in (tmp_path / "out").iterdir()}
    refused = command(tmp_path, ranks, second)
    assert refused.returncode == REFUSED
    assert "--force" in error_line(refused)
    assert {p.name: p.read_bytes() for p in (tmp_path / "out").iterdir()} == before
    assert command(tmp_path, ranks, second, "--force").returncode == 0
    assert "su: 2000" in (tmp_path / "out" / "scene.yaml").read_text(encoding="utf-8")
