"""Places and motions of ends where their line can't be, and displacements given as places."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from riser_soil.checks.check import describe
from riser_soil.checks.motion_plausibility import motion_warnings
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.whole_run import run
from tests.support.driven_stage import built
from tests.support.line_scenes import as_line
from tests.support.said import line_with
from tests.support.scenes import Mapping, dynamic, prescribed, quasi_static, riser_scene, static

PIPE = {"EA": 1.0e9, "EI": 1.0e5, "GJ": 1.0e5, "mass": 60.0, "submerged_weight": 200.0, "outer_diameter": 0.2}
TOP = [400.0, 0.0, 300.0]


def laid(*stages: Mapping, **more: Any) -> Mapping:
    """600 m of pipe on a seabed under 300 m of water."""
    ends = {"start": prescribed(0.0, 0.0, 0.1), "end": prescribed(*TOP)}
    more = {"seabed": {"kind": "spring", "stiffness": 1.0e5}} | more
    return riser_scene(static("hang"), *stages, pipe=PIPE, length=600.0, elements=60, gravity=9.81, **ends, **more)


def to(*place: float) -> Mapping:
    return static("move", move={"end": list(place)})


REFUSED = [
    ((-60.0, 0.0, 0.0), ("down to the seabed", "write [340, 0, 300]")),
    ((0.0, 0.0, -5.0), ("below the seabed", "write [400, 0, 295]")),
    ((400.0, 0.0, -1.0), ("below the seabed", "higher place")),
    ((900.0, 0.0, 300.0), ("948.6", "600 m", "bring the ends together")),
]


@pytest.mark.parametrize(("place", "words"), REFUSED, ids=[str(place) for place, _ in REFUSED])
def test_places_where_no_end_can_be(place: tuple[float, ...], words: tuple[str, ...]) -> None:
    with pytest.raises(SceneError) as refused:
        scene_from_mapping(laid(to(*place)))
    (line,) = str(refused.value).splitlines()
    assert "stages.1.move" in line
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    ("place", "write"), [((-40.0, 0.0, 300.0), "[360, 0, 300]"), ((10.0, 5.0, 50.0), "[410, 5, 350]")]
)
def test_a_likely_displacement_is_warned_of(place: tuple[float, ...], write: str) -> None:
    warnings = motion_warnings(built(laid(to(*place))).riser)
    line_with(warnings, "stages.1.move.end:", "not a displacement", f"write {write}")


@pytest.mark.parametrize("place", [(340.0, 0.0, 300.0), (460.0, 20.0, 300.0), (400.0, 0.0, 20.0), (200.0, 0.0, 300.0)])
def test_places_are_places(place: tuple[float, ...]) -> None:
    assert not [*motion_warnings(built(laid(to(*place))).riser)]


def test_beside_a_hang_off_an_offset_is_proposed() -> None:
    scene = laid(to(-60.0, 0.0, 0.0))
    scene["riser"]["end"]["hang_off"] = {"angle": 20.0}
    with pytest.raises(SceneError, match=r"give vessel: \{offset: \[-60, 0, 0\]\}"):
        scene_from_mapping(scene)


SURGE = {"harmonic": {"amplitude": [400.0, 0.0, 0.0], "period": 10.0, "ramp": 10.0}}
DIVE = {"table": "deep.csv"}
ROUND = {"arc": {"hub": [400.0, 0.0, 500.0], "amplitude_deg": 170.0, "period": 10.0, "ramp": 10.0}}
MOTIONS = [
    (dynamic(30.0, 0.5, motion={"end": SURGE}), ("853.923 m", "600 m long")),
    (quasi_static(30.0, motion={"end": SURGE}), ("853.923 m", "600 m long")),
    (quasi_static(30.0, motion={"end": {"table": "far.csv"}}), ("1140.", "600 m long")),
    (quasi_static(30.0, motion={"end": DIVE}), ("takes the end to z = -1 m at 30 s", "below the ground")),
    (dynamic(30.0, 0.5, motion={"end": ROUND}), ("600 m long",)),
    (quasi_static(30.0, motion={"start": DIVE}), ("takes the start", "below the ground")),
]


def read(scene: Mapping, folder: Path) -> Scene:
    (folder / "far.csv").write_text("t [s], x [m], y [m], z [m]\n0, 0, 0, 0\n30, 700, 0, 0\n")
    (folder / "deep.csv").write_text("t [s], x [m], y [m], z [m]\n0, 0, 0, 0\n15, 0, 0, -1\n30, 0, 0, -301\n")
    return scene_from_mapping(scene, folder)


@pytest.mark.parametrize(("stage", "words"), MOTIONS, ids=[f"{n} {words[-1]}" for n, (_, words) in enumerate(MOTIONS)])
def test_motions_to_where_no_line_can_be(stage: Mapping, words: tuple[str, ...], tmp_path: Path) -> None:
    with pytest.raises(SceneError) as refused:
        describe(read(laid(stage), tmp_path))
    (line,) = str(refused.value).splitlines()
    assert line.startswith("stages.1.motion: takes the ")
    assert all(word in line for word in words), line


def test_a_run_refuses_them_before_it_begins(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"stages\.1\.motion: takes the ends"):
        run(read(laid(MOTIONS[0][0]), tmp_path), tmp_path / "run")
    assert not (tmp_path / "run" / "results.nc").exists()
    with pytest.raises(SceneError, match=r"stages\.1\.lines\.\w+\.motion: takes the ends"):
        describe(scene_from_mapping(as_line(laid(MOTIONS[0][0]))))


def test_what_a_line_reaches_is_let_be(tmp_path: Path) -> None:
    small = {"harmonic": {"amplitude": [60.0, 10.0, 5.0], "period": 10.0, "ramp": 10.0}}
    assert describe(read(laid(dynamic(30.0, 0.5, motion={"end": small})), tmp_path))
