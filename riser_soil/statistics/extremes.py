"""Extreme values: the most probable maximum by Rayleigh's, Weibull's and Gumbel's distributions, with confidence.

A Gaussian process of standard deviation s has in N cycles the most probable maximum s √(2 ln N) above its mean, its
peaks following Rayleigh's distribution (Longuet-Higgins, Journal of Marine Research 11, 1952). Weibull's is fitted to
the peaks where the process is not Gaussian; in N of them the value exceeded once is λ (ln N)^(1/c). Gumbel's is that of
maxima of blocks or runs; over a time D times as long as theirs its mode goes up by β ln D. Fits are those of maximum
likelihood.

Confidence: Gumbel's distribution, and that of the logarithm of Weibull's, have a location and a scale, so that
(estimate - value)/(estimated scale) of any value μ + k β has a distribution that hangs on the number of samples alone.
It is found by drawing samples; intervals so are exact but for the number of draws, of independent samples from that
distribution.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy import stats

from riser_soil.core.arrays import Array

FEWEST = 3  # samples of a fit
DRAWS = 1000
SEED = 20240501
DIGITS = 2  # of the number of samples, downwards, for which draws are kept
SAME = 1e-9  # of the largest: spread of samples that are all one value


class Interval(NamedTuple):
    """An estimate and its limits of confidence; nan where they are not known."""

    value: float
    low: float
    high: float


UNKNOWN = Interval(np.nan, np.nan, np.nan)


class LocationScale(NamedTuple):
    """A fit of Gumbel's distribution of largest (`smallest` False) or smallest values to samples."""

    location: float
    scale: float
    samples: int
    smallest: bool = False

    def at(self, k: float, confidence: float) -> Interval:
        """μ + k β, within its limits."""
        if not np.isfinite(self.scale):
            return UNKNOWN
        location, scale = _draws(_fewer(self.samples), self.smallest).T
        pivot = (location + k * scale - k) / scale
        beyond = 0.5 * (1.0 - confidence)
        low, high = np.quantile(pivot, [1.0 - beyond, beyond])
        value = self.location + k * self.scale
        return Interval(value, value - self.scale * float(low), value - self.scale * float(high))


def fit_gumbel(maxima: Array, smallest: bool = False) -> LocationScale:
    """Fit to largest values, or smallest ones; nan for fewer than three, or all of one value."""
    if _indistinct(maxima):
        return LocationScale(np.nan, np.nan, len(maxima), smallest)
    location, scale = _family(smallest).fit(maxima)
    return LocationScale(float(location), float(scale), len(maxima), smallest)


class Weibull(NamedTuple):
    """A fit to heights above the mean: P(height > h) = exp(-(h/scale)^shape); Rayleigh's where shape is 2."""

    of_logarithm: LocationScale

    @property
    def scale(self) -> float:
        return float(np.exp(self.of_logarithm.location))

    @property
    def shape(self) -> float:
        return 1.0 / self.of_logarithm.scale

    def exceedance(self, heights: Array) -> Array:
        """Probability that a peak is higher."""
        return np.asarray(np.exp(-((np.maximum(heights, 0.0) / self.scale) ** self.shape)))

    def largest(self, peaks: float, confidence: float) -> Interval:
        """Height that one of so many peaks exceeds, and its limits."""
        if not peaks > np.e:
            return UNKNOWN
        return Interval(*(float(np.exp(x)) for x in self.of_logarithm.at(float(np.log(np.log(peaks))), confidence)))


def fit_weibull(heights: Array) -> Weibull:
    """Fit to heights of peaks (n,), all > 0; nan for fewer than three, or all of one height."""
    if _indistinct(heights):
        return Weibull(LocationScale(np.nan, np.nan, len(heights), smallest=True))
    return Weibull(fit_gumbel(np.log(heights), smallest=True))


def rayleigh_height(deviation: float, peaks: float) -> float:
    """Most probable largest of so many heights of a Gaussian process of this standard deviation."""
    return float(deviation * np.sqrt(2.0 * np.log(peaks))) if peaks > 1.0 else np.nan


def rayleigh_exceedance(deviation: float, heights: Array) -> Array:
    """Probability that a peak of a Gaussian process of this standard deviation is higher; nan where nothing varies."""
    return np.asarray(np.exp(-0.5 * (np.maximum(heights, 0.0) / (deviation or np.nan)) ** 2))


def plotting_positions(samples: Array) -> tuple[Array, Array]:
    """Samples (n,) from the largest down, and the probability that each is exceeded, k/(n + 1)."""
    return np.sort(samples)[::-1], np.arange(1, len(samples) + 1) / (len(samples) + 1.0)


def _indistinct(samples: Array) -> bool:
    """Whether samples are too few for a fit, or all of one value."""
    return len(samples) < FEWEST or bool(np.ptp(samples) <= SAME * np.abs(samples).max())


def _family(smallest: bool) -> stats.rv_continuous:
    return stats.gumbel_l if smallest else stats.gumbel_r


def _fewer(count: int) -> int:
    """Rounded to few digits, downwards."""
    unit = 10 ** max(0, len(str(count)) - DIGITS)
    return count // unit * unit


@lru_cache(maxsize=64)
def _draws(count: int, smallest: bool) -> Array:
    """Fits (DRAWS, 2) to samples of the standard distribution."""
    family = _family(smallest)
    samples = family.rvs(size=(DRAWS, count), random_state=np.random.default_rng(SEED))
    return np.array([family.fit(sample) for sample in samples])
