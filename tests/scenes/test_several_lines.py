"""Runs of several lines: against catenaries and one line, their files, a restart, and what is refused."""

from __future__ import annotations

import json
import math
import re
from copy import deepcopy
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from mpi4py import MPI
from scipy.optimize import brentq

from riser_soil.accuracy.barred_run import run_with_error_bars
from riser_soil.accuracy.search import first_setting
from riser_soil.accuracy.target_run import run_to_accuracy
from riser_soil.assembly import build
from riser_soil.assembly.stage import times_to_hit
from riser_soil.cases.case_values import case_values
from riser_soil.checks.check import describe
from riser_soil.checks.overload import overload
from riser_soil.checks.plausibility import physical_warnings
from riser_soil.errors import ResultsError, SceneError
from riser_soil.fatigue.stress_history import stress_history
from riser_soil.plots.curves import Curves
from riser_soil.report.extremes import bodies_and_joints_table, key_results_table
from riser_soil.report.report import write_report
from riser_soil.report.report_file import of_folders
from riser_soil.results.peaks import RunPeaks
from riser_soil.results.read import Run
from riser_soil.scene.lines import by_line, spinning
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.stages import DynamicStage
from riser_soil.statistics.records import records_of
from riser_soil.variants.key_results import key_results
from riser_soil.variants.peaks import peaks_of
from riser_soil.variants.settings import SETTINGS, settings_of, varied
from riser_soil.whole_run import run
from tests.support.catenaries import spans
from tests.support.left_run import leave_after
from tests.support.line_scenes import (
    CHAIN,
    DEPTH,
    IN_WATER,
    LENGTH,
    NAMES,
    POINT,
    RADIUS,
    RHO,
    RIGID,
    WET,
    G,
    as_line,
    lazy_s,
    lazy_s_by_catenaries,
    mooring,
    shaken,
    with_line_named,
)
from tests.support.runs import run_of
from tests.support.said import line_with, lines_with, telling
from tests.support.scenes import dynamic, prescribed, riser_scene, static
from tests.support.vtk_reading import read_by_vtk

ELEMENTS, TIME_STEP = (setting for setting in SETTINGS if setting.name in ("elements", "time_step"))


def test_a_buoy_on_three_lines_rests_where_catenaries_balance_it(tmp_path: Path) -> None:
    """A third of its buoyancy is each line's upward pull; the anchors' circle gives H. The joints' gap is V/k."""
    run = run_of(mooring(elements=40), tmp_path)
    V = (POINT["volume"] * RHO - POINT["mass"]) * G / 3.0
    H = brentq(lambda H: spans(H, V, WET, CHAIN["EA"], LENGTH)[0] - RADIUS, 1.0, 1e6)
    z = spans(H, V, WET, CHAIN["EA"], LENGTH)[1] - DEPTH
    assert run["bodies/buoy/position"][-1] == pytest.approx([0.0, 0.0, z], abs=1e-3)
    for name in NAMES:
        line = run.of_line(name)
        tension = line["effective_tension"][-1]
        assert tension[[0, -1]] == pytest.approx([math.hypot(H, V - WET * LENGTH), math.hypot(H, V)], rel=1e-5)
        gap, force = (run[f"joints/{name}_top/{key}"][-1] for key in ("gap", "force"))
        assert np.linalg.norm(force) == pytest.approx(math.hypot(H, V), rel=1e-5)
        assert 0.0 < np.linalg.norm(gap) < 0.01 * CHAIN["outer_diameter"]


@pytest.mark.parametrize("body", [POINT, RIGID], ids=["point", "rigid"])
def test_a_buoy_on_one_line_rises_over_its_anchor(body: dict[str, Any], tmp_path: Path) -> None:
    """The buoy begins aside; nothing keeps a rigid one from turning about the line. Its buoyancy is the tension at its
    foot.
    """
    scene, arm = mooring(body=body), 1.0 if body is RIGID else 0.0
    for kind, key in (("lines", "east"), ("joints", "east_top")):
        scene[kind] = {key: scene[kind][key]}
    scene["lines"]["east"]["segments"][0]["length"] = L = 75.0
    scene["joints"]["east_top"]["between"][1]["offset"] = [0.0, 0.0, -arm]
    scene["bodies"]["buoy"]["position"] = [RADIUS + 4.0, 1.0, -22.0]
    run = run_of(scene, tmp_path)
    net = (POINT["volume"] * RHO - POINT["mass"]) * G
    stretched = L + (net * L - 0.5 * WET * L**2) / CHAIN["EA"]
    assert run["bodies/buoy/position"][-1] == pytest.approx([RADIUS, 0.0, stretched + arm - DEPTH], abs=1e-3)
    tension = run.of_line("east")["effective_tension"][-1]
    assert tension[[0, -1]] == pytest.approx([net - WET * L, net], rel=1e-6)


def on_one_line(body: dict[str, Any], load: dict[str, Any], *stages: dict[str, Any]) -> dict[str, Any]:
    """A buoy over its anchor, with a load on it that stays after the first stage."""
    scene, arm = mooring(*stages, body=body), 1.0 if body is RIGID else 0.0
    for kind, key in (("lines", "east"), ("joints", "east_top")):
        scene[kind] = {key: scene[kind][key]}
    scene["lines"]["east"]["segments"][0]["length"] = 75.0
    scene["joints"]["east_top"]["between"][1]["offset"] = [0.0, 0.0, -arm]
    scene["bodies"]["buoy"]["position"] = [RADIUS, 0.0, -22.0]
    scene["stages"][0]["bodies"] = {"buoy": {"loads": [load | {"keep": True}]}}
    return scene


def test_a_force_pulls_a_buoy_aside_as_its_catenary_lets_it(tmp_path: Path) -> None:
    """There it stays in a stage in motion, as the load does."""
    F, net = 6.0e3, (POINT["volume"] * RHO - POINT["mass"]) * G
    at_rest = {"name": "wait", "kind": "dynamic", "duration": 0.5, "time_step": 0.05}
    run = run_of(on_one_line(POINT, {"force": [0.0, F, 0.0]}, at_rest), tmp_path)
    aside, high = spans(F, net, WET, CHAIN["EA"], 75.0)
    for n in (0, -1):
        assert run["bodies/buoy/position"][n] == pytest.approx([RADIUS, aside, high - DEPTH], abs=1e-3)


def test_a_moment_heels_a_buoy_until_it_is_righted(tmp_path: Path) -> None:
    """Buoyancy above, weight below, and the line's pull at its arm."""
    M, B, W = 9.0e3, RIGID["volume"] * RHO * G, RIGID["mass"] * G
    run = run_of(on_one_line(RIGID, {"moment": [0.0, M, 0.0]}), tmp_path)
    righting = B * RIGID["centre_of_buoyancy"][2] - W * RIGID["centre_of_gravity"][2] + (B - W) * 1.0
    assert run["bodies/buoy/rotation"][-1] == pytest.approx([0.0, math.asin(M / righting), 0.0], abs=1e-5)


def test_steps_hit_the_bends_of_a_load_on_a_body() -> None:
    """Steps end at the corners of a load's history, on a body as on a line."""
    load = {"force": [1.0, 0.0, 0.0], "history": [[0.0, 0.0], [0.37, 1.0], [0.81, 0.0]]}
    scene = scene_from_mapping(mooring(shaken() | {"bodies": {"buoy": {"loads": [load]}}}))
    for view in by_line(scene).values():
        _, stage = view.stages
        assert isinstance(stage, DynamicStage)
        assert {0.37, 0.81} <= {*times_to_hit(view, stage)}


def test_a_lazy_s_over_an_arch_rests_where_catenaries_balance_it(tmp_path: Path) -> None:
    """Tensions within 1 % of a root finder's on elastic catenaries; the arch's place and angle, too."""
    run = run_of(lazy_s(), tmp_path)
    (x, z, angle), tensions = lazy_s_by_catenaries()
    assert run["bodies/arch/position"][-1] == pytest.approx([x, 0.0, z], abs=0.05)
    assert run["bodies/arch/rotation"][-1] == pytest.approx([0.0, -angle, 0.0], abs=2e-3)
    assert abs(angle) > 0.02
    for name, ends in tensions.items():
        assert run.of_line(name)["effective_tension"][-1, [0, -1]] == pytest.approx(ends, rel=0.005), name


def one_riser() -> dict[str, Any]:
    """Hanging, its end heaved."""
    heave = {"amplitude": [0.2, 0.1, 0.2], "period": 4.0, "ramp": 1.0}
    pipe = {"EA": 1.0e7, "EI": 5.0e4, "GJ": 4.0e4, "mass": 60.0, "submerged_weight": 200.0}
    return {
        "title": "whole",
        "dimension": 3,
        "line_types": {"pipe": pipe},
        "riser": {
            "segments": [{"line_type": "pipe", "length": 40.0, "elements": 20}],
            "start": {"position": [0.0, 0.0, 0.0]},
            "end": {"position": [30.0, 0.0, 15.0]},
        },
        "stages": [
            {"name": "hang", "kind": "static"},
            dynamic(1.0, 0.05, "heave", motion={"end": {"harmonic": heave}}),
        ],
    }


def in_two(scene: dict[str, Any]) -> dict[str, Any]:
    """A line as two lines that are clamped to each other, the first of them guessed to end somewhere."""
    cut = deepcopy(scene)
    whole = cut.pop("riser")
    del cut["dimension"]
    halves = ([{"line_type": "pipe", "length": 2.0 * n, "elements": n}] for n in (8, 12))
    low, high = halves
    cut["lines"] = {
        "low": {"segments": low, "start": whole["start"], "end": "free"},
        "high": {"segments": high, "start": "free", "end": whole["end"]},
    }
    between = [{"line": "low", "at": "end"}, {"line": "high", "at": "start"}]
    cut["joints"] = {"weld": {"kind": "clamped", "between": between, "position": [14.0, 0.0, 1.0]}}
    cut["stages"][1]["lines"] = {"high": {"motion": cut["stages"][1].pop("motion")}}
    return cut


@pytest.mark.parametrize("along", [0, 1])
def test_lines_that_keep_to_a_plane_are_those_of_space(along: int, tmp_path: Path) -> None:
    """Where nothing leaves it; so are two lines in a plane one riser in it, but for what the joint gives."""
    riser = one_riser()
    riser["stages"][1]["motion"]["end"]["harmonic"]["amplitude"] = [0.2, 0.0, 0.2]
    two, alone = in_two(riser), riser | {"dimension": 2}
    if along == 1:
        two, alone = turned(two), turned(alone)
    space, plane, one = (run_of(each, tmp_path / str(n)) for n, each in enumerate((two, two | {"dimension": 2}, alone)))
    assert plane.summary["dofs"]["riser"] < 0.6 * space.summary["dofs"]["riser"]
    for name in ("low", "high"):
        known, line = space.of_line(name), plane.of_line(name)
        np.testing.assert_allclose(line["position"], known["position"], atol=1e-7)
        assert not line["position"][..., 1 - along].any()
        np.testing.assert_allclose(line["effective_tension"], known["effective_tension"], rtol=1e-7)
    high = plane.of_line("high")["effective_tension"][:, -1]
    assert high == pytest.approx(one["effective_tension"][:, -1], rel=1e-3)


def turned(scene: dict[str, Any]) -> dict[str, Any]:
    """The scene, turned to lie along y."""
    return {key: turned(each) if isinstance(each, dict) else _turned(each) for key, each in scene.items()}


def _turned(value: Any) -> Any:
    if not isinstance(value, list):
        return value
    if len(value) == 3 and all(isinstance(each, float) for each in value):
        return [value[1], value[0], value[2]]
    return [turned(each) if isinstance(each, dict) else each for each in value]


def test_two_lines_clamped_together_are_one(tmp_path: Path) -> None:
    """But for what the joint gives, a hundredth of an element. They begin as catenaries with a kink."""
    whole = run_of(one_riser(), tmp_path / "whole")
    two = run_of(in_two(one_riser()), tmp_path / "two")
    low, high = two.of_line("low"), two.of_line("high")
    for name, at_rest in (("effective_tension", 1e-3), ("bending_moment", 1e-2)):
        joined = np.concatenate([low[name], high[name][:, 1:]], axis=1)
        off = np.abs(joined - whole[name]).max(axis=1) / np.abs(whole[name]).max(axis=1)
        assert off[0] < at_rest, name
        assert off.max() < 0.02, name
    assert np.abs(np.concatenate([low["position"], high["position"][:, 1:]], axis=1) - whole["position"]).max() < 0.02


def test_the_energy_of_bodies_balances(tmp_path: Path) -> None:
    """A rigid body with all that it may have is shaken by its mooring; in waves and a current, too."""
    calm = run_of(mooring(shaken(), body=RIGID), tmp_path / "calm")
    waves = {"airy": {"height": 2.0, "period": 6.0}, "ramp": 1.0}
    water: dict[str, Any] = {"density": RHO, "surface_level": 0.0, "depth": DEPTH, "waves": waves}
    water["current"] = {"profile": [[-DEPTH, 0.2, 0.1], [0.0, 0.6, 0.3]]}
    rough = mooring(shaken(), body=RIGID | {"position": [0.0, 0.0, -1.0]}, water=water)
    for result in (calm, run_of(rough, tmp_path / "rough")):
        energy = result.summary["stages"][1]["energy"]
        assert energy["turned_over"] > 1e3
        assert abs(energy["relative_residual"]) < 5e-3
        assert energy["work_by"]["supports"] != 0.0
    assert calm.summary["stages"][1]["energy"]["dissipated_by"]["body_drag"] > 0.0
    assert np.abs(result["bodies/buoy/rotation"][-1]).max() > 1e-3


def test_lines_tied_along_their_length_keep_their_distance(tmp_path: Path) -> None:
    """A light and a heavy line side by side, pinned to each other at three arcs: blown sideways, the heavy one takes
    the light one along. What the ties give is their force over their stiffness.
    """
    lines = {
        name: {
            "segments": [{"line_type": name, "length": 50.0, "elements": 10}],
            "start": {"position": [0.0, y, 0.0]},
            "end": {"position": [45.0, y, 0.0]},
        }
        for name, y in (("light", 0.0), ("heavy", 0.4))
    }
    ties = {
        f"tie{arc:g}": {
            "kind": "pinned",
            "keep_distance": True,
            "between": [{"line": "light", "at": arc}, {"line": "heavy", "at": arc}],
        }
        for arc in (12.0, 25.0, 38.0)
    }
    pipe = {"EA": 1.0e7, "EI": 1.0e3, "GJ": 1.0e3}
    weights = {"light": 100.0, "heavy": 300.0}
    scene = {
        "title": "bundle",
        "line_types": {name: pipe | {"submerged_weight": weights[name]} for name in lines},
        "lines": lines,
        "joints": ties,
        "stages": [
            {"name": "hang", "kind": "static"},
            {"name": "blown", "kind": "static", "lines": {"heavy": {"loads": [{"distributed": [0.0, 80.0, 0.0]}]}}},
        ],
        "output": {"clearance": [{"between": ["light", "heavy"]}]},
    }
    run = run_of(scene, tmp_path)
    light, heavy = (run.of_line(name) for name in lines)
    assert len(light.arc) == 11, "three arcs have got nodes of their own"
    for arc in (12.0, 25.0, 38.0):
        one, other = (line["position"][:, np.abs(line.arc - arc).argmin()] for line in (light, heavy))
        force, gap = (float(np.linalg.norm(run[f"joints/tie{arc:g}/{key}"][-1])) for key in ("force", "gap"))
        assert gap == pytest.approx(force / (100.0 * pipe["EA"] / (13.0 / 3.0)), rel=1e-6)
        before, after = np.linalg.norm(one - other, axis=1)
        assert before == pytest.approx(0.4, abs=2e-3)
        assert after == pytest.approx(before, abs=1.1 * gap)
        assert one[1, 1] - one[0, 1] > 0.5, "it is taken along"
    forces = sum(run[f"joints/{name}/force"][-1] for name in ties)
    assert forces[1] < -100.0
    assert run["clearance/light_heavy/distance"][-1] == pytest.approx(0.4, abs=0.05)


def test_a_line_with_free_ends_hangs_on_its_ties(tmp_path: Path) -> None:
    """A straight pipe 2 m below a stiff one that bears both: its supports take the weight of the two."""
    lines: dict[str, Any] = {
        name: {"segments": [{"line_type": "pipe", "length": 20.0, "elements": 10}], "initial": "straight"} | ends
        for name, ends in (
            ("above", {end: {"position": [x, 0.0, 0.0]} for end, x in (("start", 0.0), ("end", 20.0))}),
            ("below", {"start": "free", "end": "free", "initial": {"points": [[0.0, 0.0, -2.0], [20.0, 0.0, -2.0]]}}),
        )
    }
    ties = {
        f"tie{arc:g}": {"kind": "pinned", "keep_distance": True}
        | {"between": [{"line": name, "at": arc} for name in ("above", "below")]}
        for arc in (2.0, 10.0, 18.0)
    }
    pipe = {"EA": 1.0e8, "EI": 1.0e6, "GJ": 1.0e6, "submerged_weight": 50.0}
    scene = {"line_types": {"pipe": pipe}, "lines": lines, "joints": ties, "stages": [static()]}
    run = run_of(scene, tmp_path)
    ends = run.of_line("above").summary["stages"][0]["final"]
    assert ends["start"]["force"][2] + ends["end"]["force"][2] == pytest.approx(2.0 * 50.0 * 20.0, rel=1e-6)
    gap = run.of_line("above")["position"][-1] - run.of_line("below")["position"][-1]
    assert gap[[1, 5, 9]] == pytest.approx(np.tile([0.0, 0.0, 2.0], (3, 1)), abs=1e-3)


def test_ties_to_nothing_hold_nothing() -> None:
    """Two lines with free ends, tied to each other alone, and then to one that is held."""
    lines: dict[str, Any] = {
        name: {"segments": [{"line_type": "chain", "length": 20.0, "elements": 4}], "start": "free", "end": "free"}
        for name in ("one", "other")
    }
    tie = {"kind": "pinned", "between": [{"line": "one", "at": 10.0}, {"line": "other", "at": 10.0}]}
    scene: dict[str, Any] = {"line_types": {"chain": CHAIN}, "lines": lines, "joints": {"tie": tie}}
    scene["stages"] = [static()]
    with pytest.raises(SceneError, match=telling("stages.0", "free ends")):
        scene_from_mapping(scene)
    lines["held"] = lines["one"] | {"start": {"position": [0.0, 0.0, 0.0]}}
    scene["joints"]["hung"] = {"kind": "pinned", "between": [{"line": "held", "at": 10.0}, {"line": "one", "at": 15.0}]}
    assert scene_from_mapping(scene).joints


SECTIONS = {"output": {"sections": {"arcs": [20.0]}}}


def test_what_no_line_has_anything_of_is_refused() -> None:
    for given, key in (({"contact": {"stiffness": 1.0e5}}, "contact:"), (SECTIONS, "output.sections:")):
        with pytest.raises(SceneError, match=telling(key)):
            scene_from_mapping(mooring() | given)
    scene = mooring()
    scene["stages"][0]["pressure"] = 1.0e6
    with pytest.raises(SceneError, match=telling("stages.0.pressure:")):
        scene_from_mapping(scene)


def test_bodies_clamped_to_each_other_spin_no_line() -> None:
    scene = mooring(body=RIGID)
    scene["bodies"]["fin"] = scene["bodies"]["buoy"] | {"position": [0.0, 0.0, -15.0]}
    between = [{"body": "buoy", "offset": [0.0, 0.0, 5.0]}, {"body": "fin"}]
    scene["joints"]["rod"] = {"kind": "clamped", "between": between}
    assert spinning(scene_from_mapping(scene)) == {"east", "north", "south"}


def test_forces_of_free_ends_count_beside_those_of_all_lines() -> None:
    """Round-off has no error of its own: of the largest force of all lines a thousandth is the least scale."""
    end = {"position": [0.0, 0.0, 0.0], "resultant_force": 0.0, "effective_tension": 0.0}
    ends: dict[str, Any] = {"start": end, "end": end}
    final: dict[str, Any] = ends | {"max_bending_moment": {"value": 1.0}, "max_curvature": {"value": 1.0}}
    final |= {"min_effective_tension": {"value": 0.0}, "touchdown_arc": None, "contact_force": 0.0}
    pulled = final | {"end": ends["end"] | {"resultant_force": 1.0e5}}
    stage = {"name": "rest", "kind": "static", "lines": {"free": {"final": final}, "held": {"final": pulled}}}
    results = key_results({"stages": [stage]})
    assert results["rest: free force at end"].scale == pytest.approx(1.0e2)
    assert results["rest: held force at start"].scale == pytest.approx(1.0e4)


def test_what_is_wrong_with_a_line_has_its_path(tmp_path: Path) -> None:
    scene = mooring()
    scene["line_types"]["floating"] = CHAIN | {"submerged_weight": 0.0}
    scene["lines"]["north"]["segments"][0]["line_type"] = "floating"
    with pytest.raises(SceneError, match=r"^lines\.north\.initial: catenary"):
        run(scene_from_mapping(scene), tmp_path)


def test_files_of_a_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The report's curves, which take long to draw, are left out."""
    monkeypatch.setattr(Curves, "content", lambda self, ending: b"<svg/>")
    output = {"clearance": [{"between": ["east", "north"], "beyond": 20.0}]}
    run = run_of(mooring(shaken(0.2), output=output), tmp_path)
    assert run.lines == NAMES
    written = {f"line_{name}.{kind}" for name in NAMES for kind in ("xdmf", "vtkhdf")}
    assert written <= {path.name for path in tmp_path.iterdir()}
    assert not (tmp_path / "riser.xdmf").exists()
    assert [Run.is_there(tmp_path / name) for name in ("", "east", "west")] == [True, True, False]
    east = Run(tmp_path / "east")
    times, frames = read_by_vtk(tmp_path / "line_east.xdmf")
    assert times[-1] == east.time[-1]
    np.testing.assert_array_equal(frames[-1]["points"], east["position"][-1])
    assert east.arc.shape == east["effective_tension"][-1].shape == (21,)
    assert east.dataset["effective_tension"].dims == ("time", "arc")
    assert east.summary["stages"][1]["final"]["end"]["effective_tension"] == east["effective_tension"][-1, -1]
    assert east.read_scene().line.length == LENGTH
    with pytest.raises(ResultsError, match=telling("effective_tension", "not of the run", "lines")):
        run["effective_tension"]
    named = {value.name for value in case_values(tmp_path, 0.0)}
    assert {"east top tension", "north largest bending moment"} <= named
    page = write_report(of_folders([tmp_path], {}), tmp_path / "report.html").read_text()
    assert all(f"{tmp_path.name} {name}" in page for name in NAMES)
    assert "one load case of 3 lines" in page
    assert all(re.search(rf"<h3[^>]*>.*Line {name}</h3>", page) for name in NAMES)
    assert "Sensitivity" not in page, "lines of one run are no parameter"
    assert page.count(">body buoy</td>") == page.count(">clearance east_north</td>") == 2
    rest, moved = (row for row in bodies_and_joints_table(run.summary).rows if row[1] == "clearance east_north")
    first, *distances = run["clearance/east_north/distance"]
    assert float(rest[4]) == pytest.approx(first, rel=1e-4)
    assert [float(moved[n]) for n in (4, 5, 7)] == pytest.approx(
        [distances[-1], min(distances), max(distances)], rel=1e-4
    )
    with pytest.raises(ResultsError, match=telling("stress", "not of the run", f"{tmp_path / 'east'}")):
        stress_history(run)
    with pytest.raises(ResultsError, match=telling("no line west", "east, north, south")):
        run.of_line("west")
    with h5py.File(tmp_path / "results.nc") as file:
        assert {"time", "work", "clearance", "work_supports"} < {*file}
        for name in {*file} - {*NAMES}:
            with pytest.raises(SceneError, match=telling(f"lines.{name}", "rename")):
                scene_from_mapping(with_line_named(name))
    summary = json.loads((tmp_path / "summary.json").read_text())["stages"][1]
    place = run["bodies/buoy/position"]
    assert summary["bodies"]["buoy"]["position"]["final"] == pytest.approx(place[-1])
    assert summary["bodies"]["buoy"]["position"]["max"] == pytest.approx(place[1:].max(axis=0))
    x, other = (run.of_line(name)["position"][-1] for name in ("east", "north"))
    nearest = np.linalg.norm(x[:17, None] - other[None, :17], axis=2).min()
    assert run["clearance/east_north/distance"][-1] == pytest.approx(nearest - CHAIN["outer_diameter"], rel=0.02)


def test_statistics_of_bodies_joints_and_clearances(tmp_path: Path) -> None:
    output = {"clearance": [{"between": ["east", "north"], "beyond": 20.0}]}
    run = run_of(mooring(shaken(1.2), output=output), tmp_path)
    moving = run["stage"] == 1
    forces = np.linalg.norm(run["joints/east_top/force"], axis=1)
    assert np.ptp(forces[moving]) > 0.0
    for name, values in {
        "bodies/buoy/position.z": run["bodies/buoy/position"][:, 2],
        "joints/east_top/force.size": forces,
        "clearance/east_north/distance": run["clearance/east_north/distance"],
    }.items():
        records = records_of([run], name, None)
        assert np.isnan(records.arc).all()
        at = run.time[moving][0] + records.step * np.arange(len(records.values[0]))
        expected = np.interp(at, run.time[moving], values[moving])
        np.testing.assert_allclose(records.values[0][:, 0], expected, rtol=1e-9, err_msg=name)
    assert records_of([run], "joints/east_top/moment.x", None).units == "N m"
    with pytest.raises(ResultsError, match=telling("--of bodies/arch/position", "joints/east_top/force")):
        records_of([run], "bodies/arch/position.x", None)
    with pytest.raises(ResultsError, match=telling("vector", "joints/east_top/force.x")):
        records_of([run], "joints/east_top/force", None)


def test_indicators_of_a_line_are_those_of_a_riser(tmp_path: Path) -> None:
    """In its own entry, with what the whole step has at its stage."""
    pipe = {"EA": 1.0e8, "EI": 1.0e3, "GJ": 1.0e3, "mass": 20.0, "outer_diameter": 0.1, "submerged_weight": 100.0}
    moved = dynamic(1.0, 0.1, motion={"end": {"harmonic": {"amplitude": [0.0, 0.0, 0.5], "period": 2.0}}})
    ends = {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(20.0, 0.0, 10.0)}
    more = ends | {"dimension": 3, "gravity": G, "riser": {"initial": "catenary"}}
    scene = riser_scene(static(), moved, pipe=pipe, length=25.0, elements=10, **more)
    alone, several = (run_of(each, tmp_path / name) for name, each in (("riser", scene), ("lines", as_line(scene))))
    expected = [stage["indicators"] for stage in alone.summary["stages"]]
    assert [*expected[0]] == ["bending"]
    assert [*expected[1]] == ["bending", "time_step", "impact"]
    indicators = [stage["indicators"] for stage in several.of_line("only").summary["stages"]]
    for one, other in zip(expected, indicators, strict=True):
        assert flat(other) == pytest.approx(flat(one), rel=1e-6, nan_ok=True)
    assert flat(expected[1])["time_step.end.effective_tension.max"] > 0.0
    shared = several.summary["stages"][1]["indicators"]
    assert {"local_error", "lost"} < {key.split(".")[1] for key in flat(shared)}
    assert not any("effective_tension" in key for key in flat(shared))


def flat(nested: dict[str, Any], path: str = "") -> dict[str, float]:
    """Values by path; nan for null."""
    values: dict[str, float] = {}
    for key, value in nested.items():
        number = np.nan if value is None else value
        values |= flat(value, f"{path}{key}.") if isinstance(value, dict) else {path + key: number}
    return values


def test_error_bars_of_each_line_hold(tmp_path: Path) -> None:
    """Against three times the elements of all lines and a quarter of the step; a line's report has its own alone."""
    scene = scene_from_mapping(mooring(shaken(1.0, 0.1), elements=12))
    run_with_error_bars(scene, tmp_path / "run")
    run = Run(tmp_path / "run")
    bars = {(bar["stage"], bar["of"], bar["name"]): bar for bar in run.summary["error_bars"]["quantities"]}
    assert {of for _, of, _ in bars} == {*NAMES, "buoy"}
    for setting, factor in zip(settings_of(scene), (3.0, 4.0), strict=True):
        scene = varied(scene, setting, factor)
    true = key_results(peaks_of(scene, MPI.COMM_SELF).as_summary("peaks")).values()
    off = [(abs(bars[each.stage, each.of, each.name]["value"] - each.value), each) for each in true]
    inside = [error <= bars[each.stage, each.of, each.name]["bar"] for error, each in off]
    assert len(inside) == len(bars) == 45
    assert sum(inside) >= 0.95 * len(inside)
    assert max(error / each.scale for error, each in off) > 1e-3, "else there is nothing to tell"
    own = run.of_line("east").summary["error_bars"]["quantities"]
    assert own == [bar for (_, line, _), bar in bars.items() if line == "east"]
    shown = key_results_table(run.of_line("east").summary)
    assert all(row[shown.head.index("±")] for row in shown.rows)


def test_a_search_for_an_accuracy_begins_with_even_elements_of_each_line() -> None:
    """Elements follow from the line's length; steps from the shortest period of what moves, here an anchor's 3 s."""
    asked = mooring(shaken(4.0), accuracy="4 %")
    for length, line in zip((130.0, 200.0, 300.0), asked["lines"].values(), strict=True):
        line["segments"][0]["length"] = length
        del line["segments"][0]["elements"]
    del asked["stages"][1]["time_step"]
    first = first_setting(scene_from_mapping(asked))
    assert [line.element_count for line in first.lines.values()] == [24, 24, 24]
    moving = first.stages[1]
    assert isinstance(moving, DynamicStage)
    assert moving.time_step == pytest.approx(3.0 / 25.0)
    assert first.accuracy is None


def test_a_bearing_capacity_that_is_exceeded_is_told_of_its_line() -> None:
    """One whose lower end is pushed into soft clay by some diameters."""
    law = {"kind": "randolph-quiggin", "su": 10.0, "su_gradient": 0.0}
    scene = mooring(seabed={"kind": "hysteretic", "level": -DEPTH - 0.025, "law": law})
    assembly = build(scene_from_mapping(scene), MPI.COMM_SELF)
    assembly.lines["north"].line.x[0, 2] -= 0.3
    line_with(overload(assembly), "bearing capacity", "exceeded", "north at arc 0 m")


@pytest.mark.verify
def test_an_accuracy_asked_of_several_lines_is_reached(tmp_path: Path) -> None:
    """Each line's elements are graded by its own curvature; the step, by its shortest period, is one of all."""
    asked = mooring(shaken(0.8), accuracy="5 %")
    asked["line_types"]["chain"] |= {"EI": 2.0e4, "GJ": 2.0e4}
    for line in asked["lines"].values():
        del line["segments"][0]["elements"]
    del asked["stages"][1]["time_step"]
    run_to_accuracy(scene_from_mapping(asked), tmp_path / "run")
    run = Run(tmp_path / "run")
    assert run.summary["accuracy"]["reached"]
    chosen = run.read_scene()
    assert len({line.element_count for line in chosen.lines.values()}) > 1
    finer = varied(varied(chosen, ELEMENTS, 2.0), TIME_STEP, 2.0)
    true = key_results(peaks_of(finer, MPI.COMM_SELF).as_summary("peaks"))
    off = [each.error(true[key]) for key, each in key_results(run.summary).items()]
    assert max(off) < 0.05


def test_check_names_each_line(tmp_path: Path) -> None:
    """Where it proposes elements; the steps of a duration that is no multiple of theirs are whole ones."""
    said = describe(scene_from_mapping(mooring(shaken(1.0, 0.15), elements=60)))
    for name in NAMES:
        line_with(said, "in place of 60", f"lines.{name}.segments:")
    assert re.search(r"estimated time: .* \d+ steps", said)


def test_a_load_that_ends_with_its_stage_is_told_of() -> None:
    """On a line and on a body, each by its path; not one that stays."""
    force = {"force": [0.0, 200.0, 0.0]}
    on_line: list[dict[str, Any]] = [{"at": 65.0, **force}]
    on_body: list[dict[str, Any]] = [{**force}]
    acts = {"lines": {"east": {"loads": on_line}}, "bodies": {"buoy": {"loads": on_body}}}
    scene = mooring(shaken()) | {"stages": [static("rest", **acts), shaken()]}
    said = [*physical_warnings(build(scene_from_mapping(scene), MPI.COMM_SELF))]
    line_with(said, "stages.0.lines.east.loads.0", "[0.0, 200.0, 0.0] N", "at 65.0", "shaken", "keep: true")
    line_with(said, "stages.0.bodies.buoy.loads.0", "[0.0, 200.0, 0.0] N", "shaken", "keep: true")
    for load in (*on_line, *on_body):
        load["keep"] = True
    assert not lines_with(physical_warnings(build(scene_from_mapping(scene), MPI.COMM_SELF)), "keep: true")


def test_a_run_that_was_left_goes_on_to_the_last_bit(tmp_path: Path) -> None:
    seabed = {"kind": "spring", "level": -DEPTH - 0.5, "stiffness": 1e4}
    scene = scene_from_mapping(mooring(shaken(0.5), body=RIGID, seabed=seabed))
    whole, peaks = RunPeaks(), RunPeaks()
    run(scene, tmp_path / "alone", peaks=whole)
    leave_after(4, scene, tmp_path / "left", RunPeaks())
    run(scene, tmp_path / "left", peaks=peaks, restart=True)
    with h5py.File(tmp_path / "alone/results.nc") as one, h5py.File(tmp_path / "left/results.nc") as other:
        names: list[str] = []
        one.visit(names.append)
        for name in names:
            if isinstance(one[name], h5py.Dataset) and one[name].dtype.kind == "f":
                assert np.array_equal(one[name][...], other[name][...], equal_nan=True), name
    folders = (tmp_path / name for name in ("alone", "left"))
    alone, resumed = (json.loads((folder / "summary.json").read_text())["stages"] for folder in folders)
    assert alone == resumed
    assert json.dumps(peaks.as_summary("smooth")) == json.dumps(whole.as_summary("smooth"))
    assert len(names) > 100


def test_a_run_begins_with_another_ones_end(tmp_path: Path) -> None:
    """Lines, bodies and joints go on from where they rest; what differs is refused by its key."""
    given = mooring(shaken(0.5), body=RIGID, elements=10, output={"checkpoint": {"keep": True}})
    whole, alone = scene_from_mapping(given), given | {"stages": given["stages"][:1]}
    run(whole, tmp_path / "whole")
    run(scene_from_mapping(alone), tmp_path / "rest")
    begun = given | {"initial": {"from": str(tmp_path / "rest")}, "stages": given["stages"][1:]}
    run(scene_from_mapping(begun), tmp_path / "shaken")
    one, other = (Run(tmp_path / name) for name in ("whole", "shaken"))
    for path in ("east/position", "south/effective_tension", "bodies/buoy/rotation", "joints/east_top/force"):
        line, name = path.rsplit("/", 1) if path.split("/")[0] in NAMES else ("", path)
        last = [(each_run.of_line(line) if line else each_run)[name][-1] for each_run in (one, other)]
        assert np.array_equal(*last), path
    heavier = begun | {"bodies": {"buoy": begun["bodies"]["buoy"] | {"mass": 2100.0}}}
    with pytest.raises(SceneError, match=telling("bodies.buoy.mass", "was 2000.0", "is 2100.0")):
        run(scene_from_mapping(heavier), tmp_path / "heavier")


def drifting(x: float, y: float) -> dict[str, Any]:
    """A buoy on one chain that lies on the seabed, in a current; it begins afloat above (x, y)."""
    scene = mooring(
        elements=40,
        seabed={"kind": "spring", "level": -DEPTH - 0.05, "stiffness": 1e4},
        water={
            "density": RHO,
            "surface_level": 0.0,
            "current": {"profile": [[-DEPTH, 0.1, 0.0], [0.0, 0.5, 0.2]]},
        },
        body={"kind": "point", "mass": 2.0e4, "volume": 30.0, "drag_area": 10.0, "added_mass": 0.5},
    )
    for kind, key in (("lines", "east"), ("joints", "east_top")):
        scene[kind] = {key: scene[kind][key]}
    scene["line_types"]["chain"] |= {"mass": 50.0, "outer_diameter": 0.1, "EI": 5.0e4} | IN_WATER
    scene["lines"]["east"]["segments"][0]["length"] = 190.0
    scene["bodies"]["buoy"]["position"] = [x, y, -2.0]
    return scene


@pytest.mark.verify
def test_dynamic_relaxation_finds_where_a_buoy_drifts_to(tmp_path: Path) -> None:
    """Wherever it begins: where its chain bears what the current's drag and its buoyancy on the wet share put there."""
    each = [run_of(drifting(*at), tmp_path / str(n)) for n, at in enumerate(((0.0, 0.0), (196.0, 36.0)))]
    assert [run.summary["stages"][0]["method"] for run in each] == ["relaxation", "relaxation"]
    one, other = (run["bodies/buoy/position"][-1] for run in each)
    assert one == pytest.approx(other, abs=1e-4)
    force, body = each[0]["joints/east_top/force"][-1], drifting(0.0, 0.0)["bodies"]["buoy"]
    wet = (abs(force[2]) + body["mass"] * G) / (RHO * G * body["volume"])
    flow = np.array([0.1 + 0.4 * (1.0 + one[2] / DEPTH), 0.2 * (1.0 + one[2] / DEPTH)])
    drag = 0.5 * RHO * body["drag_area"] * wet * np.linalg.norm(flow) * flow
    assert np.abs(force[:2]) == pytest.approx(drag, rel=1e-3)


def changed(**more: Any) -> dict[str, Any]:
    return mooring() | more


def joint(*between: dict[str, Any], **more: Any) -> dict[str, Any]:
    scene = mooring()
    scene["joints"]["east_top"] |= more | ({"between": [*between]} if between else {})
    return scene


def stage(**more: Any) -> dict[str, Any]:
    return changed(stages=[static("rest", **more)])


def clearances(*pairs: tuple[str, str]) -> dict[str, Any]:
    return changed(output={"clearance": [{"between": [*pair], "beyond": 5.0 * n} for n, pair in enumerate(pairs)]})


TO_BUOY, EAST, NORTH = {"body": "buoy"}, {"line": "east", "at": "end"}, {"line": "north", "at": "end"}
MOVED = {"move": {"end": [0.0, 0.0, 0.0]}}
WITHOUT_LINES = {key: value for key, value in mooring().items() if key != "lines"}
MISSPELT = {"line_type": "chian", "length": 9.0, "elements": 2}
REFUSED = [
    (changed(dimension=2), "lines.east.start.position: .*leaves the lines' plane along y, but dimension is 2"),
    (changed(accuracy="1 %"), "accuracy: .*chooses what lines.east.segments.0.elements gives"),
    (changed(riser=mooring()["lines"]["east"]), "riser and lines are both given"),
    (WITHOUT_LINES, "the riser is missing"),
    (joint(kind="clamped"), "joints.east_top.between.1.body: value .buoy.: a point has no direction to clamp to"),
    (joint(kind="sprung"), "a sprung joint lacks it"),
    (joint({"line": "est", "at": "end"}, TO_BUOY), "between.0.line: value .est.: must be one of east, north, south"),
    (joint({"line": "east", "at": 200.0}, TO_BUOY), "must not exceed the line's length .130 m."),
    (joint(EAST, TO_BUOY | {"offset": [1.0, 0.0, 0.0]}), "has no place beside its own"),
    (joint(EAST, NORTH), "nothing says where the joint is at first"),
    (joint(TO_BUOY, TO_BUOY), "both points are of the same line or body"),
    (changed(output={"clearance": [{"between": ["east", "west"]}]}), "output.clearance.0.between.1: value .west."),
    (
        changed(output={"clearance": [{"between": ["east", "north"], "beyond": 1.0e3}]}),
        r"output\.clearance\.0\.beyond: value 1000.* east",
    ),
    (clearances(("east", "north"), ("east", "north")), "output.clearance.1.between: .*is east_north .*clearance.0 is"),
    (stage(**MOVED), "stages.0.move: value .*: does not say of which line it is"),
    (stage(bodies={"boy": {}}), "stages.0.bodies.boy: .*must be one of bodies .buoy.; name one of them"),
    (stage(bodies={"buoy": {"loads": [{"keep": True}]}}), "stages.0.bodies.buoy.loads.0.force: .*the load is missing"),
    (
        stage(bodies={"buoy": {"loads": [{"moment": [0.0, 1.0, 0.0]}]}}),
        "stages.0.bodies.buoy.loads.0.moment: value .*: a point does not turn",
    ),
    (stage(lines={"east": MOVED}), "stages.0.lines.east.move.end: value .*: a joint holds this end"),
    (
        changed(lines=mooring()["lines"] | {"east": mooring()["lines"]["east"] | {"segments": [MISSPELT]}}),
        "lines.east.segments.0.line_type: value .chian.: must be a key of line_types",
    ),
]


def test_pairs_of_one_name_in_the_results_are_refused() -> None:
    """Joined by _ two pairs of other names are one; the other way round, a pair is another."""
    scene = clearances(("east", "north"), ("north", "east"))
    assert len(scene_from_mapping(scene).output.clearance) == 2
    for kind in ("lines", "joints"):
        given = scene[kind]
        given |= {key.replace("north", "west_north"): deepcopy(each) for key, each in given.items() if "north" in key}
        given |= {key.replace("east", "east_west"): deepcopy(each) for key, each in given.items() if "east" in key}
    for key in ("west_north", "east_west"):
        scene["joints"][f"{key}_top"]["between"][0]["line"] = key
    scene["output"]["clearance"] = [{"between": ["east", "west_north"]}, {"between": ["east_west", "north"]}]
    with pytest.raises(SceneError, match=telling("output.clearance.1.between", "east_west_north", "rename")):
        scene_from_mapping(scene)


@pytest.mark.parametrize("name", ["time", "newton_iterations", "work_supports", "clearance", "results", "frequency"])
def test_names_that_results_have_otherwise_are_refused(name: str) -> None:
    with pytest.raises(SceneError, match=telling(f"lines.{name}", "results", "rename")):
        scene_from_mapping(with_line_named(name))


@pytest.mark.parametrize(("scene", "message"), REFUSED)
def test_what_is_refused(scene: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(scene)
