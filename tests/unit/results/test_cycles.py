"""Secant stiffness from a run's files, against ranges that are known."""

from __future__ import annotations

import json
from pathlib import Path

import h5py
import numpy as np
import pytest
from ruamel.yaml import YAML
from typer.testing import CliRunner

from riser_soil.__main__ import app
from riser_soil.errors import ResultsError
from riser_soil.results import Run
from riser_soil.results.cycles import COLUMNS, secant_stiffness
from tests.support.said import telling
from tests.support.scenes import LAY, dynamic, touchdown

PERIOD, SU = 2.0, 3.0e3
STIFFNESS, HEAVE = 4.0e5, (0.01, 0.02, 0.005)  # N/m2; amplitude [m] in each cycle
ARC = np.array([0.0, 10.0, 20.0])
HEAVING = {"end": {"harmonic": {"amplitude": [0.0, 0.0, 0.02], "period": PERIOD}}}
SCENE = touchdown(LAY, dynamic(7.0, 0.05, "heave", motion=HEAVING), su=SU)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A static record, then 3.5 cycles of 40 records: z = -A sin, f = k A sin at arc 0, half as stiff at 20 m."""
    t = np.arange(1, 141) * (PERIOD / 40.0)
    amplitude = np.append(HEAVE, 0.3)[np.minimum(((t - 1e-9) / PERIOD).astype(int), 3)]
    wave = np.concatenate([[0.0], amplitude * np.sin(2.0 * np.pi * t / PERIOD)])
    force = 700.0 + STIFFNESS * wave[:, None] * np.array([1.0, 0.75, 0.5])
    position = np.zeros((141, 3, 3))
    position[:, :, 2] = 0.15 - wave[:, None]
    with h5py.File(tmp_path / "results.nc", "w") as file:
        file.update({"arc": ARC, "time": np.append(0.0, t), "stage": np.minimum(np.arange(141), 1)})
        file.update({"contact_force": force, "position": position})
    stages = [{"name": "lay", "kind": "static", "time": 0.0}, {"name": "heave", "kind": "dynamic", "time": t[-1]}]
    (tmp_path / "summary.json").write_text(json.dumps({"stages": stages}), encoding="utf-8")
    write_scene(tmp_path, SCENE)
    return tmp_path


def write_scene(folder: Path, scene: object) -> None:
    with (folder / "scene.yaml").open("w", encoding="utf-8") as file:
        YAML(typ="safe").dump(scene, file)


def test_a_spring_has_its_stiffness_in_every_cycle(folder: Path) -> None:
    stiffness = secant_stiffness(Run(folder), [0.0, 5.0, 20.0])
    assert stiffness.k.shape == (3, 3), "half a cycle is none"
    np.testing.assert_allclose(stiffness.k, np.outer(np.ones(3), [STIFFNESS, 0.875 * STIFFNESS, 0.5 * STIFFNESS]))
    np.testing.assert_allclose(stiffness.over_su, stiffness.k / SU)
    np.testing.assert_allclose(stiffness.height[:, 0], 2.0 * np.array(HEAVE))
    np.testing.assert_allclose(stiffness.end, PERIOD * np.arange(1, 4))


def test_a_riser_that_stays_or_floats_has_none(folder: Path) -> None:
    with h5py.File(folder / "results.nc", "a") as file:
        file["contact_force"][:, 0] = 0.0
        file["position"][:, 1, 2] = 0.15
    stiffness = secant_stiffness(Run(folder), [0.0, 10.0, 20.0])
    assert np.isnan(stiffness.k[:, :2]).all()
    assert not np.isnan(stiffness.k[:, 2]).any()


def test_ground_without_strength_and_another_period(folder: Path) -> None:
    write_scene(folder, SCENE | {"soil": None, "seabed": {"kind": "spring", "stiffness": 1.0e5}})
    stiffness = secant_stiffness(Run(folder), [0.0], stage="heave", period=2.0 * PERIOD)
    assert stiffness.height[:, 0] == pytest.approx([2.0 * max(HEAVE)])
    assert np.isnan(stiffness.over_su).all()


def test_strength_is_that_of_the_surface(folder: Path) -> None:
    """Strength of the first layer, and of a seabed of clay where there is no soil."""
    soil = dict(SCENE["soil"])
    law = soil.pop("law")
    layers = [{"to": 0.5, "law": law}, {"law": law | {"su": 2.0 * SU}}]
    write_scene(folder, SCENE | {"soil": soil | {"layers": layers}})
    assert secant_stiffness(Run(folder), [0.0]).over_su[0, 0] == pytest.approx(STIFFNESS / SU)
    clay = {"kind": "hysteretic", "law": {"kind": "randolph-quiggin", "su": 2.0 * SU}}
    write_scene(folder, SCENE | {"soil": None, "seabed": clay})
    assert secant_stiffness(Run(folder), [0.0]).over_su[0, 0] == pytest.approx(0.5 * STIFFNESS / SU)


@pytest.mark.parametrize(
    ("arc", "stage", "period", "says"),
    [
        (21.0, None, None, "arc length 21 m is not on the riser, which is 20 m long"),
        (1.0, "lay", None, 'is no quasi-static or dynamic stage of the run; its quasi-static or dynamic stages: heave'),
        (1.0, None, 8.0, 'stage "heave" has no whole cycle of 8 s'),
    ],
)
def test_what_cannot_be_is_said(folder: Path, arc: float, stage: str | None, period: float | None, says: str) -> None:
    with pytest.raises(ResultsError, match=says):
        secant_stiffness(Run(folder), [arc], stage, period)


def test_two_periods_are_none(folder: Path) -> None:
    ends = {"end": {"harmonic": {"period": 2.0}}, "start": {"harmonic": {"period": 3.0}}}
    write_scene(folder, SCENE | {"stages": [{}, {"motion": ends}]})
    with pytest.raises(ResultsError, match=telling("periods 2, 3 s", "length of a cycle")):
        secant_stiffness(Run(folder), [0.0])


def test_the_command_writes_csv(folder: Path) -> None:
    call = ["stiffness", str(folder), "--arc", "0", "--arc", "20"]
    done = CliRunner().invoke(app, call)
    assert done.exit_code == 0, done.output
    header, first, *rest = done.output.splitlines()
    assert header == ",".join(COLUMNS)
    assert first == f"0,1,2,{2.0 * HEAVE[0] * STIFFNESS:.6g},0.02,400000,133.333"
    assert len(rest) == 5
    CliRunner().invoke(app, [*call, "-o", str(folder / "k.csv")])
    assert (folder / "k.csv").read_text(encoding="utf-8") == done.output
    wrong = CliRunner().invoke(app, [*call, "-o", str(folder / "nowhere" / "k.csv")])
    assert wrong.exit_code == 4
    assert CliRunner().invoke(app, [*call, "--period", "0"]).exit_code == 2
