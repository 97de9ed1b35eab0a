"""A report as a document: cover, sections, paragraphs, tables, pictures; its numbering; what the writers write.

A document is a tree of sections. `numbered` walks it once and gives a flat list of items in reading order with their
numbers; HTML, PDF and Word are written from that list. A paragraph refers to a table or picture by `ref(key)`, which
becomes "Table 3" or "Figure 3".
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path
from typing import Protocol

from riser_soil.report.tables import ReportTable

_MARK = re.compile("\u27e8([^\u27e9]+)\u27e9")


class Drawing(Protocol):
    """A picture that is drawn when a writer asks for it, in the format of an ending."""

    def content(self, ending: str) -> bytes:
        """Bytes of a file with this ending, .svg or .png."""
        ...

    @property
    def endings(self) -> tuple[str, ...]:
        """Formats that it can have, the best one first."""
        ...


@dataclass(frozen=True)
class ReportCover:
    """What the first page says; empty texts are not shown."""

    title: str
    subtitle: str = ""
    client: str = ""
    document: str = ""
    revision: str = ""
    date: str = ""
    authors: str = ""
    checked: str = ""
    approved: str = ""
    program: str = ""
    logo: Path | None = None

    @property
    def rows(self) -> list[tuple[str, str]]:
        """Names and values of the block below the title."""
        named = (
            ("Client", self.client),
            ("Document number", self.document),
            ("Revision", self.revision),
            ("Date", self.date),
            ("Prepared by", self.authors),
            ("Checked by", self.checked),
            ("Approved by", self.approved),
            ("Computed with", self.program),
        )
        return [(name, value) for name, value in named if value]


@dataclass(frozen=True)
class Paragraph:
    """Plain text; kind: "" or "warning"."""

    text: str
    kind: str = ""


@dataclass(frozen=True)
class Points:
    """A list of points."""

    items: Sequence[str]
    kind: str = ""


@dataclass(frozen=True)
class Code:
    """Text that is shown as it is, letter by letter."""

    text: str


@dataclass(frozen=True)
class TableBlock:
    """A table with its caption. words: how many of the first columns hold words, and are aligned to the left."""

    caption: str
    content: ReportTable
    words: int = 1
    key: str = ""
    number: int = 0


@dataclass(frozen=True)
class PictureBlock:
    """A picture with its caption."""

    caption: str
    drawing: Drawing
    key: str = ""
    number: int = 0


@dataclass(frozen=True)
class ReportSection:
    """A heading and what is below it, sections among it; a top-level one may be an appendix."""

    title: str
    blocks: Sequence[Block]
    appendix: bool = False

    def __bool__(self) -> bool:
        """Whether there is anything to say; a section of empty ones has nothing."""
        return any(not isinstance(block, ReportSection) or block for block in self.blocks)


@dataclass(frozen=True)
class Heading:
    """A section's title with its number, "2.1" or "A"; level 1 to 3."""

    title: str
    number: str
    level: int
    appendix: bool = False

    @property
    def anchor(self) -> str:
        return f"section-{self.number}"

    @property
    def label(self) -> str:
        """The number as it is written: that of an appendix behind this word."""
        return f"Appendix {self.number}" if self.appendix and self.level == 1 else self.number


Block = Paragraph | Points | Code | TableBlock | PictureBlock | ReportSection
Item = Heading | Paragraph | Points | Code | TableBlock | PictureBlock


@dataclass(frozen=True)
class ReportDocument:
    """All of a report."""

    cover: ReportCover
    sections: Sequence[ReportSection]


def ref(key: str) -> str:
    """A reference in a paragraph: stands for "Table 3" or "Figure 3"."""
    return f"\u27e8{key}\u27e9"


def numbered(document: ReportDocument) -> list[Item]:
    """All items in reading order with their numbers, references resolved; sections with nothing in them are not there.

    Raises KeyError for a reference to what isn't there.
    """
    tables, pictures = count(1), count(1)
    items = [
        replace(item, number=next(tables if isinstance(item, TableBlock) else pictures))
        if isinstance(item, TableBlock | PictureBlock)
        else item
        for item in _in_order(document)
    ]
    names = {item.key: name_of(item) for item in items if isinstance(item, TableBlock | PictureBlock) and item.key}
    return [_resolved(item, names) for item in items]


def name_of(item: TableBlock | PictureBlock) -> str:
    """"Table 3" or "Figure 3"."""
    return f"{'Table' if isinstance(item, TableBlock) else 'Figure'} {item.number}"


def headings(items: Sequence[Item]) -> list[Heading]:
    """Headings for the list of contents."""
    return [item for item in items if isinstance(item, Heading) and item.level <= 2]


def _in_order(document: ReportDocument) -> Iterator[Item]:
    chapters, appendices = count(1), count(ord("A"))
    for section in document.sections:
        if section:
            number = chr(next(appendices)) if section.appendix else str(next(chapters))
            yield from _of_section(section, number, 1)


def _of_section(section: ReportSection, number: str, level: int) -> Iterator[Item]:
    yield Heading(section.title, number, level, section.appendix)
    inner = count(1)
    for block in section.blocks:
        if isinstance(block, ReportSection):
            if block:
                yield from _of_section(block, f"{number}.{next(inner)}", level + 1)
        else:
            yield block


def _resolved(item: Item, names: dict[str, str]) -> Item:
    def named(text: str) -> str:
        return _MARK.sub(lambda mark: names[mark[1]], text)

    match item:
        case Paragraph():
            return replace(item, text=named(item.text))
        case Points():
            return replace(item, items=[named(text) for text in item.items])
        case TableBlock():
            content = replace(item.content, note=named(item.content.note))
            return replace(item, caption=named(item.caption), content=content)
        case PictureBlock():
            return replace(item, caption=named(item.caption))
        case _:
            return item
