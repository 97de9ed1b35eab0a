"""Statistics of an output at one place, over all runs together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import stats

from riser_soil.core.arrays import Array
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
from riser_soil.statistics.series import Cycles, Spectrum, block_maxima, cycles, spectrum

FINE = 20  # values in a zero-crossing period, from which on peaks are hardly missed


@dataclass(frozen=True)
class Wanted:
    """Settings by which extremes are predicted.

    duration: for which the largest value is predicted [s]. block: length of the blocks that Gumbel's distribution is
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
        counts = [cycles(self.wanted.sign * x, self.step, self.wanted.sign * self.mean) for x in self.runs]
        peaks = np.concatenate([each.peaks for each in counts])
        return Cycles(sum(each.number for each in counts), sum(each.time for each in counts), peaks)

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
        samples = self.period / self.step
        return samples if samples < FINE else 0.0

    @property
    def expected_peaks(self) -> float:
        """Number of peaks in the time for which extremes are predicted."""
        return self.wanted.duration / self.period

    @cached_property
    def spectrum(self) -> Spectrum:
        """Mean of the runs' spectra; they have one step, and pieces of the shortest run's length."""
        shortest = min(len(x) for x in self.runs)
        segment = shortest * self.step / 8 if self.wanted.segment is None else self.wanted.segment
        spectra = [spectrum(x, self.step, min(segment, shortest * self.step)) for x in self.runs]
        return Spectrum(spectra[0].frequency, np.mean([each.density for each in spectra], axis=0))

    @property
    def rayleigh(self) -> float:
        """Most probable largest value, were the process Gaussian."""
        return self._of_height(rayleigh_height(self.deviation, self.expected_peaks))

    @cached_property
    def weibull_fit(self) -> Weibull:
        return fit_weibull(self.wanted.sign * (self.peaks - self.mean))

    @property
    def weibull(self) -> Interval:
        """Value that one of the expected peaks exceeds."""
        largest = self.weibull_fit.largest(self.expected_peaks, self.wanted.confidence)
        return self._signed(Interval(*(self.wanted.sign * self.mean + h for h in largest)))

    @cached_property
    def maxima(self) -> Array:
        """Extremes (n,) of the blocks of all runs, in the output's unit."""
        of_runs = [block_maxima(self.wanted.sign * x, self.step, self._block) for x in self.runs]
        return np.asarray(self.wanted.sign * np.concatenate(of_runs))

    @cached_property
    def gumbel_fit(self) -> LocationScale:
        """Fit to the blocks' extremes, with `minima` to those of -x."""
        return fit_gumbel(self.wanted.sign * self.maxima)

    @property
    def gumbel(self) -> Interval:
        """Most probable largest value over the time of prediction."""
        return self._signed(self.gumbel_fit.at(self._log_blocks, self.wanted.confidence))

    @property
    def _block(self) -> float:
        """Length of a block [s]: maxima of unlike times follow no distribution in common."""
        return self.step * min(len(x) for x in self.runs) if self.wanted.block is None else self.wanted.block

    @property
    def _log_blocks(self) -> float:
        """Logarithm of the time of prediction over that of a block."""
        return float(np.log(self.wanted.duration / self._block))

    def exceeded(self, level: float) -> dict[str, float]:
        """Share of time beyond a level, and by each distribution the probability that it is exceeded in the time
        of prediction; nan where that has no fit.
        """
        sign, height = self.wanted.sign, self.wanted.sign * (level - self.mean)
        of_peak = {
            "rayleigh": float(rayleigh_exceedance(self.deviation, np.array(height))),
            "weibull": float(self.weibull_fit.exceedance(np.array(height))),
        }
        fit = self.gumbel_fit
        of_block = (sign * level - fit.location) / fit.scale - self._log_blocks
        beyond = np.concatenate([sign * x > sign * level for x in self.runs])
        return {
            "time": float(beyond.mean()),
            **{name: float(-np.expm1(-self.expected_peaks * p)) for name, p in of_peak.items()},
            "gumbel": float(stats.gumbel_r.sf(of_block)),
        }

    def _of_height(self, height: float) -> float:
        return self.mean + self.wanted.sign * height

    def _signed(self, interval: Interval) -> Interval:
        """Interval in the output's unit, the lower limit first."""
        if not np.isfinite(interval.value):
            return UNKNOWN
        limits = sorted((self.wanted.sign * interval.low, self.wanted.sign * interval.high))
        return Interval(self.wanted.sign * interval.value, *limits)


def statistics_of(records: Records, wanted: Wanted) -> list[PlaceStatistics]:
    """Statistics at each place of the records."""
    places = range(len(records.arc))
    return [PlaceStatistics([values[:, k] for values in records.values], records.step, wanted) for k in places]
