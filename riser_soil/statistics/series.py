"""Statistics of evenly spaced values of one quantity: crossings, peaks, spectrum, block maxima.

x (n,) in any unit, step [s] between its values.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.integrate import trapezoid
from scipy.signal import welch

from riser_soil.core.arrays import Array, IntArray

SEGMENTS = 8  # pieces of a record, overlapping by half, over which its spectrum is averaged


class Spectrum(NamedTuple):
    """One-sided density of variance (nf,) [unit2/Hz] at frequencies (nf,) [Hz], the mean left out."""

    frequency: Array
    density: Array

    def moment(self, order: int) -> float:
        """m_n = ∫ f^n S df [unit2 Hz^n]; m_0 is the variance."""
        return float(trapezoid(self.frequency**order * self.density, self.frequency))

    @property
    def period(self) -> float:
        """Zero-crossing period of a Gaussian process of this spectrum, √(m0/m2) [s]; nan where nothing varies."""
        m2 = self.moment(2)
        return float(np.sqrt(self.moment(0) / m2)) if m2 > 0.0 else np.nan


def spectrum(x: Array, step: float, segment: float | None = None) -> Spectrum:
    """Spectrum by Welch's method with Hann's window. segment: length [s] of the pieces, by default an eighth of the
    record.
    """
    length = len(x) // SEGMENTS if segment is None else round(segment / step)
    return Spectrum(*welch(x, 1.0 / step, nperseg=int(np.clip(length, 16, len(x)))))


def up_crossings(x: Array, level: float) -> IntArray:
    """Numbers of the values after which x goes above a level."""
    return np.flatnonzero((x[:-1] <= level) & (x[1:] > level))


class Cycles(NamedTuple):
    """Number of whole cycles between up-crossings, the time that they take [s], and the largest value in each."""

    number: int
    time: float
    peaks: Array

    @property
    def period(self) -> float:
        """Mean zero up-crossing period [s]; nan without a cycle."""
        return self.time / self.number if self.number else np.nan


def cycles(x: Array, step: float, level: float) -> Cycles:
    """Between up-crossings of a level, linear between values."""
    at = up_crossings(x, level)
    if len(at) < 2:
        return Cycles(0, 0.0, np.empty(0))
    when = at + (level - x[at]) / (x[at + 1] - x[at])
    return Cycles(len(at) - 1, float(step * (when[-1] - when[0])), np.maximum.reduceat(x[: at[-1] + 1], at[:-1] + 1))


def block_maxima(x: Array, step: float, block: float | None = None) -> Array:
    """Largest values of whole blocks of a length [s]; by default of the record as one."""
    length = len(x) if block is None else max(1, round(block / step))
    blocks = len(x) // length
    return np.asarray(x[: blocks * length].reshape(blocks, length).max(axis=1))
