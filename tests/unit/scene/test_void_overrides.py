"""Overrides that would change nothing: of what a run finds anyway, and those that another one undoes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from riser_soil.api import Scene as WrittenScene
from riser_soil.errors import SceneError
from riser_soil.scene.reader import read_scene
from tests.support.scenes import Mapping, prescribed, riser_scene, static

PIPE = {"EA": 1.0e9, "EI": 1.0e3, "GJ": 1.0e3, "mass": 20.0, "submerged_weight": 200.0}


def hanging(**end: Any) -> Mapping:
    ends = {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(30.0, 0.0, 40.0) | end}
    return riser_scene(static(), pipe=PIPE, length=60.0, elements=12, gravity=9.81, **ends)


def on_a_buoy() -> Mapping:
    scene = hanging()
    riser = scene.pop("riser") | {"start": "free"}
    scene["lines"] = {"tether": riser}
    scene["bodies"] = {"buoy": {"kind": "point", "position": [0.0, 0.0, 0.0], "mass": 50.0}}
    scene["joints"] = {"top": {"kind": "pinned", "between": [{"line": "tether", "at": "start"}, {"body": "buoy"}]}}
    return scene


VOID = [
    (hanging(hang_off={"angle": 20.0}), "riser.end.position.0=25.0", "vessel.offset"),
    (hanging(hang_off={"angle": 20.0}), "riser.end.position.1=5.0", "vessel.offset"),
    (hanging(hang_off={"angle": 20.0}), "riser.end.position=[25.0, 0.0, 40.0]", "vessel.offset"),
    (hanging(hang_off={"tension": 1.1e4, "by": "anchor"}), "riser.start.position.0=5.0", "vessel.offset"),
    (hanging(hang_off={"tension": 1.1e4, "by": "anchor"}), "riser.end.position.0=25.0", "vessel.offset"),
    (hanging(hang_off={"tension": 1.1e4, "by": "length"}), "riser.segments.0.length=70.0", "hang_off"),
    (hanging(tensioner={"tension": 1.2e4}), "riser.end.position.2=41.0", "tensioner"),
    (on_a_buoy(), "bodies.buoy.position.2=1.0", "to rest"),
    (on_a_buoy(), "bodies.buoy.position=[1.0, 0.0, 0.0]", "to rest"),
]


def written(scene: Mapping, folder: Path) -> Path:
    file = folder / "scene.yaml"
    file.write_text(json.dumps(scene))
    return file


@pytest.mark.parametrize(("scene", "override", "word"), VOID, ids=[override for _, override, _ in VOID])
def test_what_a_run_finds_anyway_is_no_override(scene: Mapping, override: str, word: str, tmp_path: Path) -> None:
    file = written(scene, tmp_path)
    with pytest.raises(SceneError) as refused:
        read_scene(file, [override])
    text = str(refused.value)
    assert len(text.splitlines()) == 1
    path, _, value = override.partition("=")
    assert text.startswith(f"--set {override}: {path}: value {value}: is a first guess: ")
    assert word in text
    with pytest.raises(SceneError, match="is a first guess"):
        WrittenScene.from_file(file).changed({path: json.loads(value)})


FELT = [
    (hanging(hang_off={"angle": 20.0}), ["riser.end.position.2=41.0"]),
    (hanging(hang_off={"angle": 20.0}), ["riser.end.position=[30.0, 0.0, 41.0]"]),
    (hanging(hang_off={"angle": 20.0}), ["riser.end.hang_off=null", "riser.end.position.0=25.0"]),
    (hanging(hang_off={"tension": 1.1e4, "by": "length"}), ["riser.end.position.0=25.0"]),
    (hanging(tensioner={"tension": 1.2e4}), ["riser.end.position.0=25.0"]),
    (hanging(), ["riser.end.position.0=25.0"]),
    (on_a_buoy(), ["bodies.buoy.mass=60.0"]),
    (on_a_buoy(), ["joints.top.position=[1.0, 0.0, 0.0]"]),
    (on_a_buoy() | {"stages": [{"name": "go", "kind": "dynamic", "duration": 1.0, "time_step": 0.1}]},
     ["bodies.buoy.position.2=1.0"]),
]  # fmt: skip


@pytest.mark.parametrize(("scene", "overrides"), FELT, ids=[" ".join(overrides) for _, overrides in FELT])
def test_what_a_run_feels_is_one(scene: Mapping, overrides: list[str], tmp_path: Path) -> None:
    file = written(scene, tmp_path)
    assert read_scene(file, overrides) != read_scene(file)


UNDONE = [
    ["riser.end.position.0=25.0", "riser.end.position=[24.0, 0.0, 40.0]"],
    ["line_types.pipe.mass=3.0", "line_types.pipe={EA: 1.0e9, EI: 1.0e3, submerged_weight: 200.0}"],
]


@pytest.mark.parametrize("overrides", UNDONE, ids=[" ".join(overrides) for overrides in UNDONE])
def test_no_override_undoes_another(overrides: list[str], tmp_path: Path) -> None:
    file = written(hanging(), tmp_path)
    with pytest.raises(SceneError, match="undoes") as refused:
        read_scene(file, overrides)
    assert all(f"--set {override}" in str(refused.value) for override in overrides)
    assert read_scene(file, overrides[::-1][:1])


def test_of_one_path_the_last_override_counts(tmp_path: Path) -> None:
    assert read_scene(written(hanging(), tmp_path), ["gravity=9.8", "gravity=9.7"]).gravity == 9.7


def test_an_override_within_another_changes_it(tmp_path: Path) -> None:
    overrides = ["riser.end.position=[24.0, 0.0, 40.0]", "riser.end.position.0=25.0"]
    scene = read_scene(written(hanging(), tmp_path), overrides)
    assert scene.model_dump()["riser"]["end"]["position"] == (25.0, 0.0, 40.0)


def test_changed_scenes_are_changed_again() -> None:
    scene = WrittenScene.from_dict(hanging()).changed({"gravity": 9.8}).changed({"gravity": 9.7})
    assert scene.model.gravity == 9.7
