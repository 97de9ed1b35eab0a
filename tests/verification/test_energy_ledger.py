"""Where a run's energy goes: against closed forms, and in its files."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.whole_run import run
from tests.support.said import line_with
from tests.support.scenes import Mapping, dynamic, in_waves, prescribed, riser_scene, static

DENSITY, DRAG, WEIGHT, MASS, DIAMETER, LENGTH, DROP = 1025.0, 1.2, 700.0, 200.0, 0.3, 10.0, 2.0


@pytest.fixture(scope="module")
def fallen(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A level pipe falls 2 m through water on a rigid floor."""
    folder = tmp_path_factory.mktemp("fallen")
    pipe: Mapping = {"EA": 3e7, "EI": 5e4, "mass": MASS, "outer_diameter": DIAMETER, "submerged_weight": WEIGHT}
    pipe["drag"] = {"normal": DRAG}
    scene = riser_scene(
        dynamic(4.0, 0.01, "fall"),
        pipe=pipe,
        length=LENGTH,
        elements=5,
        start="free",
        end="free",
        riser={"initial": "straight"},
        dimension=2,
        water={"density": DENSITY},
        gravity=9.81,
        seabed={"kind": "rigid", "level": -DROP - 0.5 * DIAMETER},
        solver={"tolerance": 1e-9},
    )
    run(scene_from_mapping(scene), folder)
    return Run(folder)


def test_drag_takes_its_share_of_the_fall(fallen: Run) -> None:
    """Until the pipe lands v² = w/c (1 - exp(-2 c h/m)) after a fall h, c = rho Cd D/2; drag took w h - m v²/2."""
    before = np.flatnonzero(fallen["dissipated_seabed_time_scheme"] == 0.0)[-1]
    height = np.interp(fallen["step_time"][before], fallen["time"], fallen["position"][:, 0, 2])
    h, c = -height, 0.5 * DENSITY * DRAG * DIAMETER
    assert 0.98 * DROP < h < DROP
    kinetic = 0.5 * MASS * LENGTH * WEIGHT / c * (1.0 - np.exp(-2.0 * c * h / MASS))
    assert fallen["kinetic_energy"][before] == pytest.approx(kinetic, rel=1e-3)
    assert fallen["dissipated_morison"][before] == pytest.approx(WEIGHT * LENGTH * h - kinetic, rel=1e-3)


def test_drag_and_contact_take_all_that_the_weight_gives(fallen: Run) -> None:
    energy = fallen.summary["stages"][0]["energy"]
    assert energy["dissipated_by"].keys() == {"morison", "seabed", "seabed_time_scheme"}
    assert energy["dissipated_by"]["seabed"] == 0.0  # a rigid floor has no loss of its own
    assert energy["dissipated_by"]["seabed_time_scheme"] > 0.2 * energy["dissipated"]
    assert energy["dissipated"] == pytest.approx(WEIGHT * LENGTH * DROP, rel=1e-3)
    assert energy["kinetic"] < 1e-6 * energy["dissipated"]
    assert abs(energy["worst_residual"]["value"]) < 1e-3 * energy["turned_over"]
    warnings = fallen.summary["stages"][0]["warnings"]
    assert re.search(r"lost \S+ J to", line_with(warnings, "impact", "time step", "not to the ground"))


def waving(folder: Path, **more: Any) -> Run:
    scene = in_waves(0.1, 22.0) | more
    pipe = scene["line_types"]["pipe"] | {"damping": {"ratio": 0.05, "frequency": 0.5}}
    scene["line_types"] = {"pipe": pipe}
    scene["stages"][1]["motion"] = {"end": {"harmonic": {"amplitude": [0.2, 0.0, 0.5], "period": 4.0, "ramp": 2.0}}}
    scene["stages"][1]["loads"] = [{"at": 10.0, "force": [0.0, 0.0, 100.0]}]
    run(scene_from_mapping(scene), folder)
    return Run(folder)


def test_ledger_of_each_step_adds_up(tmp_path: Path) -> None:
    """In waves and current, with structural damping, a load and a moving end: nothing is left out of the sums."""
    run = waving(tmp_path / "out")
    ledger_names = ("structural_damping",), ("loads", "morison", "buoyancy", "supports")
    for total, names in zip(("dissipated", "work"), ledger_names, strict=True):
        parts = [run[f"{total}_{name}"][1:] for name in names]
        assert all(np.abs(part).max() > 0.1 for part in parts)
        np.testing.assert_allclose(sum(parts), run[total][1:], rtol=1e-12)
    stored = run["kinetic_energy"] + run["strain_energy"] + run["potential_energy"]
    spent = run["dissipated"] + run["dissipated_time_scheme"] - run["work"] - np.nancumsum(run["energy_residual"])
    np.testing.assert_allclose(np.diff(stored[1:]), -np.diff(spent[1:]), atol=1e-9 * np.abs(stored).max())


def test_ledger_in_the_summary_is_that_of_the_last_step(tmp_path: Path) -> None:
    run = waving(tmp_path / "out")
    energy = run.summary["stages"][1]["energy"]
    assert energy["kinetic"] == run["kinetic_energy"][-1]
    assert energy["numerical"] == run["dissipated_time_scheme"][-1]
    assert energy["work_by"]["supports"] == run["work_supports"][-1]
    relative = run["relative_energy_residual"][1:]
    assert energy["relative_residual"] == relative[-1] == energy["residual"] / energy["turned_over"]
    worst = energy["worst_residual"]
    at = np.flatnonzero(np.isclose(run["step_time"][1:], worst["time"]))[0]
    assert np.cumsum(run["energy_residual"][1:])[at] == pytest.approx(worst["value"], rel=1e-9)
    assert abs(worst["value"]) == pytest.approx(np.abs(np.cumsum(run["energy_residual"][1:])).max(), rel=1e-9)


def test_what_cannot_turn_energy_over_is_not_reported(tmp_path: Path) -> None:
    ends = prescribed(0.0, 0.0, 0.0), prescribed(9.0, 0.0, 0.0)
    pipe = {"EA": 1e6, "EI": 2e3, "mass": 20.0}
    scene = riser_scene(static(), dynamic(0.1, 0.1), pipe=pipe, length=9.0, elements=3, start=ends[0], end=ends[1])
    run(scene_from_mapping(scene), tmp_path)
    with pytest.raises(Exception, match="no dissipated_morison; it has") as error:
        Run(tmp_path)["dissipated_morison"]
    assert "work_supports" in str(error.value)
    assert "work_loads" not in str(error.value)


@pytest.mark.parametrize("duration", [2.0])
def test_too_long_steps_are_a_warning(tmp_path: Path, duration: float, capsys: pytest.CaptureFixture[str]) -> None:
    """A hanging line swings wildly in steps of 0.4 s."""
    pipe = {"EA": 1e5, "EI": 10.0, "mass": 20.0, "submerged_weight": 200.0}
    top = prescribed(0.0, 0.0, 0.0)
    given = riser_scene(dynamic(duration, 0.4), pipe=pipe, length=9.0, elements=6, start=top, end="free", gravity=9.81)
    given["riser"]["initial"] = "straight"
    run(scene_from_mapping(given), tmp_path)
    stage = Run(tmp_path).summary["stages"][0]
    assert any("take a smaller time_step" in text for text in stage["warnings"])
    assert "warning: dynamic: " in capsys.readouterr().out
