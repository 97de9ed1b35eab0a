"""`import` writes checked scenes alone: it says what `check` says, with the lines of the other program's file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from riser_soil.commands import imports
from riser_soil.commands.app import app
from riser_soil.errors import SceneError
from riser_soil.imported_scene import ImportedScene, text_of
from riser_soil.scene.problem import Path as KeyPath
from riser_soil.scene.reader import read_scene
from tests.support.said import line_with
from tests.support.scenes import ON_SEABED, overlaid

LINES: dict[KeyPath, int] = {("line_types", "pipe"): 7, ("riser",): 12, ("riser", "end"): 15, ("stages",): 30}
REMARK = (9, "a setting of its own")
LOADED = {"name": "hang", "kind": "static", "loads": [{"at": 70.0, "force": [0.0, 0.0, 500.0]}]}


def imported(piece: dict[str, Any], folder: Path, monkeypatch: pytest.MonkeyPatch) -> Result:
    """The command, of a file whose importer gives the small scene with a piece laid over it."""
    given = ImportedScene(overlaid(ON_SEABED, piece), [REMARK], {"given_table.csv": "1, 2\n"}, LINES)
    monkeypatch.setattr(imports, "_imported", lambda *_: given)
    monkeypatch.chdir(folder)
    return CliRunner().invoke(app, ["import", "line.dat"])


def test_it_ends_with_what_check_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A warning about a key has the line that the key's value, or what it is part of, comes from."""
    stages = [LOADED, {"name": "hold", "kind": "static"}]
    done = imported({"stages": stages}, tmp_path, monkeypatch)
    assert done.exit_code == 0, done.output
    line_with(done.output, "line.dat:9:", "not carried over:", REMARK[1])
    line_with(done.output, "line.yaml:", "written;", "1 entries")
    line_with(done.output, "warning:", "line.dat:30:", "stages.0.loads.0:", "ends with its stage")
    checked = CliRunner().invoke(app, ["check", "line.yaml"])
    assert done.output.splitlines()[-1] == checked.output.splitlines()[-1]
    assert {place.name for place in tmp_path.iterdir()} == {"line.yaml", "given_table.csv"}
    assert read_scene("line.yaml").stages[0].name == "hang"


def test_a_warning_about_one_of_several_lines_has_its_line_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    own = {"east": ON_SEABED["riser"]}
    stages = [{"name": "hang", "kind": "static", "lines": {"east": {"loads": LOADED["loads"]}}},
              {"name": "hold", "kind": "static"}]  # fmt: skip
    given = ImportedScene({**ON_SEABED, "lines": own, "stages": stages}, [], {}, LINES)
    del given.data["riser"]
    monkeypatch.setattr(imports, "_imported", lambda *_: given)
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["import", "line.dat"])
    assert done.exit_code == 0, done.output
    line_with(done.output, "warning:", "line.dat:30:", "stages.0.lines.east.loads.0:", "ends with its stage")


@pytest.mark.parametrize(
    ("piece", "words"),
    [
        ({"line_types": {"pipe": {"mass": -1.0}}}, ("line.dat:7:", "line_types.pipe.mass:", "value -1.0")),
        ({"riser": {"end": {"position": [800.0, 0.0, 10.0]}}}, ("line.dat:15:", "riser.end.position:")),
        ({"line_types": {"pipe": {"submerged_weight": 0.0}}}, ("line.dat:12:", "riser.initial:", "catenary")),
        ({"gravity": "heavy"}, ("line.dat:", "gravity:", 'value "heavy"')),
    ],
    ids=["of the scene language", "of values together", "of what is built", "from no line"],
)
def test_what_a_run_would_refuse_is_not_written(
    piece: dict[str, Any], words: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    done = imported(piece, tmp_path, monkeypatch)
    assert done.exit_code == 2
    line_with(done.output, "line.dat:9:", "not carried over:", REMARK[1])
    line_with(done.output, "line.dat:", "none is written")
    line_with(done.output, *words)
    assert [*tmp_path.iterdir()] == []


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_texts_of_other_programs_come_in_several_encodings(encoding: str, tmp_path: Path) -> None:
    file = tmp_path / "deck.dat"
    file.write_bytes("Kette für 40 m³\n".encode(encoding))
    assert text_of(file) == "Kette für 40 m³\n"


def test_what_is_no_text_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "deck.dat"
    file.write_bytes(b"chain\0 0.1 120.0\n")
    with pytest.raises(SceneError, match=r"deck\.dat: is no text, .* save it as text in UTF-8"):
        text_of(file)
