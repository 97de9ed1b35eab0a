"""Largest utilisations by codes, as the summary has them."""

import numpy as np
import pytest

from riser_soil.core.snapshot import CodeCheckFacts, Record
from riser_soil.results.code_tally import CodeTally
from tests.support.said import line_with

FACTS = [
    CodeCheckFacts("steel", "DNV-ST-F201", check, "sec. 5", f"{check}_utilisation", "ULS", "high")
    for check in ("bursting", "combined")
]


def record(*rows: tuple[float, float], place: float = 10.0) -> Record:
    """Utilisations of both checks at instants in turn, at arcs 10 m and 20 m."""
    largest = np.array(rows)
    places = np.broadcast_to([place, 2.0 * place], largest.shape)
    return Record(np.zeros(1), {"code_largest": largest, "code_place": places})


def followed() -> CodeTally:
    tally = CodeTally(FACTS)
    tally.update(np.array([0.5, 1.0]), record((0.2, 0.9), (0.3, 0.8)))
    tally.update(np.array([1.5]), record((0.25, 1.2), place=30.0))
    tally.update(np.array([2.0]), record((0.3, 1.2), place=50.0))
    return tally


def test_each_check_has_its_own_place_and_time() -> None:
    bursting, combined = followed().as_list()
    assert [bursting[key] for key in ("utilisation", "arc", "time", "exceeded")] == [0.3, 10.0, 1.0, False]
    assert [combined[key] for key in ("utilisation", "arc", "time", "exceeded")] == [1.2, 60.0, 1.5, True]
    assert (combined["line_type"], combined["variable"]) == ("steel", "combined_utilisation")


def test_what_is_exceeded_is_a_warning() -> None:
    (warning,) = followed().warnings("s")
    line_with([warning], "DNV-ST-F201 is not met", "combined of steel", "1.2 times", "arc 60 m and 1.5 s")


def test_nothing_is_reported_before_anything_is_checked() -> None:
    tally = CodeTally(FACTS)
    tally.update(np.array([1.0]), Record(np.zeros(1), {}))
    assert tally.as_list() == []
    assert [*tally.warnings("s")] == []


def test_another_goes_on_from_what_was_saved() -> None:
    again = CodeTally(FACTS)
    again.restore(followed().state())
    assert again.as_list() == followed().as_list()
    again.update(np.array([9.0]), record((0.9, 0.1)))
    assert again.as_list()[0]["time"] == pytest.approx(9.0)
