"""What lines end at: free ends, rods, bodies that are points, forces on them, anchors on and below the seabed."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from riser_soil.errors import SceneError
from riser_soil.moordyn.scene_of import scene_of
from riser_soil.moordyn.whole_deck import whole_scene_of
from riser_soil.scene.reader import scene_from_mapping
from tests.support.moordyn_decks import LINES, OPTIONS, POINTS, TYPES, deck_of_text, text_of_deck
from tests.support.said import line_with

CABLE = [*TYPES, "cable 0.10 25.0 2.0e8 -0.9 3.0e4 1.2 1.0 0.0 0.0"]
HELD = [*POINTS[:2], "1 Coupled 6 2 -5 0 0 0 0"]
ROD_TYPES = ["Name Diam Mass/m Cd Ca CdEnd CaEnd", "(-)", "bar 0.2 60 1.1 0.9 0 0"]
RODS = ["ID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs Outputs", "(-)"]
BODIES = ["ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca", "(-)"]
LOADS = ["ID Object Fext Blin Bquad CSys", "(-)"]


def imported(folder: Path, whole: bool = False, **parts: Any) -> tuple[dict[str, Any], list[str]]:
    scene = (whole_scene_of if whole else scene_of)(deck_of_text(folder, text_of_deck(**parts)))
    scene_from_mapping(scene.data)
    return scene.data, [f"{line}: {what}" for line, what in scene.remarks]


@pytest.mark.parametrize("mass", [0.0, 350.0])
def test_a_free_lower_end_hangs_down(mass: float, tmp_path: Path) -> None:
    lines = [*LINES[:2], "1 cable 2 1 40 20 -"]
    points = [*HELD, f"2 Free 6 2 -45 {mass} 0 0 0"]
    riser = imported(tmp_path, line_types=CABLE, points=points, lines=lines)[0]["riser"]
    assert riser["start"] == "free"
    assert riser["end"] == {"position": [6.0, 2.0, -5.0]}
    assert riser["initial"] == {"points": [[6.0, 2.0, -45.0], [6.0, 2.0, -5.0]]}
    assert riser.get("attachments") == ([{"at": 0.0, "mass": mass}] if mass else None)


def test_a_free_end_lies_on_the_seabed_towards_its_place(tmp_path: Path) -> None:
    """100 m from 70 m above the bed: 30 m lie along it."""
    points = [*HELD, "2 Free 36 42 -60 0 0 0 0"]
    riser = imported(tmp_path, line_types=CABLE, points=points, lines=[*LINES[:2], "1 cable 1 2 100 20 -"])[0]["riser"]
    assert riser["initial"]["points"] == [
        pytest.approx([6.0 + 18.0, 2.0 + 24.0, -75.0]), [6.0, 2.0, -75.0], [6.0, 2.0, -5.0],
    ]  # fmt: skip


def test_a_free_end_that_floats_rises_to_the_surface(tmp_path: Path) -> None:
    points = [*POINTS[:3], "2 Free -240 30 -20 100 2.0 0 0"]
    riser = imported(tmp_path, line_types=CABLE, points=points, lines=[*LINES[:2], "1 cable 1 2 80 20 -"])[0]["riser"]
    assert riser["end"] == "free"
    assert riser["initial"]["points"] == [[-240.0, 0.0, -75.0], [-240.0, 0.0, 0.0], [-240.0, 5.0, 0.0]]


def test_a_line_that_nothing_holds(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"deck.dat:14: no end of it is held: point 1 and point 2 are free"):
        imported(tmp_path, points=[*POINTS[:2], "1 Free 0 0 -9 0 0 0 0", "2 Free 6 0 -5 0 0 0 0"])


@pytest.mark.parametrize("segments", ["0", "4"])
@pytest.mark.parametrize("whole", [False, True])
def test_a_rod_of_no_length_joins_two_lines(segments: str, whole: bool, tmp_path: Path) -> None:
    """Where the deck guesses it does not count; of bending the two are one piece."""
    rods = [*RODS, f"1 bar Free -235 0 -9 -235 0 -9 {segments} -"]
    lines = [*LINES[:2], "1 cable 1 r1a 150 15 -", "2 cable R1B 2 108.5 11 -"]
    data, _ = imported(tmp_path, whole, line_types=CABLE, lines=lines, rod_types=ROD_TYPES, rods=rods)
    riser = data["lines"]["line1_2"] if whole else data["riser"]
    assert [each["length"] for each in riser["segments"]] == [150.0, 108.5]
    assert (riser["start"], riser["end"]) == ({"position": [-240.0, 0.0, -75.0]}, {"position": [6.0, 0.0, -5.0]})
    assert "attachments" not in riser
    assert "joints" not in data


def test_a_free_rod_is_a_stiff_piece(tmp_path: Path) -> None:
    """The rod has its own weight and drag, between the lines at its ends; what its ends have is reported."""
    rods = [*RODS, "1 bar Free -100 0 -50 -97 4 -50 5 -"]
    lines = [*LINES[:2], "1 cable 1 R1A 150 15 -", "2 cable R1B 2 106 11 -"]
    types = [*ROD_TYPES[:2], "bar 0.2 60 1.1 0.9 0.7 0"]
    data, remarks = imported(tmp_path, line_types=CABLE, lines=lines, rod_types=types, rods=rods)
    segments = data["riser"]["segments"]
    assert [(each["line_type"], each["length"]) for each in segments] == [
        ("cable", 150.0), ("rod_bar", 5.0), ("cable", 106.0),
    ]  # fmt: skip
    bar, cable = data["line_types"]["rod_bar"], data["line_types"]["cable"]
    assert (bar["outer_diameter"], bar["mass"], bar["drag"], bar["added_mass"]) == (
        0.2, 60.0, {"normal": 1.1}, {"normal": 0.9},
    )  # fmt: skip
    assert bar["EI"] >= 10.0 * cable["EI"]
    assert bar["EA"] >= 10.0 * cable["EA"]
    line_with(remarks, "rods of bar are rigid", "stiff pieces")
    line_with(remarks, "CdEnd 0.7 of bar")


def test_a_rod_that_hangs_from_a_pin(tmp_path: Path) -> None:
    rods = [*RODS, "1 bar Pinned 6 0 -5 6 0 -15 5 -"]
    data, _ = imported(tmp_path, lines=[*LINES[:2], "1 rope 1 R1B 245 24 -"], rod_types=ROD_TYPES, rods=rods)
    assert [each["length"] for each in data["riser"]["segments"]] == [245.0, 10.0]
    assert data["riser"]["end"] == {"position": [6.0, 0.0, -5.0]}


def test_lines_that_end_at_a_held_rod(tmp_path: Path) -> None:
    rods = [*RODS, "1 bar Fixed 6 0 -5 6 0 -15 5 -"]
    data, remarks = imported(tmp_path, lines=[*LINES[:2], "1 rope 1 R1B 245 24 -"], rod_types=ROD_TYPES, rods=rods)
    assert data["riser"]["end"] == {"position": [6.0, 0.0, -15.0]}
    line_with(remarks, "clamped to rod 1B", "free to turn")


@pytest.mark.parametrize("whole", [False, True])
def test_a_body_without_inertia_is_a_point(whole: bool, tmp_path: Path) -> None:
    """The point has what is on the body, and the force on it; the body's damping is reported."""
    bodies = [*BODIES, "1 Free 6 2 -45 0 0 0 900 0 0 0.2 0.4|0.4|0.6 1"]
    points = [*HELD, "2 Body1 0 0 0 100 0.1 0.2 0"]
    loads = [*LOADS, "1 Body1 3e3|0|-500 10 0 G"]
    data, remarks = imported(
        tmp_path, whole, line_types=CABLE, points=points, bodies=bodies, external_loads=loads,
        lines=[*LINES[:2], "1 cable 1 2 40 20 -"],
    )  # fmt: skip
    riser = data["lines"]["line1"] if whole else data["riser"]
    stage = data["stages"][0]["lines"]["line1"] if whole else data["stages"][0]
    assert riser["attachments"] == [
        {"at": 0.0, "mass": 1000.0, "volume": pytest.approx(0.3), "drag_area": pytest.approx(0.8), "added_mass": 1.0}
    ]
    assert stage["loads"] == [{"at": "start", "force": [3e3, 0.0, -500.0], "keep": True}]
    line_with(remarks, "Blin 10 of Body1", "damping")
    line_with(remarks, "rotation of body 1")
    line_with(remarks, "CdA 0.4|0.4|0.6", "largest")


def test_a_body_without_inertia_whose_points_are_apart(tmp_path: Path) -> None:
    bodies = [*BODIES, "1 Free 6 2 -45 0 0 0 900 0 0 0.2 0 0"]
    points = [*HELD, "2 Body1 1 0 0 0 0 0 0"]
    with pytest.raises(SceneError, match=r"deck.dat:23: body 1 has no inertia"):
        imported(tmp_path, True, points=points, bodies=bodies)


def test_a_line_at_a_free_body_says_that_the_body_is_free(tmp_path: Path) -> None:
    bodies = [*BODIES, "1 Free 6 0 -5 0 0 0 900 0 1e4 0.9 0 0"]
    points = [*POINTS[:3], "2 Body1 0 0 0 0 0 0 0", "3 Body1 1 0 0 0 0 0 0"]
    remarks = imported(tmp_path, points=points, bodies=bodies)[1]
    line_with(remarks, "point 2 is on a free body", "--line all")


@pytest.mark.parametrize(("angles", "arm"), [("0 0 90", (0, 2, 1)), ("90 0 0", (2, -1, 0)), ("0 90 0", (1, 0, -2))])
def test_points_on_a_turned_body(angles: str, arm: tuple[float, float, float], tmp_path: Path) -> None:
    """About one axis; about several MoorDyn's versions turn it in different orders."""
    bodies = [*BODIES, f"1 Coupled 6 0 -5 {angles} 0 0 0 0 0 0"]
    points = [*POINTS[:3], "2 Body1 2 0 1 0 0 0 0"]
    lines = [*LINES[:2], "1 rope 1 2 262 24 -"]
    position = imported(tmp_path, points=points, bodies=bodies, lines=lines)[0]["riser"]["end"]["position"]
    assert position == pytest.approx([6 + arm[0], arm[1], -5 + arm[2]])
    with pytest.raises(SceneError, match=r"body 1 is turned about 2 axes"):
        imported(tmp_path, points=points, bodies=[*BODIES, "1 Coupled 6 0 -5 5 5 0 0 0 0 0 0 0"], lines=lines)


def test_forces_of_points(tmp_path: Path) -> None:
    """On what is free they are loads; on what is held they are reported."""
    points = ["ID Attachment X Y Z Mass Volume FX FY FZ CdA Ca", "(-)", "1 Fixed -240 0 -75 0 0 0 0 7 0 0",
              "2 Coupled 6 0 -5 0 0 0 0 0 0 0", "3 Free -100 0 -30 0 0 40 50 60 0.3 0"]  # fmt: skip
    lines = [*LINES[:2], "1 rope 1 3 150 15 -", "2 rope 3 2 108.5 10 -"]
    data, remarks = imported(tmp_path, points=points, lines=lines, external_loads=[*LOADS, "1 P3 1|2|3 0 0 -"])
    assert data["stages"][0]["loads"] == [
        {"at": 150.0, "force": [40.0, 50.0, 60.0], "keep": True},
        {"at": 150.0, "force": [1.0, 2.0, 3.0], "keep": True},
    ]
    assert data["riser"]["attachments"] == [{"at": 150.0, "drag_area": 0.3}]
    line_with(remarks, "9:", "force on point 1")


def test_the_seabed_is_at_the_deepest_anchor_where_no_depth_is_given(tmp_path: Path) -> None:
    for options in (OPTIONS[1:], [*OPTIONS[1:], "0 WtrDpth"], [*OPTIONS[1:], "floor.txt WtrDpth"]):
        data, remarks = imported(tmp_path, options=options)
        assert data["seabed"]["level"] == -75.0
        line_with(remarks, "no WtrDpth in the options", "deepest anchor, point 1", "z = -75 m")
    line_with(remarks, "WtrDpth floor.txt:", "depths from a file")


def test_no_seabed_where_no_anchor_is_deepest(tmp_path: Path) -> None:
    points = [*POINTS[:2], "1 Coupled -240 0 -75 0 0 0 0", POINTS[3]]
    data, remarks = imported(tmp_path, points=points, options=OPTIONS[1:])
    assert "seabed" not in data
    line_with(remarks, "no WtrDpth in the options", "there is no seabed")


def test_points_on_the_seabed_by_a_word(tmp_path: Path) -> None:
    for word in ("seabed", "Ground", "SeaFloor"):
        points = [*POINTS[:2], POINTS[2].replace("-75", word), POINTS[3]]
        assert imported(tmp_path, points=points)[0]["riser"]["start"]["position"] == [-240.0, 0.0, -75.0]
    with pytest.raises(SceneError, match=r"deck.dat:9: point 1 is on the SeaFloor, and no depth is given"):
        imported(tmp_path, points=points, options=OPTIONS[1:])


@pytest.mark.parametrize(("z", "deep"), [(-75.0, 0.0), (-74.94, 0.0), (-75.3, 0.3), (-77.0, 2.0)])
def test_anchors_on_above_and_below_the_seabed(z: float, deep: float, tmp_path: Path) -> None:
    """The seabed stays, and so does the anchor; a warning states the depth."""
    data, remarks = imported(tmp_path, points=[*POINTS[:2], POINTS[2].replace("-75", f"{z}"), POINTS[3]])
    assert data["riser"]["start"]["position"] == [-240.0, 0.0, z]
    assert data["seabed"]["level"] == -75.0
    said = [each for each in remarks if "below the seabed" in each]
    assert len(said) == (deep > 0.0)
    if deep:
        line_with(said, "9:", f"point 1 is {deep:g} m below the seabed", f"(z = {z:g} m", "laid from there")


def test_a_deck_in_air(tmp_path: Path) -> None:
    """A density of 0 leaves no water, and nothing that acts in it."""
    options = [*OPTIONS, "0 WtrDnsty"]
    data, remarks = imported(tmp_path, options=options)
    assert "water" not in data
    assert {*data["line_types"]["rope"]} == {"outer_diameter", "mass", "EA", "EI"}
    line_with(remarks, "20:", "WtrDnsty 0 counts")
    assert math.isclose(data["gravity"], 9.8)


@pytest.mark.parametrize(
    ("body", "ending"),
    [("Free", "add 240 kg to its Mass and 0.1257 m3 to its Volume"), ("Fixed", "buoyancy and drag")],
)
def test_a_rod_on_a_body(body: str, ending: str, tmp_path: Path) -> None:
    """A rod of 4 m, of 60 kg/m and 0.2 m: a free body lacks its weight and buoyancy, and the remark has them."""
    bodies = [*BODIES, f"1 {body} 6 2 -5 0 0 0 900 0 1e3 1.0 0 0"]
    points = [*POINTS[:3], "2 Body1 2 0 1 0 0 0 0"]
    rods = [*RODS, "1 bar Body1 0 0 -2 0 0 2 2 -"]
    parts = {"line_types": CABLE, "points": points, "bodies": bodies, "rod_types": ROD_TYPES, "rods": rods}
    remarks = imported(tmp_path, True, **parts, lines=[*LINES[:2], "1 cable 1 2 400 20 -"])[1]
    about = line_with(remarks, "rod 1 is on a body: its weight, buoyancy and drag")
    assert about.endswith(ending)
