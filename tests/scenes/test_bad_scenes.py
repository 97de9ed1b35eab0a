"""Wrong scenes: file, line, key path, value and remedy are told; status 2, no traceback, no folder."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from riser_soil.__main__ import app
from tests.support.bad_scenes import ALL, GOOD, Bad
from tests.support.on_ranks import HANGS
from tests.support.said import line_with


def run(arguments: list[str]) -> Result:
    return CliRunner().invoke(app, arguments)


def write(folder: Path, text: str) -> Path:
    file = folder / "case.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def refused(folder: Path, file: Path, *options: str) -> list[str]:
    """The lines of the message; asserts the status, no traceback and that nothing was left behind."""
    before = sorted(folder.rglob("*"))
    result = run(["run", str(file), "-o", str(folder / "out"), *options])
    assert result.exit_code == 2, result.output
    assert isinstance(result.exception, SystemExit)
    assert "Traceback" not in result.output
    assert sorted(folder.rglob("*")) == before
    return result.stderr.splitlines()


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Bad], tuple[Path, list[str]]]:
    """The file with a mistake, and the lines that it is refused with."""

    @cache
    def lines(bad: Bad) -> tuple[Path, list[str]]:
        assert bad.old in GOOD
        text = GOOD.replace(bad.old, bad.new, 1)
        if "dimension is 2" in bad.says:
            text = text.replace("[0.0, 0.0, 1.5]", "[0.0, 1.0, 1.5]")
        folder = tmp_path_factory.mktemp("bad")
        file = write(folder, text)
        return file, refused(folder, file)

    return lines


@pytest.mark.parametrize("bad", ALL, ids=lambda bad: f"{bad.path}={bad.value}")
def test_message_gives_file_line_path_value_and_remedy(
    bad: Bad, told: Callable[[Bad], tuple[Path, list[str]]]
) -> None:
    file, lines = told(bad)
    given = "missing" if bad.value == "missing" else f"value {bad.value}"
    place = f"{file}:{bad.line}: {bad.path}: {given}"
    matching = [line for line in lines if line.startswith(place)]
    assert matching, "\n".join([f"wanted {place}", *lines])
    assert bad.says in matching[0]
    assert "; " in matching[0]


@pytest.mark.parametrize("bad", ALL, ids=lambda bad: f"{bad.path}={bad.value}")
def test_one_mistake_gives_one_line(bad: Bad, told: Callable[[Bad], tuple[Path, list[str]]]) -> None:
    _, lines = told(bad)
    assert len(lines) == bad.lines, "\n".join(lines)


def test_the_good_scene_is_good(tmp_path: Path) -> None:
    from riser_soil.scene.reader import read_scene

    assert read_scene(write(tmp_path, GOOD)).title == "base"


def test_every_wrong_key_is_reported_in_the_order_of_the_file(tmp_path: Path) -> None:
    text = (
        GOOD.replace("gravity", "gravitiy")
        .replace("period", "perod")
        .replace("    mass: 120.0", "    mass: no")
    )
    lines = refused(tmp_path, write(tmp_path, text))
    assert [line.split(":")[1] for line in lines] == ["2", "8", "34"]


def test_very_many_mistakes_are_cut_short(tmp_path: Path) -> None:
    wrong_keys = "".join(f"wrong_{n}: 1\n" for n in range(50))
    lines = refused(tmp_path, write(tmp_path, GOOD + wrong_keys))
    assert len(lines) == 21
    line_with(lines[-1], "30 more problems")


BROKEN = {
    "": "the scene is empty",
    "# only a comment\n": "the scene is empty",
    "- a\n- b\n": "scene: value [\"a\", \"b\"]: must be a mapping",
    "just a text": 'scene: value "just a text": must be a mapping',
    "42": "scene: value 42: must be a mapping",
    "null": "scene: value null: must be a mapping",
    "title: [1, 2\ngravity: 9.81\n": ":2: not valid YAML",
    "title: a\n  gravity: 9.81\n": ":2: not valid YAML",
    "title: 'open\n": "not valid YAML",
    "title: a\n\tgravity: 1\n": ":2: not valid YAML",
    "title: a\n---\ntitle: b\n": ":2: not valid YAML",
    "title: a\ntitle: b\n": ":2: title: the key is given twice",
    "title: !!python/object:os.system [ls]\n": ":1: title: tag",
    "title: !!python/object/apply:os.system ['ls']\n": "tags are not allowed",
    "gravity: !force 3\n": "tags are not allowed",
    "gravity: !!float abc\n": ":1: gravity: value 'abc' can't be read",
    "elements: !!int ''\n": ":1: elements: value '' can't be read",
    "water: !!set {a, b}\n": "tags are not allowed",
    "water: &a {density: *a}\n": "water.density: refers to itself",
    "? [1, 2]\n: 3\n": "a key must be one plain word",
    "water: *nothing\n": ":1: not valid YAML",
    "title: \x01\n": "not valid YAML",
    "<<: 3\n": "<< must be followed by an alias",
    "[" * 1000: "nested too deeply",
}  # fmt: skip


@pytest.mark.parametrize("text", BROKEN, ids=lambda text: repr(text[:30]))
def test_files_that_are_not_scenes(text: str, tmp_path: Path) -> None:
    lines = refused(tmp_path, write(tmp_path, text))
    assert len(lines) == 1
    assert lines[0].startswith(str(tmp_path / "case.yaml"))
    assert BROKEN[text] in lines[0]


def test_a_flood_of_aliases_is_refused(tmp_path: Path) -> None:
    levels = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    levels += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]" for n in range(1, 9)]
    assert "more than 1000000 values" in refused(tmp_path, write(tmp_path, "\n".join(levels)))[0]


def test_numbers_too_large_are_refused(tmp_path: Path) -> None:
    for number in ("1.0e400", "1" + "0" * 400, "1" * 5000):
        lines = refused(tmp_path, write(tmp_path, GOOD.replace("gravity: 9.81", f"gravity: {number}")))
        assert len(lines) == 1
        assert ":2: gravity: value" in lines[0]


def test_missing_file_and_folder(tmp_path: Path) -> None:
    (line,) = refused(tmp_path, tmp_path / "none.yaml")
    line_with([line], f"{tmp_path / 'none.yaml'}:", "no such file")
    assert "is a folder" in refused(tmp_path, tmp_path)[0]


def test_text_must_be_utf8(tmp_path: Path) -> None:
    file = tmp_path / "case.yaml"
    file.write_bytes(b"gravity: 9.81\ntitle: Fl\xe4che\n")
    (line,) = refused(tmp_path, file)
    line_with([line], f"{file}:2:", "not UTF-8")


UNWRITABLE = {
    'title: "a\\0b"\n': ('title: value "a\\u0000b": a text has no control characters, which U+0000 is', 1),
    'title: "a\\ud800"\n': ('title: value "a\\ud800": a text has no control characters, which U+D800 is', 1),
    'title: a\nline_types: {"b\\e\\0": {mass: 1.0}}\n': ("line_types.b\\x1b\\x00: value", 2),
}


@pytest.mark.parametrize("text", UNWRITABLE, ids=repr)
def test_characters_that_results_can_not_have(text: str, tmp_path: Path) -> None:
    says, line = UNWRITABLE[text]
    file = write(tmp_path, text)
    line_with(refused(tmp_path, file), f"{file}:{line}: {says}", "; leave them out")


def test_line_ends_and_other_scripts_are_text(tmp_path: Path) -> None:
    file = write(tmp_path, GOOD.replace("title: base", 'title: "Flexible \\t µ 管\\n second"'))
    assert run(["check", str(file)]).exit_code == 0


OVERRIDES = {
    "riser.segments.0.elments=3": 'riser.segments.0.elments: value 3: no such key here',
    "riser.segmets.0.elements=3": 'did you mean "segments"?',
    "riser.segments.7.elements=3": "riser.segments: a number from 0 to 0 must follow, not \"7\"",
    "riser.segments.x.elements=3": "riser.segments: a number from 0 to 0 must follow, not \"x\"",
    "title.a=3": 'title: value "base": has no parts',
    "gravity=heavy": 'gravity: value "heavy": must be a number',
    "gravity": "must be path=value",
    "=3": "must be path=value",
    "riser..x=3": "must be path=value",
    "gravity=[1": "not plain YAML",
    "gravity=": "gravity: value null: must be a number",
    "riser.segments.0.element_length=1.0": "leave one out",
}  # fmt: skip


@pytest.mark.parametrize("assignment", OVERRIDES)
def test_overrides_are_checked_like_the_file(assignment: str, tmp_path: Path) -> None:
    lines = refused(tmp_path, write(tmp_path, GOOD), "--set", assignment)
    assert len(lines) == 1
    assert OVERRIDES[assignment] in lines[0]
    if "leave one out" not in lines[0]:
        assert lines[0].startswith(f"--set {assignment}: ")


FREE_ENDS = {
    "riser.start=free": 'stages.0: value {"name": "bend"',
    "riser.start.rotation=free": "it has no equilibrium; set rotation: fixed",
    "stages.0.move={end: [70, 30, 1]}": "stages.0.move.end: value [70, 30, 1]: riser.end is free",
    "riser.initial=catenary": 'riser.initial: value "catenary": a catenary hangs between two ends with a position',
    "line_types.bar.GJ=null": "value null: needed in three dimensions (riser.unstressed.arc.axis leaves",
    "line_types.bar.mass=-1": "line_types.bar.mass: value -1: must be greater than 0",
}


@pytest.mark.parametrize("assignment", FREE_ENDS)
def test_a_riser_with_a_free_end(assignment: str, tmp_path: Path) -> None:
    scene = Path(__file__).with_name("bend45.yaml")
    assert any(FREE_ENDS[assignment] in line for line in refused(tmp_path, scene, "--set", assignment))


def test_a_run_must_be_there_to_begin_with(tmp_path: Path) -> None:
    (line,) = refused(tmp_path, write(tmp_path, GOOD), "--set", "initial={from: nowhere}")
    line_with([line], "initial.from:", 'value "nowhere":', "no such folder")
    (tmp_path / "empty").mkdir()
    assert "holds no finished run" in refused(tmp_path, write(tmp_path, GOOD), "--set", "initial.from=empty")[0]


def test_finished_run_is_not_overwritten(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "summary.json").write_text('{"finished": true}', encoding="utf-8")
    assert "--force" in refused(tmp_path, write(tmp_path, GOOD))[0]


def test_result_folder_must_not_be_a_file(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("mine", encoding="utf-8")
    line_with(refused(tmp_path, write(tmp_path, GOOD))[:1], f"{tmp_path / 'out'}:", "is a file")


@pytest.mark.parametrize("command", ["run", "check"])
def test_the_true_command(command: str, tmp_path: Path) -> None:
    file = write(tmp_path, GOOD.replace("length:", "lenght:"))
    call = [sys.executable, "-m", "riser_soil", command, "case.yaml"]
    done = subprocess.run(call, cwd=tmp_path, capture_output=True, text=True, timeout=HANGS, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert line.startswith("case.yaml:16: riser.segments.0.lenght: value 148.0:")
    line_with([line], "no such key", "line_type, length, elements, element_length", 'did you mean "length"?')
    assert list(tmp_path.iterdir()) == [file]
