"""An end that hangs off at an angle or with a top tension: what is solved for, against the catenary's closed form."""

from __future__ import annotations

import json
import re
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from typer.testing import CliRunner

from riser_soil.accuracy.chosen_run import run_as_asked
from riser_soil.assembly.hang_off import HangOffEnd, by_cable, hang_off_ends, settled, with_values
from riser_soil.commands.app import app
from riser_soil.errors import Interruption, SceneError
from riser_soil.hang_off import SolvedEnd, from_vertical, with_hang_offs_solved
from riser_soil.results import Run
from riser_soil.results.observer import Observer
from riser_soil.scene.cross_checks import conflicts
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.whole_run import run
from tests.support.said import telling
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static
from tests.support.stage_histories import stage_histories

W, L, RISE = 200.0, 60.0, 40.0
CHAIN: Mapping = {"EA": 1.0e10, "EI": 0.0, "submerged_weight": W}
STIFF: Mapping = CHAIN | {"EI": 2.0e5}
IN_SPACE: Mapping = CHAIN | {"EI": 1.0, "GJ": 1.0}


def hanging(pipe: Mapping = CHAIN, end: str = "end", elements: int = 30, **asked: Any) -> Mapping:
    upper, lower = prescribed(30.0, 0.0, RISE), prescribed(0.0, 0.0, 0.0)
    upper["hang_off"] = asked
    start, last = (lower, upper) if end == "end" else (upper, lower)
    return riser_scene(static(), pipe=pipe, length=L, elements=elements, start=start, end=last, gravity=9.81)


def solved(scene: Mapping) -> tuple[Scene, SolvedEnd]:
    result = with_hang_offs_solved(scene_from_mapping(scene))
    assert result is not None
    (only,) = result.ends
    return result.scene, only


def catenary(layback: float, length: float = L) -> tuple[float, float]:
    """Angle from the vertical [deg] and tension [N] at the upper end of an inextensible cable: with a = H/w,
    sqrt(L^2 - rise^2) = 2 a sinh(x/2a), and V = w (L + rise coth(x/2a))/2 (Irvine, Cable Structures, 1981).
    """
    chord = np.sqrt(length**2 - RISE**2)
    a = brentq(lambda a: 2.0 * a * np.sinh(layback / 2.0 / a) - chord, layback / 40.0, 1e4 * layback, xtol=1e-12)
    H, V = W * a, 0.5 * W * (length + RISE / np.tanh(0.5 * layback / a))
    return float(np.degrees(np.arctan2(H, V))), float(np.hypot(H, V))


@pytest.mark.parametrize("end", ["end", "start"])
def test_angle_of_a_cable(end: str) -> None:
    scene, result = solved(hanging(end=end, angle=20.0))
    assert result.reached == pytest.approx(20.0, abs=0.002)
    assert catenary(result.value)[0] == pytest.approx(20.0, abs=0.03), "by the elements"
    assert getattr(scene.riser, end).position == pytest.approx((result.value, 0.0, RISE))
    assert getattr(scene.riser, end).hang_off is None


def test_tension_of_a_cable_by_its_length() -> None:
    scene, result = solved(hanging(tension=1.1e4, by="length"))
    assert result.reached == pytest.approx(1.1e4, rel=2e-5)
    assert scene.line.segments[0].length == result.value != L
    assert catenary(30.0, result.value)[1] == pytest.approx(1.1e4, rel=1e-3), "by the elements"


@pytest.mark.parametrize(
    ("asked", "promised"), [({"angle": 15.0}, 0.01), ({"tension": 1.2e4, "by": "anchor"}, 1e-4 * 1.2e4)]
)
def test_a_stiff_riser_has_what_was_asked_for_in_its_run(asked: Mapping, promised: float) -> None:
    """Not what a cable has with that layback, by far more than what is promised."""
    scene, result = solved(hanging(STIFF, **asked))
    ((end,),) = [[history.end] for history in stage_histories(scene)]
    reached = from_vertical(end.end_tangent) if "angle" in asked else float(end.effective_tension[-1])
    wanted = result.end.asked.asked
    assert reached == pytest.approx(wanted, abs=promised)
    assert abs(catenary(result.value)["tension" in asked] - wanted) > 5.0 * promised
    if "by" in asked:
        assert end.position[-1] == pytest.approx([30.0, 0.0, RISE]), "the anchor moves"
        assert end.position[0] == pytest.approx([30.0 - result.value, 0.0, 0.0])


def test_several_lines_side_by_side() -> None:
    scene = hanging(IN_SPACE, angle=20.0)
    first = scene.pop("riser")
    ends = {end: prescribed(x, 5.0, z) for end, x, z in (("start", 0.0, 0.0), ("end", 30.0, RISE))}
    ends["end"]["hang_off"] = {"tension": 1.1e4}
    scene["lines"] = {"first": first, "second": first | ends}
    result = with_hang_offs_solved(scene_from_mapping(scene))
    assert result is not None
    angle, tension = (catenary(each.value)[n] for n, each in enumerate(result.ends))
    assert angle == pytest.approx(20.0, abs=0.03), "by the elements"
    assert tension == pytest.approx(1.1e4, rel=1e-3)
    end = result.scene.lines["second"].end
    assert isinstance(end, Support)
    assert end.position == pytest.approx((result.ends[1].value, 5.0, RISE))
    assert result.summary["second"]["asked"] == {"tension": 1.1e4}


def on_a_weight(**asked: Any) -> Mapping:
    """Two lines from supports to a weight between them, each of which asks for an angle by its length."""
    lines: Mapping = {}
    for name, x in (("west", -50.0), ("east", 50.0)):
        segments = [{"line_type": "pipe", "length": 60.0, "elements": 10}]
        lines[name] = {"segments": segments, "start": prescribed(x, 0.0, 0.0), "end": "free"}
        lines[name]["start"]["hang_off"] = {"angle": asked[name], "by": "length"}
    return {
        "line_types": {"pipe": IN_SPACE},
        "lines": lines,
        "bodies": {"weight": {"kind": "point", "position": [0.0, 0.0, -35.0], "mass": 2.0e3}},
        "joints": {f"{name}_end": {"kind": "pinned", "between": _between(name)} for name in lines},
        "stages": [static()],
    }


def _between(line: str) -> list[Mapping]:
    return [{"line": line, "at": "end"}, {"body": "weight"}]


@pytest.mark.verify
def test_lines_that_hang_on_each_other(tmp_path: Path) -> None:
    """Both pull with the same H, and together bear all weight, of which each angle's tangent gives a share."""
    result = with_hang_offs_solved(scene_from_mapping(on_a_weight(west=45.0, east=40.0)))
    assert result is not None
    assert [each.reached for each in result.ends] == pytest.approx([45.0, 40.0], abs=0.002)
    assert result.solves < 12
    weight = 2.0e3 * 9.81 + W * sum(each.value for each in result.ends)
    H = weight / sum(1.0 / np.tan(np.radians(angle)) for angle in (45.0, 40.0))
    run(result.scene, tmp_path / "run")
    for line, angle in (("west", 45.0), ("east", 40.0)):
        end = Run(tmp_path / "run" / line).summary["stages"][0]["final"]["start"]
        assert end["effective_tension"] == pytest.approx(H / np.sin(np.radians(angle)), rel=3e-3), "by the elements"
        assert end["angle_deg"] == pytest.approx(angle - 90.0, abs=0.002)


@pytest.mark.verify
def test_a_joint_goes_farther_than_its_line_is_long_at_first(tmp_path: Path) -> None:
    """The weight's place is a guess; the scene in numbers can be run again."""
    scene = on_a_weight(west=30.0, east=30.0)
    scene["bodies"]["weight"]["position"] = [0.0, 0.0, -100.0]
    scene["line_types"]["pipe"] = IN_SPACE | {"EA": 1.0e7}
    for line in scene["lines"].values():
        line["segments"][0]["length"] = 120.0
    result = with_hang_offs_solved(scene_from_mapping(scene))
    assert result is not None
    lengths = [each.value for each in result.ends]
    assert lengths[0] == pytest.approx(lengths[1], rel=1e-4)
    assert lengths[0] < np.hypot(50.0, 100.0) / 1.1
    (tmp_path / "scene.yaml").write_text(dump_scene(result.scene))
    assert read_scene(str(tmp_path / "scene.yaml")).lines["west"].length == lengths[0]


def test_a_shifted_aim_that_no_cable_reaches_ends_no_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """Aims beyond what was asked for are out of reach: one value is tried, and slopes are found by differences."""
    original = by_cable

    def at_most(wanted: HangOffEnd, asked: float) -> float:
        if asked != 15.0:
            raise SceneError("out of reach")
        return original(wanted, asked)

    monkeypatch.setattr("riser_soil.hang_off.by_cable", at_most)
    _, result = solved(hanging(STIFF, angle=15.0))
    assert result.reached == pytest.approx(15.0, abs=0.002)


def test_a_vessel_that_another_end_hangs_on_does_not_come_along(tmp_path: Path) -> None:
    (tmp_path / "vessel.csv").write_text("t [s], heave [m]\n0, 0\n1, 1\n2, 0\n3, 0\n")
    scene = hanging(IN_SPACE | {"mass": 20.0}, angle=20.0)
    riser = scene.pop("riser")
    scene["lines"] = {"first": riser, "second": riser | {"end": prescribed(30.0, 0.0, RISE)}}
    vessel = {"end": {"vessel_history": {"file": "vessel.csv", "reference": [60.0, 0.0, 45.0]}}}
    moved = {name: {"motion": vessel} for name in scene["lines"]}
    scene["stages"] = [static(), dynamic(1.0, 0.1, "sail", lines=moved)]
    with pytest.raises(SceneError, match=telling("lines.first.end.hang_off:", "vessel")):
        scene_from_mapping(scene, tmp_path)


def test_a_run_that_ends_early_tells_what_was_found_and_so_does_its_restart(tmp_path: Path) -> None:
    scene = hanging(CHAIN | {"mass": 20.0}, elements=10, angle=20.0)
    scene["stages"] = [static(), dynamic(0.3, 0.1)]
    given, folder, usual = scene_from_mapping(scene), tmp_path / "run", Observer.record

    def record_and_leave(self: Observer, *arguments: Any, **more: Any) -> None:
        usual(self, *arguments, **more)
        signal.raise_signal(signal.SIGTERM)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Observer, "record", record_and_leave)
        with pytest.raises(Interruption):
            run_as_asked(given, folder)
    first = json.loads((folder / "summary.json").read_text())["hang_off"]
    run_as_asked(read_scene(str(folder / "scene.yaml")), folder, restart=True)
    assert json.loads((folder / "summary.json").read_text())["hang_off"] == first


def test_no_anchor_moves_that_a_joint_holds() -> None:
    scene = on_a_weight(west=45.0, east=40.0)
    scene["lines"]["east"]["start"]["hang_off"]["by"] = "anchor"
    with pytest.raises(SceneError, match=telling("lines.east.start.hang_off:", "by: anchor")):
        scene_from_mapping(scene)


def test_a_cable_is_where_it_begins() -> None:
    (wanted,) = hang_off_ends(scene_from_mapping(hanging(angle=20.0)))
    assert catenary(by_cable(wanted, 20.0))[0] == pytest.approx(20.0, abs=1e-4)


def test_what_no_layback_gives_is_reported() -> None:
    with pytest.raises(SceneError, match=telling("riser.end.hang_off:", "angle of 85 deg", "out of reach")):
        solved(hanging(angle=85.0))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"riser": {"end": {"hang_off": {"angle": 10.0, "tension": 1.0}}}}, "angle and tension are both given"),
        ({"riser": {"end": {"hang_off": {}}}}, "neither angle nor tension is given"),
        ({"riser": {"end": {"hang_off": {"angle": 90.0}}}}, "must be less than 90"),
        ({"riser": {"start": {"hang_off": {"angle": 10.0}}}}, "both ends hang off"),
        ({"riser": {"end": {"position": [0.0, 0.0, RISE]}}}, "right above the start"),
        ({"riser": {"end": {"position": [30.0, 0.0, -1.0]}}}, "the end is not above the start"),
        ({"riser": {"initial": "straight"}}, "needs a catenary to begin with"),
        ({"stages": [static(move={"end": [30.0, 0.0, 41.0]})]}, "moves an end"),
    ],
)
def test_what_a_hang_off_needs(change: Mapping, message: str) -> None:
    scene = hanging(angle=20.0)
    for key, value in change.items():
        if key == "riser":
            for name, inner in value.items():
                scene["riser"][name] = {**scene["riser"][name], **inner} if isinstance(inner, dict) else inner
        else:
            scene[key] = value
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(scene)


def test_commands_tell_what_was_found(tmp_path: Path) -> None:
    file = tmp_path / "scene.yaml"
    file.write_text(json.dumps(hanging(elements=10, angle=20.0)))
    guessed = CliRunner().invoke(app, ["check", str(file)])
    assert re.search(r"angle of 20 deg: .*layback of \d", guessed.output.splitlines()[0])
    assert CliRunner().invoke(app, ["run", str(file), "-o", str(tmp_path / "run")]).exit_code == 0
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    hang_off, final = summary["hang_off"], summary["stages"][0]["final"]
    assert hang_off["asked"] == {"angle_deg": 20.0}
    assert final["end"]["angle_deg"] == pytest.approx(90.0 - hang_off["reached"], abs=1e-6)
    assert final["end"]["position"][0] == pytest.approx(hang_off["value"], rel=1e-12)


def guessed(scene: Mapping, value: float, folder: Path = Path()) -> Scene:
    return with_values(hang_off_ends(scene_from_mapping(scene, folder)), [value])


@pytest.mark.parametrize("end", ["end", "start"])
def test_what_has_its_place_along_the_riser_stays_in_its_segment(end: str) -> None:
    """20 m that become 25 m at the lower end: what lies above is carried along, what lies on them by their share."""
    scene = hanging(end=end, angle=20.0, by="length")
    lower, upper = ({"line_type": "pipe", "length": length, "elements": 10} for length in (20.0, 40.0))
    scene["riser"]["segments"] = [lower, upper] if end == "end" else [upper, lower]
    row = {"from": 30.0, "to": 50.0, "spacing": 10.0, "mass": 1.0}
    scene["riser"]["attachments"] = [{"at": 10.0, "mass": 5.0}, row]
    scene["stages"] = [static(), static("pulled", loads=[{"at": 50.0, "force": [1.0, 0.0, 0.0]}])]
    guess = guessed(scene, 25.0)
    places = [each.arcs for each in guess.line.attachments]
    assert guess.line.length == pytest.approx(65.0)
    if end == "end":
        assert places == [pytest.approx((12.5,)), pytest.approx((35.0, 45.0, 55.0))]
        assert guess.stages[1].loads[0].at == pytest.approx(55.0)
    else:
        assert places == [(10.0,), pytest.approx((30.0, 40.0, 52.5))]
        assert guess.stages[1].loads[0].at == pytest.approx(52.5)


def test_what_carries_an_end_comes_along(tmp_path: Path) -> None:
    """A vessel that it hangs from, and the hub that it swings about, until it is moved to a place of its own."""
    (tmp_path / "vessel.csv").write_text("t [s], heave [m]\n0, 0\n1, 1\n2, 0\n3, 0\n")
    vessel = {"vessel_history": {"file": "vessel.csv", "reference": [60.0, 0.0, 45.0]}}
    arc = {"arc": {"hub": [30.0, 0.0, 50.0], "amplitude_deg": 1.0, "period": 2.0}}
    scene = hanging(CHAIN | {"mass": 20.0}, angle=20.0)
    scene["stages"] = [
        static(),
        dynamic(2.0, 0.1, "sail", motion={"end": vessel}),
        dynamic(2.0, 0.1, "swing", motion={"end": arc}),
        static("tow", move={"end": [31.0, 0.0, 40.0]}),
        dynamic(2.0, 0.1, "there", motion={"end": vessel}),
    ]
    stages = guessed(scene, 33.0, tmp_path).model_dump()["stages"]
    sail, swing, there = (stages[n]["motion"]["end"] for n in (1, 2, 4))
    assert sail["vessel_history"]["reference"] == pytest.approx((63.0, 0.0, 45.0))
    assert swing["arc"]["hub"] == pytest.approx((33.0, 0.0, 50.0))
    assert there["vessel_history"]["reference"] == (60.0, 0.0, 45.0)


@pytest.mark.parametrize("by", ["anchor", "layback"])
@pytest.mark.parametrize(("end", "ground", "after"), [("end", 0.0, 0.0), ("start", 3.0, 3.5)])
def test_the_anchor_stays_on_its_ground(end: str, ground: float, after: float, by: str) -> None:
    """However the ground rises from below the start: 1 in 10."""
    scene = hanging(end=end, angle=20.0, by=by)
    scene |= {"seabed": {"kind": "rigid", "contact_at": "axis", "profile": [[0.0, 0.0], [50.0, 5.0]]}}
    lower = "start" if end == "end" else "end"
    scene["riser"][lower]["position"] = [0.0, 0.0, ground]
    guess = guessed(scene, 35.0)
    assert getattr(guess.riser, lower).position[2] == pytest.approx(after)
    assert not conflicts(guess)


def test_a_scene_that_cannot_be_with_what_was_found_is_reported(tmp_path: Path) -> None:
    (tmp_path / "seabed.csv").write_text("x [m], y [m], z [m]\n-5, -5, 0\n-5, 5, 0\n30, -5, 0\n30, 5, 0\n")
    scene = hanging(angle=20.0) | {"seabed": {"kind": "rigid", "contact_at": "axis", "grid": "seabed.csv"}}
    ends = hang_off_ends(scene_from_mapping(scene | {"dimension": 2}, tmp_path))
    with pytest.raises(SceneError, match=telling("riser.end.hang_off:", "seabed.grid:", "beyond the grid")):
        settled(ends, [35.0])
