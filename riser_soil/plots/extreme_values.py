"""Matplotlib plots of statistics: spectrum, and how often peaks and extremes of blocks are exceeded, beside fits."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from riser_soil.core.arrays import Array
from riser_soil.plots.curves import save, sheet
from riser_soil.statistics.analysis import PlaceStatistics
from riser_soil.statistics.extremes import plotting_positions, rayleigh_exceedance

MOST = 6  # places in one picture


def draw_statistics(png: Path, places: Sequence[tuple[str, str, PlaceStatistics]]) -> Path:
    """A row for each place: its words, its unit, what was found."""
    figure, panels = sheet(len(places), 3, width=13.0, height=3.4)
    for row, (words, unit, result) in enumerate(places):
        of_spectrum, of_peaks, of_blocks = panels[3 * row : 3 * row + 3]
        of_spectrum.set_title(words, fontsize=9, loc="left")
        _draw_spectrum(of_spectrum, result, unit)
        _draw_peaks(of_peaks, result, unit)
        _draw_blocks(of_blocks, result, unit)
    return save(figure, png)


def _draw_spectrum(axes: Axes, result: PlaceStatistics, unit: str) -> None:
    frequency, density = result.spectrum
    axes.plot(frequency, density, linewidth=1.0)
    if np.isfinite(result.period):
        axes.axvline(1.0 / result.period, color="0.5", linestyle=":", label="1/Tz")
        axes.set_xlim(0.0, min(float(frequency[-1]), 5.0 / result.period))
        axes.legend(fontsize=8)
    axes.set(xlabel="frequency [Hz]", ylabel=f"spectral density [({unit})²/Hz]")


def _draw_peaks(axes: Axes, result: PlaceStatistics, unit: str) -> None:
    """Share of peaks beyond a value, logarithmic."""
    sign = result.wanted.sign
    values, exceeded = plotting_positions(sign * result.peaks)
    axes.semilogy(sign * values, exceeded, ".", markersize=4, color="0.4", label="peaks")
    heights = np.linspace(0.0, 1.2 * float((values - sign * result.mean).max(initial=result.deviation)), 200)
    at = result.mean + sign * heights
    axes.semilogy(at, rayleigh_exceedance(result.deviation, heights), "C0--", label="Rayleigh, by the st. dev.")
    axes.semilogy(at, result.weibull_fit.exceedance(heights), "C3-", label="Weibull, fitted")
    axes.set_ylim(0.3 / max(len(values), 1), 1.5)
    axes.set(xlabel=f"peak [{unit}]", ylabel="share of peaks beyond [-]")
    axes.legend(fontsize=8)


def _draw_blocks(axes: Axes, result: PlaceStatistics, unit: str) -> None:
    """Extremes of blocks over the reduced variate, on which Gumbel's distribution is a straight line."""
    sign, fit = result.wanted.sign, result.gumbel_fit
    values, exceeded = plotting_positions(sign * result.maxima)
    axes.plot(_reduced(exceeded), sign * values, "o", markersize=4, color="0.4", label="extremes of blocks")
    if np.isfinite(fit.scale):
        k = np.linspace(-2.0, max(5.0, float(_reduced(exceeded)[0]) + 1.0), 60)
        within = np.array([fit.at(float(each), result.wanted.confidence) for each in k])
        axes.plot(k, sign * within[:, 0], "C3-", label="Gumbel, fitted")
        label_of_band = f"{100.0 * result.wanted.confidence:g} % confidence"
        axes.fill_between(k, sign * within[:, 1], sign * within[:, 2], color="C3", alpha=0.2, label=label_of_band)
    axes.set(xlabel="reduced variate -ln(-ln P) [-]", ylabel=f"extreme [{unit}]")
    axes.legend(fontsize=8)


def _reduced(exceeded: Array) -> Array:
    return np.asarray(-np.log(-np.log1p(-exceeded)))
