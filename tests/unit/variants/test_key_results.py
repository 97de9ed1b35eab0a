"""Key results of a summary: their values by the stage's kind, and the scales of their errors."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from riser_soil.core.snapshot import RunFacts
from riser_soil.results.figures import pack
from riser_soil.results.summary import Summary, plain_json
from riser_soil.variants.key_results import KeyResult, key_results
from tests.support.recorded_run import EI, FACTS, WEIGHT, Catenary

ARC = np.linspace(0.0, 150.0, 301)
LENGTH = math.dist((0.0, 0.0, 0.15), Catenary(32.0, 30.0).record(ARC).position[-1])


def summary(kind: str, *parameters: float, facts: RunFacts = FACTS, **soil: Any) -> Any:
    """Summary of one stage that went through catenaries of these parameters [m], as read from summary.json."""
    whole = Summary(facts)
    stage = whole.begin_stage("lay", kind)
    for t, a in enumerate(parameters):
        stage.lines[""].extremes.update(float(t), pack(Catenary(a, 62.0 - a).record(ARC)))
        stage.steps = t + 1
    made = plain_json(whole.as_dict())
    made["stages"][0] |= {"soil": soil} if soil else {}
    return made


def test_of_a_static_stage_the_end_counts() -> None:
    results = key_results(summary("static", 20.0, 32.0))
    top = WEIGHT * math.hypot(32.0, 120.0)
    values = {each.name: (each.value, each.unit) for each in results.values()}
    assert values == {
        "top tension": (pytest.approx(top), "N"),
        "force at start": (pytest.approx(WEIGHT * 32.0), "N"),
        "force at end": (pytest.approx(top), "N"),
        "largest bending moment": (pytest.approx(EI / 32.0), "N.m"),
        "largest curvature": (pytest.approx(1.0 / 32.0), "1/m"),
        "least effective tension": (pytest.approx(WEIGHT * 32.0), "N"),
        "touchdown arc": (30.0, "m"),
        "largest contact force": (pytest.approx(WEIGHT * 30.0), "N"),
    }
    assert next(iter(results)) == "lay: top tension"


def test_of_a_dynamic_stage_its_extremes_count() -> None:
    results = key_results(summary("dynamic", 32.0, 25.0, 30.0))
    assert results["lay: largest bending moment"].value == pytest.approx(EI / 25.0)
    assert results["lay: top tension"].value == pytest.approx(WEIGHT * math.hypot(32.0, 120.0))
    assert results["lay: force at start"].value == pytest.approx(WEIGHT * 32.0)
    assert results["lay: least effective tension"].value == pytest.approx(WEIGHT * 25.0)
    assert results["lay: least touchdown arc"].value == 30.0
    assert results["lay: largest touchdown arc"].value == 37.0
    assert results["lay: largest contact force"].value == pytest.approx(WEIGHT * 37.0)


def test_the_upper_end_is_the_top() -> None:
    data = summary("static", 32.0)
    final = data["stages"][0]["final"]
    final["start"], final["end"] = final["end"], final["start"]
    assert key_results(data)["lay: top tension"].value == pytest.approx(WEIGHT * math.hypot(32.0, 120.0))


def test_settlement_where_there_is_soil() -> None:
    largest = {"value": 0.02, "position": [0.0, 0.0, 0.0], "time": 1.0}
    assert key_results(summary("static", 32.0, max_settlement=largest))["lay: soil settlement"].value == 0.02
    assert "lay: soil settlement" not in key_results(summary("static", 32.0))


def test_what_a_stage_lacks_is_left_out() -> None:
    data = summary("static", 32.0)
    data["stages"][0]["final"] |= {"touchdown_arc": None, "contact_force": 0.0}
    data["stages"].append(data["stages"][0] | {"name": "failed", "final": None})
    assert {each.name for each in key_results(data).values()}.isdisjoint({"touchdown arc", "largest contact force"})
    assert {each.stage for each in key_results(data).values()} == {"lay"}


def test_scales_have_floors() -> None:
    """A least tension near zero is judged by the stage's forces, the touchdown arc by the distance of the ends."""
    data = summary("static", 32.0)
    data["stages"][0]["final"]["min_effective_tension"]["value"] = -1.0
    data["stages"][0]["final"]["max_bending_moment"]["value"] = 1e-9
    results = key_results(data)
    top = results["lay: top tension"].value
    assert results["lay: top tension"].scale == top
    assert results["lay: least effective tension"].scale == pytest.approx(0.1 * top)
    assert results["lay: touchdown arc"].scale == pytest.approx(LENGTH)
    assert results["lay: largest bending moment"].scale == pytest.approx(1e-9 * top * LENGTH)
    assert results["lay: top tension"].relative(-0.01 * top) == pytest.approx(0.01)


def test_without_a_scale_only_no_difference_is_small() -> None:
    nothing = KeyResult("lay", "top tension", "N", 0.0, 0.0)
    assert (nothing.relative(0.0), nothing.relative(1e-300)) == (0.0, math.inf)
