"""Energy gain of a stage's steps: which are rejected."""

from __future__ import annotations

from itertools import pairwise

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


def test_what_moves_nothing_does_not_count() -> None:
    """A pipe that is pressed slowly into soil, in steps so long that the mean of its forces is off."""
    slow = [Energy(kinetic=1e-3, strain=10.0 * k, potential=0.0) for k in range(9)]
    gain = EnergyGain(LARGEST, slow[1])
    for was, now in pairwise(slow[1:]):
        assert gain.rejection(was, now, 0.0, 8.5, 0.0) == "", "1.5 J appear in each of 7 steps, of 80 J"
        gain.accept(was, now, 0.0, 8.5)
    fast = [Energy(kinetic=100.0, strain=10.0 * k, potential=0.0) for k in range(9)]
    gain = EnergyGain(LARGEST, fast[1])
    gain.accept(fast[1], fast[2], 0.0, -45.0)
    assert gain.rejection(fast[2], fast[3], 0.0, 8.5, 0.0) != ""


def test_it_goes_on_from_what_was_saved() -> None:
    gain, again = EnergyGain(LARGEST, STILL), EnergyGain(LARGEST, STILL)
    gain.accept(STILL, moving(4.0), 0.0, 0.0)
    again.restore(gain.state())
    assert again.rejection(STILL, moving(2.0), 0.0, 0.0, 0.0) == gain.rejection(STILL, moving(2.0), 0.0, 0.0, 0.0) != ""
