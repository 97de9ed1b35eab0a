"""The demo of the trench that a storm digs: its scenes fit each other, and its page shows what they give."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from demos.compute import compute
from demos.dug_trench.run import HERE, PAGE, SCENES, Storms
from demos.page import block
from riser_soil.scene.reader import read_document

TEXT = PAGE.read_text(encoding="utf-8")
OWN = {"title", "initial", "stages", "output"}


def column(name: str, row: str, cell: int) -> tuple[float, float]:
    """A value of a table on the page, and its bar."""
    lines = (line.split("|")[1:-1] for line in block(TEXT, name).splitlines()[2:])
    cells = {first.strip(): others for first, *others in lines}[row][cell]
    value, _, bar = cells.partition("±")
    return float(value), float(bar)


def test_the_storm_meets_the_riser_that_was_laid() -> None:
    laid, storm = (read_document(SCENES[name]).data for name in ("laid", "first"))
    assert {key for key in storm if laid.get(key) != storm[key]} == OWN | {"water"}
    assert storm["water"] == laid["water"] | {"waves": storm["water"]["waves"]}


def test_the_second_storm_finds_the_trench_of_the_first() -> None:
    """It digs less: most of the clay that was in the way has gone."""
    laid, first, second = (column("depth", "deepest [mm]", cell) for cell in range(3))
    assert first[0] - first[1] > laid[0] + laid[1]
    assert 0.0 < second[0] - first[0] < first[0] - laid[0]


@pytest.mark.verify
def test_page_shows_the_riser_as_laid(tmp_path: Path) -> None:
    depth = Storms({"laid": compute(SCENES["laid"], tmp_path / "laid")}).depth("laid")
    assert column("depth", "deepest [mm]", 0)[0] == pytest.approx(depth, rel=0.01)


@pytest.mark.parametrize("target", sorted(set(re.findall(r"\]\(([^)#]+)\)", TEXT))))
def test_link(target: str) -> None:
    assert (HERE / target).exists()
