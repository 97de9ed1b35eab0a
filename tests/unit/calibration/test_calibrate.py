"""Calibration: bad data, the path through measured points, least squares with intervals, known numbers found again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from riser_soil.calibration.calibrate import calibrate
from riser_soil.calibration.least_squares import FitParameter, deviations, fit
from riser_soil.calibration.path import path_through, read_resistance, steps, turns
from riser_soil.calibration.segment import TABLE, PipeSegment, first_penetration, write_table
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.reader import read_scene
from riser_soil.soil.clay import UndrainedClay
from riser_soil.variants.variant import BaseScene
from tests.support.said import telling

SCENE = Path(__file__).parents[3] / "demos/pipe_segment/scene.yaml"
SLICE = ("soil.mesh.size_at_riser=0.075", "soil.block.x=[0.1125, 0.1875]")
COARSE = (*SLICE, "soil.block.y=[-0.6, 0.6]", "soil.block.depth=0.6")
D = 0.3
GOOD = "w [mm], V [kN/m]\n0, 0\n3, 1.2\n6, 2.0\n3, 0.1\n"


def written(folder: Path, text: str) -> Path:
    file = folder / "data.csv"
    file.write_text(text, encoding="utf-8")
    return file


def test_data_are_read_in_their_units(tmp_path: Path) -> None:
    measured = read_resistance(written(tmp_path, GOOD))
    assert measured.w.tolist() == pytest.approx([0.0, 0.003, 0.006, 0.003])
    assert measured.V.tolist() == pytest.approx([0.0, 1200.0, 2000.0, 100.0])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "the file is empty"),
        ("w [m], V [N]\n1, 2\n", "v can't be in [N], accepted are N/m"),
        ("w [m]\n1\n", "there is no column v"),
        ("w [m], V [N/m]\n0, 0\n0.1, 2\n", "2 rows"),
        ("w [m], V [N/m]\n0, 0\n0.1, nan\n0.2, 1\n0.3, 1\n", "not a finite number"),
        ("w [m], V [N/m]\n0.1, 0\n0.1, 1\n0.1, 2\n0.1, 3\n", "the pipe must move"),
        ("w [m], V [N/m]\n0, 0\n0.1, -1\n0.2, -2\n0.3, -3\n", "check the sign of V"),
    ],
)
def test_bad_data_are_refused_in_one_line(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(SceneError) as error:
        read_resistance(written(tmp_path, text))
    assert said in str(error.value)
    assert "data.csv" in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("wanted", "said"),
    [
        ((), "name at least one number"),
        (("soil.law.su",), "must be path=low:high"),
        (("soil.law.su=9e3:1e3",), "smaller than the second"),
        (("soil.law.cu=1e3:9e3",), "soil.law.cu: missing"),
        (("soil.law.kind=1:2",), "only a number"),
        (("soil.law.su=6e3:9e3",), "the search begins there"),
        (("soil.law.su=1e3:9e3", "soil.law.su=1e3:9e3"), "given twice"),
        (("soil.law.su=1e3:9e3", "soil.law.E_over_su=1:999", "soil.law.nu=0.1:0.49", "gravity=9:10"), "determine 4"),
    ],
)
def test_bad_wishes_are_refused_and_nothing_is_left(tmp_path: Path, wanted: tuple[str, ...], said: str) -> None:
    with pytest.raises(SceneError, match=said):
        calibrate(written(tmp_path, GOOD), SCENE, wanted, tmp_path / "out")
    assert [entry.name for entry in tmp_path.iterdir()] == ["data.csv"]


@pytest.mark.parametrize(
    ("override", "said"),
    [
        ("riser.end.rotation=free", "riser.end: both ends"),
        ("riser.end.position=[0.3, 0.0, 0.16]", "lay the pipe level"),
        ("soil.law.rate={mu: 0.1, reference: 1.0e-5}", "leave rate out"),
    ],
)
def test_a_scene_that_is_no_segment_is_refused(override: str, said: str) -> None:
    with pytest.raises(SceneError, match=said):
        first_penetration(read_scene(SCENE, (override,)))


def test_a_penetration_of_the_wrong_unit_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=telling("w reaches 6 m", "pipe's diameter")):
        calibrate(written(tmp_path, GOOD.replace("[mm]", "[m]")), SCENE, ["soil.law.su=1e3:9e3"], tmp_path / "out")


def test_resistance_is_per_length_of_pipe_on_soil(tmp_path: Path) -> None:
    """In plane strain it does not matter how thick the slice is, nor how far the pipe juts out."""
    path, table = path_through(np.array([0.02 * D]), 0.0, 0.01 * D), tmp_path / TABLE
    write_table(path, 0.0, table)
    thick, longer = "soil.block.x=[0.075, 0.225]", "riser.end.position=[0.6, 0.0, 0.15]"
    more = (thick, longer, "riser.segments.0.length=0.6")
    V = [PipeSegment(BaseScene.read(SCENE, (*COARSE, *given))).resistance({}, path, table)[-1] for given in ((), more)]
    assert V[1] == pytest.approx(V[0], rel=0.01)
    assert V[0] > 500.0


def test_other_files_are_not_overwritten(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=telling("more than a calibration", "data.csv")):
        calibrate(written(tmp_path, GOOD), SCENE, ["soil.law.su=1e3:9e3"], tmp_path, force=True)


def test_turns_leave_scatter_out() -> None:
    assert turns(np.array([0.0, 1.0, 0.9, 2.0, 1.0, 0.5, 0.6, 0.4, 3.0]), 0.5).tolist() == [0, 3, 7, 8]


def test_steps_grow_from_a_turn_on() -> None:
    sizes = np.diff(steps(1.0, 0.1))
    assert sizes.sum() == pytest.approx(1.0)
    assert sizes.max() <= 0.1
    assert sizes[0] < 0.2 * sizes[-1]


def test_the_path_passes_through_the_measured_points() -> None:
    """A value at the steps that is a function of the way gone comes back at the points; up and down tell apart."""
    w = np.concatenate([np.linspace(0.01, 0.2, 7), np.linspace(0.18, 0.1, 4), np.linspace(0.13, 0.3, 5)])
    path = path_through(w, 0.0, 0.02)
    assert path.at_points(path.w) == pytest.approx(w, abs=1e-12)
    way = path.at_points(np.concatenate(([0.0], np.cumsum(np.abs(np.diff(path.w))))))
    assert way == pytest.approx(0.01 + np.concatenate(([0.0], np.cumsum(np.abs(np.diff(w))))), abs=1e-12)
    assert np.abs(np.diff(path.w)).max() <= 0.02 + 1e-12


def power_law(ratio: Array, given: Mapping[str, float]) -> Array:
    """V/(su D) = a (w/D)^b."""
    return np.asarray(given["a"] * ratio ** given["b"])


A, B = FitParameter("a", 1.0, 20.0, 2.0), FitParameter("b", -1.0, 1.0, 0.9)


@pytest.mark.parametrize("relative", [False, True])
def test_intervals_cover_the_truth_as_often_as_they_say(relative: bool) -> None:
    """95 % of them within three standard deviations of a count of 200, for a factor and for a signed number."""
    ratio, truth = np.linspace(0.01, 0.5, 40), {"a": 6.73, "b": 0.29}
    clean, covered = power_law(ratio, truth), np.zeros(2)
    for seed in range(200):
        noise = 0.05 * np.random.default_rng(seed).normal(size=40) * (clean if relative else 4.0)
        result = fit(lambda given: power_law(ratio, given), clean + noise, (A, B), relative=relative)
        assert result.converged
        for n, each in enumerate(result.parameters):
            low, high = each.interval
            covered[n] += low <= truth[each.parameter.name] <= high
    assert np.abs(covered - 190).max() <= 3 * np.sqrt(200 * 0.05 * 0.95), covered


def test_what_the_data_do_not_tell_is_said() -> None:
    both = FitParameter("c", 1.0, 20.0, 2.0)
    ratio = np.linspace(0.01, 0.5, 40)
    result = fit(lambda g: g["a"] * g["c"] * ratio, 12.0 * ratio, (A, both))
    assert [each.known for each in result.parameters] == [False, False]
    assert np.isinf(deviations(np.ones((2, 2)), np.ones(2))).all()


def test_a_bound_is_reported() -> None:
    ratio = np.linspace(0.01, 0.5, 40)
    result = fit(lambda g: g["a"] * ratio, 30.0 * ratio, (A,))
    assert result.parameters[0].at_bound
    assert result.parameters[0].value == pytest.approx(20.0, rel=1e-2)


def test_a_noisy_curve_gives_its_strength_back(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """5 % noise: su within 2 %, and the interval covers it; the folder's scene is the calibrated one."""
    w = np.linspace(0.0, 0.06, 60) * D
    path, table = path_through(w, 0.0, 0.01 * D), tmp_path / TABLE
    write_table(path, 0.0, table)
    V = path.at_points(PipeSegment(BaseScene.read(SCENE, COARSE)).resistance({"soil.law.su": 4.0e3}, path, table))
    noisy = V * (1.0 + 0.05 * np.random.default_rng(3).normal(size=len(w)))
    data = written(tmp_path, "w [m], V [N/m]\n" + "\n".join(f"{a}, {b}" for a, b in zip(w, noisy, strict=True)))
    result = calibrate(data, SCENE, ["soil.law.su=1e3:1e4"], tmp_path / "out", overrides=COARSE, relative=True)
    (su,) = result.parameters
    assert su.value == pytest.approx(4.0e3, rel=0.02)
    assert su.interval[0] < 4.0e3 < su.interval[1]
    assert su.interval[1] - su.interval[0] < 0.05 * su.value
    soil = read_scene(tmp_path / "out/calibrated.yaml").soil
    assert soil is not None
    assert isinstance(soil.law, UndrainedClay)
    assert soil.law.su == su.value
    assert json.loads((tmp_path / "out/calibration.json").read_text())["converged"]
    assert (tmp_path / "out/fit.png").stat().st_size > 10_000
    assert "misfit" in capsys.readouterr().out
