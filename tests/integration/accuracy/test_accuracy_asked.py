"""Accuracy asked in a scene: how it is written, the setting chosen for it, the run that reaches it or says why not."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from mpi4py import MPI
from typer.testing import CliRunner

from benchmarks.asked_accuracy.asked import asking as without_settings
from benchmarks.error_bars import references
from benchmarks.error_bars.scenes import SCENES
from riser_soil.accuracy import target_run
from riser_soil.accuracy.search import first_setting, trial
from riser_soil.accuracy.target_run import run_to_accuracy
from riser_soil.commands.app import app
from riser_soil.errors import AccuracyError, Interruption, SceneError, SolveError
from riser_soil.scene.dump import schema_text
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage
from riser_soil.variants.key_results import key_results
from riser_soil.variants.settings import SETTINGS
from riser_soil.whole_run import run
from tests.support.on_ranks import mpirun
from tests.support.said import line_with, telling


def asking(name: str, accuracy: Any = "1 %", **more: Any) -> dict[str, Any]:
    """A scene of known answer that asks for an accuracy."""
    return without_settings(SCENES[name], accuracy) | more


def summary(folder: Path) -> Any:
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def worst(folder: Path, name: str) -> float:
    """The largest true error of a run's key results."""
    results, known = key_results(summary(folder)), references.read()[name]
    return max(each.relative(each.value - known[key][0]) for key, each in results.items() if key in known)


@pytest.mark.parametrize(("given", "share"), [("1 %", 0.01), ("0.5%", 0.005), (" 20 % ", 0.2), (0.02, 0.02)])
def test_accuracy_is_a_percentage(given: Any, share: float) -> None:
    assert scene_from_mapping(asking("catenary, 35 elements", given)).accuracy == pytest.approx(share)


@pytest.mark.parametrize("given", ["1", "25 %", "0.001 %", 1, 0.5, True, "good", "-1 %", ["1 %"]])
def test_other_accuracies_are_refused(given: Any) -> None:
    with pytest.raises(SceneError, match=telling("accuracy:", "percentage", "0.01 % to 20 %", "accuracy: 1 %")):
        scene_from_mapping(asking("catenary, 35 elements", given))


@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("catenary, 35 elements", "riser.segments.0.elements"),
        ("on springs", "riser.segments.0.element_length"),
        ("surge, 40 steps", "stages.1.time_step"),
        ("waves and surge, automatic steps", "stages.1.time_step"),
        ("hose on a rigid floor", "contact.stiffness"),
        ("pipe pressed on clay", "soil.mesh"),
    ],
)
def test_what_it_stands_for_is_not_given_too(name: str, key: str) -> None:
    chosen = asking(name)
    part, of_key = chosen, key.split(".")
    given: Any = SCENES[name]
    for step in of_key[:-1]:
        at: Any = int(step) if step.isdecimal() else step
        part, given = part[at], given[at]
    part[of_key[-1]] = given[of_key[-1]]
    with pytest.raises(SceneError) as caught:
        scene_from_mapping(chosen)
    assert f"chooses what {key} gives; leave out {key}, or accuracy" in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_other_mistakes_are_reported_beside_it() -> None:
    with pytest.raises(SceneError, match=r"riser\.segments: "):
        scene_from_mapping(asking("catenary, 35 elements") | {"riser": {"segments": "none"}})


def test_first_setting_has_steps_by_period_and_accuracy() -> None:
    steps = []
    for accuracy in ("1 %", "0.25 %"):
        scene = first_setting(scene_from_mapping(asking("surge, 40 steps", accuracy)))
        assert scene.accuracy is None
        assert scene.line.element_count == 24
        motion = scene.stages[1]
        assert isinstance(motion, DynamicStage)
        steps.append(motion.time_step)
    assert steps == pytest.approx([14.0 / 50.0, 14.0 / 100.0])


def test_nodes_are_where_something_acts(tmp_path: Path) -> None:
    """A moment at 4.3 m and a clump at 7.1 m of a cantilever of 10 m: M(0) = 2e3 + m g 7.1, by statics."""
    moment = {"name": "load", "kind": "static", "loads": [{"at": 4.3, "moment": [0.0, 2.0e3, 0.0]}]}
    given = asking("cantilever, tip load", stages=[moment], gravity=9.81)
    given["line_types"] = {"pipe": given["line_types"]["pipe"] | {"submerged_weight": 0.0}}
    given["riser"] = given["riser"] | {"attachments": [{"at": 7.1, "mass": 30.0}]}
    scene = scene_from_mapping(given)
    run_to_accuracy(scene, tmp_path / "run")
    arcs = read_scene(tmp_path / "run" / "scene.yaml").line.node_arcs
    for place in (4.3, 7.1):
        assert min(abs(arc - place) for arc in arcs) < 1e-9
    results = key_results(summary(tmp_path / "run"))
    assert results["load: largest bending moment"].value == pytest.approx(2.0e3 + 30.0 * 9.81 * 7.1, rel=2e-3)
    assert summary(tmp_path / "run")["accuracy"]["reached"]


def test_nothing_else_runs_before_the_setting_is_chosen(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=telling("accuracy:", "chosen first")):
        run(scene_from_mapping(asking("catenary, 35 elements")), tmp_path / "run")


@pytest.mark.parametrize(
    "name",
    [
        "beam under tension, unresolved",
        "on springs, coarse",
        pytest.param("hose on a rigid floor", marks=pytest.mark.verify),
    ],
)
def test_statics_reach_it(name: str, tmp_path: Path) -> None:
    run_to_accuracy(scene_from_mapping(asking(name)), tmp_path / "run")
    data = summary(tmp_path / "run")
    assert data["accuracy"]["reached"]
    assert data["accuracy"]["largest_error"] <= 0.01
    assert worst(tmp_path / "run", name) <= 0.01
    assert data["finished"]


def test_elements_are_short_where_curvature_asks_for_it() -> None:
    """At the clamped ends of a taut beam, in a layer of 0.35 m; in the middle they are ten times as long."""
    outcome = trial(first_setting(scene_from_mapping(asking("beam under tension, unresolved"))), 0.01, MPI.COMM_WORLD)
    lengths = [x for segment in outcome.scene.line.segments for x in segment.element_lengths]
    assert max(lengths[0], lengths[-1]) < 0.35
    assert max(lengths) > 10.0 * lengths[0]


@pytest.mark.parametrize(
    "name",
    ["on springs, coarse", pytest.param("beam under tension, sudden load", marks=pytest.mark.verify)],
    ids=["statics", "motion"],
)
def test_the_scene_of_the_run_that_reaches_it_is_kept(name: str, tmp_path: Path) -> None:
    run_to_accuracy(scene_from_mapping(asking(name)), tmp_path / "run")
    assert worst(tmp_path / "run", name) <= 0.01
    chosen = read_scene(tmp_path / "run" / "scene.yaml")
    assert chosen.accuracy is None
    run(chosen, tmp_path / "again")
    results, again = (key_results(summary(tmp_path / folder)) for folder in ("run", "again"))
    assert {key: each.value for key, each in results.items()} == {key: each.value for key, each in again.items()}


def test_accuracy_that_is_not_reached_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The finest run is kept with its error bars; the command fails as a solve does."""
    monkeypatch.setattr(target_run, "RUNS", 1)
    file, folder = tmp_path / "scene.yaml", tmp_path / "run"
    file.write_text(json.dumps(asking("cantilever under a sudden load", "20 %")), encoding="utf-8")
    done = CliRunner().invoke(app, ["run", str(file), "-o", str(folder)])
    assert done.exit_code == SolveError.exit_status
    line_with(done.output, "accuracy:", "20.00%", "not reached:")
    data = summary(folder)
    assert data["accuracy"]["reached"] is False
    assert data["accuracy"]["largest_error"] > 0.2
    assert max(bar["bar"] / abs(bar["value"]) for bar in data["error_bars"]["quantities"] if bar["bar"]) > 0.2
    assert data["finished"]


def test_an_impact_that_hardly_converges_ends_the_search_early(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The message has what it would take, as the remaining run would not reach it."""
    monkeypatch.setattr(target_run, "RUNS", 2)
    scene = scene_from_mapping(asking("cantilever under a sudden load", "1 %"))
    with pytest.raises(AccuracyError, match=r"at least \d+ times .*run has that"):
        run_to_accuracy(scene, tmp_path / "run")
    data, elements = summary(tmp_path / "run"), read_scene(tmp_path / "run" / "scene.yaml").line.segments
    assert data["accuracy"]["reached"] is False
    assert data["finished"]
    assert sum(part.elements or 0 for part in elements) < 200  # a second run has some 400


def test_a_run_too_large_to_follow_leaves_the_one_before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    name, limits = "cantilever under a sudden load", [SceneError("needs 4 TB of memory"), None]

    def limited(scene: Scene, *given: Any) -> None:
        if limit := limits.pop():
            raise limit
        run(scene, *given)

    monkeypatch.setattr(target_run, "run", limited)
    with pytest.raises(AccuracyError, match=telling("not reached:", "can't be run:", "4 TB of memory")):
        run_to_accuracy(scene_from_mapping(asking(name, "20 %")), tmp_path / "run")
    assert summary(tmp_path / "run")["accuracy"]["reached"] is False


def test_a_run_that_fails_is_followed_by_one_half_the_way_to_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    tried = list[Scene]()

    def limited(scene: Scene, *given: Any) -> None:
        tried.append(scene)
        if len(tried) == 1:
            raise SolveError("no convergence")
        run(scene, *given)

    monkeypatch.setattr(target_run, "run", limited)
    name = "beam under tension, sudden load"
    run_to_accuracy(scene_from_mapping(asking(name)), tmp_path / "run")
    assert worst(tmp_path / "run", name) <= 0.01
    line_with(capsys.readouterr().out, "fails", "no convergence", "half the way")
    (steps,) = (setting for setting in SETTINGS if setting.name == "time_step")
    failed, nearer, *_ = (steps.fineness(scene) for scene in tried)
    assert nearer < failed


def test_a_run_that_would_take_too_long_to_follow_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first is run whatever it takes."""
    monkeypatch.setattr(target_run, "LONGEST", 0.0)
    scene = scene_from_mapping(asking("cantilever under a sudden load", "20 %"))
    with pytest.raises(AccuracyError, match=telling("not reached:", "finer run", "more than 0 s")):
        run_to_accuracy(scene, tmp_path / "run")
    assert summary(tmp_path / "run")["finished"]


def test_a_finished_run_is_refused_before_the_search(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_from_mapping(asking("cantilever, tip load"))
    run_to_accuracy(scene, tmp_path / "run")
    monkeypatch.setattr(target_run, "trial", None)
    with pytest.raises(SceneError, match="holds a finished run"):
        run_to_accuracy(scene, tmp_path / "run")


def test_a_signal_during_the_search_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def ended(scene: Scene, accuracy: float, comm: Any) -> None:
        raise Interruption(2)

    monkeypatch.setattr(target_run, "trial", ended)
    with pytest.raises(Interruption, match=telling("accuracy was sought", "nothing was written")):
        run_to_accuracy(scene_from_mapping(asking("cantilever, tip load")), tmp_path / "run")
    assert not (tmp_path / "run").exists()


def test_check_tells_the_setting_that_the_search_begins_with(tmp_path: Path) -> None:
    file = tmp_path / "scene.yaml"
    file.write_text(json.dumps(asking("surge, 40 steps")), encoding="utf-8")
    done = CliRunner().invoke(app, ["check", str(file)])
    assert done.exit_code == 0, done.output
    line_with(done.output, "accuracy 1.00%:", "run chooses")
    assert "riser: 24 elements" in done.output


@pytest.mark.verify
def test_ranks_choose_alike(tmp_path: Path) -> None:
    file = tmp_path / "scene.yaml"
    file.write_text(json.dumps(asking("on springs, coarse")), encoding="utf-8")
    for ranks in (1, 2):
        done = mpirun(ranks, "-m", "riser_soil", "run", "scene.yaml", "-o", f"on {ranks}", folder=tmp_path)
        assert done.returncode == 0, done.stderr
    one, two = (summary(tmp_path / f"on {ranks}") for ranks in (1, 2))
    assert one["accuracy"]["settings"] == two["accuracy"]["settings"]
    assert one["accuracy"]["largest_error"] == pytest.approx(two["accuracy"]["largest_error"], rel=1e-3)


def test_error_is_of_the_run_that_is_reported(tmp_path: Path) -> None:
    """Bars of the summary are the accuracy's: the largest over its scale is what is told."""
    run_to_accuracy(scene_from_mapping(asking("cantilever, tip load")), tmp_path / "run")
    data = summary(tmp_path / "run")
    scales = {key: each.scale for key, each in key_results(data).items()}
    bars = data["error_bars"]["quantities"]
    shares = {f"{bar['stage']}: {bar['name']}": bar["bar"] for bar in bars}
    assert max(bar / scales[key] for key, bar in shares.items()) == pytest.approx(data["accuracy"]["largest_error"])


def test_editors_know_both_ways_of_writing_it() -> None:
    schema = json.loads(schema_text())["properties"]["accuracy"]
    assert {each["type"] for each in schema["anyOf"]} == {"string", "number", "null"}
