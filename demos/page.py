"""Tables in Markdown, and the places in a demo's page where its scripts write them."""

from __future__ import annotations

import argparse
import csv
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table; the first column to the left, the others to the right."""
    rule = ["---", *["---:"] * (len(head) - 1)]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (head, rule, *rows))


def csv_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """The same as CSV, for tables too long for a page."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([head, *rows])
    return text.getvalue()


def block(page: str, name: str) -> str:
    """What stands between a page's marks of this name. Raises KeyError where there are none."""
    return page[slice(*_place(page, name))].rstrip("\n")


def filled(page: str, blocks: Mapping[str, str]) -> str:
    """The page with other text between its marks."""
    for name, text in blocks.items():
        begin, end = _place(page, name)
        page = page[:begin] + text + "\n" + page[end:]
    return page


def publish(blocks: Mapping[str, str], results: Path, page: Path | None = None) -> None:
    """Each block to a file NAME.md among the results and on the screen; to its place in the page, if one is given."""
    for name, text in blocks.items():
        (results / f"{name}.md").write_text(text + "\n", encoding="utf-8")
        print(f"\n{name}:\n{text}")
    if page is not None:
        page.write_text(filled(page.read_text(encoding="utf-8"), blocks), encoding="utf-8")


def script(main: Callable[[Path, bool], None], description: str | None, here: Path) -> None:
    """Run a demo's script with its command line: the folder of its results, and whether its page is written, too."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=Path, default=here / "results", help="folder for runs and tables")
    parser.add_argument("--page", action="store_true", help="write tables and pictures into the demo's page, too")
    given = parser.parse_args()
    main(given.results, given.page)


def _place(page: str, name: str) -> tuple[int, int]:
    first, last = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
    if page.count(first) != 1 or page.count(last) != 1:
        raise KeyError(f"the page needs one {first.strip()} and one {last}")
    begin = page.index(first) + len(first)
    return begin, page.index(last)
