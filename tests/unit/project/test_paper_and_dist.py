"""The paper: its length, its references; wheel and source distribution: built and checked."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from riser_soil import __version__
from tests.support.on_ranks import ROOT

PAPER = (ROOT / "paper.md").read_text(encoding="utf-8")
BODY = PAPER.split("---\n")[2]
SOURCES = (ROOT / "paper.bib").read_text(encoding="utf-8")


def test_the_paper_is_as_long_as_the_journal_wants() -> None:
    assert 250 <= len(BODY.split()) <= 1000


def test_the_paper_has_a_source_for_each_reference() -> None:
    assert sorted(set(re.findall(r"@([a-z]+\d*)", BODY))) == sorted(re.findall(r"^@\w+\{(\w+),", SOURCES, re.MULTILINE))


@pytest.mark.parametrize(
    ("page", "row", "figures"),
    [
        ("error_bars", "scenes, key results judged | 40, 455", ("40 scenes", "455")),
        ("error_bars", "true error inside its bar | 98.2%", ("98.2 %",)),
        ("asked_accuracy", "of all 49 scenes (3 say that they do not reach it)", ("of 49 scenes", "other three")),
        ("quality", "| 77 | 68 | 9 | 0 | 0 |", ("Of 77",)),
        ("peers", "5.9 times as cheap", ("4.8 to 5.9 times",)),
        ("peers", "4.8 times as cheap as CableDyn", ("4.8 to 5.9 times",)),
    ],
)
def test_figures_of_the_paper_stand_in_the_pages(page: str, row: str, figures: tuple[str, ...]) -> None:
    assert row in (ROOT / f"docs/{page}.md").read_text(encoding="utf-8")
    assert all(figure in " ".join(BODY.split()) for figure in figures)


def test_the_version_is_the_same_everywhere() -> None:
    """The changelog's first section is that of the version, with the date of its release."""
    cited = dict(re.findall(r"^(version|date-released): (\S+)$", text("CITATION.cff"), re.MULTILINE))
    first = re.search(r"^## (.+)$", text("CHANGELOG.md"), re.MULTILINE)
    assert first is not None
    assert first.group(1) == f"{__version__} ({cited['date-released']})"
    assert cited["version"] == __version__
    assert f"\nVersion {__version__}. " in text("README.md")


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


@pytest.mark.verify
def test_wheel_and_source_distribution(tmp_path: Path) -> None:
    command = [sys.executable, str(ROOT / "scripts/dist.py"), str(tmp_path / "dist")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert sorted(path.suffix for path in (tmp_path / "dist").iterdir()) == [".gz", ".whl"]
