"""Calibration of error bars: true errors are inside, and bars no wider than they need be, over all its scenes."""

from __future__ import annotations

import pytest

from benchmarks.error_bars import references
from benchmarks.error_bars.calibration import judge, median_ratio, share_inside
from benchmarks.error_bars.scenes import SCENES


@pytest.mark.verify
def test_bars_hold_what_they_say() -> None:
    known = references.read()
    assert set(known) == set(SCENES)
    assert len(SCENES) >= 40
    judged = [each for name in SCENES for each in judge(name, SCENES[name], known[name]).judged]
    assert share_inside(judged) >= 0.95
    assert median_ratio(judged) <= 3.0
