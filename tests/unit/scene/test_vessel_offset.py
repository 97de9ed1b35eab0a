"""The offset of a vessel: what it moves, what it needs, and what it says."""

from __future__ import annotations

import json
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from mpi4py import MPI
from typer.testing import CliRunner

from riser_soil.accuracy.chosen_run import in_numbers
from riser_soil.assembly import build
from riser_soil.commands.app import app
from riser_soil.errors import SceneError
from riser_soil.results import Run
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.variants import at_offset
from tests.support.said import line_with, telling
from tests.support.scenes import Mapping, dynamic, prescribed, quasi_static, riser_scene, static

PIPE = {"EA": 1.0e9, "EI": 1.0e3, "GJ": 1.0e3, "mass": 20.0, "submerged_weight": 200.0}
VESSEL: Mapping = {"vessel_history": {"file": "vessel.csv", "reference": [60.0, 0.0, 45.0]}}
OTHER: Mapping = {"vessel_history": {"file": "vessel.csv", "reference": [-60.0, 0.0, 45.0]}}
ARC: Mapping = {"arc": {"hub": [30.0, 0.0, 50.0], "amplitude_deg": 1.0, "period": 2.0}}
SAIL = dynamic(2.0, 0.1, "sail", motion={"end": VESSEL})


@pytest.fixture(autouse=True)
def _vessel(tmp_path: Path) -> None:
    (tmp_path / "vessel.csv").write_text("t [s], heave [m]\n0, 0\n1, 1\n2, 0\n3, 0\n")


def hanging(*stages: Mapping, offset: Any = (-5.0, 2.0), **more: Any) -> Mapping:
    """A line of 60 m that rises by 40 m over 30 m."""
    ends = {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(30.0, 0.0, 40.0)}
    scene = riser_scene(*(stages or (static(),)), pipe=PIPE, length=60.0, elements=12, gravity=9.81, **ends, **more)
    return scene | {"vessel": {"offset": list(offset)}}


def two_lines(*motions: Mapping, **vessel: Any) -> Mapping:
    """Lines west and east, whose upper ends motions of a second stage move."""
    scene = hanging()
    riser = scene.pop("riser")
    scene["lines"] = {name: deepcopy(riser) for name in ("west", "east")}
    scene["vessel"] |= vessel
    acts = {name: {"motion": {"end": motion}} for name, motion in zip(scene["lines"], motions, strict=False)}
    scene["stages"] += [dynamic(2.0, 0.1, lines=acts)] if motions else []
    return scene


def stages(scene: Mapping, folder: Path) -> list[Mapping]:
    return list(at_offset(scene_from_mapping(scene, folder)).model_dump()["stages"])


def test_end_hub_and_reference_go_together(tmp_path: Path) -> None:
    swing = dynamic(2.0, 0.1, "swing", motion={"end": ARC})
    first, sail, swung = stages(hanging(static(), SAIL, swing, offset=(-5.0, 2.0, 1.0)), tmp_path)
    assert first["move"]["end"] == (25.0, 2.0, 41.0)
    assert first["move"]["start"] is None
    assert sail["motion"]["end"]["vessel_history"]["reference"] == (55.0, 2.0, 46.0)
    assert swung["motion"]["end"]["arc"]["hub"] == (25.0, 2.0, 51.0)


def test_all_lines_of_a_vessel_go_with_it(tmp_path: Path) -> None:
    first, sail = stages(two_lines(VESSEL, VESSEL), tmp_path)
    for name in ("west", "east"):
        assert first["lines"][name]["move"]["end"] == (25.0, 2.0, 40.0)
        assert sail["lines"][name]["motion"]["end"]["vessel_history"]["reference"] == (55.0, 2.0, 45.0)


def test_ends_that_are_named_go_alone(tmp_path: Path) -> None:
    first, sail = stages(two_lines(VESSEL, OTHER, ends=["east.end"]), tmp_path)
    assert [*first["lines"]] == ["east"]
    assert sail["lines"]["west"]["motion"]["end"]["vessel_history"]["reference"] == (60.0, 0.0, 45.0)
    assert sail["lines"]["east"]["motion"]["end"]["vessel_history"]["reference"] == (-65.0, 2.0, 45.0)


def test_no_offset_leaves_the_scene_as_it_is(tmp_path: Path) -> None:
    plain = hanging(static(), SAIL)
    del plain["vessel"]
    assert at_offset(scene_from_mapping(hanging(static(), SAIL, offset=(0.0, 0.0)), tmp_path)) == scene_from_mapping(
        plain, tmp_path
    )


def test_it_comes_after_the_hang_off(tmp_path: Path) -> None:
    """The hang-off is that at no offset; the scene in numbers can be read and run again."""
    scene = hanging(static(), SAIL)
    scene["riser"]["end"]["hang_off"] = {"angle": 20.0}
    mean, _ = in_numbers(scene_from_mapping(scene | {"vessel": None}, tmp_path))
    there, more = in_numbers(scene_from_mapping(scene, tmp_path))
    x = _end(mean)[0]
    assert _end(there) == _end(mean)
    assert there.stages[0].model_dump()["move"]["end"] == pytest.approx((x - 5.0, 2.0, 40.0))
    assert _reference(there)[0] == pytest.approx(_reference(mean)[0] - 5.0)
    assert more["vessel"]["ends"]["end"]["from"] == _end(mean)
    assert "reached" in more["hang_off"]
    (tmp_path / "again.yaml").write_text(dump_scene(there))
    assert read_scene(tmp_path / "again.yaml") == there


def _end(scene: Scene) -> tuple[float, ...]:
    return tuple(scene.model_dump()["riser"]["end"]["position"])


def _reference(scene: Scene) -> tuple[float, ...]:
    return tuple(scene.model_dump()["stages"][1]["motion"]["end"]["vessel_history"]["reference"])


def test_commands_report_it(tmp_path: Path) -> None:
    file = tmp_path / "scene.yaml"
    file.write_text(json.dumps(hanging()))
    checked = CliRunner().invoke(app, ["check", str(file), "--set", "vessel.offset=[-5.0, 2.0]"])
    done = CliRunner().invoke(app, ["run", str(file), "-o", str(tmp_path / "run")])
    for ended in (checked, done):
        assert ended.exit_code == 0, ended.output
        line_with(ended.output, "vessel", "[-5, 2, 0]", "[30, 0, 40]", "[25, 2, 40]")
    summary = Run(tmp_path / "run").summary
    assert summary["vessel"]["offset"] == [-5.0, 2.0, 0.0]
    assert summary["stages"][0]["final"]["end"]["position"] == pytest.approx([25.0, 2.0, 40.0])


def test_nothing_is_built_with_an_offset_that_no_stage_has() -> None:
    with pytest.raises(SceneError, match=telling("vessel.offset:")):
        build(scene_from_mapping(hanging()), MPI.COMM_SELF)


REFUSED = [
    (hanging(dynamic(1.0, 0.1)), ("vessel.offset:", "static", "dynamic")),
    (hanging(quasi_static(1.0)), ("vessel.offset:", "static", "quasi-static")),
    (hanging(static(move={"end": [31.0, 0.0, 40.0]})), ("stages.0.move.end:", "vessel.offset")),
    (hanging(static(), static("tow", move={"end": [31.0, 0.0, 40.0]})), ("stages.1.move.end:", "vessel.offset")),
    (hanging(offset=(50.0, 0.0)), ("vessel.offset:", "stages.0.move", "89.4427 m", "60 m")),
    (hanging(dimension=2), ("vessel.offset:", "stages.0.move.end", "dimension")),
    (
        hanging(offset=(0.0, 0.0, -41.0), seabed={"kind": "rigid", "contact_at": "axis"}),
        ("vessel.offset:", "stages.0.move.end", "seabed"),
    ),
    (two_lines(VESSEL, OTHER), ("vessel.ends:", "west.end", "east.end", "different references")),
    (two_lines(VESSEL, VESSEL, ends=["west.end"]), ("vessel.ends:", "east.end", "same vessel")),
    (two_lines(ends=["west.top"]), ("vessel.ends.0:", "west.start, west.end, east.start, east.end")),
    (two_lines(ends=["west.end", "west.end"]), ("vessel.ends.1:", "before")),
    (hanging(riser={"end": "free"}, offset=(1.0, 0.0)) | {"vessel": {"offset": [1.0, 0.0], "ends": ["end"]}},
     ("vessel.ends.0:", "no position")),
    (hanging(riser={"start": prescribed(0.0, 0.0, 40.0)}), ("vessel.ends:", "upper end")),
    (hanging(riser={"end": prescribed(30.0, 0.0, 40.0) | {"tensioner": {"tension": 1.0e4}}}, offset=(1.0, 0.0, 1.0)),
     ("vessel.offset:", "tensioner", "[dx, dy]")),
]  # fmt: skip


@pytest.mark.parametrize(("scene", "words"), REFUSED, ids=[" ".join(words) for _, words in REFUSED])
def test_what_it_needs(scene: Mapping, words: tuple[str, ...], tmp_path: Path) -> None:
    with pytest.raises(SceneError) as refused:
        scene_from_mapping(scene, tmp_path)
    assert len(str(refused.value).splitlines()) == 1, refused.value
    for word in words:
        assert word in str(refused.value)
