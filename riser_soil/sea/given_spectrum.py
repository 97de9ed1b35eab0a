"""A random sea drawn from a spectrum that is given as a table."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.sea.components import Components, drawn


def components(
    frequency: Array, density: Array, count: int, seed: int | list[int], toward: Array, g: float, h: float
) -> Components:
    """A sea of `count` waves, drawn as those of `jonswap.components`; the same seed gives the same sea.

    density: (n,) [m2 s/rad] at increasing frequencies (n,) [rad/s], linear between them and zero beyond. The sum of
    a^2/2 is its integral.
    """
    draw = np.random.default_rng(seed)
    share = (np.arange(count) + draw.random(count)) / count
    energy = _energy(frequency, density)
    return drawn(draw, float(energy[-1]), quantiles(share, frequency, density), toward, g, h)


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
