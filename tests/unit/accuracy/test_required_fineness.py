"""Fineness that an accuracy requires by made-up error bars, and the bars that are predicted."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, cast

import pytest

from riser_soil.accuracy.error_bars import ErrorBar, RunValues
from riser_soil.accuracy.required_fineness import (
    cost_ratio,
    largest,
    out_of_reach,
    predicted_bars,
    required,
    unreliable,
)
from riser_soil.accuracy.search import TriedSetting
from riser_soil.accuracy.target_run import _next_factors
from riser_soil.variants.extreme_differences import without_windows
from riser_soil.variants.key_results import KeyResult

VALUE = 1000.0
ORDERS = {"mesh": 2.0, "time": 2.0, "soil": 1.0, "penalty": 0.75}  # in which shares fall
COST = {"mesh": 0.7, "time": 1.0, "soil": 3.0, "penalty": 0.1}  # powers: soil's cells grow in number by the cube
SAFETY, SMALLEST = {"mesh": 2.0, "time": 2.8, "penalty": 1.6}, 5e-5  # of error bars, as calibrated
MARGIN, BY_CHANCE = 0.8, 0.25  # of the accuracy, that bars keep to; of a share, that stays where two runs agree
KEY_RESULT = KeyResult("hang", "top tension", "N", VALUE, 100.0)
KEY = KEY_RESULT.key


def bar(**shares: float) -> ErrorBar:
    """Shares relative to the value."""
    by_source = {source: share * VALUE for source, share in shares.items()}
    return ErrorBar(KEY_RESULT, math.hypot(*by_source.values()) + SMALLEST * VALUE, by_source)


def values(value: float, peak: float | None = None) -> RunValues:
    """Values of a run. peak: between its steps."""
    key_result = KeyResult("hang", "top tension", "N", value, 100.0)
    return RunValues(
        {KEY: key_result}, {KEY: value}, {KEY: without_windows(value if peak is None else peak)}, {KEY: value}
    )


def remaining(given: ErrorBar, factors: dict[str, float]) -> float:
    """The relative bar once each source is finer."""
    return math.hypot(*(b / VALUE / factors.get(s, 1.0) ** ORDERS[s] for s, b in given.by_source.items())) + SMALLEST


@pytest.mark.parametrize(
    "shares",
    [{"time": 0.05}, {"mesh": 0.03, "time": 0.001}, {"mesh": 0.02, "time": 0.04, "penalty": 0.01}, {"soil": 0.015}],
)
def test_bars_just_keep_to_the_margin(shares: dict[str, float]) -> None:
    given = bar(**shares)
    assert remaining(given, dict(required([given], 0.01))) == pytest.approx(MARGIN * 0.01, rel=1e-6)


def test_no_cheaper_way_leads_there() -> None:
    """The cost is the product of powers; other ways of sharing the error out cost more."""
    given = bar(mesh=0.02, time=0.04)
    factors = dict(required([given], 0.01))

    def cost(at: dict[str, float]) -> float:
        return math.prod(factor ** COST[source] for source, factor in at.items())

    for mesh in (0.9, 0.97, 1.03, 1.1):
        other = factors | {"mesh": mesh * factors["mesh"]}
        of_time = math.sqrt((MARGIN * 0.01 - SMALLEST) ** 2 - (0.02 / other["mesh"] ** ORDERS["mesh"]) ** 2)
        other["time"] = (0.04 / of_time) ** (1.0 / ORDERS["time"])
        assert remaining(given, other) == pytest.approx(MARGIN * 0.01)
        assert cost(other) > cost(factors)


def test_what_is_accurate_enough_stays() -> None:
    assert not required([bar(mesh=0.002, time=0.003)], 0.01)
    assert set(required([bar(mesh=0.0001, time=0.05)], 0.01)) == {"time"}


def test_the_worst_quantity_counts_and_no_step_is_huge() -> None:
    """Elements four times as fine at most."""
    factors = required([bar(time=0.02), bar(time=0.05), bar(mesh=100.0)], 0.01)
    assert factors["time"] == pytest.approx(math.sqrt(0.05 / (MARGIN * 0.01 - SMALLEST)))
    assert factors["mesh"] == 4.0


def test_soil_is_at_most_twice_as_fine_in_the_next_run() -> None:
    """That is eight times as many cells."""
    assert required([bar(soil=0.015)], 0.01)["soil"] == pytest.approx(0.015 / (MARGIN * 0.01 - SMALLEST))
    factors = required([bar(soil=0.03, time=0.03)], 0.01)
    assert factors["soil"] == 2.0
    assert cost_ratio(factors) == pytest.approx(8.0 * factors["time"])


def test_what_the_runs_that_are_left_can_not_reach_is_out_of_reach() -> None:
    """The accuracy asks for elements and steps, four times as many a run; soil's price has limits of its own."""
    aim = MARGIN * 0.01 - SMALLEST
    for given in (bar(mesh=15.0 * aim), bar(time=15.0 * aim), bar(soil=1.0)):
        assert out_of_reach([given], 0.01, 1) == 0.0
    far = bar(time=100.0 * aim)
    assert out_of_reach([far], 0.01, 1) == pytest.approx(10.0)
    assert out_of_reach([far], 0.01, 2) == 0.0
    both = [bar(mesh=100.0 * aim), far]
    assert out_of_reach(both, 0.01, 1) == pytest.approx(100.0)


def test_unknown_bars_ask_for_a_finer_setting() -> None:
    unknown = ErrorBar(KEY_RESULT, None, {"time": 1.0}, "a coarser run failed")
    assert required([unknown], 0.01) == {"mesh": 2.0, "time": 2.0}
    assert largest([unknown, bar(time=0.5)]) == (math.inf, KEY)


def test_shares_fall_by_their_orders() -> None:
    factors = {"mesh": 2.0, "time": 4.0}
    (predicted,) = predicted_bars([bar(mesh=0.02, time=0.04)], values(1000.0), values(1030.0), factors)
    assert predicted.by_source == pytest.approx({"mesh": 5.0, "time": 2.5})
    assert predicted.bar == pytest.approx(math.hypot(5.0, 2.5) + SMALLEST * 1030.0)


@pytest.mark.parametrize(
    ("change", "share"),
    [(4.0, SAFETY["penalty"] * 4.0 / 3.0), (1e-3, BY_CHANCE * 5.0), (12.0, SAFETY["penalty"] * 12.0 / 3.0)],
)
def test_share_of_a_source_that_is_finer_alone_is_by_the_difference(change: float, share: float) -> None:
    """The share is by Richardson's extrapolation, be it more than predicted by the order, but no less than a part of
    that.
    """
    runs, factors = (values(1000.0), values(1000.0 + change)), {"penalty": 4.0 ** (1 / 0.75)}
    (predicted,) = predicted_bars([bar(penalty=0.02)], *runs, factors)
    assert predicted.by_source["penalty"] == pytest.approx(share)


def test_difference_of_two_runs_bounds_the_share_of_each_of_several_sources() -> None:
    """Each as if it were alone, and a part of the predicted share at least, as errors may cancel."""
    before, factors = bar(penalty=0.02, mesh=0.02), {"penalty": 4.0 ** (1 / 0.75), "mesh": 2.0}
    (near,) = predicted_bars([before], values(1000.0), values(1003.0), factors)
    assert near.by_source["penalty"] == pytest.approx(SAFETY["penalty"] * 3.0 / 3.0)
    assert near.by_source["mesh"] == pytest.approx(SAFETY["mesh"] * 3.0 / (2.0 ** ORDERS["mesh"] - 1.0))
    (same,) = predicted_bars([before], values(1000.0), values(1000.001), factors)
    assert same.by_source["penalty"] == pytest.approx(BY_CHANCE * 5.0)
    assert same.by_source["mesh"] == pytest.approx(BY_CHANCE * 5.0)
    (far,) = predicted_bars([before], values(1000.0), values(1015.0), factors)
    assert (far.by_source["penalty"], far.by_source["mesh"]) == pytest.approx((5.0, 5.0))


def test_a_source_that_is_no_finer_keeps_its_share() -> None:
    (predicted,) = predicted_bars([bar(penalty=0.02)], values(1000.0), values(1000.001), {"penalty": 1.0, "time": 2.0})
    assert predicted.by_source["penalty"] == pytest.approx(20.0)


@pytest.mark.parametrize("factors", [{"soil": 2.0}, {"soil": 2.0, "mesh": 2.0}])
def test_two_meshes_of_soil_that_agree_may_do_so_by_chance(factors: dict[str, float]) -> None:
    (predicted,) = predicted_bars([bar(soil=0.02)], values(1000.0), values(1000.0), factors)
    assert predicted.by_source["soil"] == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("before", "change", "after", "measured"),
    [
        (0.02, 15.0, 0.005, False),
        (0.02, 25.0, 0.005, True),  # by more than the bar before
        (0.002, 4.0, 0.002, False),  # likewise, but by less than half the accuracy
        (0.06, 15.0, 0.009, False),
        (0.06, 15.0, 0.007, True),  # to less than an eighth
        (0.03, 15.0, 0.003, False),  # likewise, but from less than eight times half the accuracy
    ],
)
def test_predictions_can_be_relied_on_or_not(before: float, change: float, after: float, measured: bool) -> None:
    """For an accuracy of 1 %."""
    (given, predicted), runs = (bar(time=share) for share in (before, after)), (values(1000.0), values(1000.0 + change))
    assert unreliable([given], *runs, [predicted], 0.01) is measured


def test_a_quantity_that_one_of_two_runs_lacks_can_not_be_predicted() -> None:
    assert unreliable([bar(time=0.02)], values(1000.0), values(1001.0), [], 0.01)


def test_what_falls_between_the_runs_own_steps_is_kept() -> None:
    (predicted,) = predicted_bars([bar(time=0.02)], values(1000.0), values(1000.0, peak=1008.0), {"time": 10.0})
    assert predicted.by_source["time"] == pytest.approx(SAFETY["time"] * 8.0)


def test_a_quantity_that_the_run_before_lacks_is_not_known() -> None:
    (predicted,) = predicted_bars([], values(1000.0), values(1000.0), {})
    assert predicted.bar is None
    assert "run before" in predicted.reason


def test_the_next_run_aims_as_close_as_there_is_time_for() -> None:
    """Half an hour, which eight times a run of 300 s are not, as cells half as large would be; the bar of 7 % falls to
    that which is asked for by cells of 4/7 of the size.
    """
    given = TriedSetting(cast("Any", None), None, [bar(soil=0.07)], 300.0)
    close, quick = (_next_factors(replace(given, seconds=seconds), 0.05, 3) for seconds in (1.0, 300.0))
    assert dict(close[0]) == {"soil": 2.0}
    assert close[1] == pytest.approx(8.0)
    assert quick[0]["soil"] == pytest.approx(0.07 / (MARGIN * 0.05 - SMALLEST), rel=1e-6)
    assert quick[1] == pytest.approx(300.0 * quick[0]["soil"] ** COST["soil"])
    assert quick[1] < 1800.0
    assert _next_factors(replace(given, seconds=600.0), 0.05, 3)[1] > 1800.0
