"""Fineness that an accuracy requires, from the error bars of a coarser run; error bars predicted for the finer run."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

from riser_soil.accuracy.error_bars import SAFETY, SMALLEST, ErrorBar, RunValues, sampling_errors
from riser_soil.variants.extreme_differences import difference

COST = {"mesh": 0.7, "time": 1.0, "soil": 3.0, "penalty": 0.1}  # exponents of the fineness in the computing time
MARGIN = 0.8  # largest bar aimed at, over the accuracy
MOST = {"mesh": 4.0, "time": 4.0, "soil": 2.0, "penalty": 10.0}  # largest ratio of fineness from one run to the next
BY_CHANCE = 0.25  # least share after refinement, over that predicted by the order, where two runs agree
UNKNOWN = 2.0  # ratio of fineness in mesh and time where a bar is not known
NEGLIGIBLE = 0.5  # difference of two runs that does not matter, over the accuracy
LARGEST_FALL = 8.0  # largest ratio of a bar to the next run's that orders of convergence predict reliably

Factors = Mapping[str, float]  # ratios of fineness by source


def required(bars: Sequence[ErrorBar], accuracy: float) -> Factors:
    """Ratios of fineness with which all bars keep to the accuracy at the least cost, each at most `MOST`.

    accuracy: over the scale of each quantity.
    """
    return {source: min(factor, MOST[source]) for source, factor in _unlimited(bars, accuracy).items()}


def cost_ratio(factors: Factors) -> float:
    """Ratio of the computing times of a run that is finer by factors and of the run before."""
    return math.prod(factor ** COST[source] for source, factor in factors.items())


def out_of_reach(bars: Sequence[ErrorBar], accuracy: float, runs: int) -> float:
    """Ratio of elements times steps that the accuracy requires; 0 where `runs` more runs, each at most `MOST` times as
    fine, reach it in mesh and time.
    """
    factors = {source: f for source, f in _unlimited(bars, accuracy).items() if source in ("mesh", "time")}
    if all(factor <= MOST[source] ** runs for source, factor in factors.items()):
        return 0.0
    return math.prod(factors.values())


def predicted_bars(bars: Sequence[ErrorBar], before: RunValues, run: RunValues, factors: Factors) -> list[ErrorBar]:
    """Error bars of a run that is finer by factors than the run `before`, which has these bars.

    Each source's share falls by its order. If a source alone is finer, its share is that of the difference of both
    runs by Richardson's extrapolation, whether larger or smaller. If several are, none has more than if it were alone.
    As runs may agree by chance, and errors of sources may cancel, a part of each predicted share stays; of the soil's
    all.
    """
    known = {bar.key_result.key: bar for bar in bars}
    return [_predicted(known.get(key), before, run, factors, key) for key in run.key_results]


def unreliable(
    bars: Sequence[ErrorBar], before: RunValues, run: RunValues, predicted: Sequence[ErrorBar], accuracy: float
) -> bool:
    """Whether predicted bars of a run are unreliable.

    They are where the run differs from the run `before` by more than that one's bars, and by more than is negligible;
    and where a bar falls by more than orders of convergence predict reliably.
    """
    known = {bar.key_result.key: bar for bar in predicted}
    return any(_unreliable(bar, before, run, known.get(bar.key_result.key), accuracy) for bar in bars)


def _unreliable(bar: ErrorBar, before: RunValues, run: RunValues, now: ErrorBar | None, accuracy: float) -> bool:
    key = bar.key_result.key
    if now is None or now.bar is None or bar.bar is None or key not in before.peaks or key not in run.peaks:
        return True
    change, negligible = difference(before.peaks[key], run.peaks[key]), NEGLIGIBLE * accuracy * bar.key_result.scale
    return change > max(bar.bar, negligible) or bar.bar > LARGEST_FALL * max(now.bar, negligible)


def largest(bars: Sequence[ErrorBar]) -> tuple[float, str]:
    """The largest bar over its quantity's scale, inf where one is not known, and its key."""
    return max((_relative(bar), bar.key_result.key) for bar in bars)


def _relative(bar: ErrorBar) -> float:
    return math.inf if bar.bar is None else bar.key_result.relative(bar.bar)


def _unlimited(bars: Sequence[ErrorBar], accuracy: float) -> Factors:
    """The largest ratios of fineness that any of the quantities requires, without limits."""
    factors: dict[str, float] = {}
    for bar in bars:
        for source, factor in _of_quantity(bar, accuracy).items():
            factors[source] = max(factors.get(source, 1.0), factor)
    return factors


def _of_quantity(bar: ErrorBar, accuracy: float) -> Factors:
    """Ratios of fineness that one quantity requires, at the least cost.

    With cost f^c and error f^-p of each source, the squares of the shares are in proportion to c/p at the least cost.
    Sources whose share is smaller keep it, and leave more to the others.
    """
    if bar.bar is None:
        return {"mesh": UNKNOWN} | ({"time": UNKNOWN} if "time" in bar.by_source else {})
    allowed = (MARGIN * accuracy - SMALLEST) * bar.key_result.scale
    remaining, shares = allowed**2, dict(bar.by_source)
    while True:
        weights = {source: COST[source] / bar.order[source] for source in shares}
        total = math.fsum(weights.values())
        aims = {source: math.sqrt(remaining * weight / total) for source, weight in weights.items()}
        small = [source for source, aim in aims.items() if shares[source] <= aim]
        if not small:
            return {source: (shares[source] / aim) ** (1.0 / bar.order[source]) for source, aim in aims.items()}
        remaining -= math.fsum(shares.pop(source) ** 2 for source in small)


def _predicted(bar: ErrorBar | None, before: RunValues, run: RunValues, factors: Factors, key: str) -> ErrorBar:
    key_result = run.key_results[key]
    if bar is None or bar.bar is None or key not in before.peaks:
        return ErrorBar(key_result, None, {}, (bar and bar.reason) or "the run before does not have it")
    sampling = {source: SAFETY[source] * error for source, error in sampling_errors(key_result, run).items()}
    shares = {s: each / factors.get(s, 1.0) ** bar.order[s] for s, each in bar.by_source.items()}
    shares |= _by_difference(shares, difference(before.peaks[key], run.peaks[key]), factors, bar.order)
    shares = {source: max(sampling.get(source, 0.0), each) for source, each in (sampling | shares).items()}
    size = math.hypot(*shares.values()) + SMALLEST * key_result.scale
    return replace(bar, key_result=key_result, bar=size, by_source=shares)


def _by_difference(
    shares: Mapping[str, float], change: float, factors: Factors, order: Mapping[str, float]
) -> dict[str, float]:
    """Shares of the refined sources, but the soil's, from those by orders and the difference of two runs."""
    limited, finer = {}, [source for source, ratio in factors.items() if ratio > 1.0]
    for source in finer:
        if source in shares and source != "soil":
            share = max(SAFETY[source] * change / (factors[source] ** order[source] - 1.0), BY_CHANCE * shares[source])
            limited[source] = share if len(finer) == 1 else min(shares[source], share)
    return limited
