"""Study of a scene: references, shares and cheapest settings of manufactured answers; the command on a small riser."""

from __future__ import annotations

import csv
import json
import math
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML
from typer.testing import CliRunner

from riser_soil.accuracy import findings
from riser_soil.accuracy.findings import Study
from riser_soil.accuracy.study import study
from riser_soil.accuracy.study_page import words
from riser_soil.accuracy.study_points import Factors, PointOutcome, compute, point_task
from riser_soil.commands.app import app
from riser_soil.errors import ResultsError, SceneError, SolveError, WriteError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.variants import one_run
from riser_soil.variants.key_results import KeyResult
from tests.support.case_files import SMALL
from tests.support.on_ranks import HANGS, environment
from tests.support.said import line_with, telling
from tests.support.scenes import LAY, heave, touchdown

FAILED = "no convergence at 0.3 s"
Answer = Callable[[float, float], float]


def scene() -> Scene:
    data = touchdown(LAY, heave(1.0, 0.01))
    del data["soil"]
    return scene_from_mapping(data)


def manufactured(monkeypatch: pytest.MonkeyPatch, folder: Path, answer: Answer, **given: Any) -> Study:
    """A study whose runs are formulas of the sizes of elements and steps, 1 in the scene; failures by `fails`."""
    fails: Callable[[float, float], bool] = given.pop("fails", lambda h, dt: False)

    def compute(scenes: Mapping[Factors, Scene], runs: Path, jobs: int, on_end: Any) -> list[PointOutcome]:
        return [outcome(factors) for factors in scenes]

    def outcome(factors: tuple[float, ...]) -> PointOutcome:
        h, dt = (1.0 / factor for factor in factors)
        if fails(h, dt):
            return PointOutcome(factors, 3, FAILED, 0.1, True)
        values = {
            "heave: top tension": KeyResult("heave", "top tension", "N", answer(h, dt), 0.0),
            "heave: touchdown arc": KeyResult("heave", "touchdown arc", "m", 20.0 + 0.1 * (answer(h, dt) - 100.0), 0.0),
        }
        return PointOutcome(factors, 0, "", 2.0 / (h * dt), True, 10, values)

    monkeypatch.setattr(findings, "compute", compute)
    return study(scene(), folder, echo=lambda _: None, **given)


def both(h: float, dt: float) -> float:
    """Second order in steps, fourth in elements, and a little of both together."""
    return 100.0 + 4.0 * dt**2 - 0.3 * h**4 + 0.02 * h**4 * dt**2


def test_reference_and_shares_of_a_manufactured_answer(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    quantity = manufactured(monkeypatch, tmp_path / "s", both).quantities()["heave: top tension"]
    assert quantity.reference.value == pytest.approx(100.0, abs=0.01)
    assert abs(quantity.reference.value - 100.0) <= quantity.uncertainty < 0.2
    assert quantity.error == pytest.approx(0.0372, abs=1e-4)
    assert [each.order for each in quantity.limits] == [pytest.approx(4.0), pytest.approx(2.0)]
    assert [quantity.share(0), quantity.share(1)] == [pytest.approx(0.0028, abs=1e-5), pytest.approx(0.0402, abs=1e-5)]


def test_how_errors_act_together_is_in_the_uncertainty(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """An answer whose errors multiply more than they add."""
    made = manufactured(monkeypatch, tmp_path / "s", lambda h, dt: 100.0 + 4.0 * h**2 * dt**2 + dt**2)
    quantity = made.quantities()["heave: top tension"]
    assert 0.1 < abs(quantity.reference.value - 100.0) <= quantity.uncertainty


def test_the_limiting_setting_and_the_cheapest_settings(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """1 % of 100 needs steps of a half, with elements twice as long (0.3 h^4 = 4.8) too much: 4 s. By hand."""
    made = manufactured(monkeypatch, tmp_path / "s", both)
    for target, best, seconds in ((0.01, (1.0, 2.0), 4.0), (0.001, (2.0, 8.0), 32.0)):
        reached = made.reaching(target)
        assert reached is not None
        assert (reached.factors, reached.cpu) == (best, seconds)
    lines = words(made)
    line_with(lines, "as it is", "takes 2 s", "3.73 % off")
    line_with(lines, "limits the accuracy", "is the time step")
    line_with(lines, "1 % is reached", "least cost, 4 s", "36 elements, time_step 0.005 s")
    line_with(lines, "0.1 % is reached", "least cost, 32 s", "72 elements, time_step 0.00125 s")


def test_the_pareto_front_falls(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    made = manufactured(monkeypatch, tmp_path / "s", both)
    front = made.front()
    errors = [made.error(each)[0] for each in front]
    assert errors == sorted(errors, reverse=True)
    assert [each.cpu for each in front] == sorted(each.cpu for each in front)
    for each in made.outcomes.values():
        assert any(a.cpu <= each.cpu and made.error(a)[0] <= made.error(each)[0] for a in front)


def test_errors_that_cancel_reach_nothing(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """In the scene two errors of 4 % cancel."""
    made = manufactured(monkeypatch, tmp_path / "s", lambda h, dt: 100.0 + 4.0 * dt**2 - 4.0 * h**2)
    assert made.error(made.scene)[0] < 1e-6
    assert made.reaching(0.01) is not made.scene


def test_a_failed_point_is_a_row_with_its_reason(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Steps too long fail: the refinement series goes on without them."""
    made = manufactured(monkeypatch, tmp_path / "s", both, fails=lambda h, dt: dt > 2.0)
    assert made.quantities()["heave: top tension"].reference.value == pytest.approx(100.0, abs=0.01)
    with (tmp_path / "s" / "study.csv").open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["status"] != "0"]
    (row,) = rows
    line_with([row["settings"]], "36 elements", "time_step 0.04 s")
    assert row["reason"] == FAILED
    line_with(words(made)[-1], "1 of 11", "failed")
    assert FAILED in (tmp_path / "s" / "study.html").read_text(encoding="utf-8")


def test_a_failed_corner_leaves_a_reference(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    made = manufactured(monkeypatch, tmp_path / "s", both, fails=lambda h, dt: h < 1.0 and dt < 1.0)
    quantity = made.quantities()["heave: top tension"]
    assert abs(quantity.reference.value - 100.0) <= quantity.uncertainty < 1.0


def test_what_does_not_close_in_is_not_judged(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    made = manufactured(monkeypatch, tmp_path / "s", lambda h, dt: 100.0 + 40.0 * (-1.0) ** round(math.log2(dt)) + h)
    assert made.judged().keys() == set()
    line_with(words(made)[:1], "error of heave: top tension (±", "is unknown", "no refinement converges")
    assert made.reaching(0.01) is None


def test_a_target_finer_than_the_reference_counts_what_can_be_reported(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Steps make a noise of 2 %, elements an error of 4 % at their coarsest: those must be as fine as for 1 %."""
    made = manufactured(
        monkeypatch, tmp_path / "s", lambda h, dt: 100.0 + (-1.0) ** round(math.log2(dt)) + 0.5 * h**2
    )
    tension = made.quantities()["heave: top tension"]
    assert 0.015 < tension.relative_uncertainty < 0.05
    reached = made.reaching(0.001)
    assert reached is not None
    assert tension.error_of(reached.key_results["heave: top tension"]) <= tension.relative_uncertainty
    assert made.predicted(0.001).error_ratio((0.25, 0.25)) > 1.0
    *_, cannot, why = words(made)
    line_with([cannot], "0.1 % can't be judged", "reference", "least cost")
    line_with([why], "known less well", "0.1 %", "heave: top tension (±")


def test_a_scene_that_fails_is_studied_around_finer_settings(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The scene runs with steps of a quarter: 0.0025 s, elements of a quarter, too. What failed is a row."""
    results = {"heave: top tension": KeyResult("heave", "top tension", "N", 100.0, 0.0)}

    def outcome(factors: Factors, scene: Scene) -> PointOutcome:
        if scene.line.element_count < 4 * 36:
            return PointOutcome(factors, 3, "folded", 1.0, True)
        return PointOutcome(factors, 0, "", 1.0, True, 1, results)

    def compute(scenes: Mapping[Factors, Scene], runs: Path, jobs: int, on_end: Any) -> list[PointOutcome]:
        return [outcome(*each) for each in scenes.items()]

    monkeypatch.setattr(findings, "compute", compute)
    made = study(scene(), tmp_path / "t", levels=3, echo=lambda _: None)
    finer = "144 elements", "time_step 0.0025 s"
    line_with(made.refinements.in_words(made.refinements.base), *finer)
    line_with(words(made)[:1], "scene itself fails:", "folded", "finer settings:", *finer)
    with (tmp_path / "t" / "study.csv").open(encoding="utf-8") as file:
        failed = [row["settings"] for row in csv.DictReader(file) if row["reason"] == "folded"]
    line_with(failed, "36 elements", "time_step 0.01 s")
    line_with(failed, "72 elements", "time_step 0.005 s")
    assert len(failed) > 2


def test_a_scene_that_fails_with_finer_settings_too_ends_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    with pytest.raises(SolveError, match=telling("scene itself fails", FAILED)):
        manufactured(monkeypatch, tmp_path / "s", both, fails=lambda h, dt: True)


def test_numbers_are_json_and_the_page_stands_alone(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    made = manufactured(monkeypatch, tmp_path / "s", both)
    numbers = json.loads((tmp_path / "s" / "study.json").read_text(encoding="utf-8"))
    assert numbers["cheapest"] == {"0.01": [1.0, 2.0], "0.001": [2.0, 8.0]}
    assert numbers["quantities"]["heave: top tension"]["knobs"]["time_step"]["order"] == pytest.approx(2.0)
    assert len(numbers["points"]) == len(made.outcomes)
    page = (tmp_path / "s" / "study.html").read_text(encoding="utf-8")
    assert "data:image/svg+xml;base64," in page
    assert "http" not in page
    assert all(sentence[1:] in page.replace("&#x27;", "'") for sentence in numbers["words"])


def test_bad_input_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ResultsError, match=telling("--setting penalty:", "no such setting", "elements")):
        study(scene(), tmp_path / "s", settings=["penalty"])
    assert not (tmp_path / "s").exists()
    (tmp_path / "letters").mkdir()
    (tmp_path / "letters" / "a.txt").write_text("mine")
    with pytest.raises(SceneError, match=telling("else than a study", "a.txt")):
        study(scene(), tmp_path / "letters", force=True)


FAKE = """
import json, os, signal, sys
folder, status = sys.argv[1:]
if status == "-9":
    os.kill(os.getpid(), signal.SIGKILL)
json.dump({"finished": status == "0", "stages": [], "processor_seconds": 1.5}, open(folder + "/summary.json", "w"))
open(folder + "/results.nc", "w").close()
print("no convergence at all" if status == "3" else folder + "/scene.yaml:7: riser.start: buried")
sys.exit(int(status))
"""


@pytest.mark.parametrize(
    ("status", "reason", "cpu", "again"),
    [
        (0, "", 1.5, False),
        (2, "riser.start: buried", 1.5, False),
        (3, "no convergence at all", 1.5, False),
        (4, "", 1.5, True),
        (-9, "killed by SIGKILL, as where memory runs out", math.nan, True),
    ],
)
def test_how_a_point_ends(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, status: int, reason: str, cpu: float, again: bool
) -> None:
    """One that was killed, or found the disk full, is run again; one whose scene fails is not. Its summary stays."""
    monkeypatch.setattr(one_run, "command", lambda made: [sys.executable, "-c", FAKE, str(made), str(status)])
    point: dict[Factors, Scene] = {(2.0, 1.0): scene()}
    known_before = list[bool]()
    if status == 4:
        with pytest.raises(WriteError, match="buried"):
            compute(point, tmp_path, 1, lambda outcome, before: known_before.append(before))
        assert not list(tmp_path.glob("*/*"))
        return
    for _ in range(2):
        (result,) = compute(point, tmp_path, 1, lambda outcome, before: known_before.append(before))
        assert (result.status, result.reason, result.alone) == (137 if status == -9 else status, reason, True)
        assert result.cpu == pytest.approx(cpu, nan_ok=True)
    assert known_before == [False, not again]
    (folder,) = (entry for entry in tmp_path.iterdir() if not entry.name.startswith("."))
    files = {"case.json", "said.txt", "scene.yaml"} | ({"summary.json"} if status >= 0 else set())
    assert {entry.name for entry in folder.iterdir()} == files


def test_a_scene_that_differs_is_another_run(tmp_path: Path) -> None:
    scenes = (scene().model_copy(update={"gravity": g}) for g in (9.8, 9.81))
    one, other = (point_task(each, tmp_path, True) for each in scenes)
    assert one["name"] != other["name"]
    twice = point_task(scene().model_copy(update={"error_bars": True, "gravity": 9.8}), tmp_path, True)
    assert twice["name"] == one["name"], "a study estimates no error bars"


COMMAND = [sys.executable, "-m", "riser_soil", "study", "small.yaml", "--levels", "3", "--jobs", "2"]


def _started(folder: Path) -> subprocess.Popen[str]:
    pipe = subprocess.PIPE
    return subprocess.Popen(COMMAND, cwd=folder, env=environment(), text=True, stdout=pipe, stderr=pipe)


@pytest.mark.verify
def test_a_study_that_was_interrupted_goes_on(tmp_path: Path) -> None:
    """A run of each level, and of those that were done before the signal none again."""
    (tmp_path / "small.yaml").write_text(SMALL, encoding="utf-8")
    with _started(tmp_path) as first:
        outcomes = _first_outcomes(tmp_path, first)
        first.send_signal(signal.SIGTERM)
        _, said = first.communicate(timeout=HANGS)
    assert first.returncode == 143
    assert line_with(said, "SIGTERM", "in a study", "call again") == said.splitlines()[0]
    before = {path: path.stat().st_mtime_ns for path in outcomes}
    with _started(tmp_path) as again:
        output, said = again.communicate(timeout=HANGS)
    assert again.returncode == 0, said
    assert {path: path.stat().st_mtime_ns for path in outcomes} == before
    assert output.count("computed before") >= len(outcomes)
    data = json.loads((tmp_path / "small-study" / "study.json").read_text(encoding="utf-8"))
    tension = data["quantities"]["hang: top tension"]
    assert tension["error"] < 0.02
    assert tension["knobs"]["elements"]["order"] == pytest.approx(4.0, abs=1.5)
    assert {tuple(p["factors"].values()): p["timed_alone"] for p in data["points"][:3]} == {
        (0.5,): True, (1.0,): True, (2.0,): False,
    }  # fmt: skip
    assert not list((tmp_path / "small-study").rglob("*.nc"))


def _first_outcomes(folder: Path, process: subprocess.Popen[str]) -> list[Path]:
    """What has been computed as soon as there is something."""
    since = time.monotonic()
    while time.monotonic() - since < HANGS and process.poll() is None:
        files = list(folder.glob("small-study/points/*/case.json"))
        if files:
            return files
        time.sleep(0.05)
    raise AssertionError(process.communicate())


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--levels", "2"], "--levels 2: must be from 3 to 9"),
        (["--jobs", "0"], "--jobs 0: must be 1 or more"),
        (["--setting", "time_step"], "--setting time_step: the scene has no such setting; choose among elements"),
        (["-o", "small.yaml"], "small.yaml: is a file, not a folder; choose another result folder with -o FOLDER"),
    ],
)
def test_the_command_refuses_bad_input(
    options: list[str], says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "small.yaml").write_text(SMALL, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(app, ["study", "small.yaml", *options])
    assert (result.exit_code, result.stderr) == (2, says + "\n")
    assert [path.name for path in tmp_path.iterdir()] == ["small.yaml"]


def test_a_run_that_fails_tells_why(tmp_path: Path) -> None:
    given = YAML(typ="safe").load(SMALL) | {"solver": {"max_iterations": 1, "min_load_step": 1.0}}
    (outcome,) = compute({(1.0,): scene_from_mapping(given)}, tmp_path, 1, lambda outcome, before: None)
    assert outcome.status == 3
    assert "no stable equilibrium" in outcome.reason
    assert 0.0 < outcome.cpu < HANGS
