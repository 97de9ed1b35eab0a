"""Error bars: of made-up companions with known errors, of small runs with their files, and of companions that fail."""

from __future__ import annotations

import json
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from typer.testing import CliRunner

from benchmarks.error_bars import references
from benchmarks.error_bars.calibration import judge, share_inside
from benchmarks.error_bars.scenes import CLAY, SCENES
from riser_soil.accuracy import chain
from riser_soil.accuracy.barred_run import run_with_error_bars
from riser_soil.accuracy.error_bars import Companion, ErrorBar, RunValues, divisor, error_bars, orders
from riser_soil.accuracy.headlines import Headline
from riser_soil.accuracy.knobs import KNOBS, settings_told
from riser_soil.commands.app import app
from riser_soil.core.communicator import Alone
from riser_soil.errors import SolveError
from riser_soil.results.peaks import RunPeaks
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene

KEY = "hang: top tension"
# As calibrated by the page of error bars, and the orders that it assumes.
SAFETY, ON_PATH = {"mesh": 1.5, "time": 1.8, "soil": 0.9, "penalty": 1.6}, 1.4
ORDER, SMALLEST = {"time": 2.0, "soil": 1.0, "penalty": 0.75}, 5e-5
SOIL = [name for name, scene in SCENES.items() if "soil" in scene]
SOIL_MESH = next(knob for knob in KNOBS if knob.name == "soil_mesh")
QUICK = ("catenary, 35 elements", "cantilever, tip load", "on springs", "surge, 140 steps", "hose on a rigid floor")


def bar_of(
    told: float, peak: float, *companions: Companion, touches: bool = False, path_dependent: bool = False
) -> ErrorBar:
    headline = Headline("hang", "top tension", "N", told, 1000.0)
    values = RunValues({KEY: headline}, {KEY: peak}, {KEY: peak}, {KEY: peak})
    (bar,) = error_bars(values, companions, touches, path_dependent)
    return bar


def of_order(order: float, ratio: float, error: float, source: str, before: float = 1000.0) -> Companion:
    """A companion whose error is that of the run times ratio^order."""
    return Companion(source, ratio, {KEY: before + error * (ratio**order - 1.0)})


@pytest.mark.parametrize(("source", "ratio", "order"), [("mesh", 2.0, 4.0), ("time", 5.0, 2.0), ("soil", 2.0, 1.0)])
def test_error_of_the_known_order_is_found(source: str, ratio: float, order: float) -> None:
    error = 1e-3  # so small that it is asymptotic
    bar = bar_of(1000.0, 1000.0, of_order(order, ratio, error, source))
    assert bar.by_source[source] == pytest.approx(SAFETY[source] * error, rel=0.01)
    assert bar.bar == pytest.approx(bar.by_source[source] + SMALLEST * 1000.0)


@pytest.mark.parametrize(("touches", "divided"), [(True, 3.0), (False, 15.0)])
def test_elements_that_touch_down_have_a_lower_order(touches: bool, divided: float) -> None:
    bar = bar_of(1000.0, 1000.0, Companion("mesh", 2.0, {KEY: 1000.0 + 1e-6}), touches=touches)
    assert bar.by_source["mesh"] == pytest.approx(SAFETY["mesh"] * 1e-6 / divided, rel=1e-3)


def test_contact_force_on_a_penalty_falls_by_its_own_orders() -> None:
    assert orders("top tension", {"mesh", "penalty"}, 2.0) == ORDER | {"mesh": 2.0}
    assert orders("largest contact force", {"mesh", "time"}, 2.0) == ORDER | {"mesh": 2.0}  # on springs
    assert orders("largest contact force", {"mesh", "soil", "penalty"}, 2.0) == ORDER | {"mesh": 2.0}  # soil gives way
    assert orders("largest contact force", {"mesh", "penalty"}, 2.0) == ORDER | {"mesh": 1.0, "penalty": 0.25}


def test_large_differences_are_hardly_divided() -> None:
    assert divisor(Companion("time", 5.0, {}), 10.0, 2.0) == pytest.approx(1.0, abs=0.05)


def test_sources_follow_one_another_and_add_up_as_squares_do() -> None:
    first = of_order(2.0, 5.0, 0.03, "time")
    assert first.values is not None
    second = of_order(4.0, 2.0, 0.04, "mesh", before=first.values[KEY])
    bar = bar_of(1000.0, 1000.0, first, second)
    shares = (SAFETY["time"] * 0.03, SAFETY["mesh"] * 0.04)
    assert (bar.by_source["time"], bar.by_source["mesh"]) == pytest.approx(shares, rel=0.1)
    assert bar.bar == pytest.approx(math.hypot(*bar.by_source.values()) + SMALLEST * 1000.0)


def test_of_two_companions_in_one_source_the_larger_share_counts() -> None:
    """Of first order the two differences are 0.41 and 1.41 times the error; either may be small by chance."""
    near, far = 2.0**0.5, 2.0 * 2.0**0.5
    for first, second in ((near - 1.0, far - 1.0), (near - 1.0, near - 1.0), (0.0, far - near)):
        chain = Companion("soil", near, {KEY: 1000.0 + first}), Companion("soil", 2.0, {KEY: 1000.0 + second})
        assert bar_of(1000.0, 1000.0, *chain).by_source["soil"] == pytest.approx(SAFETY["soil"])


def test_soil_that_depends_on_its_path_takes_a_larger_factor() -> None:
    """Clay, or layers of which one is clay; elastic soil does not, nor does a scene without soil."""
    yields = {name: scene_from_mapping(scene).has_path_dependent_soil for name, scene in SCENES.items()}
    assert {name for name, found in yields.items() if found} == {name for name in SOIL if "clay" in name}
    soil = SCENES["pipe pressed on elastic soil"]["soil"]
    layers = [{"to": 0.5, "law": soil["law"]}, {"law": CLAY}]
    mixed = {key: value for key, value in soil.items() if key != "law"} | {"layers": layers}
    scene = scene_from_mapping(SCENES["pipe pressed on elastic soil"] | {"soil": mixed})
    assert scene.has_path_dependent_soil
    companion = of_order(1.0, 2.0, 1.0, "soil")
    elastic, clay = (bar_of(1000.0, 1000.0, companion, path_dependent=found) for found in (False, True))
    assert (elastic.by_source["soil"], clay.by_source["soil"]) == pytest.approx((SAFETY["soil"], ON_PATH))


def test_what_falls_between_nodes_is_the_meshs() -> None:
    bar = bar_of(1000.0, 1010.0, Companion("mesh", 2.0, {KEY: 1010.0}))
    assert bar.by_source["mesh"] == pytest.approx(SAFETY["mesh"] * 10.0)


def test_what_falls_between_steps_and_what_rings_is_the_time_steps() -> None:
    """Twice as much as this run shows of either, for another one has its steps elsewhere."""
    headline = Headline("heave", "top tension", "N", 1000.0, 1000.0)
    key = headline.key
    nodes, steps, smooth = {key: 1000.0}, {key: 1004.0}, {key: 997.0}
    (bar,) = error_bars(RunValues({key: headline}, nodes, steps, smooth), [], touches=False, path_dependent=False)
    assert bar.by_source["time"] == pytest.approx(SAFETY["time"] * (2.0 * 4.0 + 2.0 * 3.0))


def test_no_bar_without_a_companion() -> None:
    """What is known is told by source; what stands behind one that failed is not compared with what stands before."""
    failed = Companion("time", 5.0, None, "its coarser companion failed: it did")
    bar = bar_of(1000.0, 1000.0, failed, Companion("mesh", 2.0, {KEY: 1001.0}))
    assert bar.bar is None
    assert "its coarser companion failed: it did" in bar.reason
    assert bar.by_source["mesh"] == 0.0


def test_true_errors_of_a_few_scenes_are_inside() -> None:
    known = references.read()
    judged = [each for name in QUICK for each in judge(name, SCENES[name], known[name]).judged]
    assert len(judged) > 30
    assert share_inside(judged) > 0.9


def run_told(tmp_path: Path, name: str, **more: Any) -> Any:
    run_with_error_bars(scene_from_mapping(SCENES[name] | more), tmp_path / "run")
    return json.loads((tmp_path / "run" / "summary.json").read_text(encoding="utf-8"))


def test_bars_of_a_run_are_on_the_screen_and_in_its_summary(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    told = run_told(tmp_path, "cantilever let go", output={"fields": []})
    screen = capsys.readouterr().out
    assert "motion: error bars" in screen
    assert "force at start, N" in screen
    quantities = {(bar["stage"], bar["name"]): bar for bar in told["error_bars"]["quantities"]}
    bar = quantities["motion", "largest bending moment"]
    assert set(bar["by_source"]) == {"mesh", "time"}
    assert 0.0 < bar["bar"] < 0.2 * bar["value"]
    assert told["finished"]
    assert not (tmp_path / "run" / ".riser_soil").exists()


def test_companion_that_fails_is_told_and_its_run_stays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(scene: Scene, comm: object) -> None:
        raise SolveError("no convergence at 3 s\nmore of it")

    monkeypatch.setattr(chain, "peaks_of", fails)
    told = run_told(tmp_path, "cantilever let go")
    assert told["finished"]
    assert {bar["bar"] for bar in told["error_bars"]["quantities"]} == {None}
    assert "its coarser companion failed: no convergence at 3 s" in capsys.readouterr().out


def test_error_that_one_rank_may_have_met_alone_is_no_failed_companion(monkeypatch: pytest.MonkeyPatch) -> None:
    """The others are within the companion still, and would not hear of the next one."""

    def fails(scene: Scene, comm: object) -> None:
        raise ValueError("math domain error")

    monkeypatch.setattr(chain, "peaks_of", fails)
    scene = scene_from_mapping(SCENES["hose swings on a rigid floor"])
    assert [each.values for each in chain.companions(scene, Alone())] == [None, None, None]
    with pytest.raises(ValueError, match="math domain error"):
        chain.companions(scene, SimpleNamespace(rank=0, size=2))


def test_companions_go_on_from_one_to_the_next(monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps five times as long, which output times do not hold back, then half the elements too, then soft contact."""
    seen: list[Scene] = []

    def looks(scene: Scene, comm: object) -> RunPeaks:
        seen.append(scene)
        return RunPeaks()

    monkeypatch.setattr(chain, "peaks_of", looks)
    scene = scene_from_mapping(SCENES["hose swings on a rigid floor"] | {"output": {"interval": 0.1}})
    found = chain.companions(scene, None)
    assert [(each.source, each.ratio) for each in found] == [("time", 5.0), ("mesh", 2.0), ("penalty", 4.0)]
    assert [each.riser.element_count for each in seen] == [80, 40, 40]
    assert [each.contact and each.contact.stiffness for each in seen] == [1e5, 1e5, 2.5e4]
    assert {each.output.interval for each in seen} == {None}


def test_soil_is_coarsened_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[str] = []

    def looks(scene: Scene, comm: object) -> RunPeaks:
        seen.append(settings_told(scene, [SOIL_MESH]))
        return RunPeaks()

    monkeypatch.setattr(chain, "peaks_of", looks)
    found = chain.companions(scene_from_mapping(SCENES["pipe pressed on clay"]), None)
    assert [each.source for each in found] == ["soil", "soil", "mesh", "penalty"]
    assert [each.ratio for each in found] == pytest.approx([2.0**0.5, 2.0, 2.0, 4.0])
    near, far = (f"soil cells of {0.025 * n**0.5:.4g} m across the riser" for n in (2.0, 8.0))
    assert seen == [near, far, far, far]


def test_a_scene_may_ask_for_bars(tmp_path: Path) -> None:
    file, folder = tmp_path / "scene.yaml", tmp_path / "run"
    file.write_text(json.dumps(SCENES["cantilever, tip load"] | {"error_bars": True}), encoding="utf-8")
    assert CliRunner().invoke(app, ["run", str(file), "-o", str(folder)]).exit_code == 0
    told = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert {bar["bar"] is None for bar in told["error_bars"]["quantities"]} == {False}


def test_what_cannot_be_coarsened_has_no_bar() -> None:
    """One element can't be halved: it must not look exact."""
    scene = SCENES["cantilever, tip load"]
    (segment,) = scene["riser"]["segments"]
    single = scene | {"riser": scene["riser"] | {"segments": [segment | {"elements": 1}]}}
    (companion,) = chain.companions(scene_from_mapping(single), None)
    assert companion.values is None
    assert "can't be coarsened" in companion.reason
