"""Writer of a report as Word document, in Word's own styles, fields and captions, for those who go on editing it."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import docx
from docx.enum.text import WD_ALIGN_PARAGRAPH, WD_BREAK
from docx.oxml import OxmlElement
from docx.oxml.ns import qn
from docx.shared import Mm, Pt, RGBColor

from riser_soil.report.document import (
    Code,
    Heading,
    Item,
    Paragraph,
    PictureBlock,
    Points,
    ReportDocument,
    TableBlock,
    headings,
    numbered,
)
from riser_soil.report.html import Began, running_title
from riser_soil.report.tables import BREAK

_MARGIN, _TEXT = Mm(20), Mm(170)
_WIDE = 7  # columns, from which on a table has smaller letters
_LETTER = 0.68  # width of most letters over their size
_ACCENT, _WARN = RGBColor(0x1F, 0x4F, 0x79), RGBColor(0x8A, 0x4B, 0x00)


def write_word(document: ReportDocument, file: Path, began: Began) -> None:
    """Write the document."""
    made, items, cover = docx.Document(), numbered(document), document.cover
    about = made.core_properties
    about.title, about.subject, about.author = cover.title, cover.subtitle, cover.authors
    about.comments = cover.program
    _set_up(made, running_title(cover))
    _add_cover(made, document)
    _add_contents(made, items)
    for item in items:
        _add(made, item, began)
    made.save(str(file))


def _set_up(made: Any, running: str) -> None:
    page = made.sections[0]
    page.page_width, page.page_height = Mm(210), Mm(297)
    page.left_margin = page.right_margin = _MARGIN
    page.top_margin, page.bottom_margin = Mm(24), Mm(22)
    page.different_first_page_header_footer = True
    page.header.paragraphs[0].text = running
    foot = page.footer.paragraphs[0]
    foot.alignment = WD_ALIGN_PARAGRAPH.RIGHT
    foot.add_run("page ")
    _add_field(foot, "PAGE", "1")
    foot.add_run(" of ")
    _add_field(foot, "NUMPAGES", "1")
    for paragraph in (page.header.paragraphs[0], foot):
        for run in paragraph.runs:
            run.font.size = Pt(8)
    made.styles["Normal"].font.name, made.styles["Normal"].font.size = "Arial", Pt(9.5)
    for level, size in ((1, 14), (2, 11.5), (3, 10)):
        style = made.styles[f"Heading {level}"]
        style.font.name, style.font.size, style.font.color.rgb = "Arial", Pt(size), _ACCENT
        style.element.rPr.rFonts.set(qn("w:asciiTheme"), "")
        style.element.rPr.rFonts.attrib.pop(qn("w:asciiTheme"))


def _add_cover(made: Any, document: ReportDocument) -> None:
    cover = document.cover
    if cover.logo is not None:
        made.add_picture(str(cover.logo), height=Mm(25))
    title = made.add_paragraph(cover.title, style="Title")
    title.paragraph_format.space_before = Mm(40)
    if cover.subtitle:
        made.add_paragraph(cover.subtitle, style="Subtitle")
    table = made.add_table(rows=0, cols=2)
    for name, value in cover.rows:
        cells = table.add_row().cells
        cells[0].text, cells[1].text = name, value
    made.add_paragraph().add_run().add_break(WD_BREAK.PAGE)


def _add_contents(made: Any, items: list[Item]) -> None:
    """A field that Word brings up to date on demand (F9), with the headings as they are until then."""
    made.add_paragraph("Contents").runs[0].bold = True
    lines = [f"{each.label}\t{each.title}" for each in headings(items)]
    paragraph = made.add_paragraph()
    _begin_field(paragraph, 'TOC \\o "1-2" \\h \\z \\u')
    for n, line in enumerate(lines):
        run = paragraph.add_run(line)
        if n < len(lines) - 1:
            run.add_break()
    _end_field(paragraph)
    made.add_paragraph().add_run().add_break(WD_BREAK.PAGE)


def _add(made: Any, item: Item, began: Began) -> None:
    match item:
        case Heading():
            made.add_heading(f"{item.label}  {item.title}", level=item.level)
        case Paragraph():
            _add_text(made.add_paragraph(), item.text, item.kind)
        case Points():
            for point in item.items:
                _add_text(made.add_paragraph(style="List Bullet"), point, item.kind)
        case Code():
            run = made.add_paragraph().add_run(item.text.rstrip())
            run.font.name, run.font.size = "Courier New", Pt(7)
        case TableBlock():
            _add_table(made, item)
        case PictureBlock():
            began(item)
            made.add_picture(io.BytesIO(item.drawing.content(".png")), width=_TEXT)
            made.paragraphs[-1].paragraph_format.keep_with_next = True
            _add_caption(made, "Figure", item.number, item.caption)


def _add_text(paragraph: Any, text: str, kind: str) -> None:
    run = paragraph.add_run(text)
    if kind == "warning":
        run.font.color.rgb = _WARN


def _add_caption(made: Any, word: str, number: int, text: str) -> Any:
    paragraph = made.add_paragraph(style="Caption")
    paragraph.add_run(f"{word} ")
    _add_field(paragraph, f"SEQ {word} \\* ARABIC", str(number))
    paragraph.add_run(f"  {text}")
    return paragraph


def _add_table(made: Any, item: TableBlock) -> None:
    _add_caption(made, "Table", item.number, item.caption).paragraph_format.keep_with_next = True
    head, rows = item.content.head, item.content.rows
    table = made.add_table(rows=1 + len(rows), cols=len(head), style="Light List Accent 1")
    points = 7 if len(head) > _WIDE else 8
    size, widths = Pt(points), column_widths([head, *rows], points)
    table.autofit = False
    for column, width in zip(table.columns, widths, strict=True):
        column.width = width
    for row, cells in enumerate([head, *rows]):
        for cell, text, place, width in zip(table.rows[row].cells, cells, range(len(head)), widths, strict=True):
            cell.width, paragraph = width, cell.paragraphs[0]
            run = paragraph.add_run(text)
            run.font.size, run.bold = size, row == 0
            if place >= item.words and not item.content.has_words(place):
                paragraph.alignment = WD_ALIGN_PARAGRAPH.RIGHT
    repeat = OxmlElement("w:tblHeader")
    repeat.set(qn("w:val"), "true")
    table.rows[0]._tr.get_or_add_trPr().append(repeat)
    note = made.add_paragraph().add_run(item.content.note)
    note.font.size = Pt(7.5)


def column_widths(rows: Sequence[Sequence[str]], points: float) -> list[int]:
    """Widths of a table's columns, within that of the text: as wide as their longest cell, else less by what can be
    broken into lines, and where even words are too long in proportion.
    """
    letter, edges = Pt(_LETTER * points), Mm(4.5)
    columns = [[text.split(BREAK) for text in column] for column in zip(*rows, strict=True)]
    whole = [edges + letter * max(len("".join(parts)) for parts in column) for column in columns]
    words = [
        edges + letter * max((len(word) for parts in column for part in parts for word in part.split()), default=0)
        for column in columns
    ]
    if sum(whole) <= _TEXT:
        return [int(width) for width in whole]
    spare = _TEXT - sum(words)
    if spare < 0:
        return [int(width * _TEXT / sum(words)) for width in words]
    share = spare / (sum(whole) - sum(words))
    return [int(least + share * (most - least)) for least, most in zip(words, whole, strict=True)]


def _add_field(paragraph: Any, code: str, shown: str) -> None:
    _begin_field(paragraph, code)
    paragraph.add_run(shown)
    _end_field(paragraph)


def _begin_field(paragraph: Any, code: str) -> None:
    paragraph.add_run()._r.append(_mark("begin"))
    text = OxmlElement("w:instrText")
    text.set(qn("xml:space"), "preserve")
    text.text = f" {code} "
    paragraph.add_run()._r.append(text)
    paragraph.add_run()._r.append(_mark("separate"))


def _end_field(paragraph: Any) -> None:
    paragraph.add_run()._r.append(_mark("end"))


def _mark(kind: str) -> Any:
    element = OxmlElement("w:fldChar")
    element.set(qn("w:fldCharType"), kind)
    return element
