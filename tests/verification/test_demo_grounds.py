"""The page of grounds shows what its runs give, and its sections are beside the block what it says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from demos.compute import compute
from demos.grounds.run import GROUNDS, PAGE, SCENE, row
from demos.page import block
from riser_soil.results import Run

CHEAP = [ground for ground in GROUNDS if ground != "block"]
LINES = [line.split("|")[1:-1] for line in block(PAGE.read_text(encoding="utf-8"), "grounds").splitlines()[2:]]
ROWS = {ground.strip(): cells for ground, *cells in LINES}


def numbers(cells: list[str]) -> list[float]:
    return [float(each) for cell in cells for each in re.findall(r"[\d.]+", cell)]


def test_all_grounds_are_told_the_dearest_last() -> None:
    assert list(ROWS) == list(GROUNDS)
    seconds = [numbers(cells)[-1] for cells in ROWS.values()]
    assert max(seconds[:3]) < 0.2 * seconds[3] < 0.2 * seconds[4]


def test_what_the_riser_feels_is_alike_on_all_grounds() -> None:
    """The page says so of moments and touchdown points."""
    for cells in ROWS.values():
        _, _, laid, moved, *arcs, _ = numbers(cells)
        assert [laid, moved] == pytest.approx(numbers(ROWS["block"])[2:4], rel=0.02)
        assert arcs == pytest.approx(numbers(ROWS["block"])[4:7], rel=0.02)


@pytest.mark.verify
@pytest.mark.parametrize("ground", CHEAP)
def test_page_shows_what_a_run_gives(ground: str, tmp_path: Path) -> None:
    run: Run = compute(SCENE, tmp_path, *GROUNDS[ground])
    values = numbers(row(ground, run, 1.0)[1:-1])
    assert values == pytest.approx(numbers(ROWS[ground])[:-1], rel=0.01, abs=0.06)
