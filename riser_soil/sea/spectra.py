"""Random seas drawn from a JONSWAP or a given spectrum, and waves that repeat a record of the surface."""

from __future__ import annotations

from functools import cache

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.sea.components import Components, alike, drawn, wave_number

# Frequencies of a sea's components, over the peak's. What lies outside is 0.0 % below and 0.1 to 0.2 % above of the
# spectrum's energy (gamma 7 to 1).
LOWEST, HIGHEST = 0.5, 5.0
_STEP = 1e-3  # of the logarithm of the frequency, in quadratures
_GOLDEN = 0.5 * (5.0**0.5 - 1.0)


def spectrum(w: Array, Hs: float, Tp: float, gamma: float) -> Array:
    """One-sided spectral density of the surface [m2 s/rad] at angular frequencies w > 0 [rad/s].

    Its integral is Hs^2/16 exactly: the shape of Hasselmann et al. (1973), with widths 0.07 below and 0.09 above the
    peak, is normalised by quadrature.
    """
    peak = 2.0 * np.pi / Tp
    return Hs**2 / (16.0 * peak * _area(gamma)) * _shape(w / peak, gamma)


def components(
    Hs: float, Tp: float, gamma: float, count: int, seed: int | list[int], toward: float | Array, g: float, h: float
) -> Components:
    """A sea of `count` waves towards directions (m,) [rad] in water of depth h [m]; the same seed gives the same sea.

    The frequencies from LOWEST to HIGHEST times the peak's are cut into bins of equal energy, one for each wave. Within
    its bin a wave's frequency is drawn with the spectrum as its density, so that no frequency is preferred and the sea
    never repeats itself; phases are drawn evenly. All amplitudes are alike, and the sum of a^2/2 is Hs^2/16. Of gamma 1
    it is the spectrum of Pierson and Moskowitz (1964).
    """
    draw = np.random.default_rng(seed)
    share = (np.arange(count) + draw.random(count)) / count
    w = 2.0 * np.pi / Tp * quantiles(share, gamma)
    return drawn(draw, Hs**2 / 16.0, w, np.atleast_1d(toward), g, h)


def _shape(x: Array, gamma: float) -> Array:
    """Density over the frequency x, relative to the peak's; of any size."""
    width = np.where(x <= 1.0, 0.07, 0.09)
    return x**-5.0 * np.exp(-1.25 * x**-4.0) * gamma ** np.exp(-0.5 * ((x - 1.0) / width) ** 2)


@cache
def _area(gamma: float) -> float:
    """Integral of the shape over all frequencies; the kink of the width lies on a point of the trapezoidal rule."""
    x = np.exp(_STEP * np.arange(-1500.0, 7000.0))
    return float(np.sum(x * _shape(x, gamma)) * _STEP)


def mean_period(gamma: float) -> float:
    """Mean zero-crossing period over the peak's, by the moments m0 and m2 of the whole spectrum; 0.710 for gamma 1."""
    x = np.exp(_STEP * np.arange(-1500.0, 14000.0))
    return float(np.sqrt(np.sum(x * _shape(x, gamma)) / np.sum(x**3 * _shape(x, gamma))))


def quantiles(share: Array, gamma: float) -> Array:
    """Relative frequencies below which the given shares (0 to 1) of the energy from LOWEST to HIGHEST lie."""
    log = np.arange(np.log(LOWEST), np.log(HIGHEST) + _STEP, _STEP)
    density = np.exp(log) * _shape(np.exp(log), gamma)
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    return np.exp(np.interp(share, energy / energy[-1], log))


def components_of_spectrum(
    frequency: Array,
    density: Array,
    count: int,
    seed: int | list[int],
    toward: Array,
    g: float,
    h: float,
    parts: Array | None = None,
) -> Components:
    """A sea of `count` waves, drawn as those of `components`; the same seed gives the same sea.

    density: (n,) [m2 s/rad] at increasing frequencies (n,) [rad/s], linear between them and zero beyond. The sum of
    a^2/2 is its integral. toward: directions (m,) [rad] of equal energy, unless parts (n, m) tell how much of the
    density each has.
    """
    draw = np.random.default_rng(seed)
    share = (np.arange(count) + draw.random(count)) / count
    energy = float(_energy_of_spectrum(frequency, density)[-1])
    w = quantiles_of_spectrum(share, frequency, density)
    if parts is None:
        return drawn(draw, energy, w, toward, g, h)
    phase = 2.0 * np.pi * draw.random(count)
    return alike(energy, w, toward[_directions(draw.random(), w, frequency, parts)], phase, g, h)


def _directions(first: float, w: Array, frequency: Array, parts: Array) -> IntArray:
    """Numbers of directions (n,) of waves of increasing frequencies w.

    Each wave goes where a share of the energy at its own frequency lies: the first one's is given, and it grows by the
    golden section from wave to wave, modulo 1, so that any band of frequencies has the energy of all its directions.
    """
    share = (first + _GOLDEN * np.arange(w.size)) % 1.0
    cumulative = np.cumsum(parts, axis=1)
    at_w = np.array([np.interp(w, frequency, column) for column in cumulative.T])
    return np.minimum((at_w <= share * at_w[-1]).sum(axis=0), parts.shape[1] - 1)


def quantiles_of_spectrum(share: Array, frequency: Array, density: Array) -> Array:
    """Frequencies below which the given shares (0 to 1) of the energy lie: of straight pieces, exactly."""
    energy = _energy_of_spectrum(frequency, density)
    wanted = share * energy[-1]
    n = np.clip(np.searchsorted(energy, wanted, side="right") - 1, 0, frequency.size - 2)
    rise, width = density[n + 1] - density[n], frequency[n + 1] - frequency[n]
    rest = wanted - energy[n]
    root = np.sqrt(np.maximum(density[n] ** 2 + 2.0 * rise / width * rest, 0.0))
    return np.asarray(frequency[n] + np.minimum(2.0 * rest / np.maximum(density[n] + root, 1e-300), width))


def _energy_of_spectrum(frequency: Array, density: Array) -> Array:
    pieces = 0.5 * (density[1:] + density[:-1]) * np.diff(frequency)
    return np.concatenate([[0.0], np.cumsum(pieces)])


def recorded(
    elevation: Array, step: float, harmonics: range, position: tuple[float, float], toward: float, g: float, h: float
) -> Components:
    """Waves of one direction [rad] whose sum at a position (x, y) [m] is the record (n,) [m], as far as the harmonics.

    step: between its values [s], the first of which belongs to the clock's beginning. The discrete Fourier transform
    tells amplitudes and phases; the sum goes through every value, without mean and Nyquist's frequency, and repeats
    itself after n steps.
    """
    numbers = np.arange(harmonics.start, harmonics.stop)
    value = 2.0 / elevation.size * np.fft.rfft(elevation)[numbers]
    w = 2.0 * np.pi * numbers / (elevation.size * step)
    k = wave_number(w, g, h)
    along = position[0] * np.cos(toward) + position[1] * np.sin(toward)
    return Components(np.abs(value), w, k, np.full(w.size, toward), -np.angle(value) - k * along)
