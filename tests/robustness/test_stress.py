"""Stress suite: verdicts on runs with known answers, limits of processes, extremes of a scene, the cheapest cases."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from riser_soil.results import Run
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.stages import DynamicStage
from riser_soil.whole_run import run
from tests.robustness.limited_process import Ending, Limits, ended
from tests.robustness.stress.bounds import Answer, between, bounds, near
from tests.robustness.stress.extremes import BASE, extremes
from tests.robustness.stress.outcome import BROKEN, LONG, PASSED, REPORTED, WRONG, StressOutcome, outcome
from tests.robustness.stress.page import page
from tests.support.line_scenes import CHAIN, mooring, shaken
from tests.support.on_ranks import ROOT, environment
from tests.support.said import line_with
from tests.support.scenes import prescribed, riser_scene, static

FIRST_SCENE = ROOT / "demos" / "first_scene.yaml"
RIGHT, OFF = near("T [N]", 101.0, 100.0, rel=0.02), near("T [N]", 103.0, 100.0, rel=0.02)
ENERGY_OFF = between("heave: energy residual [-]", 0.02, 0.0, 0.01)


def test_answers_hold_within_what_they_may_miss() -> None:
    assert (RIGHT.holds, OFF.holds) == (True, False)
    assert RIGHT.error == pytest.approx(0.01)
    assert between("x", 3.0, 0.0, 2.0).error == pytest.approx(0.5)
    assert not near("x", float("nan"), 1.0, rel=1.0).holds
    assert near("x", float("nan"), 1.0, rel=1.0).error == float("inf")


@pytest.mark.parametrize(
    ("ending", "answer", "may_tell", "verdict", "hoped"),
    [
        (Ending("done", True, 1.0, ""), RIGHT, None, PASSED, True),
        (Ending("done", True, 1.0, "warning: too coarse"), OFF, None, WRONG, False),
        (Ending("done", True, 1.0, "warning: too coarse"), OFF, "coarse", REPORTED, True),
        (Ending("done", True, 1.0, "warning: too coarse"), OFF, "too long", WRONG, False),
        (Ending("done", True, 1.0, "warning: the energy balance is off"), ENERGY_OFF, None, REPORTED, False),
        (Ending("done", True, 1.0, ""), ENERGY_OFF, None, WRONG, False),
        (Ending("solve failed", True, 1.0, "no convergence"), OFF, None, REPORTED, False),
        (Ending("solve failed", True, 1.0, "no convergence"), OFF, "no conv", REPORTED, True),
        (Ending("traceback", False, 1.0, "Traceback"), OFF, "Trace", BROKEN, False),
        (Ending("hang", False, 60.0, ""), OFF, None, LONG, False),
    ],
)
def test_verdicts(ending: Ending, answer: Answer, may_tell: str | None, verdict: str, hoped: bool) -> None:
    row = outcome("case", "", ending, [], [RIGHT, answer], may_tell=may_tell)
    assert (row.verdict, row.as_hoped) == (verdict, hoped)
    if ending.finished:
        assert row.answer == str(answer)


def test_a_process_ends_at_its_limits(tmp_path: Path) -> None:
    def busy() -> int:
        while True:
            pass

    def greedy() -> int:
        return len(bytearray(2**33))

    def fails() -> int:
        print("no convergence")
        return 3

    def crashes() -> int:
        os.kill(os.getpid(), signal.SIGTERM)
        return 0

    begun = time.monotonic()
    assert ended(busy, tmp_path, Limits(cpu=1)).word == "hang"
    assert time.monotonic() - begun < 20.0
    assert ended(greedy, tmp_path, Limits()).word == "traceback"
    ending = ended(fails, tmp_path, Limits())
    assert (ending.word, ending.well, ending.output) == ("solve failed", True, "no convergence\n")
    assert ended(crashes, tmp_path, Limits()).word == "killed by SIGTERM"


def test_extremes_of_the_first_scene() -> None:
    variants = {each.name: each for each in extremes(read_scene(FIRST_SCENE))}
    assert next(iter(variants)) == BASE
    pipe = variants["EA times 1000"].scene.line_types["flexible"]
    assert pytest.approx(3e11) == pipe.EA
    coarse = variants["time step, 0.1 times as fine"].scene.stages[1]
    assert isinstance(coarse, DynamicStage)
    assert coarse.time_step == pytest.approx(1.0)
    assert all(each.against in (None, "at rest", *variants) for each in variants.values())
    assert not [name for name in variants if "soil" in name or "penalty" in name], "it has springs alone"


def test_extremes_of_several_lines() -> None:
    variants = {each.name: each for each in extremes(scene_from_mapping(mooring(shaken())))}
    wild, still = (variants[name].scene.stages[1].lines["east"].motion for name in _MOVED)
    assert wild is not None
    assert wild.start is not None
    assert wild.start.harmonic is not None
    assert wild.start.harmonic.amplitude == pytest.approx((10.0, 3.0, 5.0))
    assert still is None
    assert {line.initial for line in variants["gravity 0"].scene.lines.values()} == {"straight"}
    assert "in three dimensions" not in variants, "they are in space already"


def test_loads_that_do_not_stay_leave_no_rest() -> None:
    load: dict[str, Any] = {"force": [0.0, 0.0, 100.0]}
    kept = {"rest": {"bodies": {"buoy": {"loads": [load | {"keep": True}]}}}}
    for acting, there in ((kept, True), ({"rest": {"bodies": {"buoy": {"loads": [load]}}}}, False)):
        scene = mooring(shaken())
        scene["stages"][0] |= acting["rest"]
        assert ("no motion" in {each.name for each in extremes(scene_from_mapping(scene))}) == there
    scene = mooring(shaken())
    scene["stages"][1]["lines"]["north"] = {"loads": [load | {"at": "end"}]}
    assert "no motion" not in {each.name for each in extremes(scene_from_mapping(scene))}


_MOVED = ("harmonic motion times 10", "no motion")


@pytest.mark.verify
def test_the_cheapest_cases_end_as_they_are_to() -> None:
    call = [sys.executable, "-m", "tests.robustness.stress.run", "--quick", "--workers", "1"]
    done = subprocess.run(call, cwd=ROOT, env=environment(), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("passed: ") > 5


@pytest.mark.verify
def test_all_cases_end_as_they_are_to(tmp_path: Path) -> None:
    """Right, or reported plainly where that is an answer, too."""
    call = [sys.executable, "-m", "tests.robustness.stress.run", "--keep", str(tmp_path)]
    done = subprocess.run(call, cwd=ROOT, env=environment(), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.verify
def test_extremes_around_a_scene_are_run_and_judged(tmp_path: Path) -> None:
    """A line that hangs, of elements that may be four times as long: a row a run, and none is quietly wrong."""
    pipe = {"EA": 1e8, "EI": 10.0, "mass": 50.0, "submerged_weight": 500.0, "outer_diameter": 0.2}
    ends = {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(80.0, 0.0, 30.0)}
    scene = riser_scene(static(), pipe=pipe, length=100.0, elements=40, gravity=9.81, **ends)
    (tmp_path / "line.yaml").write_text(json.dumps(scene), encoding="utf-8")
    paths = (str(tmp_path / "line.yaml"), "-o", str(tmp_path / "out"))
    call = [sys.executable, "-m", "tests.robustness.stress.around", *paths]
    done = subprocess.run(call, cwd=ROOT, env=environment(), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    rows = json.loads((tmp_path / "out/stress.json").read_text(encoding="utf-8"))["cases"]
    assert rows[0]["name"] == BASE
    assert {row["verdict"] for row in rows} <= {PASSED, REPORTED}


def test_forces_out_of_balance_are_found(tmp_path: Path) -> None:
    """A hanging line's run, then the same with one reaction 1 % larger in its summary."""
    line = {"EA": 1e8, "EI": 10.0, "submerged_weight": 500.0}
    ends = {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(80.0, 0.0, 30.0)}
    scene = riser_scene(static(), pipe=line, length=100.0, elements=20, gravity=9.81, **ends)
    run(scene_from_mapping(scene), tmp_path / "run")
    assert all(answer.holds for answer in bounds(Run(tmp_path / "run")))
    summary = tmp_path / "run" / "summary.json"
    data = json.loads(summary.read_text())
    data["stages"][0]["final"]["end"]["force"][2] *= 1.01
    summary.write_text(json.dumps(data))
    (wrong,) = (answer.what for answer in bounds(Run(tmp_path / "run")) if not answer.holds)
    line_with([wrong], "static:", "vertical forces", "out of balance")


def test_a_tensioner_bears_what_hangs_on_it(tmp_path: Path) -> None:
    pipe = {"EA": 2.0e9, "EI": 9.0e6, "submerged_weight": 500.0}
    ends = {"start": prescribed(0.0, 0.0, -100.0), "end": prescribed(0.0, 0.0, 0.0) | {"tensioner": {"tension": 8.0e4}}}
    run(scene_from_mapping(riser_scene(static(), pipe=pipe, length=100.0, elements=10, gravity=9.81, **ends)), tmp_path)
    judged = list(bounds(Run(tmp_path)))
    assert len(judged) == 3
    assert all(answer.holds for answer in judged)


def test_forces_out_of_balance_are_found_on_a_line_of_several(tmp_path: Path) -> None:
    """A weight on two lines, a third tied to one of these; then one reaction 1 % larger in the summary."""
    lines: dict[str, Any] = {
        "west": {"start": {"position": [-50.0, 0.0, 0.0]}, "end": "free"},
        "east": {"start": {"position": [50.0, 0.0, 0.0]}, "end": "free"},
        "low": {"start": {"position": [-50.0, 0.0, -30.0]}, "end": {"position": [-20.0, 0.0, -30.0]}},
    }
    for line in lines.values():
        line["segments"] = [{"line_type": "chain", "length": 60.0 if line["end"] == "free" else 32.0, "elements": 12}]
    hung = {name: {"kind": "pinned", "between": [{"line": name, "at": "end"}, {"body": "weight"}]} for name in _HUNG}
    tie: dict[str, Any] = {"kind": "sprung", "between": [{"line": "low", "at": 16.0}, {"line": "west", "at": 30.0}]}
    tie["stiffness"] = {"translation": 10.0}
    scene = {
        "line_types": {"chain": CHAIN},
        "bodies": {"weight": {"kind": "point", "position": [0.0, 0.0, -33.0], "mass": 500.0}},
        "lines": lines,
        "joints": {**hung, "tie": tie},
        "stages": [static()],
    }
    run(scene_from_mapping(scene), tmp_path / "run")
    judged = list(bounds(Run(tmp_path / "run")))
    assert all(answer.holds for answer in judged)
    assert {answer.what.split(": ")[1] for answer in judged[1:]} == {"east"}, "the tie pulls the others"
    summary = tmp_path / "run" / "summary.json"
    data = json.loads(summary.read_text())
    data["stages"][0]["lines"]["east"]["final"]["start"]["force"][2] *= 1.01
    summary.write_text(json.dumps(data))
    assert [answer.holds for answer in bounds(Run(tmp_path / "run"))] == [True, False, True]


_HUNG = ("west", "east")


def test_the_page_is_that_of_its_figures() -> None:
    data = json.loads((ROOT / "docs/stress.json").read_text(encoding="utf-8"))
    rows = [StressOutcome(**row) for row in data["cases"]]
    assert page(rows, data["made"]) == (ROOT / "docs/stress.md").read_text(encoding="utf-8")
