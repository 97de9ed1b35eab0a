"""The report file: what it takes, and one clear line for what it does not."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from riser_soil.commands.app import app
from riser_soil.errors import ResultsError, SceneError
from riser_soil.report.report_file import ReportFile, of_folders, read_report_file
from riser_soil.report.sources import opened
from tests.support.on_ranks import ROOT
from tests.support.pages import blocks
from tests.support.recorded_run import record
from tests.support.said import line_with


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with runs, one, other/one and a folder of cases that has none that is done."""
    folder = tmp_path_factory.mktemp("place")
    record(folder / "one", duration=0.4)
    record(folder / "other" / "one", duration=0.4)
    (folder / "cases").mkdir()
    (folder / "cases" / "cases.csv").write_text("case,status,reason\na,3,diverged\n", encoding="utf-8")
    return folder


def written(place: Path, text: str) -> Path:
    file = place / "report.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_names_and_lists_may_be_short(place: Path) -> None:
    given = read_report_file(written(place, "runs: one\nauthors: A. B.\n"))
    assert given.runs == {"one": str(place / "one")}
    assert given.authors == ("A. B.",)
    named = read_report_file(written(place, "runs: {near: one, far: other/one}\nauthors: [A, B]\nrequired_life: 25.0"))
    assert list(named.runs) == ["near", "far"]
    both = read_report_file(written(place, "runs: [one, other/one]"))
    assert list(both.runs) == ["one", "other/one"]


def test_options_take_the_place_of_keys(place: Path) -> None:
    file = written(place, "runs: one\nrevision: A\nclient: C\n")
    given = read_report_file(file, {"revision": "B"})
    assert (given.revision, given.client) == ("B", "C")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("runs: one\nclint: X", ("report.yaml:2: clint", "client")),
        ("client: X", ("report.yaml:1: runs", "neither runs nor cases")),
        ("runs: lost", ("runs.lost:", "not the folder of a run")),
        ("runs: one\ncases: lost", ("report.yaml:2: cases", "no such folder")),
        ("runs: one\nlogo: report.yaml", ("report.yaml:2: logo", ".png")),
        ("runs: one\nrequired_life: -1", ("report.yaml:2: required_life", "greater than 0")),
        ("runs: one\nstatistics: lost.json", ("report.yaml:2: statistics", "no such file")),
        ("runs: one\nmodes: one\nnot_assessed: {modes: none}", ("report.yaml:3: not_assessed", "given as modes")),
        ("runs: one\nnot_assessed: {weather: none}", ("report.yaml:2: not_assessed", "has weather")),
        ("", ("report file is empty",)),
        ("line_types: {}", ("is a scene, and a report file is wanted",)),
    ],
)
def test_what_is_wrong_is_one_line(place: Path, text: str, says: tuple[str, ...]) -> None:
    with pytest.raises(SceneError) as caught:
        read_report_file(written(place, text))
    line_with(str(caught.value), *says)
    assert "\n" not in str(caught.value)


def test_folders_are_known_by_their_files(place: Path) -> None:
    given = of_folders([place / "one", place / "cases"], {"client": "C"})
    assert (list(given.runs), [folder.name for folder in given.cases], given.client) == (["one"], ["cases"], "C")
    (place / "f").mkdir()
    (place / "f" / "fatigue.json").write_text("{}", encoding="utf-8")
    with pytest.raises(SceneError, match="second folder"):
        of_folders([place / "one", place / "f", place / "f"], {})


def test_what_cannot_be_opened_is_said(place: Path) -> None:
    with pytest.raises(ResultsError, match="no case of it is done"):
        opened(of_folders([place / "cases"], {}))
    with pytest.raises(ResultsError, match='reference "lost" is none of the cases; it can be one of one'):
        opened(of_folders([place / "one"], {"reference": "lost"}))
    with pytest.raises(ResultsError, match="is not a file of riser-soil statistics"):
        opened(of_folders([place / "one"], {"statistics": [str(place / "one" / "summary.json")]}))


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["one", "-o", "report.txt"], ("report.txt:", ".html", ".pdf", ".docx")),
        (["report.yaml", "one"], ("report.yaml:", "is given alone")),
        (["one", "--required-life", "-3"], ("required_life",)),
        (["lost"], ("lost", "not the folder of a run")),
    ],
)
def test_the_command_says_what_is_wrong(
    place: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], says: tuple[str, ...]
) -> None:
    written(place, "runs: one")
    monkeypatch.chdir(place)
    done = CliRunner().invoke(app, ["report", *arguments])
    assert done.exit_code == 2
    line_with(done.output, *says)


def test_the_report_file_of_the_page_is_valid(tmp_path: Path) -> None:
    """The file is read with folders of these names beside it; the page's table has every key."""
    page = ROOT / "docs/report.md"
    (text,) = blocks(page, "yml")
    record(tmp_path / "results" / "base", duration=0.4)
    for folder in ("offsets", "soils", "damage", "modes"):
        (tmp_path / "results" / folder).mkdir()
    (tmp_path / "results" / "extremes.json").write_text("[]", encoding="utf-8")
    given = read_report_file(written(tmp_path, text))
    assert (given.required_life, given.revision, [*given.runs]) == (25.0, "A", ["base"])
    rows = [row.split("|")[1] for row in page.read_text(encoding="utf-8").splitlines() if row.startswith("| `")]
    assert set(ReportFile.model_fields) <= {name.strip(" `") for row in rows for name in row.split(",")}
