"""Calibration of error bars: true errors are inside, and bars no wider than they need be, in it and out of sample."""

from __future__ import annotations

import math
from statistics import median
from typing import Any

import pytest

from benchmarks.error_bars import random_soils, references
from benchmarks.error_bars.calibration import CERTAIN, Judged, judge, ratios, share_inside
from benchmarks.error_bars.random_risers import CALIBRATION, OUT_OF_SAMPLE
from benchmarks.error_bars.scenes import Mapping
from riser_soil.accuracy.error_bars import ErrorBar
from riser_soil.variants.key_results import SETTLEMENT, KeyResult


def test_every_scene_has_a_reference() -> None:
    assert set(references.read()) == set(CALIBRATION | OUT_OF_SAMPLE)
    assert set(references.read(references.ON_SOIL)) == set(random_soils.SOILS)


@pytest.mark.verify
@pytest.mark.parametrize("scenes", [CALIBRATION, OUT_OF_SAMPLE], ids=["calibration", "out of sample"])
def test_bars_hold_what_they_say(scenes: dict[str, Mapping]) -> None:
    known = references.read()
    judged = [each for name in scenes for each in judge(name, scenes[name], known[name]).judged]
    assert share_inside(judged) >= 0.95
    assert median(ratios(judged)) <= 3.0


@pytest.mark.verify
@pytest.mark.parametrize("scenes", [random_soils.EVEN, random_soils.ODD, random_soils.NEW], ids=["even", "odd", "new"])
def test_bars_on_soil_hold_what_they_say(scenes: dict[str, Mapping]) -> None:
    known = references.read(references.ON_SOIL)
    judged = [each for name, scene in scenes.items() for each in judge(name, scene, known[name]).judged]
    settled = [each for each in judged if each.bar.key_result.name == SETTLEMENT]
    assert share_inside(judged) >= 0.95
    assert share_inside(settled) >= (0.95 if len(settled) > 20 else 0.9)  # one of so few is more than 5 %
    assert median(ratios(judged)) <= 3.0
    assert median(ratios(judged, math.inf)) <= 3.0


@pytest.mark.parametrize(("error", "uncertainty", "ratio"), [(1.0, 0.2, 3.0), (1.0, 0.3, None), (1e-7, 0.0, None)])
def test_a_ratio_is_told_where_the_reference_tells_the_error(error: float, uncertainty: float, ratio: Any) -> None:
    """However wide the bar is."""
    for bar in (3.0, 300.0):
        each = Judged("scene", ErrorBar(KeyResult("stage", "top tension", "N", 1.0, 1.0), bar, {}), error, uncertainty)
        assert each.ratio(CERTAIN) == (ratio and ratio * bar / 3.0)
