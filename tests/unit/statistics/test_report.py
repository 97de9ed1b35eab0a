"""The report of a recorded run: its tables against the summary, its page in a browser."""

from __future__ import annotations

import base64
import io
import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from riser_soil.__main__ import app
from riser_soil.errors import ResultsError, WriteError
from riser_soil.report.extremes import ends_table, error_bars, extremes_table
from riser_soil.report.extremes import key_results_table as key_results_of
from riser_soil.report.health import energy_table, versions_table, warnings_of
from riser_soil.report.report import compared_key_results_table as key_results_table
from riser_soil.report.report import differences_table, write_report
from riser_soil.report.scene_words import parts_table, pipes_table, prose, read, segments_table, stages_table
from riser_soil.report.tables import ReportTable, compact, number
from riser_soil.results import Run
from tests.support.browser import visit
from tests.support.on_ranks import ROOT
from tests.support.recorded_run import block, record
from tests.support.said import line_with, telling

SCENE = (ROOT / "demos/first_scene.yaml").read_text(encoding="utf-8")
WARNING = "elements are <long>"
BAR = {"stage": "heave", "name": "largest bending moment", "unit": "N.m", "value": 1.0, "bar": 12.0}


def recorded(folder: Path, scene: str = SCENE, **options: Any) -> Run:
    """A run that the recorder has seen, with the first scene's file."""
    record(folder, duration=0.4, picture_interval=0.2, **options)
    (folder / "scene.yaml").write_text(scene, encoding="utf-8")
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    summary["warnings"] = [WARNING]
    summary["error_bars"] = {"quantities": [BAR | {"by_source": {"mesh": 9.0, "time": 3.0}}]}
    (folder / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    return Run(folder)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return recorded(tmp_path_factory.mktemp("report") / "run", mesh=block(8, 4, 2))


@pytest.fixture(scope="module")
def page(run: Run) -> Path:
    file = run.folder.parent / "report.html"
    done = CliRunner().invoke(app, ["report", str(run.folder), "-o", str(file)])
    assert (done.exit_code, done.output.strip()) == (0, str(file))
    return file


def images(page: Path) -> Iterator[tuple[str, bytes]]:
    """Type and content of the page's pictures."""
    for kind, data in re.findall(r'src="data:image/([^;]+);base64,([^"]*)"', page.read_text(encoding="utf-8")):
        yield kind, base64.b64decode(data)


def row(table: ReportTable, *words: str) -> dict[str, str]:
    """The row that begins with these words, by the heads of the columns; a head that comes twice keeps both."""
    found = next(row for row in table.rows if tuple(row[: len(words)]) == words)
    named = [f"{head}{'' if head not in table.head[:n] else ' (2)'}" for n, head in enumerate(table.head)]
    return dict(zip(named, found, strict=True))


def test_the_page_needs_nothing_else(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert not re.search(r"<script|<link [^>]*href=\"(?!data:)|@import|url\(|(src|href)=\"(?!data:|#)", text)
    kinds = [kind for kind, _ in images(page)]
    assert kinds.count("png") == 1
    assert kinds.count("svg+xml") > 12
    for kind, content in images(page):
        if kind == "png":
            assert Image.open(io.BytesIO(content)).size == (1600, 900)
        else:
            drawing = ElementTree.fromstring(content)
            assert len(list(drawing.iter("{http://www.w3.org/2000/svg}path"))) > 10
            assert not list(drawing.iter("{http://www.w3.org/2000/svg}text")), "letters are drawn: no font is needed"


def test_the_page_tells_all_that_it_should(page: Path) -> None:
    text = re.sub(r'src="[^"]*"', "", page.read_text(encoding="utf-8"))
    assert "elements are &lt;long&gt;" in text
    for words in (
        *("Headline quantities", "A riser of 148 m", "Line types", "Stage lay (static)", "Stage heave (dynamic)"),
        *("Along the riser", "Ends, touchdown and contact in time", "Shapes", "Soil", "Energy balance"),
        *("How it was solved", "How to reproduce it", "riser-soil run scene.yaml", "@page", "trough across the riser"),
    ):
        assert words in text, words
    assert SCENE.splitlines()[0] in text


def test_a_browser_opens_the_page(page: Path, tmp_path: Path) -> None:
    shot = tmp_path / "page.png"
    seen = visit(page, "--dump-dom", f"--screenshot={shot}", "--window-size=1200,2400")
    assert seen.console == []
    assert "Stage heave (dynamic)" in seen.printed
    pixels = np.asarray(Image.open(shot).convert("RGB")).astype(int)
    assert pixels.shape[:2] == (2400, 1200)
    assert 0.02 < (pixels.sum(axis=2) < 600).mean() < 0.6, "text and pictures on white"
    assert (np.ptp(pixels, axis=2) > 60).mean() > 0.01, "pictures in colour"


def test_the_page_prints_on_pages(page: Path, tmp_path: Path) -> None:
    visit(page, f"--print-to-pdf={tmp_path / 'page.pdf'}", "--no-pdf-header-footer")
    pdf = (tmp_path / "page.pdf").read_bytes()
    assert pdf.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b", pdf)) > 3


def test_one_run_begins_on_the_first_page(page: Path) -> None:
    """In print a run begins a page, but for one that the title alone would stand before."""
    text = page.read_text(encoding="utf-8")
    assert re.search(r"header \+ section\.run \{\s*break-before: auto\b", text)
    assert re.search(r'</header>\s*<section class="run"', text)


def test_the_browser_would_tell(tmp_path: Path) -> None:
    broken = tmp_path / "broken.html"
    broken.write_text("<script>throw new Error('no good')</script>", encoding="utf-8")
    assert any("no good" in line for line in visit(broken, "--dump-dom").console)


def test_extremes_have_times_places_and_error_bars(run: Run) -> None:
    stage = run.summary["stages"][1]
    reported = row(extremes_table(run.summary, stage), "largest bending moment")
    known = stage["extremes"]["max_bending_moment"]
    assert float(reported["max"]) == pytest.approx(1e-3 * known["max"], rel=1e-4)
    assert float(reported["at t [s] (2)"]) == pytest.approx(known["t_max"], rel=1e-3)
    assert float(reported["at arc [m] (2)"]) == pytest.approx(known["arc_max"], rel=1e-4)
    assert error_bars(run.summary, "heave") == {("max_bending_moment", "max"): 12.0}
    assert "0.012" in reported.values(), "of 12 N.m"
    first = row(key_results_of(run.summary), "heave", "largest bending moment")
    assert (first["±"], first["by mesh"], first["by time"]) == ("0.012", "0.009", "0.003")


def test_energy_and_versions_and_warnings(run: Run) -> None:
    stage = run.summary["stages"][1]
    reported = row(energy_table(stage), "put in since the stage began; negative where it was taken out")
    assert float(reported["kJ"]) == pytest.approx(1e-3 * stage["energy"]["work"], rel=1e-4)
    assert float(reported["% of turned over"]) == pytest.approx(100.0)
    assert ("riser_soil", "0.1.0") in [tuple(row) for row in versions_table(run.summary).rows]
    assert warnings_of(run.summary)[0] == WARNING


def test_the_scene_in_words(run: Run) -> None:
    scene = read(run)
    assert scene is not None
    line_with(prose(scene, run), "ground", "spring seabed")
    assert row(pipes_table(scene), "flexible")["EI [N.m²]"] == "50000"
    assert row(segments_table(scene), "flexible")["to arc [m]"] == "50"
    reported = row(parts_table(scene), "seabed.stiffness")
    assert (reported["value"], reported["unit"]) == ("100000", "N/m2")
    assert row(stages_table(scene), "heave.motion.end.harmonic.period")["value"] == "10"


def test_contents_ends_and_walls_of_the_scene(run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    shutil.copytree(run.folder, folder)
    wall = "EA: 3.0e8\n    wall: {yield_stress: 448.0e6, design_factor: 0.67}"
    pressed = SCENE.replace("EA: 3.0e8", wall).replace("{density: 850.0}", "{density: 850.0, pressure: 2.0e7}")
    surfaced = pressed.replace("water: {density: 1025.0}", "water: {density: 1025.0, surface_level: 110.0}")
    graded = surfaced.replace("element_length: 2.0", "element_length: [1.0, 4.0]")
    (folder / "scene.yaml").write_text(graded, encoding="utf-8")
    reported = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    reported["hang_off"] = {"end": "end", "asked": {"tension": 9e4}, "by": "layback", "value": 81.25}
    (folder / "summary.json").write_text(json.dumps(reported), encoding="utf-8")
    scene = read(Run(folder))
    assert scene is not None
    pipe = row(pipes_table(scene), "flexible")
    assert (pipe["yield stress [Pa]"], pipe["design factor [-]"]) == ("4.48e+08", "0.67")
    assert "damping ratio [-]" not in pipe
    line_with(segments_table(scene).rows[1][-1], "elements", "1 to 4 m")
    assert row(parts_table(scene), "riser.contents.pressure")["unit"] == "Pa"
    assert row(parts_table(scene), "riser.end.position")["value"] == "(80, 0, 100)"
    assert row(parts_table(scene), "riser.end.rotation")["unit"] == "", "free has none"
    line_with(prose(scene, Run(folder)), "end hangs off", "90 kN", "layback of 81.25 m")


def test_components_of_round_off_are_left_out(run: Run) -> None:
    stage = json.loads(json.dumps(run.summary["stages"][1]))
    largest = stage["final"]["max_bending_moment"]["value"]
    reported = {"min": [0.0, -1e-13 * largest, 0.0], "max": [0.0, 1e-3 * largest, 1e-12 * largest]}
    stage["final"]["start"]["moment"], stage["final"]["end"]["moment"] = [0.0, 1e-13 * largest, 0.0], [0.0] * 3
    stage["extremes"]["start"]["moment"] |= reported
    stage["extremes"]["end"]["moment"] |= {"min": reported["min"], "max": [0.0] * 3}
    table = ends_table(stage)
    (moment,) = (words for words, *_ in table.rows if "moment" in words)
    assert row(table, line_with([moment], "moment", "start, y"))["at the end"] == "0"
    assert "moment at the end" not in table.note


def test_two_runs_side_by_side(run: Run, tmp_path: Path) -> None:
    other = recorded(tmp_path / "other", SCENE.replace("1.0e5", "2.0e4"))
    runs = {"one": run, "other": other}
    assert [tuple(row) for row in differences_table(runs).rows if row[0] == "seabed.stiffness"] == [
        ("seabed.stiffness", "100000.0", "20000.0")
    ]
    changed = other.summary["stages"][1]["extremes"]["max_bending_moment"]
    changed["max"] *= 1.1
    reported = row(key_results_table(runs), "heave: largest bending moment")
    assert [value for head, value in reported.items() if "differs from one" in head] == ["+10"]


@pytest.mark.parametrize(
    ("value", "reported"),
    [
        *((None, "–"), (float("nan"), "–"), (0.0, "0"), (1543.21, "1543.2")),
        *((123456.7, "123457"), (1.5e-7, "1.5e-07"), (3e8, "3e+08")),
    ],
)
def test_numbers_read_well(value: float | None, reported: str) -> None:
    assert number(value) == reported


def test_columns_without_anything_are_left_out() -> None:
    sparse = ReportTable(("a", "b", "c"), [["1", "", "2"], ["3", "–", ""]])
    assert compact(sparse) == ReportTable(["a", "c"], [["1", "2"], ["3", ""]])


def test_a_run_whose_scene_is_gone_is_reported_without_it(run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    shutil.copytree(run.folder, folder)
    (folder / "scene.yaml").unlink()
    reported = write_report([folder], tmp_path / "report.html").read_text(encoding="utf-8")
    line_with(reported, "# scene.yaml", "can&#39;t be read:", "No such file")
    assert "Stage heave (dynamic)" in reported


def test_what_cannot_be_reported_is_said(run: Run, tmp_path: Path) -> None:
    with pytest.raises(WriteError, match="there is no folder"):
        write_report([run.folder], tmp_path / "nowhere" / "report.html")
    with pytest.raises(ResultsError, match=telling(f"{tmp_path}:", "not the folder")):
        write_report([tmp_path], tmp_path / "report.html")
    with pytest.raises(ResultsError, match=telling('"storm"', "no stage")):
        write_report([run.folder], tmp_path / "report.html", "storm")
    assert not [*tmp_path.glob("*.html"), *tmp_path.glob(".*")]
    done = CliRunner().invoke(app, ["report", str(run.folder), "-o", str(tmp_path / "report.pdf")])
    assert done.exit_code == 2
    line_with(done.output, "report.pdf:", ".html file")
