"""The JONSWAP spectrum, and seas drawn from it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.signal import periodogram

from riser_soil.core.arrays import Array
from riser_soil.sea.components import Components
from riser_soil.sea.flows import Sea
from riser_soil.sea.spectra import components, quantiles, spectrum
from riser_soil.sea.waves import linear_waves

G, HS, TP, GAMMA, DEPTH = 9.81, 6.0, 11.0, 3.3, 120.0
PEAK = 2.0 * np.pi / TP


def sea(count: int = 100, seed: int = 1, gamma: float = GAMMA) -> Components:
    return components(HS, TP, gamma, count, seed, 0.5, G, DEPTH)


def energy(low: float, high: float, gamma: float = GAMMA) -> float:
    """Energy of the spectrum between two frequencies relative to the peak's [m2]."""
    return float(quad(lambda x: PEAK * spectrum(np.array([x * PEAK]), HS, TP, gamma)[0], low, high, epsabs=1e-13)[0])


@pytest.mark.parametrize("gamma", [1.0, 3.3, 7.0])
def test_spectrum_has_the_energy_of_its_significant_height(gamma: float) -> None:
    whole = sum(energy(*part, gamma) for part in ((0.2, 0.8), (0.8, 1.0), (1.0, 1.5), (1.5, 20.0), (20.0, np.inf)))
    assert whole == pytest.approx(HS**2 / 16.0, rel=1e-9)


def test_spectrum_without_enhancement_is_that_of_pierson_and_moskowitz() -> None:
    w = np.linspace(0.3, 3.0, 50)
    expected = 5.0 / 16.0 * HS**2 * PEAK**4 * w**-5 * np.exp(-1.25 * (PEAK / w) ** 4)
    assert spectrum(w, HS, TP, 1.0) == pytest.approx(expected, rel=1e-10)


def test_peak_is_enhanced_by_gamma() -> None:
    """Relative to the tail, where gamma has no part but by the common factor."""
    ratio = spectrum(np.array([PEAK, 3.0 * PEAK]), HS, TP, 3.3) / spectrum(np.array([PEAK, 3.0 * PEAK]), HS, TP, 1.0)
    assert ratio[0] / ratio[1] == pytest.approx(3.3, rel=1e-12)


def test_peak_is_narrower_below_than_above() -> None:
    """One width from the peak, 0.07 below and 0.09 above, the enhancement is gamma^exp(-1/2)."""
    w = PEAK * np.array([0.93, 1.09, 3.0])
    ratio = spectrum(w, HS, TP, 3.3) / spectrum(w, HS, TP, 1.0)
    assert ratio[:2] / ratio[2] == pytest.approx([3.3 ** np.exp(-0.5)] * 2, rel=1e-12)


@pytest.mark.parametrize("gamma", [1.0, 7.0])
def test_range_of_frequencies_leaves_little_energy_out(gamma: float) -> None:
    """Half the peak's to five times as much: below that there is nothing, above 0.1 to 0.2 %."""
    assert energy(0.1, 0.5, gamma) < 1e-6 * HS**2 / 16.0
    assert energy(5.0, np.inf, gamma) < 2.1e-3 * HS**2 / 16.0
    assert quantiles(np.array([0.0, 1.0]), gamma) == pytest.approx([0.5, 5.0], rel=2e-3)


@pytest.mark.parametrize("count", [1, 7, 100])
def test_amplitudes_add_up_to_the_significant_height(count: int) -> None:
    waves = sea(count)
    assert np.sum(waves.amplitude**2) / 2.0 == pytest.approx(HS**2 / 16.0, rel=1e-14)
    assert all(part.shape == (count,) for part in waves)
    assert waves.frequency == pytest.approx(np.sqrt(G * waves.wave_number * np.tanh(waves.wave_number * DEPTH)))


def test_seed_decides_the_sea() -> None:
    first, again, other = sea(seed=1), sea(seed=1), sea(seed=2)
    assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True))
    assert not np.isclose(first.frequency, other.frequency, rtol=1e-6).any()
    assert not np.isclose(first.phase, other.phase, rtol=1e-6).any()


def test_each_bin_of_equal_energy_has_one_wave() -> None:
    x, total = sea(40).frequency / PEAK, energy(0.5, 5.0)
    share = np.array([energy(0.5, value) for value in x]) / total
    assert np.array_equal(np.floor(40.0 * share), np.arange(40.0))
    assert np.unique(np.floor(400.0 * share) % 10.0).size > 5


def record(waves: Components, dt: float, count: int) -> Array:
    """The surface's rise at x = y = 0, once a step."""
    starts = np.arange(0, count, 2000)
    times = (dt * np.arange(start, min(start + 2000, count)) for start in starts)
    return np.concatenate([np.cos(np.outer(t, waves.frequency) - waves.phase) @ waves.amplitude for t in times])


def test_record_is_the_rise_of_the_water() -> None:
    flow, origin = Sea(0.0, [linear_waves(sea(), DEPTH, 0.0)]), np.zeros((1, 3))
    assert record(sea(), 50.0, 40) == pytest.approx([flow(50.0 * n, origin).immersion[0] for n in range(40)], abs=1e-10)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_long_record_has_the_spectrum_that_was_asked_for(seed: int) -> None:
    """Twenty hours of 200 waves, long enough to tell them apart; bands of about an eighth of the energy each."""
    eta = record(sea(200, seed), 1.0, 72000)
    assert 4.0 * np.std(eta) == pytest.approx(HS, rel=2e-3)
    f, density = periodogram(eta, window="hann")
    w = 2.0 * np.pi * f / PEAK
    edges = quantiles(np.linspace(0.0, 1.0, 9), GAMMA)
    for low, high in pairwise(edges):
        content = np.sum(density[(w >= low) & (w < high)]) * f[1]
        assert content == pytest.approx(energy(low, high), rel=0.02)
    width = np.count_nonzero(w < 0.06)
    peak = w[np.argmax(np.convolve(density, np.ones(width), "same"))]
    assert peak == pytest.approx(1.0, rel=0.02)
