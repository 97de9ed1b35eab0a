"""The pages that tell of the project: README.md, those in docs, those of the demos; their code blocks and equations."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from demos.page import all_pages, fill_pages, places, plain
from tests.support.on_ranks import ROOT

Tell = Callable[[Mapping[str, str]], None]  # see the fixture `tell`

README = ROOT / "README.md"
DOCS = sorted((ROOT / "docs").rglob("*.md"))
DEMOS = sorted((ROOT / "demos").glob("*/*.md"))


def text(page: Path) -> str:
    """The page as it is read, without the marks around figures."""
    return plain(page.read_text(encoding="utf-8"))


def flowing(page: Path) -> str:
    """The page in one line."""
    return " ".join(text(page).split())


def blocks(page: Path, language: str) -> list[str]:
    """The page's code blocks of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", text(page), re.MULTILINE | re.DOTALL)


def equations(page: Path) -> list[str]:
    """The page's equations, between single and double dollars, outside of code."""
    prose = re.sub(r"^```.*?^```$|`[^`\n]*`", "", text(page), flags=re.MULTILINE | re.DOTALL)
    return [a or b for a, b in re.findall(r"\$\$(.+?)\$\$|\$([^$]+)\$", prose, re.DOTALL)]


def same_figures(shown: str, computed: str) -> bool:
    """Equal words; equal numbers but for the last digit that is told."""
    (words, numbers), (others, values) = (_apart(each) for each in (shown, computed))
    close = (abs(float(a) - float(b)) <= 1.01 * _last_digit(a) for a, b in zip(numbers, values, strict=False))
    return words == others and all(close)


def compare(texts: Mapping[str, str], write: bool = False) -> None:
    """Figures by their names are what the pages tell; write: to their places there, first."""
    if write:
        fill_pages(texts)
    there = [places(page.read_text(encoding="utf-8")) for page in all_pages()]
    stated = [(name, text) for page in there for name, each in page.items() for text in each]
    assert texts.keys() <= {name for name, _ in stated}
    for name, text in stated:
        assert name not in texts or same_figures(text, texts[name]), f"{text} is told of {name}, and is {texts[name]}"


def signed_percent(shares: Iterable[float]) -> str:
    """Shares as `+12.9, −6.3 %`."""
    rounded = (round(100.0 * share, 1) + 0.0 for share in shares)
    return ", ".join(f"{each:+.1f}" if each else "0.0" for each in rounded).replace("-", "−") + " %"


def _apart(text: str) -> tuple[list[str], list[str]]:
    pieces = re.split(r"(\d[\d,]*(?:\.\d+)?)", text)
    return pieces[::2], [number.replace(",", "") for number in pieces[1::2]]


def _last_digit(number: str) -> float:
    return float(10.0 ** -len(number.partition(".")[2]))
