"""Tables in Markdown, and the places in pages where scripts write them.

A place has a name: a block of lines between `<!-- NAME -->` and `<!-- end of NAME -->`, or figures within a sentence,
`<!-- figure NAME -->11.1<!-- end -->`, which may stand in a page more than once, but not where a line begins.
"""

from __future__ import annotations

import argparse
import csv
import io
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import chain
from pathlib import Path

ROOT = Path(__file__).parents[1]
_FIGURE = re.compile(r"(<!-- figure ([^>]+) -->)(.*?)(<!-- end -->)", re.DOTALL)
_BLOCK = re.compile(r"^<!-- end of ([^>]+) -->$", re.MULTILINE)


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table; the first column to the left, the others to the right."""
    rule = ["---", *["---:"] * (len(head) - 1)]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (head, rule, *rows))


def csv_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table as CSV, for tables too long for a page."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([head, *rows])
    return text.getvalue()


def block(page: str, name: str) -> str:
    """What stands between a page's marks of this name. Raises KeyError where there are none."""
    return page[slice(*_place(page, name))].rstrip("\n")


def places(page: str) -> dict[str, list[str]]:
    """What stands at each of a page's places, by their names."""
    blocks = {name: [block(page, name)] for name in _BLOCK.findall(page)}
    for _, name, text, _ in _FIGURE.findall(page):
        blocks.setdefault(name, []).append(text)
    return blocks


def plain(page: str) -> str:
    """The page without the marks of figures."""
    return _FIGURE.sub(r"\3", page)


def filled(page: str, texts: Mapping[str, str]) -> str:
    """The page with other texts at its places. Raises KeyError where it lacks one."""
    there = places(page)
    for name, text in texts.items():
        if name not in there or f"<!-- {name} -->" in page:
            begin, end = _place(page, name)
            page = page[:begin] + text + "\n" + page[end:]
    return _FIGURE.sub(lambda match: match[1] + texts.get(match[2], match[3]) + match[4], page)


def all_pages() -> list[Path]:
    """README.md, the paper, the pages in docs and those of the demos."""
    in_folders = (sorted(ROOT.glob(pattern)) for pattern in ("docs/**/*.md", "demos/*/*.md"))
    return [ROOT / "README.md", ROOT / "paper.md", *chain.from_iterable(in_folders)]


def fill_pages(texts: Mapping[str, str]) -> None:
    """Texts to their places in all pages that have them."""
    for page in all_pages():
        before = page.read_text(encoding="utf-8")
        after = filled(before, {name: texts[name] for name in places(before).keys() & texts.keys()})
        if after != before:
            page.write_text(after, encoding="utf-8")


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
