"""Waves by series about places against plain sums over the components: everywhere, at all times, in any order."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.sea import spectra, wave_series
from riser_soil.sea.components import Components, regular
from riser_soil.sea.flows import Sea, WaterMotion
from riser_soil.sea.wave_series import number, places
from riser_soil.sea.waves import linear_waves
from tests.support.summed_waves import SummedWaves

G, LEVEL = 9.81, 7.0
DEPTHS = [np.inf, 1000.0, 120.0, 30.0, 5.0]
HOURS = 3.0 * 3600.0


def in_waves(*given: Any) -> Sea:
    """The sea with `linear_waves` of these arguments."""
    return Sea(LEVEL, [linear_waves(*given)])


KINDS = in_waves, SummedWaves
Stretching = Literal["wheeler", "vertical"]


def sea(h: float, Tp: float, count: int, seed: int, gamma: float = 2.0, direction: float = 0.4) -> Components:
    return spectra.components(0.01 * Tp**2 * (0.3 if h < 20.0 else 1.0), Tp, gamma, count, seed, direction, G, h)


def points(h: float, far: float, seed: int) -> Array:
    """Points from the bottom to above the crests, densest near the surface; some above it, some below the bottom."""
    draw = np.random.default_rng(seed)
    x = draw.uniform(-far, far, (400, 3))
    reach = min(h, 600.0)
    even, graded = draw.uniform(0.0, 1.02, 200), 10.0 ** draw.uniform(-5.0, 0.0, 100)
    x[:, 2] = LEVEL + np.concatenate([-reach * even, -reach * graded, draw.uniform(-2.0, 12.0, 100)])
    return x


def sizes(waves: Components, h: float) -> WaterMotion:
    """Sums of the components' amplitudes at the surface."""
    a, w, k = waves.amplitude, waves.frequency, waves.wave_number
    speed = a * w / np.tanh(np.minimum(k * h, 100.0))
    sums = speed, w * speed, k * speed, w * k * speed, a, k * a
    return WaterMotion(*(np.asarray(np.sum(values)) for values in sums))


def errors(motion: WaterMotion, expected: WaterMotion, size: WaterMotion) -> Array:
    return np.array([np.abs(f - e).max() / s for f, e, s in zip(motion, expected, size, strict=True)])


@pytest.mark.parametrize("stretching", ["wheeler", "vertical"])
@pytest.mark.parametrize("h", DEPTHS)
@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_series_are_the_sums(seed: int, h: float, stretching: Stretching) -> None:
    """Series agree to the round-off of the sums, and to the DEEPEST waves that are left out; in the ramp, too."""
    draw = np.random.default_rng(10 * seed)
    Tp, gamma, count = draw.uniform(3.0, 16.0), draw.uniform(1.0, 7.0), (1, 20, 200, 400)[seed - 1]
    waves, x = sea(h, Tp, count, seed, gamma, draw.uniform(-3.0, 3.0)), points(h, 100.0, seed)
    for ramp in (0.0, 80.0):
        t = draw.uniform(0.0, 80.0)
        series, summed = (kind(waves, h, LEVEL, stretching, ramp)(t, x) for kind in KINDS)
        assert errors(series, summed, sizes(waves, h)).max() < 1e-12
        assert np.abs(summed.velocity).max() > 1e-4 * sizes(waves, h).velocity


@pytest.mark.parametrize("h", DEPTHS)
def test_crossing_waves_are_summed_by_direction(h: float) -> None:
    waves = sea(h, 8.0, 60, 5)
    waves = waves._replace(direction=np.random.default_rng(6).choice([-2.0, -0.1, 0.4, 1.7], 60))
    x = points(h, 100.0, 7)
    series, summed = (kind(waves, h, LEVEL)(12.3, x) for kind in KINDS)
    assert errors(series, summed, sizes(waves, h)).max() < 1e-12


@pytest.mark.parametrize("h", DEPTHS)
def test_far_away_and_after_hours_only_the_phases_round_off(h: float) -> None:
    waves, x = sea(h, 6.0, 200, 8), points(h, 5000.0, 9)
    series, summed = (kind(waves, h, LEVEL)(HOURS, x) for kind in KINDS)
    assert errors(series, summed, sizes(waves, h)).max() < 1e-10


@pytest.mark.parametrize("h", [np.inf, 300.0])
def test_waves_go_on_across_the_borders_of_places(h: float) -> None:
    """Above each other and side by side, at all depths: what differs is the way from one side to the other."""
    waves = sea(h, 8.0, 100, 10, direction=0.0)
    side = np.sqrt(2.0) * wave_series.RADIUS / waves.wave_number.max()
    rows = np.arange(1.0, 2.0 * wave_series.NEAREST)
    depths = np.concatenate([side * 2.0**level * rows for level in range(7)])
    at = np.zeros((depths.size, 3))
    at[:, 0], at[:, 2] = side * 64.0, LEVEL - depths
    flow, step = Sea(LEVEL, [linear_waves(waves, h, LEVEL, "vertical")]), 1e-9 * side
    for axis in (0, 2):
        shift = step * np.eye(3)[axis]
        before, after = flow(5.0, at - shift), flow(5.0, at + shift)
        gone = 2.0 * step * before.velocity_gradient[:, :, axis]
        assert np.abs(after.velocity - before.velocity - gone).max() < 2e-13 * sizes(waves, h).velocity
        gone = 2.0 * step * before.acceleration_gradient[:, :, axis]
        assert np.abs(after.acceleration - before.acceleration - gone).max() < 2e-13 * sizes(waves, h).acceleration


def test_nothing_hangs_on_what_was_evaluated_before() -> None:
    """One field that has been everywhere, in any order, beside one that is new: as after a restart, to the last bit."""
    waves, x = sea(120.0, 9.0, 50, 11), points(120.0, 200.0, 12)
    draw, used = np.random.default_rng(13), Sea(LEVEL, [linear_waves(waves, 120.0, LEVEL, ramp=20.0)])
    for _ in range(20):
        t, some = draw.uniform(0.0, 60.0), draw.permutation(len(x))[:50]
        used(draw.uniform(0.0, 60.0), x + draw.uniform(-5.0, 5.0, 3))
        new = Sea(LEVEL, [linear_waves(waves, 120.0, LEVEL, ramp=20.0)])
        for values, expected in zip(used(t, x[some]), new(t, x), strict=True):
            assert np.array_equal(values, expected[some])


def test_places_that_find_no_workspace_are_computed_again(monkeypatch: pytest.MonkeyPatch) -> None:
    waves, x = sea(120.0, 9.0, 50, 11), points(120.0, 200.0, 12)
    roomy = Sea(LEVEL, [linear_waves(waves, 120.0, LEVEL)])(4.0, x)
    monkeypatch.setattr(wave_series, "MOST", 3)
    field = linear_waves(waves, 120.0, LEVEL)
    assert field.series.cells.places.key.size == 3
    for _ in range(2):
        for values, expected in zip(Sea(LEVEL, [field])(4.0, x), roomy, strict=True):
            assert np.array_equal(values, expected)


def test_stations_of_a_riser_share_few_places() -> None:
    """1200 stations of a catenary in a storm: fewer than one place for ten of them."""
    along = np.linspace(0.0, 1.0, 1200)
    x = np.stack([150.0 * along, 0.0 * along, 120.0 * along**2], axis=-1)
    field = linear_waves(sea(120.0, 13.0, 200, 1), 120.0, 120.0)
    Sea(120.0, [field])(3.0, x)
    used = [int(at.places.used[0]) for at in (field.series.columns, field.series.cells)]
    assert min(used) > 5
    assert sum(used) < 100


def test_long_and_short_waves_of_any_unit_of_length() -> None:
    """Waves in metres are those in millionths of metres."""
    here, tiny = (regular(0.02 * unit, 6.0, 0.3, 0.2, G * unit, 30.0 * unit) for unit in (1.0, 1e-6))
    x = points(30.0, 50.0, 14) - [0.0, 0.0, LEVEL]
    first = Sea(0.0, [linear_waves(here, 30.0, 0.0)])(2.0, x)
    second = Sea(0.0, [linear_waves(tiny, 30e-6, 0.0)])(2.0, 1e-6 * x)
    assert 1e6 * second.velocity == pytest.approx(first.velocity, abs=1e-14)
    assert 1e6 * second.immersion == pytest.approx(first.immersion, abs=1e-12)


def test_keys_keep_their_numbers_until_there_is_no_workspace() -> None:
    at, keys = places(50), np.random.default_rng(15).integers(-(2**60), 2**60, 50)
    keys[:20] = np.arange(-10, 10)
    assert [number(at, key) for key in keys] == list(range(50))
    at.time[:] = 1.0
    assert [number(at, key) for key in keys[::-1]] == list(range(49, -1, -1))
    assert not np.isnan(at.time).any()
    assert number(at, 12345) == 0
    assert [number(at, key) for key in keys[:3]] == [1, 2, 3]
    assert np.isnan(at.time[:4]).all()
