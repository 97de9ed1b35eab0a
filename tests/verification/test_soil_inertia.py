"""Soil with inertia under a riser that heaves: its ledger, beside quasi-static soil, by both schemes, on ranks."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.whole_run import run
from tests.support.on_ranks import mpirun
from tests.support.scenes import LAY, Mapping, heave, touchdown

WAYS: dict[str, tuple[Mapping, Mapping]] = {
    "quasi-static": ({"strain": "small"}, {}),
    "held": ({"inertia": True}, {}),
    "absorbing": ({"inertia": True, "absorbing": True}, {}),
    "Newmark": ({"inertia": True, "absorbing": True}, {"scheme": {"newmark": {"beta": 0.25, "gamma": 0.5}}}),
    "half as dense": ({"inertia": True, "density": 900.0}, {}),
}


def scene(soil: Mapping, stage: Mapping, duration: float = 1.5) -> Mapping:
    given = touchdown(LAY, heave(duration) | stage, su=1000.0, tolerance=1e-9)
    given["soil"] |= soil
    return given | {"contact": {"method": "surface", "smoothing": 1e-3}}


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Run]:
    results = {}
    for way, given in WAYS.items():
        folder = tmp_path_factory.mktemp("run")
        run(scene_from_mapping(scene(*given)), folder)
        results[way] = Run(folder)
    return results


def energy(of: Run) -> dict[str, Any]:
    values: dict[str, Any] = of.summary["stages"][1]["energy"]
    return values


@pytest.mark.parametrize("way", [way for way in WAYS if way != "quasi-static"])
def test_the_ledger_closes(runs: dict[str, Run], way: str) -> None:
    """To what the scheme makes of quasi-static soil; the soil's own share is not the scheme's."""
    lost = energy(runs[way])["dissipated_by"]
    assert abs(energy(runs[way])["relative_residual"]) < 2.0 * abs(energy(runs["quasi-static"])["relative_residual"])
    assert lost["soil_time_scheme"] == 0.0
    assert lost["soil_plasticity"] > 0.0
    assert ("soil_boundary" in lost) == (way in ("absorbing", "Newmark"))
    assert lost.get("soil_boundary", 1.0) > 0.0


def test_slow_motion_is_that_on_quasi_static_soil(runs: dict[str, Run]) -> None:
    """A pulse goes through the block in 0.02 s, and the heave takes 3 s; what inertia changes is seen all the same."""
    slow, *others = (runs[way]["position"] for way in ("quasi-static", "held", "half as dense"))
    heaved = np.abs(slow - slow[0]).max()
    off = [float(np.abs(other - slow).max()) / heaved for other in others]
    assert 1e-7 < off[1] < off[0] < 5e-3


def test_schemes_agree(runs: dict[str, Run]) -> None:
    one, other = (runs[way]["position"] for way in ("absorbing", "Newmark"))
    assert 0.0 < np.abs(one - other).max() < 2e-3


def test_ranks_agree(runs: dict[str, Run], tmp_path: Path) -> None:
    """In the first steps."""
    (tmp_path / "scene.yaml").write_text(json.dumps(scene(*WAYS["absorbing"], duration=0.5)), encoding="utf-8")
    done = mpirun(2, "-m", "riser_soil", "run", "scene.yaml", "-o", "out", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    several, alone = Run(tmp_path / "out"), runs["absorbing"]
    assert several.summary["ranks"] == 2
    np.testing.assert_allclose(several["position"], alone["position"][: several.time.size], atol=1e-7)
    for name in ("kinetic_energy", "dissipated_soil_boundary"):
        expected = alone[name][: len(several[name])]
        assert expected.max() > 0.0
        np.testing.assert_allclose(several[name], expected, rtol=1e-5, atol=1e-5 * np.abs(expected).max())
