"""Characteristic extremes over seeds, against Gumbel's distribution itself."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from rich.console import Console

from riser_soil.cases.case_file import WantedExtremes
from riser_soil.cases.case_table import CaseTable
from riser_soil.cases.case_values import CaseValue, Sample
from riser_soil.cases.characteristic import (
    CharacteristicExtreme,
    characteristic_extremes,
    governing,
    governing_table,
    row_of,
    warnings_of,
)
from riser_soil.cases.expansion import Case
from riser_soil.variants.runs_folder import Outcome

MODE, SCALE = 900.0e3, 40.0e3  # N, of the extremes of 1200 s
WANTED = WantedExtremes(fractile=0.95, duration=3600.0, confidence=0.9)


def cases_of(sea: str, count: int) -> list[Case]:
    path = "water.waves.jonswap.seed"
    labels = [{"sea state": sea, "seed": str(n)} for n in range(count)]
    return [Case(f"{sea}-seed={n}", {path: n}, labels[n], sea) for n in range(count)]


def table_of(maxima: dict[str, Sequence[float]], least: bool = False, name: str = "top tension") -> CaseTable:
    """Sea states with the extremes of their seeds."""
    cases = [case for sea, values in maxima.items() for case in cases_of(sea, len(values))]
    numbers = [value for values in maxima.values() for value in values]
    extremes = {
        case.name: {f"storm: {name}": CaseValue("storm", name, "N", value, Sample(value, least, 1200.0))}
        for case, value in zip(cases, numbers, strict=True)
    }
    return CaseTable("seas", cases, {case.name: Outcome(case.name, "", 0) for case in cases}, extremes)


def extremes_of(maxima: dict[str, Sequence[float]], least: bool = False) -> list[CharacteristicExtreme]:
    return characteristic_extremes(table_of(maxima, least), WANTED)


def drawn(count: int) -> list[float]:
    return np.random.default_rng(5).gumbel(MODE, SCALE, count).tolist()


def test_a_fractile_of_many_seeds_is_that_of_the_distribution() -> None:
    """Over three times as long the mode goes up by scale ln 3; the fractile p lies -scale ln(-ln p) above it."""
    (extreme,) = extremes_of({"storm": drawn(20000)})
    mode = MODE + SCALE * math.log(3.0)
    assert extreme.most_probable == pytest.approx(mode, abs=0.02 * SCALE)
    assert extreme.characteristic.value == pytest.approx(mode - SCALE * math.log(-math.log(0.95)), abs=0.05 * SCALE)
    assert extreme.characteristic.low < extreme.characteristic.value < extreme.characteristic.high
    assert extreme.simulated == 1200.0


def test_the_fractile_is_the_share_of_long_sea_states_that_stay_below() -> None:
    """The largest of three blocks of 1200 s is below the fractile in 95 of 100 cases."""
    (extreme,) = extremes_of({"storm": drawn(20000)})
    largest = np.random.default_rng(9).gumbel(MODE, SCALE, (20000, 3)).max(axis=1)
    assert (largest < extreme.characteristic.value).mean() == pytest.approx(0.95, abs=0.01)


def test_least_values_are_those_of_the_negatives() -> None:
    maxima = drawn(7)
    (largest,) = extremes_of({"storm": maxima})
    (least,) = extremes_of({"storm": [-value for value in maxima]}, least=True)
    assert least.characteristic.value == -largest.characteristic.value
    assert (least.characteristic.low, least.characteristic.high) == (
        -largest.characteristic.high, -largest.characteristic.low,
    )  # fmt: skip
    assert (least.of_seeds, least.location, least.scale) == (-max(maxima), -largest.location, largest.scale)


def test_fewer_than_three_seeds_have_no_fit_but_an_extreme() -> None:
    extremes = extremes_of({"storm": [3.0, 5.0], "mild": [1.0, 2.0, 2.5]})
    few, enough = (row_of(each, ["sea state"]) for each in extremes)
    assert (few["of seeds"], few["seeds"], few["sea state"]) == (5.0, 2, "storm")
    assert all(math.isnan(few[name]) for name in ("characteristic", "low", "high", "most probable", "scale"))
    assert all(math.isfinite(enough[name]) for name in ("characteristic", "low", "high", "most probable", "scale"))
    (warning,) = warnings_of(extremes, [*cases_of("storm", 2), *cases_of("mild", 3)])
    assert "1 of 2 groups have fewer than 3 seeds, as storm" in warning


def test_what_governs_is_the_worst_group_of_each_quantity() -> None:
    extremes = extremes_of({"mild": [1e3, 2e3, 3e3], "storm": [5e3, 6e3, 8e3], "swell": [4e3, 4.5e3, 5e3]})
    assert [each.group.name for each in governing(extremes)] == ["storm"]
    tensions = extremes_of({"mild": [5e3, 6e3, 8e3], "storm": [-1e3, -2e3, 3e3]}, least=True)
    assert [each.group.name for each in governing(tensions)] == ["storm"]
    console = Console(width=80, record=True, quiet=False)
    with console.capture() as shown:
        console.print(governing_table(extremes))
    rows = [[cell.strip() for cell in line.split("│")[1:-1]] for line in shown.get().splitlines()]
    quantity = next(row for row in rows if row and row[0].startswith("top tension"))
    worst = extremes[1]
    assert quantity[0] == "top tension [kN]"
    assert quantity[1] == "8"
    assert quantity[3] == f"{1e-3 * worst.characteristic.value:.4g}"


def test_failed_seeds_do_not_count() -> None:
    table = table_of({"storm": [1.0, 2.0, 4.0, 3.0]})
    values = {name: of_case for name, of_case in table.values.items() if name != "storm-seed=2"}
    (extreme,) = characteristic_extremes(CaseTable("", table.cases, table.outcomes, values), WANTED)
    assert extreme.samples.tolist() == [1.0, 2.0, 3.0]
