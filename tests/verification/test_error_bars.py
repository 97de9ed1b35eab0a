"""Calibration of error bars: true errors are inside, and bars no wider than they need be, in it and out of sample."""

from __future__ import annotations

from statistics import median

import pytest

from benchmarks.error_bars import random_soils, references
from benchmarks.error_bars.calibration import judge, ratios, share_inside
from benchmarks.error_bars.random_risers import CALIBRATION, OUT_OF_SAMPLE
from benchmarks.error_bars.scenes import Mapping
from riser_soil.accuracy.key_results import SETTLEMENT


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
def test_bars_on_soil_hold_what_they_say() -> None:
    """Both halves together; of settlements all are inside."""
    known = references.read(references.ON_SOIL)
    judged = [each for name, scene in random_soils.SOILS.items() for each in judge(name, scene, known[name]).judged]
    assert share_inside(judged) >= 0.95
    assert share_inside(each for each in judged if each.bar.key_result.name == SETTLEMENT) >= 0.95
