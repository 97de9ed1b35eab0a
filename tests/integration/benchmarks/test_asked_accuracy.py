"""Calibration of accuracies asked: quick scenes and a random one, settings by hand, and what its page counts."""

from __future__ import annotations

import pytest

from benchmarks.asked_accuracy import by_hand
from benchmarks.asked_accuracy.asked import (
    SOIL,
    AskedScene,
    HandCost,
    Outcome,
    asked,
    asking,
    costs,
    median_error,
    share_of_all,
    share_of_claims,
)
from benchmarks.asked_accuracy.by_hand import ASKED, best, settings
from benchmarks.asked_accuracy.other_scenes import FILE, OTHERS
from benchmarks.asked_accuracy.page import FIGURES, not_reached, page, random_page
from benchmarks.asked_accuracy.true_errors import ACCURACY, ON_SOIL, TrueErrors
from benchmarks.error_bars import references
from benchmarks.error_bars.calibration import judge
from demos.page import block
from riser_soil.scene.reader import scene_from_mapping
from tests.support.said import line_with

GOOD, BAD = TrueErrors({"hang: top tension": 0.2 * ACCURACY}, 0), TrueErrors({"hang: top tension": 3.0 * ACCURACY}, 1)


def made_up() -> list[AskedScene]:
    return [
        AskedScene("a", GOOD, "", "24 elements", HandCost(3.0, 1.0, 0.5)),
        AskedScene("b", BAD, "", "24 elements", HandCost(3.0, 1.0, 0.5)),
        AskedScene("c", BAD, "accuracy: it was not reached", "24 elements", HandCost(3.0, 1.0, 0.5)),
        AskedScene("d", TrueErrors({"hang: top tension": 0.4 * ACCURACY}, 0), "", "9 elements"),
    ]


def test_outcomes_and_shares() -> None:
    scenes = made_up()
    assert [each.outcome for each in scenes] == [Outcome.REACHED, Outcome.MISSED, Outcome.REPORTED, Outcome.REACHED]
    assert share_of_claims(scenes) == pytest.approx(2.0 / 3.0)
    assert share_of_all(scenes) == pytest.approx(0.5)
    assert median_error(scenes) == pytest.approx(0.4)
    assert costs(scenes) == [scenes[0].cost]


def test_what_is_asked_has_none_of_what_it_chooses() -> None:
    for mapping in (*ASKED.values(), *OTHERS.values(), *SOIL.values()):
        before = repr(mapping)
        assert scene_from_mapping(asking(mapping)).accuracy == (ON_SOIL if "soil" in mapping else ACCURACY)
        assert repr(mapping) == before


@pytest.mark.parametrize("name", ["clamped catenary", "on springs"])
def test_quick_scenes_reach_it(name: str) -> None:
    known = references.read()[name]
    hand = by_hand.read()[name]
    outcome = asked(name, ASKED[name], known, hand)
    assert outcome.outcome is Outcome.REACHED
    assert outcome.cost is not None
    assert 0.0 < outcome.cost.chosen < outcome.cost.everything
    far = {key: (1.05 * value, 0.0) for key, (value, _) in known.items()}
    assert asked(name, ASKED[name], far).outcome is Outcome.MISSED


def test_page_of_a_random_scene() -> None:
    name = "catenary A"
    known = references.read(FILE)[name]
    outcome = asked(name, OTHERS[name], known)
    bars = [judge(name, OTHERS[name], known)]
    text = page(made_up(), [outcome], bars, made_up())
    assert outcome.outcome is Outcome.REACHED
    line_with(block(text, FIGURES), "truly reach", "claim it", "| 66.7% |")
    missed = not_reached(made_up())
    assert line_with(missed, "missed, 3.00%", "hang: top tension").startswith('b,"')
    assert line_with(missed, "accuracy:", "not reached").startswith("c,")
    assert f"\n{name},reached," in random_page([outcome], bars)


def test_best_by_hand_is_the_cheapest_that_reaches_it() -> None:
    name = "catenary, 35 elements"
    reference = references.read()[name]
    setting = best(ASKED[name], reference)
    assert setting is not None
    known = by_hand.read()[name]
    assert known is not None
    assert setting.factors == known.factors
    assert setting.error == pytest.approx(known.error, rel=1e-6)
    assert setting.error <= ACCURACY
    uncertain = {key: (value, abs(value)) for key, (value, _) in reference.items()}
    assert best(ASKED[name], uncertain) is None


def test_settings_by_hand_begin_with_the_cheapest() -> None:
    tried = list(settings(scene_from_mapping(ASKED["heave on a rigid floor"])))
    assert len(tried) == 75
    assert tried[0] == {"elements": 0.25, "time_step": 0.25, "penalty": 1.0}
    assert tried[-1] == {"elements": 4.0, "time_step": 4.0, "penalty": 16.0}


def test_every_scene_has_what_it_is_compared_with() -> None:
    assert set(by_hand.read()) == set(ASKED)
    assert set(references.read(FILE)) == set(OTHERS)
    assert len(OTHERS) >= 12
