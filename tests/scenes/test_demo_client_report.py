"""The demos of a client's report: their files fit each other, and one command writes a report with all chapters."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from demos.client_report.run import EXTREMES, FORMATS, HERE, MATRICES, commands, main
from demos.page import block
from riser_soil.cases.expansion import Case, read_cases
from riser_soil.fatigue.fatigue_file import read_fatigue_file
from riser_soil.report.report_file import read_report_file
from tests.support.on_ranks import ROOT
from tests.support.pages import text

FLEXIBLE = HERE.parent / "flexible_report"
SHORT = {  # of each file what is replaced by what
    "scene": {"duration: 3600.0": "duration: 40.0"},
    "storms": {
        "offsets: 5 %": "offsets: {near: [-60.0, 0.0], mean: [0.0, 0.0]}",
        "seeds: 3": "seeds: [2]",
        "60.0}": "20.0}",
    },
    "sea_states": {"since: 60.0": "since: 20.0"},
    "fatigue": {"skip: 60.0": "skip: 20.0"},
}


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return copied(HERE, tmp_path)


def copied(demo: Path, tmp_path: Path) -> Path:
    """A demo's input files, and beside them the vessel of the demo in waves."""
    folder = tmp_path / demo.name
    folder.mkdir()
    for file in demo.glob("*.yaml"):
        shutil.copy(file, folder)
    (tmp_path / "waves").mkdir()
    shutil.copy(HERE.parent / "waves" / "rao.csv", tmp_path / "waves")
    return folder


@pytest.fixture
def hung(place: Path) -> Path:
    """The scenes of the storms with folders in place of the runs at rest, which the storms name."""
    for soil in ("soft", "stiff"):
        (place / "results/at_rest/cases" / soil).mkdir(parents=True)
    return place


def cases_of(folder: Path, name: str) -> list[Case]:
    return read_cases(folder / f"{name}.yaml")[1]


def test_each_step_finds_what_those_before_it_leave(place: Path) -> None:
    """Folders and files by their names, without a run: each is made only when its step is reached."""
    made = {arguments[3]: arguments for arguments in commands(place, 2).values()}
    for name in MATRICES:
        assert str(place / "results" / name) in made
        for case in cases_of(place, name):  # storms name the folders of at_rest
            (place / "results" / name / "cases" / case.name).mkdir(parents=True)
    fatigue = read_fatigue_file(place / "fatigue.yaml")
    assert {place / case.run for case in fatigue.cases} == {*(place / "results/sea_states/cases").iterdir()}
    for name in ("damage", "modes"):
        assert str(place / "results" / name) in made
        (place / "results" / name).mkdir()
    given = read_report_file(place / "report.yaml")
    assert [*given.cases, given.fatigue, given.modes] == [
        place / "results" / name for name in ("storms", "damage", "modes")
    ]
    assert [Path(output).suffix[1:] for output in made][-3:] == [*FORMATS]


def test_it_has_the_load_cases_that_the_page_tells(hung: Path) -> None:
    storms = cases_of(hung, "storms")
    groups = {case.group_labels for case in storms}
    assert groups == {(offset, soil) for offset in ("near", "mean", "far") for soil in ("soft", "stiff")}
    assert len(storms) == 3 * len(groups)
    assert len(cases_of(hung, "sea_states")) == 8
    assert read_fatigue_file(hung / "fatigue.yaml").total_share == pytest.approx(1.0)


def test_functional_load_effects_are_those_of_the_storm_s_soil(hung: Path) -> None:
    grounds = {case.labels["soil"]: case.values for case in cases_of(hung, "at_rest")}
    for case in cases_of(hung, "storms"):
        functional = Path(case.values["code_check.0.functional_run"])
        assert grounds[functional.name].items() <= case.values.items()


def test_a_flexible_riser_has_no_fatigue_and_its_report_says_why(tmp_path: Path) -> None:
    place = copied(FLEXIBLE, tmp_path)
    reports = [f"report, {ending}" for ending in FORMATS]
    assert [*commands(place, 2)] == ["storms", "modes", *reports]
    storms = cases_of(place, "storms")
    assert len({case.group_labels for case in storms}) == 6
    assert len(storms) == 18
    for case in storms:
        (place / "results/storms/cases" / case.name).mkdir(parents=True)
    (place / "results/modes").mkdir()
    given = read_report_file(place / "report.yaml")
    assert given.fatigue is None
    assert [*given.not_assessed] == ["fatigue"]


@pytest.mark.parametrize("demo", [HERE, FLEXIBLE])
def test_the_page_has_the_tables_of_a_run(demo: Path) -> None:
    page = (demo / "README.md").read_text(encoding="utf-8")
    rows = {
        name: [row.split("|")[1].strip() for row in block(page, name).splitlines()[2:] if "|" in row]
        for name in ("found", "seconds")
    }
    shown = [row.rpartition(", ")[0] for row in rows["found"] if "seed" in row]
    assert shown == [quantity for quantity in EXTREMES if quantity in shown]
    assert ("of it, bend radius" in shown) == (demo == FLEXIBLE)
    steps = [step for step in commands(demo, 2) if step not in MATRICES]
    assert rows["seconds"][-len(steps) - 1 :] == [*steps, "all"]


@pytest.mark.verify
def test_one_command_writes_a_report_with_all_chapters(place: Path) -> None:
    for name, changes in SHORT.items():
        file = place / f"{name}.yaml"
        words = file.read_text(encoding="utf-8")
        for old, new in changes.items():
            assert words.count(old) == 1, f"{old} in {file}"
            words = words.replace(old, new)
        file.write_text(words, encoding="utf-8")
    main(place, 2, write_page=False)
    report = (place / "results/report.html").read_text(encoding="utf-8")
    chapters = re.findall(r"<h2 id[^>]*>(.*?)</h2>", report, re.DOTALL)
    titles = " ".join(re.sub(r"<[^>]+>", " ", each) for each in chapters)
    table = text(ROOT / "docs/report.md").partition("## What it has")[2].partition("\n\nA chapter")[0]
    expected = [
        row.split("|")[1].strip() for row in table.splitlines() if row.startswith("| ") and "| chapter" not in row
    ]
    assert len(expected) == 10
    assert [title for title in expected if title not in titles] == []
    for ending in FORMATS:
        assert (place / f"results/report.{ending}").stat().st_size > 1e5
