"""The swinging hose's demo: its figures, its page, and what its convergence promises."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from demos.compute import compute
from demos.page import block
from demos.tank.convergence import CHEAP, COUNT, STEP, STIFFNESS
from demos.tank.run import SEABEDS, near_touchdown, seabeds_page
from demos.tank.statics import HERE, at_rest, penalty_rows, reference
from demos.tank.swing import EXTREMES, MOMENT, SCENE, TOUCHDOWN, Swing, orders, swing
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.reader import read_scene

PAGE = "".join((HERE / page).read_text(encoding="utf-8") for page in ("README.md", "convergence.md"))
EXAMPLE = Path(__file__).parent / "tank.yaml"
SHOWN = slice(4, 4 + len(EXTREMES))
Rows = list[list[str]]


def rows(name: str) -> Rows:
    return [[cell.strip() for cell in line.split("|")[1:-1]] for line in block(PAGE, name).splitlines()[2:]]


@pytest.fixture(scope="module")
def cheap(tmp_path_factory: pytest.TempPathFactory) -> Swing:
    return swing(tmp_path_factory.mktemp("tank"), *CHEAP[1])


def test_scene_is_the_example() -> None:
    assert dump_scene(read_scene(SCENE)) == dump_scene(read_scene(EXAMPLE))


def test_page_shows_a_cheap_run_as_computed(cheap: Swing) -> None:
    shown = [float(cell) for cell in rows("cheap")[1][SHOWN]]
    assert shown == pytest.approx([*cheap.extremes.values()], rel=1e-4, abs=0.02)


def test_cheap_run_is_near_the_finest(cheap: Swing) -> None:
    """Tensions to 4 N, as far as 100 elements shake the hose when it touches down; the moment to 0.1 %, the touchdown
    arc to 2 mm.
    """
    finest = dict(zip(EXTREMES, map(float, rows("cheap")[-1][SHOWN]), strict=True))
    bounds = dict.fromkeys(EXTREMES, 4.0) | dict.fromkeys(TOUCHDOWN, 2e-3)
    bounds |= {name: 1e-3 * finest[name] for name in MOMENT}
    assert {name for name in EXTREMES if abs(cheap.extremes[name] - finest[name]) > bounds[name]} == set()


def test_cheap_run_is_easy_to_solve(cheap: Swing) -> None:
    assert cheap.stage["iterations"] <= 4.0
    assert cheap.stage["cuts"] == 0
    assert cheap.stage["energy"] < 0.01


def test_motion_repeats_itself_from_period_to_period(cheap: Swing) -> None:
    position, period = near_touchdown(cheap.run), round(10.0 / cheap.time_step)
    assert np.abs(position[-period:] - position[-2 * period : -period]).max() < 0.01 * np.ptp(position[-period:, 2])


@pytest.mark.parametrize("name", ["elements", "steps", "stiffnesses", "cheap"])
def test_page_s_runs_were_easy_to_solve(name: str) -> None:
    for row in rows(name):
        iterations, cuts, energy = (float(cell) for cell in row[SHOWN.stop : SHOWN.stop + 3])
        assert (iterations <= 4.0, cuts, energy < 0.01) == (True, 0.0, True)


def test_page_shows_the_penalty_as_computed() -> None:
    assert rows("at_rest_penalty") == penalty_rows()


def test_page_shows_the_mesh_s_error_as_computed(tmp_path: Path) -> None:
    (shown,) = (row for row in rows("at_rest_mesh") if row[:3] == ["line", "1e+06", "100"])
    errors = at_rest(tmp_path, 100, 1e6).errors(reference()[1][1e6])
    assert [float(cell) for cell in shown[3:]] == pytest.approx(list(errors), rel=0.1)


@pytest.mark.parametrize("target", sorted(set(re.findall(r"\]\(([^)#]+)\)", PAGE))))
def test_link(target: str) -> None:
    assert (HERE / target).exists()


@pytest.mark.verify
def test_page_shows_the_seabeds_as_computed(tmp_path: Path) -> None:
    runs = {name: compute(SCENE, tmp_path / name, *overrides) for name, overrides in SEABEDS.items()}
    computed = [line.split("|")[2:-1] for line in seabeds_page(runs).splitlines()[2:]]
    shown = [row[1:] for row in rows("seabeds")]
    assert np.array(shown, dtype=float) == pytest.approx(np.array(computed, dtype=float), rel=1e-3, abs=0.03)


@pytest.mark.verify
def test_order_in_elements_and_step(tmp_path: Path) -> None:
    """Order of the positions; vibrations along the hose hide that of the tensions."""
    by_elements = [swing(tmp_path / str(n), n, STEP, STIFFNESS) for n in (100, 200, 400)]
    by_step = [swing(tmp_path / str(dt), COUNT, dt, STIFFNESS) for dt in (0.1, 0.05, 0.025)]
    assert orders(*by_elements)["position"] > 2.5
    assert orders(*by_step)["position"] == pytest.approx(2.0, abs=0.3)
