"""Tables of `riser-soil statistics` on the screen, and its CSV and JSON files."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from riser_soil.errors import ResultsError
from riser_soil.results.whole_file import written_whole
from riser_soil.statistics.analysis import FINE, PlaceStatistics, Wanted
from riser_soil.statistics.extremes import Interval
from riser_soil.statistics.records import Records

ENDINGS = (".csv", ".json")


class Place(NamedTuple):
    """Statistics of an output at one place, over all runs."""

    records: Records
    arc: float
    statistics: PlaceStatistics

    @property
    def words(self) -> str:
        return self.records.name if np.isnan(self.arc) else f"{self.records.name} at {self.arc:.6g} m"


def table(places: Sequence[Place], wanted: Wanted) -> list[str]:
    """A line for each place."""
    most = "least" if wanted.minima else "largest"
    wide = max(len(place.words) for place in places)
    names = ("mean", "st. dev.", "least", "largest", "Tz [s]", "Rayleigh", "Weibull", "Gumbel")
    records, heads = places[0].records, [f"{name:>{10 if n < 6 else 32}}" for n, name in enumerate(names)]
    runs = "1 run" if len(records.values) == 1 else f"{len(records.values)} runs"
    lines = [
        f"{runs}, {records.duration:.6g} s in all; most probable {most} value in {wanted.duration:g} s by three "
        f"distributions, fits with {100.0 * wanted.confidence:g} % confidence",
        f"{'':{wide}} {'unit':>5} " + " ".join(heads),
    ]
    for place in places:
        x = place.statistics
        numbers = (x.mean, x.deviation, x.least, x.largest, x.period, x.rayleigh)
        columns = [f"{_shown(value):>10}" for value in numbers] + [
            f"{_within(fit):>32}" for fit in (x.weibull, x.gumbel)
        ]
        lines.append(f"{place.words:{wide}} {place.records.units:>5} " + " ".join(columns))
    return lines + list(_warnings(places))


def exceedance_table(places: Sequence[Place], levels: Sequence[float], wanted: Wanted) -> list[str]:
    """A line for each place and level; none without levels."""
    if not levels:
        return []
    wide, beyond = max(len(place.words) for place in places), "below" if wanted.minima else "above"
    names = (beyond, "of time", "Rayleigh", "Weibull", "Gumbel")
    lines = [
        f"share of time {beyond} a level, and probability that it is passed within {wanted.duration:g} s",
        f"{'':{wide}} {'unit':>5} " + " ".join(f"{name:>12}" for name in names),
    ]
    for place in places:
        for level in levels:
            row = (level, *place.statistics.exceeded(level).values())
            lines.append(
                f"{place.words:{wide}} {place.records.units:>5} " + " ".join(f"{_shown(x):>12}" for x in row)
            )
    return lines


def write(file: Path, places: Sequence[Place], levels: Sequence[float], wanted: Wanted) -> None:
    """A row of a CSV file for each place, or all with spectra and exceedance of peaks in a JSON file."""
    with written_whole(file) as part, part.open("w", encoding="utf-8") as opened:
        if file.suffix == ".csv":
            rows = [row_of(place, levels, wanted) for place in places]
            writer = csv.DictWriter(opened, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows({name: _cell(value) for name, value in row.items()} for row in rows)
        else:
            json.dump([_known(row_of(place, levels, wanted) | _curves(place)) for place in places], opened, indent=1)


def refuse_ending(file: Path | None) -> None:
    """ResultsError for a file that is neither CSV nor JSON."""
    if file is not None and file.suffix not in ENDINGS:
        raise ResultsError(f"{file}: statistics go to a {' or '.join(ENDINGS)} file; change its ending")


def row_of(place: Place, levels: Sequence[float], wanted: Wanted) -> dict[str, Any]:
    """Names and numbers of a place, in the output's unit but where the name tells another."""
    x, records = place.statistics, place.records
    row: dict[str, Any] = {
        "output": records.name,
        "unit": records.units,
        "arc_m": place.arc,
        "runs": len(records.values),
        "recorded_s": records.duration,
        "mean": x.mean,
        "standard_deviation": x.deviation,
        "least": x.least,
        "largest": x.largest,
        "zero_crossing_period_s": x.period,
        "peaks": len(x.peaks),
        "duration_s": wanted.duration,
        "extremes": "least" if wanted.minima else "largest",
        "confidence": wanted.confidence,
        "rayleigh": x.rayleigh,
        **_columns("weibull", x.weibull),
        "weibull_shape": x.weibull_fit.shape,
        "weibull_scale": x.weibull_fit.scale,
        **_columns("gumbel", x.gumbel),
        "gumbel_location": wanted.sign * x.gumbel_fit.location,
        "gumbel_scale": x.gumbel_fit.scale,
        "blocks": len(x.maxima),
    }
    for level in levels:
        row |= {f"{name}_beyond_{level:g}": share for name, share in x.exceeded(level).items()}
    return row


def _columns(name: str, interval: Interval) -> dict[str, float]:
    return {name: interval.value, f"{name}_low": interval.low, f"{name}_high": interval.high}


def _curves(place: Place) -> dict[str, Any]:
    """Spectrum, peaks and extremes of blocks, for whoever draws them."""
    x = place.statistics
    return {
        "spectrum": {
            "frequency_Hz": x.spectrum.frequency.tolist(),
            f"density_{place.records.units}2_per_Hz": x.spectrum.density.tolist(),
            "period_sqrt_m0_over_m2_s": x.spectrum.period,
        },
        "peak_values": x.peaks.tolist(),
        "block_values": x.maxima.tolist(),
    }


def _known(value: Any) -> Any:
    """JSON has no nan: null."""
    if isinstance(value, dict):
        return {key: _known(each) for key, each in value.items()}
    return None if isinstance(value, float) and not np.isfinite(value) else value


def _cell(value: Any) -> Any:
    return (f"{value:.8g}" if np.isfinite(value) else "") if isinstance(value, float) else value


def _shown(value: float) -> str:
    return f"{value:.5g}" if np.isfinite(value) else "-"


def _within(interval: Interval) -> str:
    return f"{interval.value:.5g} ({interval.low:.5g} to {interval.high:.5g})" if np.isfinite(interval.value) else "-"


def _warnings(places: Sequence[Place]) -> Iterator[str]:
    coarse = min((place.statistics.coarse for place in places if place.statistics.coarse), default=0.0)
    if coarse:
        missed = 1.0 - np.cos(np.pi / coarse)
        yield (
            f"warning: there are only {coarse:.3g} records in a zero-crossing period, so that peaks may be missed by "
            f"{100.0 * missed:.2g} %; record at least {FINE}: a shorter output.interval"
        )
    if all(len(place.statistics.maxima) < 3 for place in places):
        yield "Gumbel's distribution needs three maxima or more: give more runs (seeds), or --block SECONDS"
