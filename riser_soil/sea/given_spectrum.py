"""A random sea drawn from a spectrum that is given as a table."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.sea.components import Components, alike, drawn

_GOLDEN = 0.5 * (5.0**0.5 - 1.0)


def components(
    frequency: Array,
    density: Array,
    count: int,
    seed: int | list[int],
    toward: Array,
    g: float,
    h: float,
    parts: Array | None = None,
) -> Components:
    """A sea of `count` waves, drawn as those of `jonswap.components`; the same seed gives the same sea.

    density: (n,) [m2 s/rad] at increasing frequencies (n,) [rad/s], linear between them and zero beyond. The sum of
    a^2/2 is its integral. toward: directions (m,) [rad] of equal energy, unless parts (n, m) tell how much of the
    density each has.
    """
    draw = np.random.default_rng(seed)
    share = (np.arange(count) + draw.random(count)) / count
    energy = float(_energy(frequency, density)[-1])
    w = quantiles(share, frequency, density)
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


def quantiles(share: Array, frequency: Array, density: Array) -> Array:
    """Frequencies below which the given shares (0 to 1) of the energy lie: of straight pieces, exactly."""
    energy = _energy(frequency, density)
    wanted = share * energy[-1]
    n = np.clip(np.searchsorted(energy, wanted, side="right") - 1, 0, frequency.size - 2)
    rise, width = density[n + 1] - density[n], frequency[n + 1] - frequency[n]
    rest = wanted - energy[n]
    root = np.sqrt(np.maximum(density[n] ** 2 + 2.0 * rise / width * rest, 0.0))
    return np.asarray(frequency[n] + np.minimum(2.0 * rest / np.maximum(density[n] + root, 1e-300), width))


def _energy(frequency: Array, density: Array) -> Array:
    pieces = 0.5 * (density[1:] + density[:-1]) * np.diff(frequency)
    return np.concatenate([[0.0], np.cumsum(pieces)])
