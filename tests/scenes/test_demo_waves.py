"""The demo in waves: its checks at rest, its made-up vessel, its page; the storm itself among the long tests."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import trapezoid

from demos.compute import compute
from demos.page import block
from demos.waves import checks, rao
from demos.waves.convergence import extremes
from demos.waves.run import HERE, SCENE, SINCE, STILL
from riser_soil.scene.reader import read_scene

FEW_ELEMENTS = [f"riser.segments.{n}.element_length=5.0" for n in range(5)]
PAGE = (HERE / "README.md").read_text(encoding="utf-8")


def test_still_riser_hangs_like_a_cable(tmp_path: Path) -> None:
    rows = list(checks.at_rest(compute(SCENE, tmp_path, *STILL)))
    assert len(rows) == 3
    for name, _, value, expected in rows:
        assert value == pytest.approx(expected, rel=1e-3), name
    shown = [float(line.split("|")[2]) for line in block(PAGE, "checks").splitlines()[2:5]]
    assert shown == pytest.approx([value for _, _, value, _ in rows], rel=1e-3)


def test_table_of_responses_is_what_its_script_writes() -> None:
    assert rao.FILE.read_text(encoding="utf-8") == rao.text()


def test_vessel_follows_long_waves_and_ignores_short_ones() -> None:
    surge, sway, heave, roll, pitch, yaw = rao.responses(np.array([0.05, 2.5]), np.radians(195.0))
    along, across, slope = np.cos(np.pi / 12), np.sin(np.pi / 12), 0.05**2 / 9.81
    assert [abs(x[0]) for x in (heave, surge, sway)] == pytest.approx([1.0, along, across], rel=0.02)
    assert [abs(x[0]) for x in (roll, pitch)] == pytest.approx([slope * across, slope * along], rel=0.02)
    assert abs(heave[1]) < 0.01
    assert not yaw.any()


def test_spectrum_holds_the_significant_height() -> None:
    w = np.linspace(0.1, 8.0, 20000)
    assert 4.0 * np.sqrt(trapezoid(checks.jonswap(w), w)) == pytest.approx(6.0, rel=0.01)


def test_turret_follows_the_waves_one_by_one(tmp_path: Path) -> None:
    """After the ramp; what remains is the table's interpolation, and what is of second order in angles."""
    run = compute(SCENE, tmp_path, "stages.1.duration=60.0", *FEW_ELEMENTS)
    window = run.time > 26.0
    moved = (run["position"][window, -1] - run["position"][0, -1]).T
    expected = checks.answer(run.time[window])
    assert np.abs(moved - expected).max(axis=1) == pytest.approx(np.zeros(3), abs=0.02 * expected.std(axis=1).max())


@pytest.mark.verify
def test_the_storm_is_the_page_s(tmp_path: Path) -> None:
    run = compute(SCENE, tmp_path)
    rows = list(checks.in_waves(run, SINCE))
    for name, _, value, expected in rows:
        assert value == pytest.approx(expected, rel=0.01 if "this sea" in name else 0.2), name
    shown = [float(line.split("|")[2]) for line in block(PAGE, "checks").splitlines()[5:]]
    assert shown == pytest.approx([value for _, _, value, _ in rows], rel=1e-3)
    (row,) = (row for row in block(PAGE, "extremes").splitlines() if row.startswith(f"| {run.arc.size - 1} | 0.2 |"))
    assert [float(cell) for cell in row.split("|")[4:11]] == pytest.approx([*extremes(run).values()], rel=1e-3)


def test_the_page_s_steps_and_elements_are_fine_enough() -> None:
    """Errors of T, M and s [%] of the scene as it stands, against the run with half the elements' length and a quarter
    of the step.
    """
    rows = [[cell.strip() for cell in row.split("|")[1:-1]] for row in block(PAGE, "extremes").splitlines()[2:]]
    (scene,) = (row for row in rows if row[:2] == [str(len(read_scene(SCENE).line.node_arcs) - 1), "0.2"])
    assert max(float(cell.removesuffix(" %")) for cell in scene[-3:]) < 1.0


@pytest.mark.parametrize("target", sorted(set(re.findall(r"\]\(([^)#]+)\)", PAGE))))
def test_link(target: str) -> None:
    assert (HERE / target).exists()
