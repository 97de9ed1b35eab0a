"""A block of a scene that is null is one that is absent: so an override takes it off."""

from __future__ import annotations

from pathlib import Path

import pytest

from riser_soil.cases.expansion import read_cases
from riser_soil.errors import SceneError
from riser_soil.scene.reader import read_scene, scene_from_mapping
from tests.support.scenes import Mapping, prescribed, riser_scene, static

PIPE = {"EA": 1.0e9, "EI": 1.0e3, "GJ": 1.0e3, "mass": 20.0, "submerged_weight": 200.0}
CHECKED = """
line_types: {hose: {EA: 1.0e9, EI: 1.0e3, GJ: 1.0e3, mass: 20.0, submerged_weight: 200.0}}
riser:
  segments: [{line_type: hose, length: 60.0, elements: 12}]
  start: {position: [0.0, 0.0, 0.0]}
  end: {position: [30.0, 0.0, 40.0]}
stages: [{name: hang, kind: static}]
solver: {load_steps: 7}
code_check: [{kind: flexible-pipe, static_radius: 3.0}]
"""


def hanging() -> Mapping:
    ends = {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(30.0, 0.0, 40.0)}
    return riser_scene(static(), pipe=PIPE, length=60.0, elements=12, gravity=9.81, **ends)


@pytest.mark.parametrize(
    "block",
    ["water", "lines", "bodies", "joints", "vessel", "seabed", "soil", "contact", "initial", "solver", "output",
     "code_check", "accuracy"],
)  # fmt: skip
def test_a_block_that_is_null_is_absent(block: str) -> None:
    assert scene_from_mapping(hanging() | {block: None}) == scene_from_mapping(hanging())


@pytest.mark.parametrize("key", ["gravity", "title", "dimension", "error_bars", "line_types", "stages"])
def test_numbers_words_and_what_is_needed_are_not_null(key: str) -> None:
    with pytest.raises(SceneError, match=f"{key}: value null") as refused:
        scene_from_mapping(hanging() | {key: None})
    assert len(str(refused.value).splitlines()) == 1


def test_a_case_takes_the_code_check_off(tmp_path: Path) -> None:
    (tmp_path / "checked.yaml").write_text(CHECKED, encoding="utf-8")
    rows = "[{name: with, set: {title: a}}, {name: without, set: {code_check: null}}]"
    text = f"base: checked.yaml\ntable: {rows}\n"
    (tmp_path / "cases.yaml").write_text(text, encoding="utf-8")
    scenes = []
    for case in read_cases(tmp_path / "cases.yaml", ())[1]:
        (tmp_path / f"{case.name}.yaml").write_text(case.variant.text, encoding="utf-8")
        scenes.append(read_scene(tmp_path / f"{case.name}.yaml"))
    assert [len(scene.code_check) for scene in scenes] == [1, 0]
    assert [scene.solver.load_steps for scene in scenes] == [7, 7]


def test_an_override_of_the_command_line_takes_blocks_off(tmp_path: Path) -> None:
    (tmp_path / "checked.yaml").write_text(CHECKED, encoding="utf-8")
    scene = read_scene(tmp_path / "checked.yaml", ["code_check=null", "solver="])
    assert (scene.code_check, scene.solver.load_steps) == ((), scene_from_mapping(hanging()).solver.load_steps)
