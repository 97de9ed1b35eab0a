"""The page of the touchdown demo shows what its run gives."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from demos.compute import compute
from demos.page import ROOT, all_pages, block, places
from demos.touchdown_clay.run import AT_REST, COARSER, HERE, PAGE, SCENE, figures, sentences, stiffness
from riser_soil.results import Run
from riser_soil.scene.reader import read_scene
from tests.support.pages import same_figures, text
from tests.support.scenes import DEMO
from tests.support.watched_run import WatchedRun, watched_run

TEXT = PAGE.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> WatchedRun:
    return watched_run(read_scene(DEMO), tmp_path_factory.mktemp("demo") / "results")


@pytest.mark.verify
@pytest.mark.parametrize(("name", "computed"), [("figures", figures), ("stiffness", stiffness)])
def test_page_shows_figures_as_computed(demo: WatchedRun, name: str, computed: object) -> None:
    assert callable(computed)
    shown, values = (re.split(r"(-?\d+\.?\d*)", text) for text in (block(TEXT, name), computed(Run(demo.folder))))
    assert shown[::2] == values[::2]
    assert [*map(float, shown[1::2])] == pytest.approx([*map(float, values[1::2])], rel=0.01, abs=0.011)


@pytest.mark.verify
def test_pages_tell_what_a_run_gives(demo: WatchedRun, tmp_path: Path) -> None:
    """README.md, the tutorial and the demo's page; `make figures` writes them anew."""
    texts = sentences(Run(demo.folder), compute(SCENE, tmp_path, COARSER, AT_REST))
    stated = {page: places(page.read_text(encoding="utf-8")) for page in all_pages()}
    assert {name for names in stated.values() for name in names if name.startswith("demo ")} == texts.keys()
    assert COARSER in text(ROOT / "docs/tutorial_clay.md"), "the page has the command of the coarser run"
    for page, names in stated.items():
        for name in names.keys() & texts.keys():
            assert all(same_figures(each, texts[name]) for each in names[name]), (page, name, texts[name])


@pytest.mark.verify
def test_demo_needs_few_newton_iterations(demo: WatchedRun) -> None:
    """7.5 a step in motion, none of which was cut, and 6.5 a load step, were found."""
    assert np.mean([step.iterations for step in demo.of_kind(static=True)]) <= 7.5
    steps = demo.of_kind(static=False)
    assert sum(step.cuts for step in steps) <= 2
    assert np.mean([step.iterations for step in steps]) <= 8.5


def test_half_the_steps_and_half_the_cells_change_no_figure_by_more_than_five_per_cent() -> None:
    """By the page's table, which `convergence.py` makes in about an hour."""
    rows = [row.split("|")[1:-1] for row in block(TEXT, "halved").splitlines()[2:]]
    assert len(rows) == 10
    for row in rows:
        changes = [float(cell.replace("%", "").replace("−", "-")) for cell in row[2:]]
        assert len(changes) == 3
        assert np.abs(changes).max() <= 5.0, row


@pytest.mark.parametrize("target", sorted(set(re.findall(r"\]\(([^)#]+)\)", TEXT))))
def test_link(target: str) -> None:
    assert (HERE / target).exists()
