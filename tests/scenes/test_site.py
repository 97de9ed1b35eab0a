"""The site of the project's pages: builds without a warning, asks nothing of the network, and typesets equations."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from tests.support.on_ranks import ROOT
from tests.support.pages import equations, text

pytestmark = pytest.mark.xdist_group("site")

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


def test_equations_are_typeset(site: Path) -> None:
    known = equations(ROOT / "docs/theory.md")
    assert len(known) > 30
    assert text(site / "docs/theory/index.html").count("<math ") == len(known)


def test_no_equation_is_left_raw(site: Path) -> None:
    """Neither dollars nor what marks an equation that was found; code may have them."""
    pages = [page for page in site.rglob("*.html") if "arithmatex" in text(page) or "$" in CODE.sub("", text(page))]
    assert pages == []
