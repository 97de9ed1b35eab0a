"""A report's document: numbers of sections, tables and pictures, references, what is not there."""

from __future__ import annotations

import pytest

from riser_soil.report.document import (
    Heading,
    Paragraph,
    PictureBlock,
    Points,
    ReportCover,
    ReportDocument,
    ReportSection,
    TableBlock,
    headings,
    numbered,
    ref,
)
from riser_soil.report.tables import ReportTable, given_value, is_number, without_paths

CONTENT = ReportTable(("a", "b"), [["x", "1"]])
LAST = TableBlock("last", CONTENT)


class Drawn:
    """A picture that nobody looks at."""

    endings = (".png",)

    def content(self, ending: str) -> bytes:
        return b""


PICTURE = PictureBlock("p", Drawn())


def document(*sections: ReportSection) -> ReportDocument:
    return ReportDocument(ReportCover("title"), sections)


def test_sections_tables_and_pictures_are_numbered_in_reading_order() -> None:
    deeper = ReportSection("deeper", [TableBlock("third", CONTENT)])
    items = numbered(
        document(
            ReportSection("one", [TableBlock("first", CONTENT), ReportSection("within", [PICTURE, LAST])]),
            ReportSection("two", [PICTURE, ReportSection("deep", [deeper])]),
            ReportSection("scene", [Paragraph("text")], appendix=True),
            ReportSection("more", [Paragraph("text")], appendix=True),
        )
    )
    assert [(item.label, item.title) for item in items if isinstance(item, Heading)] == [
        ("1", "one"), ("1.1", "within"), ("2", "two"), ("2.1", "deep"), ("2.1.1", "deeper"),
        ("Appendix A", "scene"), ("Appendix B", "more"),
    ]  # fmt: skip
    assert [(item.number, item.caption) for item in items if isinstance(item, TableBlock)] == [
        (1, "first"), (2, "last"), (3, "third"),
    ]  # fmt: skip
    assert [item.number for item in items if isinstance(item, PictureBlock)] == [1, 2]
    assert [item.title for item in headings(items)] == ["one", "within", "two", "deep", "scene", "more"]


def test_sections_with_nothing_in_them_are_not_there_and_take_no_number() -> None:
    empty = ReportSection("empty", [ReportSection("within", []), ReportSection("too", [])])
    some = ReportSection("some", [Paragraph("x")])
    items = numbered(document(empty, ReportSection("full", [ReportSection("none", []), some])))
    assert [item.label for item in items if isinstance(item, Heading)] == ["1", "1.1"]


def test_references_become_names_forwards_and_backwards() -> None:
    table = TableBlock("t", ReportTable(("a",), [["1"]], f"see {ref('picture')}"), key="table")
    items = numbered(
        document(
            ReportSection("s", [Paragraph(f"as {ref('table')}"), Points([ref("picture")]), table]),
            ReportSection("t", [PictureBlock(f"of {ref('table')}", Drawn(), key="picture")]),
        )
    )
    texts = [item.text for item in items if isinstance(item, Paragraph)]
    assert texts == ["as Table 1"]
    assert [item.items for item in items if isinstance(item, Points)] == [["Figure 1"]]
    assert [item.content.note for item in items if isinstance(item, TableBlock)] == ["see Figure 1"]
    assert [item.caption for item in items if isinstance(item, PictureBlock)] == ["of Table 1"]


def test_a_reference_to_what_is_not_there_is_an_error() -> None:
    with pytest.raises(KeyError, match="lost"):
        numbered(document(ReportSection("s", [Paragraph(ref("lost"))])))


def test_the_cover_shows_what_is_given() -> None:
    assert ReportCover("t", client="C", revision="A").rows == [("Client", "C"), ("Revision", "A")]


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("see /home/me/case/scene.yaml and more", "see scene.yaml and more"),
        ("beside kN/m and m/s, 1/m", "beside kN/m and m/s, 1/m"),
        ("results/run", "results/run"),
        ("/a/b", "b"),
    ],
)
def test_paths_of_a_machine_are_names_alone(text: str, shown: str) -> None:
    assert without_paths(text) == shown


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        *(("[-60.0, 0.0]", "-60, 0"), ("100000.0", "100000"), ("near", "near"), ("/x/y.csv", "y.csv")),
        *((None, "–"), (True, "yes")),
    ],
)
def test_values_of_a_scene_read_well(value: object, shown: str) -> None:
    assert given_value(value) == shown


@pytest.mark.parametrize(
    ("text", "number"),
    [
        *(("1.5", True), ("−2.5 %", True), ("–", True), ("12 ± 3", True), ("> 1e6", True)),
        *(("near", False), ("10 inch pipe", False)),
    ],
)
def test_numbers_are_aligned_to_the_right(text: str, number: bool) -> None:
    assert is_number(text) is number
