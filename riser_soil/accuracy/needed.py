"""How much finer a setting has to be for an accuracy, from error bars of a coarser one; what is left to expect then."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

from riser_soil.accuracy.error_bars import SAFETY, SMALLEST, ErrorBar, RunValues, gaps
from riser_soil.accuracy.extreme_differences import apart

COST = {"mesh": 0.7, "time": 1.0, "soil": 3.0, "penalty": 0.1}  # what fineness costs, as a power
MARGIN = 0.8  # of the accuracy, that the bars are to keep to
MOST = {"mesh": 4.0, "time": 4.0, "soil": 2.0, "penalty": 10.0}  # from one setting to the next
BY_CHANCE = 0.25  # of a share, that is left at least where two runs agree
NOT_KNOWN = 2.0  # finer in mesh and time, where a bar is not known
DOUBT = 0.5  # of the accuracy, below which it does not matter how two runs are apart
MOST_FALL = 8.0  # times that a bar can be foretold to fall by orders, from one run to the next

Factors = Mapping[str, float]  # by source: how many times as fine


def needed(bars: Sequence[ErrorBar], accuracy: float) -> Factors:
    """For all bars to keep to the accuracy, a share of their quantities' scales, at the least cost; at most `MOST`."""
    return {source: min(factor, MOST[source]) for source, factor in _asked(bars, accuracy).items()}


def times_as_long(factors: Factors) -> float:
    """That a run takes which is finer by factors."""
    return math.prod(factor ** COST[source] for source, factor in factors.items())


def too_dear(bars: Sequence[ErrorBar], accuracy: float, runs: int) -> float:
    """How many times as many elements and steps all bars ask for together, where so many runs, each at most so much
    finer as `MOST`, don't get there in mesh or time; 0 where they do.
    """
    found = {source: factor for source, factor in _asked(bars, accuracy).items() if source in ("mesh", "time")}
    if all(factor <= MOST[source] ** runs for source, factor in found.items()):
        return 0.0
    return math.prod(found.values())


def _asked(bars: Sequence[ErrorBar], accuracy: float) -> Factors:
    """The largest factors that any of the quantities asks for, however large."""
    found: dict[str, float] = {}
    for bar in bars:
        for source, factor in _of_quantity(bar, accuracy).items():
            found[source] = max(found.get(source, 1.0), factor)
    return found


def expected(bars: Sequence[ErrorBar], before: RunValues, found: RunValues, factors: Factors) -> list[ErrorBar]:
    """Bars of a run that is finer by factors than the one `before` with its bars.

    Each source's share falls by its order. A source that is finer alone has the share by which it tells the two runs
    apart, by Richardson's extrapolation, be it more or less; of several none has more than if it were alone. But as
    runs may agree by chance, and sources hide one another, a part of each stays. Of the soil it is all.
    """
    known = {bar.key_result.key: bar for bar in bars}
    return [_expected(known.get(key), before, found, factors, key) for key in found.key_results]


def doubtful(
    bars: Sequence[ErrorBar], before: RunValues, found: RunValues, left: Sequence[ErrorBar], accuracy: float
) -> bool:
    """Whether bars that are left to expect of a run can't be relied on: where it is further from the one `before` than
    that one's bars, by more than a share of the accuracy, or would have fallen by more than orders can foretell.
    """
    expected_of = {bar.key_result.key: bar for bar in left}
    return any(_doubtful(bar, before, found, expected_of.get(bar.key_result.key), accuracy) for bar in bars)


def _doubtful(bar: ErrorBar, before: RunValues, found: RunValues, left: ErrorBar | None, accuracy: float) -> bool:
    key = bar.key_result.key
    if left is None or left.bar is None or bar.bar is None or key not in before.peaks or key not in found.peaks:
        return True
    off, telling = apart(before.peaks[key], found.peaks[key]), DOUBT * accuracy * bar.key_result.scale
    return off > max(bar.bar, telling) or bar.bar > MOST_FALL * max(left.bar, telling)


def largest(bars: Sequence[ErrorBar]) -> tuple[float, str]:
    """The largest bar over its quantity's scale, inf where one is not known, and its key."""
    return max((_relative(bar), bar.key_result.key) for bar in bars)


def _relative(bar: ErrorBar) -> float:
    return math.inf if bar.bar is None else bar.key_result.relative(bar.bar)


def _of_quantity(bar: ErrorBar, accuracy: float) -> Factors:
    if bar.bar is None:
        return {"mesh": NOT_KNOWN} | ({"time": NOT_KNOWN} if "time" in bar.by_source else {})
    allowed = (MARGIN * accuracy - SMALLEST) * bar.key_result.scale
    left, shares = allowed**2, dict(bar.by_source)
    while True:
        weights = {source: COST[source] / bar.order[source] for source in shares}
        whole = math.fsum(weights.values())
        aims = {source: math.sqrt(left * weight / whole) for source, weight in weights.items()}
        small = [source for source, aim in aims.items() if shares[source] <= aim]
        if not small:
            return {source: (shares[source] / aim) ** (1.0 / bar.order[source]) for source, aim in aims.items()}
        left -= math.fsum(shares.pop(source) ** 2 for source in small)


def _expected(bar: ErrorBar | None, before: RunValues, found: RunValues, factors: Factors, key: str) -> ErrorBar:
    key_result = found.key_results[key]
    if bar is None or bar.bar is None or key not in before.peaks:
        return ErrorBar(key_result, None, {}, (bar and bar.reason) or "the run before does not have it")
    own = {source: SAFETY[source] * gap for source, gap in gaps(key_result, found).items()}
    left = {s: each / factors.get(s, 1.0) ** bar.order[s] for s, each in bar.by_source.items()}
    left |= _by_the_two_runs(left, apart(before.peaks[key], found.peaks[key]), factors, bar.order)
    shares = {source: max(own.get(source, 0.0), each) for source, each in (own | left).items()}
    whole = math.hypot(*shares.values()) + SMALLEST * key_result.scale
    return replace(bar, key_result=key_result, bar=whole, by_source=shares)


def _by_the_two_runs(
    left: Mapping[str, float], off: float, factors: Factors, order: Mapping[str, float]
) -> dict[str, float]:
    """Shares of the sources that are finer, but for the soil's; off: how far the two runs are apart."""
    shares, finer = {}, [source for source, ratio in factors.items() if ratio > 1.0]
    for source in finer:
        if source in left and source != "soil":
            share = SAFETY[source] * off / (factors[source] ** order[source] - 1.0)
            share = max(share, BY_CHANCE * left[source])
            shares[source] = share if len(finer) == 1 else min(left[source], share)
    return shares
