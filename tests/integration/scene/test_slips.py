"""Slips of the pen in scene files: tabs, blanks that are missing, words of other programs, files of another kind."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from riser_soil.commands.app import app
from riser_soil.errors import LONGEST, SceneError, in_short
from riser_soil.scene.aliases import ALIASES, meant_by
from riser_soil.scene.problem import shown
from riser_soil.scene.reader import read_scene
from riser_soil.scene.scene import Scene
from tests.support.said import line_with

SCENE = """\
water: {density: 1025.0}
line_types:
  pipe:
    outer_diameter: 0.28
    inner_diameter: 0.18
    mass: 105.0
    EA: 2.6e8
    EI: 4.1e4
    drag: {normal: 1.1}
riser:
  contents: {density: 850.0}
  segments: [{line_type: pipe, length: 140.0, element_length: 4.0}]
  start: {position: [0.0, 0.0, 0.14]}
  end: {position: [75.0, 0.0, 95.0]}
seabed: {kind: spring, stiffness: 1.0e5}
stages: [{name: hang, kind: static}]
"""


def refused(folder: Path, old: str, new: str) -> list[str]:
    """Lines of the error, of a scene with one thing written otherwise."""
    assert SCENE.count(old) == 1
    (folder / "scene.yaml").write_text(SCENE.replace(old, new))
    with pytest.raises(SceneError) as err:
        read_scene(folder / "scene.yaml")
    return str(err.value).splitlines()


def test_as_it_is_it_is_a_scene(tmp_path: Path) -> None:
    (tmp_path / "scene.yaml").write_text(SCENE)
    assert read_scene(tmp_path / "scene.yaml").line.length == 140.0


@pytest.mark.parametrize(("old", "at"), [("    mass", 6), ("  start", 13), ("  pipe:", 3)])
def test_a_tab_is_named(old: str, at: int, tmp_path: Path) -> None:
    tabbed = old.replace("  ", "\t", 1)
    (line,) = refused(tmp_path, f"\n{old}", f"\n{tabbed}")
    shown_line = SCENE.splitlines()[at - 1].strip()
    line_with([line], f"scene.yaml:{at}: ", f"line {at} is indented by a tab", "use spaces", shown_line)


@pytest.mark.parametrize(
    ("old", "new", "at", "key"),
    [
        ("water: {", "water:{", 1, "water"),
        ("mass: 105.0", "mass:105.0", 6, "mass"),
        ("{normal: 1.1}", "{normal:1.1}", 9, "normal"),
        ("contents: {density: 850.0}", "contents:\n    density:850.0", 12, "density"),
        ("drag: {normal: 1.1}", "drag:\n      normal:1.1", 10, "normal"),
        ("start: {", "start:{", 13, "start"),
        ("seabed: {kind: spring", "seabed: {kind:spring", 15, "kind"),
    ],
)
def test_a_blank_missing_after_a_colon(old: str, new: str, at: int, key: str, tmp_path: Path) -> None:
    lines = refused(tmp_path, old, new)
    message = line_with(lines, f"a blank is missing after the colon of {key}")
    assert abs(int(message.split("scene.yaml:")[1].split(":")[0]) - at) <= 1, message
    assert new.split("\n")[-1].strip() in message


WORDS = [
    ("outer_diameter: 0.28", "OD: 0.28", "outer_diameter"),
    ("inner_diameter: 0.18", "ID: 0.18", "inner_diameter"),
    ("mass: 105.0", "mass: 105.0\n    wall_thickness: 0.02", "inner_diameter: the outer_diameter less twice the wall"),
    ("mass: 105.0", "MassPerUnitLength: 105.0", "mass"),
    ("mass: 105.0", "mass: 105.0\n    w: 700.0", "submerged_weight"),
    ("drag: {normal: 1.1}", "Cd: 1.1", "drag: {normal: ...}"),
    ("drag: {normal: 1.1}", "Ca: 1.0", "added_mass: {normal: ...}"),
    ("[75.0, 0.0, 95.0]}", "[75.0, 0.0, 95.0], hang_off_angle: 8.0}", "hang_off: {angle: ...}"),
    ("{kind: spring, stiffness: 1.0e5}", "{kind: hysteretic, law: {kind: randolph-quiggin, su0: 2.0e3}}", "su"),
    ("stiffness: 1.0e5", "k: 1.0e5", "stiffness"),
    ("{density: 1025.0}", "{rho: 1025.0}", "density"),
    ("kind: static}", "kind: dynamic, duration: 5.0, dt: 0.1}", "time_step"),
    ("{density: 1025.0}", "{density: 1025.0, waves: {jonswap: {height: 3.0, Tp: 8.0, seed: 1}}}", "Hs"),
]


@pytest.mark.parametrize(("old", "new", "key"), WORDS)
def test_words_of_other_programs(old: str, new: str, key: str, tmp_path: Path) -> None:
    """One line, with the line of the file and the right key; what is missing only by another name is not told."""
    lines = refused(tmp_path, old, new)
    message = line_with(lines, f'did you mean "{key}"?')
    written = (tmp_path / "scene.yaml").read_text().splitlines()[int(message.split(":")[1]) - 1]
    assert f'the line is "{written.strip()}"' in message
    assert not any("required" in line for line in lines)


def test_each_alias_is_for_a_key_of_scenes() -> None:
    """And is none itself, where that key is."""
    keys = all_keys(Scene)
    for word, written in ALIASES.items():
        key = written.partition(":")[0]
        assert any(key in group for group in keys), word
        assert all(word not in group for group in keys if key in group), word
    assert meant_by("OD", ["mass"]) == ""


def all_keys(model: type[Scene]) -> list[list[str]]:
    """The keys of each mapping of the language."""
    schema = model.model_json_schema()
    return [list(each.get("properties", {})) for each in (schema, *schema["$defs"].values())]


def test_other_errors_of_yaml_have_line_and_column(tmp_path: Path) -> None:
    (line,) = refused(tmp_path, "start: {position", 'start: {"position')
    line_with([line], "scene.yaml", "not valid YAML, column", "the line is")
    (line,) = refused(tmp_path, "    EA: 2.6e8", "   EA: 2.6e8")
    line_with([line], "scene.yaml:7: not valid YAML, column 4: ", 'the line is "EA: 2.6e8"')


FATIGUE = "curve: {standard: DNV, name: D}\ncases: [{run: storm, share: 0.1}]\n"


@pytest.mark.parametrize(
    ("command", "text", "what"),
    [
        ("fatigue", SCENE, ("is a scene", "fatigue file")),
        ("cases", SCENE, ("is a scene", "case file")),
        ("check", FATIGUE, ("is a fatigue file", "riser-soil fatigue reads it")),
        ("run", "base: scene.yaml\nproduct: {}\n", ("is a case file", "riser-soil cases reads it")),
        ("plot", SCENE, ("is an input file", "the folder of a run is wanted")),
        ("report", SCENE, ("is a scene", "a report file is wanted")),
        ("statistics --of effective_tension", SCENE, ("is an input file", "the folder of a run is wanted")),
    ],
)
def test_a_file_of_another_kind_is_told_so(command: str, text: str, what: tuple[str, ...], tmp_path: Path) -> None:
    """In one line."""
    (tmp_path / "given.yaml").write_text(text)
    done = CliRunner().invoke(app, [*command.split(), str(tmp_path / "given.yaml")])
    assert done.exit_code == 2
    (line,) = done.output.strip().splitlines()
    for each in ("given.yaml: ", *what):
        assert each in line


@pytest.mark.parametrize("command", ["run", "check", "modes", "fatigue", "cases"])
def test_a_folder_in_the_place_of_a_file(command: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(app, [command, str(tmp_path)])
    assert done.exit_code == 2
    line_with(done.output.strip().splitlines(), "is a folder", "a file (.yaml) is wanted here")


def test_values_are_cut_between_their_parts() -> None:
    vessel = {"rao": "rao.csv", "reference": [1003.625, 0.0, 12.5], "heading_deg": 180.0, "ramp": 20.0}
    assert shown(vessel) == '{"rao": "rao.csv", ... (4 in all)}'
    assert shown([[0.25, 1.5, 0.0]] * 9) == "[[0.25, 1.5, 0.0], [0.25, 1.5, 0.0], ... (9 in all)]"
    assert shown("a" * 90) == '"' + 55 * "a" + '..."'
    assert shown({"z": 1.5}) == '{"z": 1.5}'


def test_long_lines_of_messages_keep_their_sense() -> None:
    names = [f"mooring line {n}" for n in range(400)]
    line = f"scene.yaml:3: joints.a.line: must be one of lines ({', '.join(names)}); correct it"
    short = in_short(f"first\n{line}")
    assert short.splitlines()[0] == "first"
    assert short.endswith("mooring line 6, mooring line 7, ... (400 in all)); correct it")
    assert str(SceneError("x" * 9000 + "; correct it")).endswith("; correct it")
    assert len(str(SceneError("x" * 9000))) < LONGEST + 100
    assert str(SceneError("y" * LONGEST)) == "y" * LONGEST
