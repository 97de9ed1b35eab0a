"""Statistics of an output at one place, over all runs together.

Statistics of evenly spaced values of one quantity: crossings, peaks, spectrum, block maxima.

x (n,) in any unit, step [s] between its values.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy import stats
from scipy.integrate import trapezoid
from scipy.signal import welch

from riser_soil.core.arrays import Array, IntArray
from riser_soil.statistics.extremes import (
    UNKNOWN,
    Interval,
    LocationScale,
    Weibull,
    fit_gumbel,
    fit_weibull,
    rayleigh_exceedance,
    rayleigh_height,
)
from riser_soil.statistics.records import Records

FINE = 20  # values in a zero-crossing period, from which on peaks are hardly missed
SEGMENTS = 8  # of the record, by which its spectrum is averaged, half over each other


@dataclass(frozen=True)
class Wanted:
    """What the extremes are those of.

    duration: over which the largest value is foretold [s]. block: length of the blocks that Gumbel's distribution is
    fitted to [s]; None for as long as the shortest run. minima: smallest values in the place of largest ones.
    confidence: of intervals. segment: length of the pieces that a spectrum is averaged over [s]; None for an eighth of
    the shortest run.
    """

    duration: float
    block: float | None = None
    minima: bool = False
    confidence: float = 0.95
    segment: float | None = None

    @property
    def sign(self) -> float:
        return -1.0 if self.minima else 1.0


class PlaceStatistics:
    """Statistics of one output at one place, from values x (n,) of each run, in the output's unit, and the step [s]
    between them.

    Peaks are the largest values between up-crossings of the mean of all runs. With `minima` they are the smallest
    values between down-crossings: extremes of -x, given as values of x.
    """

    def __init__(self, runs: Sequence[Array], step: float, wanted: Wanted) -> None:
        self.runs, self.step, self.wanted = runs, step, wanted
        together = np.concatenate(runs)
        self.mean, self.deviation = float(together.mean()), float(together.std())
        self.least, self.largest = float(together.min()), float(together.max())

    @cached_property
    def _cycles(self) -> Cycles:
        found = [cycles(self.wanted.sign * x, self.step, self.wanted.sign * self.mean) for x in self.runs]
        peaks = np.concatenate([each.peaks for each in found])
        return Cycles(sum(each.number for each in found), sum(each.time for each in found), peaks)

    @property
    def period(self) -> float:
        """Mean zero-crossing period, of crossings of the mean [s]."""
        return self._cycles.period

    @property
    def peaks(self) -> Array:
        """(n,) in the output's unit."""
        return np.asarray(self.wanted.sign * self._cycles.peaks)

    @property
    def coarse(self) -> float:
        """Values in a zero-crossing period, where they are fewer than FINE; else 0."""
        found = self.period / self.step
        return found if found < FINE else 0.0

    @property
    def foretold(self) -> float:
        """Peaks in the time that the extremes are foretold for."""
        return self.wanted.duration / self.period

    @cached_property
    def spectrum(self) -> Spectrum:
        """Mean of the runs' spectra; they have one step, and pieces of the shortest run's length."""
        shortest = min(len(x) for x in self.runs)
        segment = shortest * self.step / 8 if self.wanted.segment is None else self.wanted.segment
        found = [spectrum(x, self.step, min(segment, shortest * self.step)) for x in self.runs]
        return Spectrum(found[0].frequency, np.mean([each.density for each in found], axis=0))

    @property
    def rayleigh(self) -> float:
        """Most probable largest value, were the process Gaussian."""
        return self._of_height(rayleigh_height(self.deviation, self.foretold))

    @cached_property
    def weibull_fit(self) -> Weibull:
        return fit_weibull(self.wanted.sign * (self.peaks - self.mean))

    @property
    def weibull(self) -> Interval:
        """Value that one of the peaks foretold exceeds."""
        found = self.weibull_fit.largest(self.foretold, self.wanted.confidence)
        return self._signed(Interval(*(self.wanted.sign * self.mean + h for h in found)))

    @cached_property
    def maxima(self) -> Array:
        """Extremes (n,) of the blocks of all runs, in the output's unit."""
        of_runs = [block_maxima(self.wanted.sign * x, self.step, self._block) for x in self.runs]
        return np.asarray(self.wanted.sign * np.concatenate(of_runs))

    @cached_property
    def gumbel_fit(self) -> LocationScale:
        """To the blocks' extremes, with `minima` to those of -x."""
        return fit_gumbel(self.wanted.sign * self.maxima)

    @property
    def gumbel(self) -> Interval:
        """Most probable largest value over the time foretold."""
        return self._signed(self.gumbel_fit.at(self._blocks_foretold, self.wanted.confidence))

    @property
    def _block(self) -> float:
        """Length of a block [s]: maxima of unlike times follow no distribution in common."""
        return self.step * min(len(x) for x in self.runs) if self.wanted.block is None else self.wanted.block

    @property
    def _blocks_foretold(self) -> float:
        """Logarithm of the time foretold over that of a block."""
        return float(np.log(self.wanted.duration / self._block))

    def exceeded(self, level: float) -> dict[str, float]:
        """Share of time beyond a level, and by each distribution the probability that it is exceeded in the time
        foretold; nan where that has no fit.
        """
        sign, height = self.wanted.sign, self.wanted.sign * (level - self.mean)
        of_peak = {
            "rayleigh": float(rayleigh_exceedance(self.deviation, np.array(height))),
            "weibull": float(self.weibull_fit.exceedance(np.array(height))),
        }
        fit = self.gumbel_fit
        of_block = (sign * level - fit.location) / fit.scale - self._blocks_foretold
        beyond = np.concatenate([sign * x > sign * level for x in self.runs])
        return {
            "time": float(beyond.mean()),
            **{name: float(-np.expm1(-self.foretold * p)) for name, p in of_peak.items()},
            "gumbel": float(stats.gumbel_r.sf(of_block)),
        }

    def _of_height(self, height: float) -> float:
        return self.mean + self.wanted.sign * height

    def _signed(self, found: Interval) -> Interval:
        """In the output's unit, the lower limit first."""
        if not np.isfinite(found.value):
            return UNKNOWN
        limits = sorted((self.wanted.sign * found.low, self.wanted.sign * found.high))
        return Interval(self.wanted.sign * found.value, *limits)


def statistics_of(records: Records, wanted: Wanted) -> list[PlaceStatistics]:
    """At each place of the records."""
    places = range(len(records.arc))
    return [PlaceStatistics([values[:, k] for values in records.values], records.step, wanted) for k in places]


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
    """By Welch's method with Hann's window. segment: length [s] of the pieces, by default an eighth of the record."""
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
