"""The page of the touchdown demo shows what its run gives."""

from __future__ import annotations

import re

import numpy as np
import pytest

from demos.page import block
from demos.touchdown_clay.run import HERE, PAGE, figures, stiffness
from riser_soil.results import Run
from riser_soil.scene.reader import read_scene
from tests.support.coupled_scenes import DEMO
from tests.support.watched_run import WatchedRun, watched_run

TEXT = PAGE.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> WatchedRun:
    return watched_run(read_scene(DEMO), tmp_path_factory.mktemp("demo") / "results")


@pytest.mark.verify
@pytest.mark.parametrize(("name", "computed"), [("figures", figures), ("stiffness", stiffness)])
def test_page_shows_figures_as_computed(demo: WatchedRun, name: str, computed: object) -> None:
    assert callable(computed)
    shown, found = (re.split(r"(-?\d+\.?\d*)", text) for text in (block(TEXT, name), computed(Run(demo.folder))))
    assert shown[::2] == found[::2]
    assert [*map(float, shown[1::2])] == pytest.approx([*map(float, found[1::2])], rel=0.01, abs=0.011)


@pytest.mark.verify
def test_demo_needs_few_newton_iterations(demo: WatchedRun) -> None:
    """5.6 a step in motion, one step of which was cut, and 6.3 a load step, were found."""
    assert np.mean([step.iterations for step in demo.of_kind(static=True)]) <= 7.0
    steps = demo.of_kind(static=False)
    assert sum(step.cuts for step in steps) <= 2
    assert np.mean([step.iterations for step in steps]) <= 6.0


@pytest.mark.parametrize("target", sorted(set(re.findall(r"\]\(([^)#]+)\)", TEXT))))
def test_link(target: str) -> None:
    assert (HERE / target).exists()
