"""The site of the project's pages: builds without a warning, asks nothing of the network, and typesets equations."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from tests.support.on_ranks import ROOT
from tests.support.pages import equations, text

pytestmark = pytest.mark.xdist_group("site")

PAGES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "SUPPORT.md")]
PAGES += [*sorted((ROOT / "docs").rglob("*.md")), *sorted((ROOT / "demos").rglob("README.md"))]
CODE = re.compile(r"<(script|style|pre|code|math)\b.*?</\1>", re.DOTALL)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    done = subprocess.run([ROOT / "scripts/site.sh", "--site-dir", folder], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return folder


def test_site_needs_no_network(site: Path) -> None:
    home = text(site / "index.html")
    assert re.findall(r'<(?:script|img)[^>]* src="(?:https?:)?//|<link rel="stylesheet" href="http', home) == []
    assert "doc-heading" in text(site / "docs/api/index.html")


def test_pages_have_the_style_and_its_font(site: Path) -> None:
    """Code that is wrapped and not cut, whole words in tables, a font with a table for equations."""
    assert re.search(r'<link rel="stylesheet" href="[^"]*site\.css"', text(site / "docs/theory/index.html"))
    style = text(site / "docs/site.css")
    (font,) = re.findall(r'url\("([^"]+)"\)', style)
    assert b"MATH" in (site / "docs" / font).read_bytes()[:512]
    assert (site / "docs/fonts/LICENSE.txt").is_file()
    rules = ".md-typeset pre > code", ".md-typeset table"
    code, table = (style[style.index(rule) :].partition("}")[0] for rule in rules)
    assert "white-space: pre-wrap" in code
    assert "word-break: normal" in table


def test_no_two_entries_of_the_menu_have_one_name() -> None:
    titles = re.findall(r"^ +- ([^:\n]+):", text(ROOT / "mkdocs.yml").partition("nav:")[2], re.MULTILINE)
    assert len(titles) > 40
    assert [title for title in {*titles} if titles.count(title) > 1] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_to_pages_have_their_titles(page: Path) -> None:
    """And not the names of their files."""
    assert re.findall(r"\[[\w./]+\.md\]\(", text(page)) == []


def test_equations_are_typeset(site: Path) -> None:
    known = equations(ROOT / "docs/theory.md")
    assert len(known) > 30
    assert text(site / "docs/theory/index.html").count("<math ") == len(known)


def test_primes_are_no_exponents(site: Path) -> None:
    """Primes as exponents are specks, whatever the font."""
    shown = text(site / "docs/theory/index.html")
    assert len(re.findall(r"<mo [^>]*>&#x0(?:2032|2033|2057);</mo>|<mo [^>]*>[′″⁗]</mo>", shown)) > 5
    assert re.findall(r"<msup><mi>\w+</mi><m[io]>(?:&#x0(?:2032|2033|2057);|[′″⁗])", shown) == []


def test_no_equation_is_left_raw(site: Path) -> None:
    """Neither dollars nor what marks an equation that was found; code may have them."""
    pages = [page for page in site.rglob("*.html") if "arithmatex" in text(page) or "$" in CODE.sub("", text(page))]
    assert pages == []
