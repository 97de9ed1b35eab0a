"""The pipe segment's demo: its path, its page, its resistance beside Prandtl's, what its calibrations found."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from demos.page import block
from demos.pipe_segment.curves import FORMULAS, HERE, PAUSE, SCENE, D, demo_path, monotonic, resistance
from demos.pipe_segment.run import FINER, NOISE, SMALL, capacity_page, stiffness_page
from riser_soil.calibration.segment import write_table
from riser_soil.core.arrays import Array
from riser_soil.scene.reader import read_scene

PAGE = (HERE / "README.md").read_text(encoding="utf-8")


def rows(text: str) -> dict[str, list[str]]:
    cells = ([cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines()[2:])
    return {first: others for first, *others in cells}


@cache
def coarse() -> tuple[Array, Array]:
    """Penetration over D and V/(su D) of the scene, straight down."""
    path = monotonic()
    return path.w / D, resistance(path)


def test_the_scene_follows_the_demo_s_path(tmp_path: Path) -> None:
    path = demo_path()
    write_table(path, 0.0, tmp_path / "path.csv")
    assert (tmp_path / "path.csv").read_text() == (HERE / "penetration.csv").read_text()
    (stage,) = read_scene(SCENE).stages
    assert stage.kind == "quasi-static"
    assert stage.duration == len(path.w) - 1


@pytest.mark.verify
def test_page_shows_capacities_as_computed() -> None:
    shown, name = rows(block(PAGE, "capacity")), "cells of D/16"
    computed = rows(capacity_page({name: coarse()}))
    assert all(shown[formula] == computed[formula] for formula in FORMULAS)
    numbers = [[float(x) for x in table[f"segment, {name}"]] for table in (shown, computed)]
    assert numbers[0] == pytest.approx(numbers[1], rel=0.01, abs=0.01)


@pytest.mark.verify
def test_resistance_is_that_of_a_smooth_pipe_with_heave() -> None:
    """Merifield, White & Randolph's, for clay that does not harden; this one's strength is far from used at first."""
    ratio, V = coarse()
    assert np.all(np.diff(V) > -0.01 * V.max())
    deep = ratio >= PAUSE
    np.testing.assert_allclose(V[deep], FORMULAS["Merifield et al., smooth"](ratio[deep]), rtol=0.1)
    assert V[-1] == pytest.approx(FORMULAS["Merifield et al., smooth"](ratio[-1]), rel=0.03)


@pytest.mark.verify
@pytest.mark.parametrize("cells", [(), (FINER,)], ids=["D/16", "D/32"])
def test_resistance_never_falls_down_to_a_quarter_of_the_diameter(cells: tuple[str, ...]) -> None:
    V = resistance(monotonic(0.25), *cells)
    assert np.diff(V).min() > -1e-3 * V.max()
    assert V[-1] == pytest.approx(FORMULAS["Merifield et al., smooth"](0.25), rel=0.03)


def test_what_was_found_covers_what_was_behind_the_curves() -> None:
    for name, (truth, fit, interval, _) in rows(block(PAGE, "fits")).items():
        low, high = map(float, interval.split(" to "))
        assert low <= float(fit) <= high
        if name.startswith("the model's own"):
            assert low <= float(truth) <= high
        if "su`" in name and name.startswith("the model's own"):
            assert float(fit) == pytest.approx(float(truth), rel=0.02)
    assert NOISE == 0.05


@pytest.mark.parametrize("target", sorted(set(re.findall(r"\]\(([^)#]+)\)", PAGE))))
def test_link(target: str) -> None:
    assert (HERE / target).exists()


@pytest.mark.verify
def test_page_shows_stiffnesses_as_computed() -> None:
    path = demo_path()
    shown, computed = rows(block(PAGE, "stiffness")), rows(stiffness_page(path.w, resistance(path)))
    assert shown.keys() == computed.keys()
    for name in shown:
        numbers = [[float(x) for x in table[name]] for table in (shown, computed)]
        assert numbers[0] == pytest.approx(numbers[1], rel=0.02, abs=1.0)


@pytest.mark.verify
def test_soil_at_small_strain_loses_its_resistance() -> None:
    path = monotonic(PAUSE)
    ratio = path.w / D
    large, small = (resistance(path, *more) for more in ((), (SMALL,)))
    assert np.diff(large).min() > -5e-3 * large.max()
    assert small[-1] < 0.5 * large[-1]
    assert 0.03 < ratio[small.argmax()] < 0.07
