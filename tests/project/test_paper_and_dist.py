"""The paper's references and claims, the version; wheel and source distribution: built and checked."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from demos.page import block, plain
from riser_soil import __version__
from tests.support.on_ranks import ROOT

PAPER = plain((ROOT / "paper.md").read_text(encoding="utf-8"))
BODY = PAPER.split("---\n")[2]
SOURCES = (ROOT / "paper.bib").read_text(encoding="utf-8")


def test_the_paper_has_a_source_for_each_reference() -> None:
    assert sorted(set(re.findall(r"@([a-z]+\d*)", BODY))) == sorted(re.findall(r"^@\w+\{(\w+),", SOURCES, re.MULTILINE))


def test_the_paper_says_how_stress_cases_ended() -> None:
    """The paper's other figures have marks, see test_demo_page.py."""
    wrong = block((ROOT / "docs/quality.md").read_text(encoding="utf-8"), "stress").splitlines()[2].split("|")[4]
    assert ("none ends quietly wrong" in " ".join(BODY.split())) == (wrong.strip() == "0")


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
