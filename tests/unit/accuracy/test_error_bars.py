"""Error bars: of made-up comparison runs with known errors, of small runs with their files, and of comparison runs that
fail.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.error_bars import references
from benchmarks.error_bars.calibration import Judged, judge, share_inside
from benchmarks.error_bars.page import page
from benchmarks.error_bars.random_soils import SOILS
from benchmarks.error_bars.scenes import CLAY, SCENES
from riser_soil.accuracy import chain
from riser_soil.accuracy.barred_run import run_with_error_bars
from riser_soil.accuracy.error_bars import ComparisonRun, ErrorBar, RunValues, SoilOfRun, divisor, error_bars, orders
from riser_soil.commands.app import app
from riser_soil.core.communicator import Alone
from riser_soil.errors import SolveError
from riser_soil.results.peaks import RunPeaks
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.variants import settings
from riser_soil.variants.extreme_differences import Extreme, difference, without_windows
from riser_soil.variants.key_results import SETTLEMENT, KeyResult
from riser_soil.variants.settings import SETTINGS, resolved, settings_in_words, varied
from tests.support.said import line_with

KEY = "hang: top tension"
# As calibrated by the page of error bars, and the orders that it assumes.
SAFETY, ON_PATH = {"mesh": 2.0, "time": 2.8, "soil": 0.9, "penalty": 1.6}, 1.4
ORDER, SMALLEST = {"mesh": 2.0, "time": 2.0, "soil": 1.0, "penalty": 0.75}, 5e-5
# On soil: of the coarser run and how often at most, of the slice beside it; of elements; the smallest bar.
BY_SLICE, MOST_SEEN, SLICE, AT_REST, MESH_ON_SOIL, SMALLEST_ON_SOIL = 1.2, 2.0, 1.4, 0.35, 1.5, 1e-4
SOIL = [name for name, scene in SCENES.items() if "soil" in scene]
SOIL_MESH, PENALTY = (next(each for each in SETTINGS if each.name == name) for name in ("soil_mesh", "penalty"))
QUICK = ("catenary, 35 elements", "cantilever, tip load", "on springs", "surge, 140 steps", "hose on a rigid floor")


def bar_of(value: float, peak: float, *comparison_runs: ComparisonRun, soil: SoilOfRun | None = None) -> ErrorBar:
    key_result = KeyResult("hang", "top tension", "N", value, 1000.0)
    values = RunValues({KEY: key_result}, {KEY: peak}, {KEY: without_windows(peak)}, {KEY: peak})
    (bar,) = error_bars(values, comparison_runs, rigid=False, soil=soil)
    return bar


def of_order(order: float, finer: float, error: float, source: str, before: float = 1000.0) -> ComparisonRun:
    """A comparison run that is finer by a factor, after a run with an error above `before` which falls by an order."""
    return comparison_run(source, finer, before + error * (finer**-order - 1.0))


def comparison_run(source: str, finer: float, value: float) -> ComparisonRun:
    return ComparisonRun(source, finer, {KEY: without_windows(value)})


@pytest.mark.parametrize(("source", "finer", "order"), [("mesh", 2.0, 2.0), ("time", 0.2, 2.0), ("soil", 0.5, 1.0)])
def test_error_of_the_known_order_is_found(source: str, finer: float, order: float) -> None:
    error = 1e-3  # so small that it is asymptotic
    bar = bar_of(1000.0, 1000.0, of_order(order, finer, error, source))
    assert bar.by_source[source] == pytest.approx(SAFETY[source] * error, rel=0.01)
    assert bar.bar == pytest.approx(bar.by_source[source] + SMALLEST * 1000.0)


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0, 8.0])
def test_finer_elements_tell_an_error_of_any_order(order: float) -> None:
    """At first order 1.3 times the error, at the highest 2.7 times, however large the error is."""
    bar = bar_of(1000.0, 1000.0, of_order(order, 2.0, 500.0, "mesh"))
    assert 1.0 < bar.by_source["mesh"] / 500.0 <= SAFETY["mesh"] * 4.0 / 3.0


def test_contact_force_on_a_rigid_floor_falls_by_its_own_orders() -> None:
    assert orders("top tension", rigid=True) == ORDER
    assert orders("largest contact force", rigid=False) == ORDER
    assert orders("largest contact force", rigid=True) == ORDER | {"mesh": 1.0, "penalty": 0.25}


def test_large_differences_of_longer_steps_are_hardly_divided() -> None:
    """Half way to the divisor 1 where they are 5 % of the scale; those of finer runs have no such limit."""
    longer = ComparisonRun("time", 0.2, {})
    assert divisor(longer, 2.0, 0.0) == pytest.approx(24.0)
    assert divisor(longer, 2.0, 0.05) == pytest.approx(12.5)
    assert divisor(longer, 2.0, 10.0) == pytest.approx(1.0, abs=0.2)
    assert divisor(ComparisonRun("mesh", 2.0, {}), 2.0, 10.0) == pytest.approx(0.75)


def test_sources_follow_one_another_and_add_up_as_squares_do() -> None:
    first = of_order(2.0, 0.2, 0.03, "time")
    assert first.extremes is not None
    second = of_order(2.0, 2.0, 0.04, "mesh", before=first.extremes[KEY].value)
    bar = bar_of(1000.0, 1000.0, first, second)
    shares = (SAFETY["time"] * 0.03, SAFETY["mesh"] * 0.04)
    assert (bar.by_source["time"], bar.by_source["mesh"]) == pytest.approx(shares, rel=0.1)
    assert bar.bar == pytest.approx(math.hypot(*bar.by_source.values()) + SMALLEST * 1000.0)


def test_of_two_coarser_runs_in_one_source_the_larger_share_counts() -> None:
    """At first order the two differences are 0.41 and 1.41 times the error; either may be small by chance."""
    near, far = 2.0**0.5, 2.0 * 2.0**0.5
    for first, second in ((near - 1.0, far - 1.0), (near - 1.0, near - 1.0), (0.0, far - near)):
        chain = comparison_run("soil", 1.0 / near, 1000.0 + first), comparison_run("soil", 0.5, 1000.0 + second)
        assert bar_of(1000.0, 1000.0, *chain).by_source["soil"] == pytest.approx(SAFETY["soil"])


def on_soil(tension: float = 1000.0, settled: float = 1e-3) -> RunValues:
    """Results of a stage in which a riser settles [m]."""
    keys = [KeyResult("hang", "top tension", "N", tension, 0.0), KeyResult("hang", SETTLEMENT, "m", settled, 0.0)]
    known = {each.key: each.value for each in keys}
    peaks = {key: without_windows(x) for key, x in known.items()}
    return RunValues({each.key: each for each in keys}, known, peaks, known)


@pytest.mark.parametrize(
    ("fine", "share"), [(0.9e-3, 1.0), (1.3e-3, 1.5), (1.9e-3, MOST_SEEN), (1.01e-3, 1.0), (None, MOST_SEEN)]
)
def test_a_slice_tells_the_cells_share(fine: float | None, share: float) -> None:
    """Cells twice as wide settle 0.2 mm less than 1 mm, and change a tension by 1 N. Without a slice all counts twice;
    else the settlement by the slice, and the tension once to twice as the slice's change is over that 0.2 mm.
    """
    run, coarser = on_soil(), on_soil(1001.0, 0.8e-3)
    of_settlement = f"hang: {SETTLEMENT}"
    soil = SoilOfRun(True, {} if fine is None else {of_settlement: fine})
    bars = error_bars(run, [ComparisonRun("soil", 0.5, coarser.peaks)], rigid=False, soil=soil)
    tension, settlement = (each.by_source["soil"] for each in bars)
    assert tension == pytest.approx(BY_SLICE * share * 1.0)
    by_slice = BY_SLICE * share * 0.2e-3 if fine is None else math.hypot(SLICE * (fine - 1e-3), AT_REST * 0.2e-3)
    assert settlement == pytest.approx(by_slice)
    assert bars[0].bar == pytest.approx(tension + SMALLEST_ON_SOIL * 1000.0)


def test_a_slice_is_pressed_once_and_a_trough_in_motion_is_not() -> None:
    """There the coarser run's difference counts 1.8 times."""
    soil = SoilOfRun(True, {f"hang: {SETTLEMENT}": 1e-3}, frozenset({"hang"}))
    coarser = ComparisonRun("soil", 0.5, on_soil(1001.0, 0.8e-3).peaks)
    _, settlement = error_bars(on_soil(), [coarser], rigid=False, soil=soil)
    assert settlement.by_source["soil"] == pytest.approx(1.8 * 0.2e-3)


def test_elements_on_soil_take_a_smaller_factor() -> None:
    finer = comparison_run("mesh", 2.0, 1003.0)
    assert bar_of(1000.0, 1000.0, finer, soil=SoilOfRun(False)).by_source["mesh"] == pytest.approx(MESH_ON_SOIL * 4.0)


def test_bars_see_clay_that_yields_on_fine_cells_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """A riser on cells of D/4 settles 1.2 mm, on fine ones 2.2 mm, which a slice shows."""
    name = "laid on sections 4"
    known = references.read(references.ON_SOIL)[name]

    def settled() -> Judged:
        (bar,) = (each for each in judge(name, SOILS[name], known).judged if each.bar.key_result.name == SETTLEMENT)
        return bar

    assert settled().inside
    monkeypatch.setattr("riser_soil.accuracy.error_bars.SLICE", 0.0)
    assert not settled().inside


def test_a_slice_that_fails_leaves_wider_bars(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twice the coarser run's share."""

    def fails(scene: Scene, settlements: object) -> None:
        raise SolveError("no convergence")

    monkeypatch.setattr(chain, "settlements_on_fine_cells", fails)
    monkeypatch.setattr(chain, "has_many_slices", lambda scene: True)
    scene = scene_from_mapping(SCENES["pipe pressed on clay"])
    bars = chain.bars_of(scene, on_soil(), [ComparisonRun("soil", 0.5, on_soil(1001.0, 0.8e-3).peaks)])
    assert [each.by_source["soil"] for each in bars] == pytest.approx([2.0 * BY_SLICE, 2.0 * BY_SLICE * 0.2e-3])


def course(*windows: float, least: bool = False) -> Extreme:
    """Course of a motion whose extreme is in the last window."""
    return Extreme(windows[-1], np.array(windows), least)


def test_runs_that_agree_in_the_extreme_by_chance_are_apart_in_windows_near_it() -> None:
    """Windows at 9 and 10 count, as they are above 8; the one at 0 does not: differences of 3 and 0 there, and of 0 in
    the extreme itself.
    """
    run, other = course(0.0, 9.0, 10.0), course(50.0, 12.0, 10.0)
    assert difference(run, other) == pytest.approx(math.sqrt(0.5 * (0.0 + 9.0 / 2.0)))
    upside_down = (course(*(-each.windows), least=True) for each in (run, other))
    assert difference(*upside_down) == pytest.approx(difference(run, other))


def test_windows_that_are_not_known_do_not_count() -> None:
    """A riser that does not touch has windows that are not known; a quantity that has no course at all is its extreme
    alone.
    """
    assert difference(course(math.nan, 9.0, 10.0), course(1.0, math.nan, 14.0)) == pytest.approx(4.0)
    assert difference(course(9.0, 10.0), course(math.nan, math.nan)._replace(value=13.0)) == 3.0
    assert difference(without_windows(10.0), course(9.0, 13.0)) == 3.0


def test_soil_that_depends_on_its_path_takes_a_larger_factor() -> None:
    """Clay, or layers of which one is clay; elastic soil does not, nor does a scene without soil."""
    yields = {name: scene_from_mapping(scene).has_path_dependent_soil for name, scene in SCENES.items()}
    assert {name for name, dependent in yields.items() if dependent} == {name for name in SOIL if "clay" in name}
    soil = SCENES["pipe pressed on elastic soil"]["soil"]
    layers = [{"to": 0.5, "law": soil["law"]}, {"law": CLAY}]
    mixed = {key: value for key, value in soil.items() if key != "law"} | {"layers": layers}
    scene = scene_from_mapping(SCENES["pipe pressed on elastic soil"] | {"soil": mixed})
    assert scene.has_path_dependent_soil
    coarser = of_order(1.0, 0.5, 1.0, "soil")
    elastic, clay = (bar_of(1000.0, 1000.0, coarser, soil=SoilOfRun(dependent)) for dependent in (False, True))
    assert (elastic.by_source["soil"], clay.by_source["soil"]) == pytest.approx((SAFETY["soil"], ON_PATH))


def test_what_falls_between_nodes_is_the_meshs() -> None:
    bar = bar_of(1000.0, 1010.0, comparison_run("mesh", 2.0, 1010.0))
    assert bar.by_source["mesh"] == pytest.approx(SAFETY["mesh"] * 10.0)


def test_what_falls_between_steps_and_what_rings_is_the_time_steps() -> None:
    key_result = KeyResult("heave", "top tension", "N", 1000.0, 1000.0)
    key = key_result.key
    nodes, steps, smooth = {key: 1000.0}, {key: without_windows(1004.0)}, {key: 997.0}
    (bar,) = error_bars(RunValues({key: key_result}, nodes, steps, smooth), [], rigid=False)
    assert bar.by_source["time"] == pytest.approx(SAFETY["time"] * (4.0 + 3.0))


def test_no_bar_without_a_coarser_run() -> None:
    """Known shares are given by source; runs behind one that failed are not compared with those before it."""
    failed = ComparisonRun("time", 0.2, None, "it did")
    bar = bar_of(1000.0, 1000.0, failed, comparison_run("mesh", 2.0, 1001.0))
    assert bar.bar is None
    assert "it did" in bar.reason
    assert bar.by_source["mesh"] == 0.0


def test_true_errors_of_a_few_scenes_are_inside() -> None:
    known = references.read()
    judged = [each for name in QUICK for each in judge(name, SCENES[name], known[name]).judged]
    assert len(judged) > 30
    assert share_inside(judged) > 0.9


def run_reported(tmp_path: Path, name: str, **more: Any) -> Any:
    run_with_error_bars(scene_from_mapping(SCENES[name] | more), tmp_path / "run")
    return json.loads((tmp_path / "run" / "summary.json").read_text(encoding="utf-8"))


def test_bars_of_a_run_are_on_the_screen_and_in_its_summary(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    summary = run_reported(tmp_path, "cantilever let go", output={"fields": []})
    screen = capsys.readouterr().out
    assert "motion: error bars" in screen
    assert "force at start, N" in screen
    quantities = {(bar["stage"], bar["name"]): bar for bar in summary["error_bars"]["quantities"]}
    bar = quantities["motion", "largest bending moment"]
    assert set(bar["by_source"]) == {"mesh", "time"}
    assert 0.0 < bar["bar"] < 0.2 * bar["value"]
    assert summary["finished"]
    assert not (tmp_path / "run" / ".riser_soil").exists()


def test_coarser_run_that_fails_is_reported_and_its_run_stays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(scene: Scene, comm: object) -> None:
        raise SolveError("no convergence at 3 s\nmore of it")

    monkeypatch.setattr(chain, "peaks_of", fails)
    summary = run_reported(tmp_path, "cantilever let go")
    assert summary["finished"]
    assert {bar["bar"] for bar in summary["error_bars"]["quantities"]} == {None}
    line_with(capsys.readouterr().out, "coarser run failed:", "no convergence", "3 s")


def test_in_the_place_of_a_finer_run_that_fails_comes_a_coarser_one(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_from_mapping(SCENES["hose swings on a rigid floor"])
    elements = scene.line.element_count

    def fails_if_finer(looked_at: Scene, comm: object) -> RunPeaks:
        if looked_at.line.element_count > elements:
            raise SolveError("no convergence")
        return RunPeaks()

    monkeypatch.setattr(chain, "peaks_of", fails_if_finer)
    runs = chain.comparison_runs(scene, Alone())
    assert [(each.source, each.extremes is not None) for each in runs] == [("time", True), ("mesh", True)]
    assert runs[1].finer == pytest.approx(0.5)


def test_error_that_one_rank_may_have_met_alone_is_no_failed_coarser_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """The others are within the comparison run still, and would not hear of the next one."""

    def fails(scene: Scene, comm: object) -> None:
        raise ValueError("math domain error")

    monkeypatch.setattr(chain, "peaks_of", fails)
    scene = scene_from_mapping(SCENES["hose swings on a rigid floor"])
    assert [each.extremes for each in chain.comparison_runs(scene, Alone())] == [None, None]
    with pytest.raises(ValueError, match="math domain error"):
        chain.comparison_runs(scene, SimpleNamespace(rank=0, size=2))


def test_coarser_runs_go_on_from_one_to_the_next(looked_at: list[Scene]) -> None:
    """Steps as long as 20 to the period, which output times do not hold back; elements twice as fine and contact 16
    times as stiff, so that a riser sinks in over half the length.
    """
    scene = scene_from_mapping(SCENES["hose swings on a rigid floor"] | {"output": {"interval": 0.1}})
    runs = chain.comparison_runs(scene, None)
    assert [each.source for each in runs] == ["time", "mesh"]
    assert [each.finer for each in runs] == pytest.approx([0.25, 2.0])  # four times as long at most
    assert [each.line.element_count for each in looked_at] == [80, 160]
    assert [each.contact and each.contact.stiffness for each in looked_at] == [1e5, 16e5]
    assert {each.output.interval for each in looked_at} == {None}


@pytest.mark.parametrize(("name", "longer"), [("surge, 40 steps", 2.0), ("surge across", 3.0), ("fast surge", 3.0)])
def test_longer_steps_are_left_to_the_shortest_period(name: str, longer: float, looked_at: list[Scene]) -> None:
    (time, mesh) = chain.comparison_runs(scene_from_mapping(SCENES[name]), None)
    assert (1.0 / time.finer, mesh.finer) == pytest.approx((longer, 2.0))


def test_on_soil_one_run_is_coarser_in_everything(looked_at: list[Scene]) -> None:
    """Cells and elements twice as long, steps half as long again, a quarter of the penalty."""
    scene = resolved(scene_from_mapping(SOILS["heaved on sections 4"]))
    (one_run,) = chain.comparison_runs(scene, None)
    (coarser,) = looked_at
    assert one_run.source == "soil"
    assert one_run.finer == pytest.approx(0.5)
    for setting in SETTINGS:
        ratio = {"time_step": 2.0 / 3.0, "penalty": 0.25}.get(setting.name, 0.5)
        assert setting.fineness(coarser) == pytest.approx(ratio * setting.fineness(scene), rel=0.02)


def test_on_a_block_the_runs_own_steps_come_after_what_is_coarser_in_everything(looked_at: list[Scene]) -> None:
    """On the same coarser cells, elements and penalty."""
    given = SOILS["heaved on sections 4"]
    scene = resolved(scene_from_mapping(given | {"soil": given["soil"] | {"model": "block"}}))
    runs = chain.comparison_runs(scene, None)
    assert [each.source for each in runs] == ["soil", "time"]
    assert runs[1].finer == pytest.approx(1.5)
    coarser, own = looked_at
    for setting in SETTINGS:
        like = scene if setting.name == "time_step" else coarser
        assert setting.fineness(own) == pytest.approx(setting.fineness(like), rel=1e-9)


def test_cells_of_a_few_slices_are_coarsened_twice(looked_at: list[Scene]) -> None:
    """Then elements are twice as many on a penalty four times as hard."""
    runs = chain.comparison_runs(scene_from_mapping(SCENES["pipe pressed on clay"]), None)
    assert [each.source for each in runs] == ["soil", "soil", "mesh"]
    assert [each.finer for each in runs] == pytest.approx([0.6, 0.6, 2.0])
    coarse = [f"soil cells of {0.025 / share:.4g} m across the riser" for share in (0.6, 0.36, 0.36)]
    assert [settings_in_words(each, [SOIL_MESH]) for each in looked_at] == coarse
    assert PENALTY.fineness(looked_at[2]) == pytest.approx(4.0 * PENALTY.fineness(looked_at[1]))


def test_a_firm_penalty_on_soil_is_not_varied(looked_at: list[Scene]) -> None:
    """Two runs would differ by what cells and load steps make, not by the penalty."""
    given = varied(scene_from_mapping(SCENES["pipe pressed on clay"]), PENALTY, 100.0)
    alone = [chain.Variation("mesh", {"elements": 2.0}), chain.Variation("penalty", {"penalty": 4.0})]
    assert [each.source for each in chain.comparison_runs(given, None, alone)] == ["mesh"]
    softer = varied(given, PENALTY, 0.1)
    assert [each.source for each in chain.comparison_runs(softer, None, alone)] == ["mesh", "penalty"]


@pytest.fixture
def looked_at(monkeypatch: pytest.MonkeyPatch) -> list[Scene]:
    """Comparison runs, which are not computed."""
    scenes: list[Scene] = []

    def looks(scene: Scene, comm: object) -> RunPeaks:
        scenes.append(scene)
        return RunPeaks()

    monkeypatch.setattr(chain, "peaks_of", looks)
    return scenes


def test_a_scene_may_ask_for_bars(tmp_path: Path) -> None:
    file, folder = tmp_path / "scene.yaml", tmp_path / "run"
    file.write_text(json.dumps(SCENES["cantilever, tip load"] | {"error_bars": True}), encoding="utf-8")
    assert CliRunner().invoke(app, ["run", str(file), "-o", str(folder)]).exit_code == 0
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert {bar["bar"] is None for bar in summary["error_bars"]["quantities"]} == {False}


def test_what_cannot_be_varied_has_no_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    """A quantity without a variation must not look exact."""
    monkeypatch.setattr(settings, "MOST_ELEMENTS", 7)
    (coarser,) = chain.comparison_runs(scene_from_mapping(SCENES["cantilever, tip load"]), None)
    assert coarser.extremes is None
    assert "more than 7 elements" in coarser.reason


def test_the_page_has_each_kind_in_and_out_of_sample() -> None:
    name = "catenary, 20 elements"
    scenes = [judge(name, SCENES[name], references.read()[name])]
    lines = page(scenes, scenes, "").splitlines()
    for kind in ("top tension", "no ground", "static"):
        (row,) = (line for line in lines if line.startswith(f"| {kind} |"))
        judged = [cell.strip() for cell in row.split("|")[2:-1]]
        assert int(judged[0]) > 0
        assert judged[:3] == judged[3:]
