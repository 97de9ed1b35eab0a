"""Step control: nominal times are hit whatever is cut, cuts end at the smallest step, easy steps grow again."""

from __future__ import annotations

import pytest

from riser_soil.solve.step_control import StepControl


def walk(control: StepControl, easy: bool = True) -> list[float]:
    times = []
    while not control.finished:
        times.append(control.target)
        control.accept(easy)
    return times


def test_nominal_steps() -> None:
    assert walk(StepControl(1.0, 0.25, 0.01)) == pytest.approx([0.25, 0.5, 0.75, 1.0])


def test_last_step_ends_the_stage() -> None:
    control = StepControl(1.0, 0.3, 0.01)
    assert walk(control) == pytest.approx([0.3, 0.6, 0.9, 1.0])


def test_cuts_of_a_short_last_step_stay_within_the_stage() -> None:
    control = StepControl(1.05, 0.1, 0.01)
    while control.target < 1.05:
        control.accept(easy=True)
    control.cut()
    control.cut()
    assert walk(control, easy=False) == pytest.approx([1.0125, 1.025, 1.0375, 1.05])


def test_no_sliver_of_a_step_from_round_off() -> None:
    assert len(walk(StepControl(15.0, 0.1, 1e-5))) == 150


def test_cut_steps_return_to_the_nominal_times_and_grow_again() -> None:
    control = StepControl(1.0, 0.25, 0.01)
    assert control.cut()
    assert control.cut()
    assert control.dt == pytest.approx(0.0625)
    assert walk(control) == pytest.approx([0.0625, 0.125, 0.25, 0.5, 0.75, 1.0])


def test_hard_steps_do_not_grow() -> None:
    control = StepControl(1.0, 0.5, 0.01)
    control.cut()
    assert walk(control, easy=False) == pytest.approx([0.25, 0.5, 0.75, 1.0])


def test_cuts_end_at_the_smallest_step() -> None:
    control = StepControl(1.0, 0.5, 0.1)
    assert [control.cut() for _ in range(3)] == [True, True, False]
    assert control.dt == pytest.approx(0.125)
