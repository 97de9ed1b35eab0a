"""The report of a recorded run: its chapters against the summary, its page in a browser and on paper."""

from __future__ import annotations

import base64
import io
import json
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest.mock import patch
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib import rc_context
from matplotlib.text import Text
from PIL import Image
from typer.testing import CliRunner

from riser_soil.__main__ import app
from riser_soil.errors import ResultsError, WriteError
from riser_soil.plots.album import TouchdownView
from riser_soil.plots.curves import STYLE, Curves
from riser_soil.report.document import Heading, Item, Paragraph, PictureBlock, Points, TableBlock, numbered
from riser_soil.report.extremes import error_bars, key_results_table, reactions_table
from riser_soil.report.health import energy_table, versions_table, warnings_of
from riser_soil.report.inputs import input_rows
from riser_soil.report.report import document_of, write_report
from riser_soil.report.report_file import of_folders
from riser_soil.report.sources import opened
from riser_soil.report.tables import ReportTable, compact, number
from riser_soil.results import Run
from riser_soil.soil.kinematic_hardening import KinematicHardening
from tests.support.on_ranks import ROOT
from tests.support.recorded_run import block, record
from tests.support.said import line_with, telling

NAMES = ("chromium-headless-shell", "chromium")
QUIET = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync"),
    *("--disable-background-networking", "--disable-component-update", "--enable-logging=stderr", "--v=0"),
)


@dataclass(frozen=True)
class Visit:
    """What the browser printed, and the messages of its console."""

    printed: str
    console: list[str]


def visit(page: Path, *options: str) -> Visit:
    """Opens a page in an empty profile, by options such as --dump-dom, --screenshot=FILE and --print-to-pdf=FILE."""
    program = next((path for name in NAMES if (path := shutil.which(name))), None)
    assert program is not None, f"none of {', '.join(NAMES)} is installed; make setup does it"
    with tempfile.TemporaryDirectory() as profile:
        call = [program, *QUIET, f"--user-data-dir={profile}", *options, page.resolve().as_uri()]
        done = subprocess.run(call, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return Visit(done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line])


SCENE = (ROOT / "demos/first_scene.yaml").read_text(encoding="utf-8")
WARNING = "elements are <long>"
BAR = {"stage": "heave", "name": "largest bending moment", "unit": "N.m", "value": 1.0, "bar": 12.0}
JARGON = ("left out", "told", "looks", "figure ", "turned over", "headline", "null", "None", "nan", "greatest")


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


# Where nobody looks at the picture of the touchdown zone, which takes longer to draw than all else does together.
NOT_DRAWN = patch.object(TouchdownView, "png", b"not drawn")


@NOT_DRAWN
def document(folder: Path, **given: str) -> list[Item]:
    """What stands in a run's report."""
    return numbered(document_of(opened(of_folders([folder], given))))


@pytest.fixture(scope="module")
def items(run: Run) -> list[Item]:
    return document(run.folder, client="A <client>", document="X-1")


@pytest.fixture(scope="module")
def page(run: Run) -> Path:
    file = run.folder.parent / "report.html"
    options = ["--client", "A <client>", "--document", "X-1", "--author", "A", "--author", "B"]
    done = CliRunner().invoke(app, ["report", str(run.folder), "-o", str(file), *options])
    assert (done.exit_code, done.output.strip()) == (0, str(file))
    return file


def images(page: Path) -> Iterator[tuple[str, bytes]]:
    """Type and content of the page's pictures."""
    for kind, data in re.findall(r'src="data:image/([^;]+);base64,([^"]*)"', page.read_text(encoding="utf-8")):
        yield kind, base64.b64decode(data)


def table(items: list[Item], key: str) -> ReportTable:
    return next(item.content for item in items if isinstance(item, TableBlock) and item.key == key)


def row(content: ReportTable, *words: str) -> dict[str, str]:
    """The row that begins with these words, by the heads of the columns; a head that comes twice keeps both."""
    match = next(row for row in content.rows if tuple(row[: len(words)]) == words)
    named = [f"{head}{'' if head not in content.head[:n] else ' (2)'}" for n, head in enumerate(content.head)]
    return dict(zip(named, match, strict=True))


def texts(items: list[Item]) -> Iterator[str]:
    """All words of a document but those of scenes."""
    for item in items:
        match item:
            case Heading():
                yield item.title
            case Paragraph():
                yield item.text
            case Points():
                yield from item.items
            case TableBlock():
                yield from (item.caption, item.content.note, *item.content.head)
                yield from (cell for cells in item.content.rows for cell in cells)
            case PictureBlock():
                yield item.caption


def test_the_page_needs_nothing_else(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert not re.search(r"<script|<link [^>]*href=\"(?!data:)|@import|url\((?!attr)|(src|href)=\"(?!data:|#)", text)
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


def test_chapters_stand_in_the_order_of_a_design_report(items: list[Item]) -> None:
    assert [item.title for item in items if isinstance(item, Heading) and item.level == 1] == [
        "Summary", "Basis", "Static configuration", "Extremes", "Code checks", "Numerical quality",
        "How to reproduce the results", "Input file",
    ]  # fmt: skip


def test_the_page_has_cover_contents_and_numbers(page: Path) -> None:
    text = re.sub(r'src="[^"]*"', "", page.read_text(encoding="utf-8"))
    for words in (
        *("<th>Client</th><td>A &lt;client&gt;</td>", "<td>A, B</td>", "<h1>Touchdown on soft clay</h1>"),
        *('<a href="#section-4.1">', "<b>Table 1</b>", "<b>Figure 1</b>", "elements are &lt;long&gt;", "@page"),
        *("riser-soil run scene.yaml", "title: First scene", 'content: "X-1 · Touchdown on soft clay"'),
    ):
        assert words in text, words
    numbers = [int(n) for n in re.findall(r"<b>Figure (\d+)</b>", text)]
    assert numbers == [*range(1, len(numbers) + 1)]


def test_no_word_of_the_program_no_null_and_no_path(run: Run, page: Path, items: list[Item]) -> None:
    words = "\n".join(text for text in texts(items) if WARNING not in text)
    assert [each for each in JARGON if re.search(rf"\b{each}", words)] == []
    text = re.sub(r'src="[^"]*"', "", page.read_text(encoding="utf-8"))
    assert str(run.folder.parent) not in text
    scene = re.findall(r"<pre>(.*?)</pre>", text, re.DOTALL)[-1]
    assert "null" not in scene
    assert not re.search(r"[\[{]\s*[\]}]", scene), "nothing empty"


def test_figures_can_be_read_on_paper(items: list[Item]) -> None:
    """No wider than the text of A4, no letter under 7 pt, as they are printed in their size."""
    drawn = [item for item in items if isinstance(item, PictureBlock) and isinstance(item.drawing, Curves)]
    assert len(drawn) > 10
    for item in drawn:
        assert isinstance(item.drawing, Curves)
        with rc_context(STYLE):
            figure = item.drawing.draw()
        assert 25.4 * figure.get_figwidth() <= 210.0 - 2 * 20.0 + 0.5, item.caption
        sizes = [float(text.get_fontsize()) for text in figure.findobj(Text) if text.get_text().strip()]
        assert min(sizes) >= 7.0, item.caption


def test_a_browser_opens_the_page(page: Path, tmp_path: Path) -> None:
    shot = tmp_path / "page.png"
    output = visit(page, "--dump-dom", f"--screenshot={shot}", "--window-size=1200,2400")
    assert output.console == []
    assert "Static configuration" in output.printed
    pixels = np.asarray(Image.open(shot).convert("RGB")).astype(int)
    assert pixels.shape[:2] == (2400, 1200)
    assert 0.02 < (pixels.sum(axis=2) < 600).mean() < 0.6, "text and pictures on white"


def test_the_page_prints_on_pages(page: Path, tmp_path: Path) -> None:
    visit(page, f"--print-to-pdf={tmp_path / 'page.pdf'}", "--no-pdf-header-footer")
    pdf = (tmp_path / "page.pdf").read_bytes()
    assert pdf.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b", pdf)) > 3


def test_the_browser_would_tell(tmp_path: Path) -> None:
    broken = tmp_path / "broken.html"
    broken.write_text("<script>throw new Error('no good')</script>", encoding="utf-8")
    assert any("no good" in line for line in visit(broken, "--dump-dom").console)


def test_the_summary_has_the_values_of_the_run_in_units_of_the_field(run: Run, items: list[Item]) -> None:
    stage = run.summary["stages"][1]
    moment = stage["extremes"]["max_bending_moment"]
    entry = row(table(items, "summary"), "maximum bending moment")
    value, bar = entry["value"].split(" ± ")
    assert float(value) == pytest.approx(1e-3 * moment["max"], rel=1e-3)
    assert float(bar) == pytest.approx(0.012)
    assert (entry["unit"], entry["load step"], entry["load case"]) == ("kN m", "heave", "run")
    assert float(entry["arc length [m]"]) == pytest.approx(moment["arc_max"], rel=1e-4)
    assert float(entry["time [s]"]) == pytest.approx(moment["t_max"], rel=1e-3)
    radius = row(table(items, "summary"), "minimum bend radius (MBR)")
    assert float(radius["value"]) == pytest.approx(stage["extremes"]["min_bend_radius"]["min"], rel=1e-3)
    use = stage["extremes"]["max_bend_utilisation"]["max"]
    assert float(radius["utilisation [-]"]) == pytest.approx(use, abs=6e-4)
    angles = [90.0 - abs(stage["extremes"]["end"]["angle_deg"][side]) for side in ("min", "max")]
    angle = row(table(items, "summary"), "maximum hang-off angle from the vertical")
    assert float(angle["value"]) == pytest.approx(max(angles), rel=1e-3)


def test_there_is_one_maximum(run: Run, tmp_path: Path) -> None:
    """Tables have the summary's, between nodes; the legend of the curve does not name another one at a node."""
    shutil.copytree(run.folder, tmp_path / "run")
    summary = json.loads((tmp_path / "run" / "summary.json").read_text(encoding="utf-8"))
    moment = summary["stages"][1]["extremes"]["max_bending_moment"]
    moment["max"], moment["arc_max"] = 1.07 * moment["max"], 33.33
    (tmp_path / "run" / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    items, known = document(tmp_path / "run"), 1e-3 * moment["max"]
    rows = (row(table(items, key), "maximum bending moment") for key in ("summary", "governing"))
    assert {each["value"].split(" ± ")[0] for each in rows} == {number(known, 4)}
    begins = "Bending moment along the line, load"
    picture = next(item for item in items if isinstance(item, PictureBlock) and item.caption.startswith(begins))
    assert isinstance(picture.drawing, Curves)
    legend = picture.drawing.draw().axes[0].get_legend_handles_labels()[1]
    line_with(legend, "max, largest", f"{known:.4g} at 33.33 m")


def test_reactions_count_from_the_vertical_and_leave_round_off_away(run: Run) -> None:
    stage = json.loads(json.dumps(run.summary["stages"][1]))
    largest = stage["final"]["max_bending_moment"]["value"]
    for end in ("start", "end"):
        stage["final"][end]["moment"] = [0.0, 1e-13 * largest, 0.0]
        stage["extremes"][end]["moment"] |= {"min": [0.0] * 3, "max": [0.0, 1e-5 * largest, 0.0]}
    words = [words for words, *_ in reactions_table(stage).rows]
    assert not [each for each in words if "moment" in each]
    stage["extremes"]["start"]["moment"]["max"] = [0.0, 0.1 * largest, 0.0]
    entry = row(reactions_table(stage), "end A: moment, y")
    assert float(entry["max."]) == pytest.approx(1e-4 * largest, rel=1e-3)
    angle = row(reactions_table(stage), "end B: angle from the vertical")
    given = stage["extremes"]["end"]["angle_deg"]
    assert float(angle["min."]) == pytest.approx(90.0 - given["max"], rel=1e-3)
    assert float(angle["at t [s]"]) == pytest.approx(given["t_max"], rel=1e-3)


def test_error_bars_have_their_parts(run: Run) -> None:
    assert error_bars(run.summary, "heave") == {("max_bending_moment", "max"): 12.0}
    first = row(key_results_table(run.summary), "heave", "maximum bending moment")
    assert (first["±"], first["by mesh"], first["by time"]) == ("0.012", "0.009", "0.003")


def test_energy_and_versions_and_warnings(run: Run, items: list[Item]) -> None:
    stage = run.summary["stages"][1]
    entry = row(energy_table(stage), "work of external forces on line and ground since the load step began")
    assert float(entry["kJ"]) == pytest.approx(1e-3 * stage["energy"]["work"], rel=1e-4)
    assert float(entry["% of the largest"]) == pytest.approx(100.0)
    assert ("riser_soil", "0.1.0") in [tuple(row) for row in versions_table(run.summary).rows]
    assert warnings_of(run.summary)[0] == WARNING
    assert [item for item in items if isinstance(item, Points) and WARNING in item.items]


def test_the_basis_has_the_scene_in_units_of_the_field(items: list[Item]) -> None:
    pipe = next(item.content for item in items if isinstance(item, TableBlock) and "line types" in item.caption)
    assert row(pipe, "bending stiffness EI")["flexible"] == "50"
    assert row(pipe, "outer diameter")["unit"] == "mm"
    ground = next(item.content for item in items if isinstance(item, TableBlock) and item.caption == "Ground")
    assert row(ground, "stiffness per length of pipe") == {
        "quantity": "stiffness per length of pipe", "value": "100", "unit": "kN/m²",
    }  # fmt: skip
    line_with("\n".join(texts(items)), "850 kg/m³")
    line_with("\n".join(texts(items)), "load step heave", "end B moves", "(0, 0, 1.5) m", "10 s")


def test_the_input_of_a_law_is_in_units_of_the_field() -> None:
    given = {"kind": "kinematic-hardening", "su": 2.0e3, "su_gradient": 1.5e3, "E_over_su": 300.0, "nu": 0.49}
    rows = input_rows(KinematicHardening.model_validate(given))
    assert rows[:3] == [
        ["law", "kinematic-hardening", ""], ["undrained shear strength at the mudline", "2", "kPa"],
        ["its gradient with depth", "1.5", "kPa/m"],
    ]  # fmt: skip


def test_without_a_code_check_that_is_said(run: Run, items: list[Item], tmp_path: Path) -> None:
    def said(items: list[Item]) -> list[str]:
        return [item.text for item in items if isinstance(item, Paragraph) and "No code check" in item.text]

    assert table(items, "checks").rows
    assert said(items) == []
    shutil.copytree(run.folder, tmp_path / "run")
    summary = json.loads((tmp_path / "run" / "summary.json").read_text(encoding="utf-8"))
    for stage in summary["stages"]:
        del stage["code_check"]
    (tmp_path / "run" / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    unchecked = said(document(tmp_path / "run"))
    assert len(unchecked) == 2, "in the summary and in its chapter"


def test_walls_contents_and_hang_off_of_the_scene(run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    shutil.copytree(run.folder, folder)
    wall = "EA: 3.0e8\n    wall: {yield_stress: 448.0e6, design_factor: 0.67}"
    pressed = SCENE.replace("EA: 3.0e8", wall).replace("{density: 850.0}", "{density: 850.0, pressure: 2.0e7}")
    waves = "surface_level: 110.0, waves: {jonswap: {Hs: 3.0, Tp: 9.0, seed: 7}}"
    flow = "current: {profile: [[0.0, 0.1, 0.0], [110.0, 0.6, 0.0]]}"
    wet = pressed.replace("water: {density: 1025.0}", f"water: {{density: 1025.0, {waves}, {flow}}}")
    (folder / "scene.yaml").write_text(wet, encoding="utf-8")
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    summary["hang_off"] = {"end": "end", "asked": {"tension": 9e4}, "by": "layback", "value": 81.25}
    (folder / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    items = document(folder)
    pipe = next(item.content for item in items if isinstance(item, TableBlock) and "line types" in item.caption)
    assert row(pipe, "specified minimum yield stress")["flexible"] == "448"
    assert not [row for row in pipe.rows if "damping" in row[0]]
    sea = next(item.content for item in items if isinstance(item, TableBlock) and item.caption.startswith("Sea states"))
    assert row(sea, "irregular, JONSWAP")["seeds"] == "7"
    current = next(item.content for item in items if isinstance(item, TableBlock) and item.caption == "Current")
    assert [cells[-1] for cells in current.rows] == ["0.1", "0.6"]
    words = "\n".join(texts(items))
    line_with(words, "End B hangs off", "90 kN", "layback of 81.25 m")
    line_with(words, "850 kg/m³", "20 MPa")
    assert {"Current by height", "Wave spectra"} <= {item.caption for item in items if isinstance(item, PictureBlock)}


@pytest.mark.parametrize(
    ("value", "text"),
    [
        *((None, "–"), (float("nan"), "–"), (0.0, "0"), (1543.21, "1543.2")),
        *((123456.7, "123457"), (1.5e-7, "1.5e-07"), (3e8, "3e+08")),
    ],
)
def test_numbers_read_well(value: float | None, text: str) -> None:
    assert number(value) == text


def test_columns_without_anything_have_no_place() -> None:
    sparse = ReportTable(("a", "b", "c"), [["1", "", "2"], ["3", "–", ""]])
    assert compact(sparse) == ReportTable(["a", "c"], [["1", "2"], ["3", ""]])


def test_a_run_whose_scene_is_gone_is_reported_without_it(run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    shutil.copytree(run.folder, folder)
    (folder / "scene.yaml").unlink()
    items = document(folder)
    words = "\n".join(texts(items))
    line_with(words, "input file cannot be read", "values are not shown")
    assert table(items, "summary").rows
    assert str(tmp_path) not in words


@NOT_DRAWN
def test_what_cannot_be_reported_is_said(run: Run, tmp_path: Path) -> None:
    with pytest.raises(WriteError, match="there is no folder"):
        write_report(of_folders([run.folder], {}), tmp_path / "nowhere" / "report.html")
    with pytest.raises(ResultsError, match=telling(f"{tmp_path}:", "not the folder")):
        write_report(of_folders([tmp_path], {}), tmp_path / "report.html")
    with pytest.raises(ResultsError, match=telling('"storm"', "no stage")):
        write_report(of_folders([run.folder], {"stage": "storm"}), tmp_path / "report.html")
    assert not [*tmp_path.glob("*.html"), *tmp_path.glob(".*")]
