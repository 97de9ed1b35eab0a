"""Waves that repeat a record of the surface's elevation at one place."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.sea.components import Components
from riser_soil.sea.dispersion import wave_number


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
