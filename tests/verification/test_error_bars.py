"""Calibration of error bars: true errors are inside, and bars no wider than they need be, in it and out of sample."""

from __future__ import annotations

from statistics import median

import pytest

from benchmarks.error_bars import references
from benchmarks.error_bars.calibration import judge, ratios, share_inside
from benchmarks.error_bars.random_risers import CALIBRATION, OUT_OF_SAMPLE
from benchmarks.error_bars.scenes import Mapping


def test_every_scene_has_a_reference() -> None:
    assert set(references.read()) == set(CALIBRATION | OUT_OF_SAMPLE)


@pytest.mark.verify
@pytest.mark.parametrize("scenes", [CALIBRATION, OUT_OF_SAMPLE], ids=["calibration", "out of sample"])
def test_bars_hold_what_they_say(scenes: dict[str, Mapping]) -> None:
    known = references.read()
    judged = [each for name in scenes for each in judge(name, scenes[name], known[name]).judged]
    assert share_inside(judged) >= 0.95
    assert median(ratios(judged)) <= 3.0
