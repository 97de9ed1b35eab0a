"""Seas of several directions, trains and kinds: spreading, given spectra, records; against closed forms."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.plane import resolved_dimension
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.wave_kinds import relative_directions
from riser_soil.sea import spectra
from riser_soil.sea.components import Components
from riser_soil.sea.flows import Sea
from riser_soil.sea.waves import linear_waves
from tests.support.driven_stage import built
from tests.support.line_scenes import mooring, shaken
from tests.support.scenes import ON_SEABED
from tests.support.seas import components_of

SEA = {"Hs": 4.0, "Tp": 10.0, "components": 60}
DEPTH = 100.0


def scene(waves: dict[str, Any], folder: Path = Path(), **more: Any) -> Scene:
    water = {"density": 1025.0, "surface_level": DEPTH, "waves": waves}
    return scene_from_mapping(ON_SEABED | {"water": water} | more, folder)


def sea(waves: dict[str, Any], folder: Path = Path()) -> Components:
    components = components_of(scene(waves, folder))
    assert components is not None
    return components


def energy(waves: Components) -> Array:
    return 0.5 * waves.amplitude**2


@pytest.mark.parametrize("s", [1.0, 10.0, 50.0])
@pytest.mark.parametrize("count", [2, 10, 36])
def test_spread_energy_has_the_first_moments_of_the_closed_form(s: float, count: int) -> None:
    """Over all directions cos^2s(theta/2) has the mean s/(s + 1) of cos theta, and 0 of sin theta."""
    angles = np.array(relative_directions(s, count))
    assert np.cos(angles).mean() == pytest.approx(s / (s + 1.0), abs=1e-6)
    assert np.sin(angles).mean() == pytest.approx(0.0, abs=1e-14)
    assert (np.diff(angles) > 0.0).all()
    assert np.abs(angles).max() < math.pi


def test_the_spread_of_half_the_energy() -> None:
    """cos^2(theta/2), s = 1: theta + sin theta = pi/2 halves one side's energy."""
    inner, outer = relative_directions(1.0, 4)[2:]
    edge = 0.8317111935796765
    mean = [np.array([np.sin(b) + b / 2 + np.sin(2 * b) / 4 for b in ab]) for ab in ((0.0, edge), (edge, math.pi))]
    assert np.cos([inner, outer]) == pytest.approx([(b - a) / (math.pi / 2) for a, b in mean], abs=1e-6)


def test_a_spread_sea_has_all_its_energy_evenly_over_its_directions() -> None:
    spread = sea({"jonswap": SEA | {"direction_deg": 30.0, "spreading": {"s": 10.0, "directions": 6}}})
    assert energy(spread).sum() == pytest.approx(4.0**2 / 16.0, rel=1e-12)
    directions, counts = np.unique(spread.direction, return_counts=True)
    np.testing.assert_allclose(directions, math.radians(30.0) + np.array(relative_directions(10.0, 6)), atol=1e-12)
    assert counts.tolist() == [10] * 6
    for half in (slice(0, 30), slice(30, 60)):  # short waves and long ones alike
        assert np.unique(spread.direction[half], return_counts=True)[1].tolist() == [5] * 6
    long_crested = sea({"jonswap": SEA | {"direction_deg": 30.0}})
    np.testing.assert_array_equal(spread.frequency, long_crested.frequency)
    again, other = (
        sea({"jonswap": SEA | {"seed": n, "direction_deg": 30.0, "spreading": {"s": 10.0, "directions": 6}}})
        for n in (1, 2)
    )
    np.testing.assert_array_equal(again.direction, spread.direction)
    assert (other.direction != spread.direction).any()


def test_a_spread_sea_is_no_plane_problem() -> None:
    motion = {"water": {"surface_level": DEPTH, "waves": {"jonswap": SEA}}}
    assert resolved_dimension(scene_from_mapping(ON_SEABED | motion)) == 2
    spread = {"jonswap": SEA | {"spreading": {"s": 10.0}}}
    assert resolved_dimension(scene(spread)) == 3
    with pytest.raises(SceneError, match=r"water\.waves\.jonswap\.spreading"):
        scene(spread, dimension=2)


def test_pierson_and_moskowitz_is_jonswap_without_a_sharper_peak() -> None:
    """S = 5/16 Hs^2 wp^4 w^-5 exp(-5/4 (wp/w)^4)."""
    for part, other in zip(sea({"pierson_moskowitz": SEA}), sea({"jonswap": SEA | {"gamma": 1.0}}), strict=True):
        np.testing.assert_array_equal(part, other)
    w, wp = np.linspace(0.3, 3.0, 50), 2.0 * np.pi / 10.0
    closed = 5.0 / 16.0 * 4.0**2 * wp**4 * w**-5.0 * np.exp(-1.25 * (wp / w) ** 4)
    np.testing.assert_allclose(spectra.spectrum(w, 4.0, 10.0, 1.0), closed, rtol=1e-6)


def test_trains_add_up_and_differ_though_their_seeds_are_the_same() -> None:
    swell, wind = {"jonswap": SEA | {"Tp": 16.0, "gamma": 6.0}}, {"jonswap": SEA | {"direction_deg": 40.0}}
    both, first = sea({"trains": [swell, wind]}), sea(swell)
    assert energy(both).sum() == pytest.approx(2.0 * 4.0**2 / 16.0, rel=1e-12)
    np.testing.assert_array_equal(both.phase[:60], first.phase)
    assert (both.phase[60:] != both.phase[:60]).all()
    water = scene({"trains": [swell, wind]}).water
    assert water is not None
    assert water.waves is not None
    assert (water.waves.ramp, water.waves.count) == (16.0, 120)


def test_frequencies_of_a_given_spectrum_have_its_energy(tmp_path: Path) -> None:
    """A triangle: half the energy lies below its peak, a quarter below the peak over the square root of two."""
    (tmp_path / "s.csv").write_text("frequency [Hz], density [m2/Hz]\n0.1, 0\n0.2, 5\n0.3, 0\n")
    given = sea({"spectrum": {"file": "s.csv", "components": 60}}, tmp_path)
    assert energy(given).sum() == pytest.approx(0.5 * 0.2 * 5.0, rel=1e-12)
    w = 2.0 * np.pi * np.array([0.1, 0.2, 0.3])
    frequencies = spectra.quantiles_of_spectrum(np.array([0.0, 0.125, 0.5, 0.875, 1.0]), w, np.array([0.0, 20.0, 0.0]))
    np.testing.assert_allclose(frequencies / (2.0 * np.pi), [0.1, 0.15, 0.2, 0.25, 0.3], rtol=1e-12)
    assert (np.diff(given.frequency) > 0.0).all()
    model = scene({"spectrum": {"file": "s.csv"}}, tmp_path).water
    assert model is not None
    assert model.waves is not None
    ((_, kind),) = model.waves.each
    assert kind.height == pytest.approx(4.0 * math.sqrt(0.5))
    assert kind.period == pytest.approx(5.0)


def test_a_record_comes_back_where_it_was_taken(tmp_path: Path) -> None:
    """The surface of the sea, at the record's place and times, from its own kernels."""
    t = 0.5 * np.arange(64)
    eta = np.cos(0.8 * t) + 0.3 * np.sin(1.7 * t + 1.0)
    rows = "".join(f"{a:.6f}, {b:.12f}\n" for a, b in zip(t, eta, strict=True))
    (tmp_path / "eta.csv").write_text("t [s], elevation [m]\n" + rows)
    record = {"file": "eta.csv", "position": [12.0, -5.0], "direction_deg": 20.0}
    waves = sea({"record": record}, tmp_path)
    flow, place = Sea(0.0, [linear_waves(waves, DEPTH, 0.0)]), np.array([[12.0, -5.0, 0.0]])
    elevation = [flow(time, place).immersion[0] for time in t]
    nyquist = np.mean(eta * (-1.0) ** np.arange(64)) * (-1.0) ** np.arange(64)
    np.testing.assert_allclose(elevation, eta - eta.mean() - nyquist, atol=1e-9)


@pytest.mark.parametrize(
    ("waves", "message"),
    [
        ({"jonswap": SEA | {"spreading": {"s": 10.0, "directions": 8}}}, "components: value 60: must be a multiple"),
        ({"jonswap": SEA | {"spreading": {"s": 10.0, "directions": 3}}}, r"spreading\.directions: value 3"),
        ({"jonswap": SEA, "pierson_moskowitz": SEA}, "jonswap and pierson_moskowitz are both given"),
        ({"trains": [{"jonswap": SEA}]}, r"water\.waves\.trains"),
        ({"trains": [{"jonswap": SEA}, {}]}, r"water\.waves\.trains\.1.*no wave is given"),
        ({"trains": [{"jonswap": SEA}, {"jonswap": SEA | {"Hs": 40.0}}]}, r"trains\.1\.jonswap\.Hs: value 40"),
        ({"spectrum": {"file": "bad.csv"}}, r"bad\.csv:3: frequency must increase"),
        ({"record": {"file": "uneven.csv"}}, r"uneven\.csv:\d+: a step of"),
        ({"record": {"file": "short.csv"}}, r"short\.csv lasts 0\.8 s, but waves act for 1 s"),
        ({"record": {"file": "short.csv", "shortest_period": 5.0}}, "0 waves lie between"),
    ],
)
def test_mistakes(waves: dict[str, Any], message: str, tmp_path: Path) -> None:
    (tmp_path / "bad.csv").write_text("frequency [Hz], density [m2/Hz]\n0.2, 1\n0.1, 1\n")
    times = [0.05 * n for n in range(16)]
    for name, t in {"short": times, "uneven": [*times[:-1], 1.0]}.items():
        rows = "".join(f"{a:.4f}, {math.sin(9.0 * a) * 0.01:.6f}\n" for a in t)
        (tmp_path / f"{name}.csv").write_text("t [s], elevation [m]\n" + rows)
    with pytest.raises(SceneError, match=message):
        scene(waves, tmp_path)


def test_a_record_is_judged_by_the_waves_left_in(tmp_path: Path) -> None:
    """Noise crosses the mean more often than the waves do, which would break with so short a period."""
    t = np.arange(0.0, 200.0, 0.25)
    noise = 0.4 * np.cos(np.pi * np.arange(t.size) * 0.9)
    rows = "".join(f"{a:.6f}, {b:.6f}\n" for a, b in zip(t, np.cos(2.0 * np.pi * t / 8.0) + noise, strict=True))
    (tmp_path / "noisy.csv").write_text("t [s], elevation [m]\n" + rows)
    record = {"file": "noisy.csv", "shortest_period": 2.0}
    given = scene({"record": record}, tmp_path).water
    assert given is not None
    assert given.waves is not None
    ((_, train),) = given.waves.each
    assert train.height == pytest.approx(4.0 / np.sqrt(2.0), rel=1e-5)
    assert given.waves.ramp == pytest.approx(8.0, rel=0.05)


def test_bodies_in_waves_over_a_grid_have_the_depth_that_is_given(tmp_path: Path) -> None:
    """Over a grid of heights each of several lines has a seabed of its own, and the waves have one depth."""
    rows = [f"{x}, {y}, {-100.0 - 0.01 * x}" for x in (-150, 150) for y in (-150, 150)]
    (tmp_path / "heights.csv").write_text("\n".join(["x [m], y [m], z [m]", *rows]) + "\n", encoding="utf-8")
    seabed = {"kind": "spring", "stiffness": 1.0e5, "grid": str(tmp_path / "heights.csv")}
    water = {"density": 1025.0, "surface_level": 0.0, "depth": 100.0, "waves": {"airy": {"height": 1.0, "period": 6.0}}}
    assembly = built(mooring(shaken(), seabed=seabed, water=water))
    assert "body drag" in assembly.part_names
    assert assembly.sea is not None
    assert assembly.sea.waves is not None
    assert assembly.sea.waves.depth == 100.0


def test_all_that_floats_has_the_same_waves(monkeypatch: pytest.MonkeyPatch) -> None:
    """Waves are drawn once, and not anew for each stage, line or body."""
    waves = {"jonswap": {"Hs": 2.0, "Tp": 8.0, "components": 5}}
    water = {"density": 1025.0, "surface_level": 0.0, "depth": 100.0, "waves": waves}
    drawn, usual = list[float](), spectra.components

    def draw(Hs: float, *given: Any) -> Components:
        drawn.append(Hs)
        return usual(Hs, *given)

    monkeypatch.setattr(spectra, "components", draw)
    assembly = built(mooring(shaken(), shaken() | {"name": "again"}, water=water))
    for stage in assembly.scene.stages:
        assembly.begin(stage)
    assert drawn == [2.0]
