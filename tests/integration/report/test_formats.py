"""A report as PDF and as Word document: pages, headings, tables, captions, pictures, what lies behind them."""

from __future__ import annotations

import re
import zlib
from pathlib import Path

import docx
import pytest
from docx.shared import Mm
from PIL import Image
from typer.testing import CliRunner

from riser_soil.commands.app import app
from riser_soil.errors import ResultsError
from riser_soil.report import report as writing
from riser_soil.report.document import (
    Code,
    Heading,
    Paragraph,
    PictureBlock,
    Points,
    ReportCover,
    ReportDocument,
    ReportSection,
    TableBlock,
    numbered,
    ref,
)
from riser_soil.report.pdf import write_pdf
from riser_soil.report.tables import ReportTable
from riser_soil.report.word import column_widths, write_word
from tests.support.recorded_run import record
from tests.support.said import line_with


class Square:
    """A picture of 20 by 20 red dots."""

    endings: tuple[str, ...] = (".png",)

    def __init__(self, folder: Path) -> None:
        self._file = folder / "square.png"
        Image.new("RGB", (20, 20), "red").save(self._file)

    def content(self, ending: str) -> bytes:
        return self._file.read_bytes()


@pytest.fixture(scope="module")
def document(tmp_path_factory: pytest.TempPathFactory) -> ReportDocument:
    """Two chapters, of which the second has a table of three pages, and an appendix."""
    folder = tmp_path_factory.mktemp("formats")
    square = Square(folder)
    long = ReportTable(("case", "value"), [[f"case {n}", f"{n}.5"] for n in range(150)], f"as {ref('red')}")
    sections = [
        ReportSection("First", [Paragraph("A <b> & Ä.", "warning"), PictureBlock("Red", square, key="red")]),
        ReportSection("Second", [ReportSection("Within", [Points(["one", "two"]), TableBlock("Long", long)])]),
        ReportSection("Scene", [Code("title: x\n  y: 1\n")], appendix=True),
    ]
    cover = ReportCover(
        "A 'title' \"quoted\"", client="Client", document="D-1", revision="B", authors="A. B.",
        program="riser_soil 1.0", logo=folder / "square.png",
    )  # fmt: skip
    return ReportDocument(cover, sections)


def streams(pdf: bytes) -> str:
    """What a PDF's compressed streams hold, as far as it is text."""
    blocks = re.findall(rb"stream\r?\n(.*?)\r?\nendstream", pdf, re.DOTALL)
    return "\n".join(inflated(each).decode("latin-1") for each in blocks)


def inflated(data: bytes) -> bytes:
    try:
        return zlib.decompress(data)
    except zlib.error:
        return b""


def test_a_pdf_has_pages_bookmarks_and_a_title(document: ReportDocument, tmp_path: Path) -> None:
    began: list[str] = []
    write_pdf(document, tmp_path / "report.pdf", lambda item: began.append(item.caption))
    pdf = (tmp_path / "report.pdf").read_bytes()
    whole = pdf.decode("latin-1") + streams(pdf)
    assert pdf.startswith(b"%PDF")
    (pages,) = re.findall(r"<<[^<>]*/Type\s*/Pages\b[^<>]*>>", whole)
    (count,) = map(int, re.findall(r"/Count (\d+)", pages))
    assert 7 <= count <= 9, "cover, contents, chapters, 150 rows, appendix"
    assert "/Outlines" in whole
    assert "/MediaBox [0 0 595" in whole, "A4"
    assert began == ["Red"]


def test_a_word_document_has_what_the_document_has(document: ReportDocument, tmp_path: Path) -> None:
    file = tmp_path / "report.docx"
    write_word(document, file, lambda _: None)
    made, items = docx.Document(str(file)), numbered(document)
    headings = [each.text for each in made.paragraphs if each.style.name.startswith("Heading")]
    assert headings == [f"{each.label}  {each.title}" for each in items if isinstance(each, Heading)]
    captions = [each.text for each in made.paragraphs if each.style.name == "Caption"]
    assert captions == ["Figure 1  Red", "Table 1  Long"]
    cover, long = made.tables
    assert [cell.text for cell in cover.rows[0].cells] == ["Client", "Client"]
    assert len(long.rows) == 151
    assert [cell.text for cell in long.rows[3].cells] == ["case 2", "2.5"]
    assert len(made.inline_shapes) == 2, "logo and picture"
    text = "\n".join(each.text for each in made.paragraphs)
    line_with(text, "A <b> & Ä.")
    line_with(text, "as Figure 1")
    fields = re.findall(r"<w:instrText[^>]*> *([^<]*?) *</w:instrText>", made.element.xml)
    assert [field.split()[0] for field in fields] == ["TOC", "SEQ", "SEQ"]
    foot = made.sections[0].footer.paragraphs[0]
    assert [*re.findall(r"> (PAGE|NUMPAGES) <", foot._p.xml)] == ["PAGE", "NUMPAGES"]
    assert made.sections[0].header.paragraphs[0].text.startswith("D-1 · rev. B · ")
    assert (made.core_properties.title, made.core_properties.author) == (document.cover.title, "A. B.")
    assert made.sections[0].page_width.mm == pytest.approx(210.0, abs=0.1)


def test_the_command_writes_all_formats(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A report of one chapter, as drawing all pictures is the page's test."""
    monkeypatch.setattr(writing, "CHAPTERS", (writing.summary_chapter.chapter,))
    record(tmp_path / "run", duration=0.4)
    for ending, begins in ((".html", b"<!DOCTYPE"), (".pdf", b"%PDF"), (".docx", b"PK"), (".PDF", b"%PDF")):
        file = tmp_path / f"report{ending}"
        done = CliRunner().invoke(app, ["report", str(tmp_path / "run"), "-o", str(file)])
        assert (done.exit_code, done.output.strip()) == (0, str(file))
        assert file.read_bytes().startswith(begins)


def test_a_format_whose_package_is_not_there_is_refused_in_a_line(
    document: ReportDocument, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(writing.WRITERS, ".pdf", ("riser_soil.report.pdf", "write_pdf", "no_such_package"))
    with pytest.raises(ResultsError) as caught:
        writing.writer_of(tmp_path / "report.pdf")
    line_with(str(caught.value), "report.pdf:", "no_such_package", "riser_soil[report]", ".html")
    assert "\n" not in str(caught.value)


def test_columns_are_as_wide_as_their_words_and_share_what_is_left() -> None:
    """A narrow table keeps its width; a wide one has that of the text, and no word of it is cut."""
    narrow = column_widths([["case", "value"], ["a", "1.0"]], 8.0)
    assert narrow[0] < narrow[1]
    assert sum(narrow) < Mm(60)
    words = "a long sentence that is to be broken into several lines"
    wide = column_widths([["case", "remark"], ["near-stiff", f"{words}, {words}, {words}"]], 8.0)
    assert sum(wide) == pytest.approx(Mm(170), rel=1e-4)
    assert wide[0] >= column_widths([["near-stiff"]], 8.0)[0] - 1
    crowded = column_widths([["wordswithoutspaces" * 3] * 5], 8.0)
    assert sum(crowded) == pytest.approx(Mm(170), rel=1e-4)
