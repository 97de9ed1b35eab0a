"""The hose in a tank (tests/scenes/tank.yaml): its static shape, and the first seconds of its end's swing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from riser_soil.results import Run
from riser_soil.scene.reader import read_scene
from riser_soil.whole_run import run

SCENE = Path(__file__).parents[1] / "scenes/tank.yaml"
HUB, RADIUS, AMPLITUDE, PERIOD = np.array([28.0, 0.0, 17.0]), 2.0, np.radians(20.0), 10.0
WEIGHT, LENGTH, EI = 147.09975, 40.0, 1.0e3


@pytest.fixture(scope="module")
def swung(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("tank") / "results"
    run(read_scene(SCENE, ["stages.1.duration=4.0"]), folder)
    return Run(folder)


def test_hose_hangs_and_lies(swung: Run) -> None:
    """Anchor, floor and top bear its weight; bending lifts it off by up to its length sqrt(EI/H) before the catenary of
    the same H = T - w h would.
    """
    final = swung.summary["stages"][0]["final"]
    up = final["start"]["force"][2] + final["end"]["force"][2] + final["contact_force"]
    assert up == pytest.approx(WEIGHT * LENGTH, rel=1e-6)
    H = final["end"]["effective_tension"] - WEIGHT * 15.0
    assert final["end"]["force"][0] == pytest.approx(H, rel=0.05)
    lying = LENGTH - np.sqrt(15.0**2 + 2.0 * 15.0 * H / WEIGHT)
    assert lying - np.sqrt(EI / H) < final["touchdown_arc"] < lying


def test_top_swings_below_its_hub(swung: Run) -> None:
    """With the smooth step of a ramp of one period."""
    t, top = np.arange(1, 81) * 0.05, swung["position"][-80:, -1]
    x = t / 10.0
    phi = x**3 * (10.0 - 15.0 * x + 6.0 * x**2) * AMPLITUDE * np.sin(2.0 * np.pi * t / PERIOD)
    expected = HUB + RADIUS * np.stack([np.sin(phi), 0.0 * phi, -np.cos(phi)], axis=1)
    assert np.abs(top - expected).max() < 1e-12


def test_energy_balances(swung: Run) -> None:
    energy = swung.summary["stages"][1]["energy"]
    assert abs(energy["residual"]) < 1e-5 * energy["work"]
