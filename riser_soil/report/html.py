"""Writer of a report as one HTML page that needs no other file, no network and no script, and prints on A4."""

from __future__ import annotations

import base64
from collections.abc import Callable
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from riser_soil.report.document import Item, PictureBlock, ReportCover, ReportDocument, headings, numbered

TYPES = {".svg": "image/svg+xml", ".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg"}

Began = Callable[[PictureBlock], None]
"""Hears of each picture before it is drawn."""


def write_html(document: ReportDocument, file: Path, began: Began) -> None:
    """Write the page."""
    file.write_text(page_of(document, began), encoding="utf-8")


def page_of(document: ReportDocument, began: Began) -> str:
    """The page as text."""

    def image(item: PictureBlock) -> str:
        began(item)
        ending = item.drawing.endings[0]
        return as_uri(item.drawing.content(ending), ending)

    items, cover = numbered(document), document.cover
    page: str = _template().render(
        cover=cover,
        logo=None if cover.logo is None else as_uri(cover.logo.read_bytes(), cover.logo.suffix.lower()),
        running=Markup(_css_text(running_title(cover))),
        items=items,
        contents=headings(items),
        image=image,
        kind_of=_kind_of,
    )
    return page


def running_title(cover: ReportCover) -> str:
    """What stands at the top of each page: document number, revision, title."""
    revision = f"rev. {cover.revision}" if cover.revision else ""
    return " · ".join(part for part in (cover.document, revision, cover.title) if part)


def _css_text(text: str) -> str:
    """A quoted text of CSS within HTML: what would end the quotes or the style is written by its code."""
    return '"' + "".join(f"\\{ord(c):06x}" if c in '"\\<>&\n\r' else c for c in text) + '"'


def as_uri(content: bytes, ending: str) -> str:
    """A picture as part of the page."""
    return f"data:{TYPES[ending]};base64,{base64.b64encode(content).decode()}"


def _kind_of(item: Item) -> str:
    return type(item).__name__


def _template() -> Any:
    loader = PackageLoader("riser_soil.report", "template")
    environment = Environment(
        loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return environment.get_template("report.html")
