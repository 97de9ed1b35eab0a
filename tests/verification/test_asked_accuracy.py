"""Accuracies asked: scenes that claim to reach them truly do, the calibration's, on soil too, and random ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.asked_accuracy import by_hand
from benchmarks.asked_accuracy.asked import SOIL, asked, share_of_claims
from benchmarks.asked_accuracy.other_scenes import FILE, OTHERS
from benchmarks.asked_accuracy.true_errors import run_errors
from benchmarks.error_bars import references
from benchmarks.error_bars.calibration import judge, share_inside
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.variants.settings import refined


@pytest.mark.verify
def test_scenes_reach_what_they_claim() -> None:
    known = references.read()
    assert share_of_claims(asked(name, by_hand.ASKED[name], known[name]) for name in by_hand.ASKED) >= 0.95


@pytest.mark.verify
def test_random_scenes_reach_what_they_claim() -> None:
    known = references.read(FILE)
    assert share_of_claims(asked(name, OTHERS[name], known[name]) for name in OTHERS) >= 0.9


@pytest.mark.verify
def test_scenes_on_soil_reach_what_they_claim() -> None:
    known = references.read()
    assert share_of_claims(asked(name, SOIL[name], known[name]) for name in SOIL) == 1.0


@pytest.mark.verify
def test_error_bars_of_random_scenes_hold() -> None:
    known = references.read(FILE)
    judged = [each for name in OTHERS for each in judge(name, OTHERS[name], known[name]).judged]
    assert share_inside(judged) >= 0.9


@pytest.mark.verify
def test_settings_by_hand_reach_it(tmp_path: Path) -> None:
    known = references.read()
    for name, setting in by_hand.read().items():
        if setting is not None:
            scene = refined(scene_from_mapping(by_hand.ASKED[name]), setting.factors)
            errors, _ = run_errors(scene, tmp_path / "run", known[name])
            assert errors is not None, name
            assert errors.within, name
