"""Energy gain of a stage's steps: which are rejected."""

from __future__ import annotations

from itertools import pairwise

import pytest

from riser_soil.core.part import Energy
from riser_soil.solve.energy_gain import EnergyGain
from tests.support.said import line_with

STILL = Energy(kinetic=100.0, strain=0.0, potential=0.0)


def moving(gained: float) -> Energy:
    return Energy(kinetic=100.0 + gained, strain=0.0, potential=0.0)


def test_a_step_that_makes_much_is_rejected() -> None:
    """More than a fifth of the energy in motion, 100 J."""
    gain = EnergyGain(STILL)
    line_with(gain.rejection(STILL, moving(20.1), 0.0, 0.0, 0.0), "the step's", "makes 20.1 J")
    assert "the step's" not in gain.rejection(STILL, moving(19.9), 0.0, 0.0, 0.0)
    assert gain.rejection(STILL, moving(25.0), 0.0, 25.0, 0.0) == "", "put in from outside"
    assert gain.rejection(STILL, moving(25.0), 0.0, 0.0, negligible=25.0) == ""


@pytest.mark.parametrize(
    ("was", "now", "dissipated", "work", "reason"),
    [
        (Energy(kinetic=100.0), Energy(kinetic=125.0), 0.0, 0.0, "25 J out of nothing, beside 100 J"),
        (Energy(strain=100.0), Energy(kinetic=125.0), 0.0, 0.0, "25 J out of nothing, beside 100 J"),
        (Energy(potential=100.0), Energy(kinetic=125.0), 0.0, 0.0, "25 J out of nothing, beside 100 J"),
        (Energy(), Energy(potential=50.0), 75.0, 100.0, "25 J out of nothing, beside 100 J"),
        (Energy(strain=100.0), Energy(strain=45.0), 0.0, -100.0, "45 J out of nothing, beside 200 J"),
    ],
)
def test_in_motion_is_what_moves_is_strained_falls_or_goes_through_supports(
    was: Energy, now: Energy, dissipated: float, work: float, reason: str
) -> None:
    assert reason in EnergyGain(STILL).rejection(was, now, dissipated, work, 0.0)


def test_steps_that_make_a_little_each_are_rejected_once_their_sum_is_too_much() -> None:
    """A twentieth of the 100 J; one that makes less than half a joule hardly adds."""
    gain = EnergyGain(STILL)
    for _ in range(2):
        assert gain.rejection(STILL, moving(2.0), 0.0, 0.0, 0.0) == ""
        gain.accept(STILL, moving(2.0), 0.0, 0.0)
    line_with(gain.rejection(STILL, moving(2.0), 0.0, 0.0, 0.0), "6 J out of nothing", "102 J exchanged")
    assert gain.rejection(STILL, moving(0.98), 0.0, 0.0, 0.0) == "", "4.98 J in all"
    assert gain.rejection(STILL, moving(1.2), 0.0, 0.0, 0.0) != ""
    assert gain.rejection(STILL, moving(2.0), 0.0, 0.0, negligible=1.4) != ""
    assert gain.rejection(STILL, moving(2.0), 0.0, 0.0, negligible=1.6) == ""
    gain.accept(STILL, moving(1.2), 0.0, 0.0)
    assert gain.rejection(STILL, moving(0.49), 0.0, 0.0, 0.0) == "", "it hardly adds"
    assert gain.rejection(STILL, moving(0.51), 0.0, 0.0, 0.0) != ""
    assert gain.rejection(STILL, moving(-2.0), 0.0, 0.0, 0.0) == ""
    gain.accept(STILL, moving(-4.0), 0.0, 0.0)
    assert gain.rejection(STILL, moving(2.0), 0.0, 0.0, 0.0) == "", "balanced since"


HIGH = Energy(potential=1000.0)


@pytest.mark.parametrize(
    ("was", "now", "dissipated", "work"),
    [
        (HIGH, Energy(kinetic=1000.0), 0.0, 0.0),
        (HIGH, Energy(strain=1000.0), 0.0, 0.0),
        (HIGH, Energy(), 1000.0, 0.0),
        (Energy(), HIGH, 0.0, 1000.0),
        (HIGH, Energy(), 0.0, -1000.0),
        (STILL, STILL, 1000.0, 1000.0),
    ],
)
def test_what_was_stored_or_went_through_counts_as_turned_over(
    was: Energy, now: Energy, dissipated: float, work: float
) -> None:
    """A twentieth of 1000 J may have been made, not of 100 J."""
    gain = EnergyGain(STILL)
    gain.accept(was, now, dissipated, work)
    for _ in range(4):
        assert gain.rejection(STILL, moving(12.0), 0.0, 0.0, 0.0) == ""
        gain.accept(STILL, moving(12.0), 0.0, 0.0)
    line_with(gain.rejection(STILL, moving(12.0), 0.0, 0.0, 0.0), "60 J", "out of nothing", "1e+03 J exchanged")


@pytest.mark.parametrize(("dissipated", "work"), [(500.0, 0.0), (0.0, 500.0)])
def test_work_and_losses_add_up_over_steps(dissipated: float, work: float) -> None:
    gain = EnergyGain(STILL)
    for _ in range(2):
        gain.accept(STILL, Energy(kinetic=100.0, potential=work - dissipated), dissipated, work)
    for _ in range(4):
        gain.accept(STILL, moving(12.0), 0.0, 0.0)
    assert "1e+03 J exchanged" in gain.rejection(STILL, moving(12.0), 0.0, 0.0, 0.0)


def test_what_may_have_moved_before_a_step_or_after_it_counts() -> None:
    """Motion of 100 J that becomes strain, and strain that becomes motion, each with 6 J more than there were."""
    moves, strained = STILL, Energy(strain=106.0)
    line_with(EnergyGain(STILL).rejection(moves, strained, 0.0, 0.0, 0.0), "make 6 J", "out of nothing")
    moves, strained = moving(6.0), Energy(strain=100.0)
    line_with(EnergyGain(STILL).rejection(strained, moves, 0.0, 0.0, 0.0), "make 6 J", "out of nothing")


def test_what_moves_nothing_does_not_count() -> None:
    """A pipe that is pressed slowly into soil, in steps so long that the mean of its forces is off."""
    slow = [Energy(kinetic=1e-3, strain=10.0 * k, potential=0.0) for k in range(9)]
    gain = EnergyGain(slow[1])
    for was, now in pairwise(slow[1:]):
        assert gain.rejection(was, now, 0.0, 8.5, 0.0) == "", "1.5 J appear in each of 7 steps, of 80 J"
        gain.accept(was, now, 0.0, 8.5)
    fast = [Energy(kinetic=100.0, strain=10.0 * k, potential=0.0) for k in range(9)]
    gain = EnergyGain(fast[1])
    gain.accept(fast[1], fast[2], 0.0, -45.0)
    assert gain.rejection(fast[2], fast[3], 0.0, 8.5, 0.0) != ""


def test_it_goes_on_from_what_was_saved() -> None:
    gain, again = EnergyGain(STILL), EnergyGain(STILL)
    gain.accept(STILL, moving(4.0), 0.0, 0.0)
    again.restore(gain.state())
    assert again.rejection(STILL, moving(2.0), 0.0, 0.0, 0.0) == gain.rejection(STILL, moving(2.0), 0.0, 0.0, 0.0) != ""
