"""The pages that tell of the project: README.md, those in docs, those of the demos; their code blocks and equations."""

from __future__ import annotations

import re
from pathlib import Path

from tests.support.on_ranks import ROOT

README = ROOT / "README.md"
DOCS = sorted((ROOT / "docs").glob("*.md"))
DEMOS = sorted((ROOT / "demos").glob("*/*.md"))


def text(page: Path) -> str:
    return page.read_text(encoding="utf-8")


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
