"""Energy gain of a stage's steps: which are rejected."""

from __future__ import annotations

import pytest

from riser_soil.core.part import Energy
from riser_soil.solve.energy_gain import LARGEST, SMALL, SUM, EnergyGain

STILL = Energy(kinetic=100.0, strain=0.0, potential=0.0)


def moving(gained: float) -> Energy:
    return Energy(kinetic=100.0 + gained, strain=0.0, potential=0.0)


def test_a_step_that_makes_much_is_rejected() -> None:
    gain = EnergyGain(LARGEST, STILL)
    assert "25 J out of nothing, beside 100 J in motion" in gain.rejection(STILL, moving(25.0), 0.0, 0.0, 0.0)
    assert gain.rejection(STILL, moving(25.0), 0.0, 25.0, 0.0) == "", "put in from outside"
    assert gain.rejection(STILL, moving(25.0), 0.0, 0.0, negligible=25.0) == ""


def test_steps_that_make_a_little_each_are_rejected_once_their_sum_is_too_much() -> None:
    gain, allowed = EnergyGain(LARGEST, STILL), SUM * LARGEST * 100.0
    assert allowed == pytest.approx(5.0)
    for _ in range(2):
        assert gain.rejection(STILL, moving(2.0), 0.0, 0.0, 0.0) == ""
        gain.accept(STILL, moving(2.0), 0.0, 0.0)
    assert "6 J out of nothing, beside 102 J turned over" in gain.rejection(STILL, moving(2.0), 0.0, 0.0, 0.0)
    assert gain.rejection(STILL, moving(0.9 * SMALL * LARGEST * 100.0), 0.0, 0.0, 0.0) == "", "it hardly adds"
    assert gain.rejection(STILL, moving(-2.0), 0.0, 0.0, 0.0) == ""
    gain.accept(STILL, moving(-3.0), 0.0, 0.0)
    assert gain.rejection(STILL, moving(2.0), 0.0, 0.0, 0.0) == "", "balanced since"


def test_work_that_goes_through_counts_as_turned_over() -> None:
    gain = EnergyGain(LARGEST, STILL)
    gain.accept(STILL, STILL, dissipated=1000.0, work=1000.0)
    gain.accept(STILL, moving(6.0), 0.0, 0.0)
    assert gain.rejection(STILL, moving(6.0), 0.0, 0.0, 0.0) == ""


def test_it_goes_on_from_what_was_saved() -> None:
    gain, again = EnergyGain(LARGEST, STILL), EnergyGain(LARGEST, STILL)
    gain.accept(STILL, moving(4.0), 0.0, 0.0)
    again.restore(gain.state())
    assert again.rejection(STILL, moving(2.0), 0.0, 0.0, 0.0) == gain.rejection(STILL, moving(2.0), 0.0, 0.0, 0.0) != ""
