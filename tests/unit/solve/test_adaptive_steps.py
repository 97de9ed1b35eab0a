"""Automatic steps: they hit what must be hit, settle where the error asks, and shrink no further than allowed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from riser_soil.assembly.stage import times_to_hit
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.stages import DynamicStage
from riser_soil.solve.adaptive_steps import AutoSteps
from tests.support.said import line_with
from tests.support.scenes import dynamic, prescribed, riser_scene

TOLERANCE = 1e-3


def walk(steps: AutoSteps, error: Callable[[float, float], float], easy: bool = True) -> tuple[list[float], int]:
    """Ends of the accepted steps, and how many attempts failed; error(t, dt)."""
    times, failed = list[float](), 0
    while not steps.finished:
        if steps.rejection(error(steps.target, steps.dt)):
            assert steps.cut()
            failed += 1
        else:
            times.append(steps.target)
            steps.accept(easy)
    return times, failed


def smooth(size: float) -> Callable[[float, float], float]:
    """An error of third order that asks for steps of this size, at which it is 0.3 of the tolerance."""
    return lambda t, dt: 0.3 * TOLERANCE * (dt / size) ** 3


def test_steps_settle_where_the_error_asks() -> None:
    times, failed = walk(AutoSteps(40.0, TOLERANCE, 1e-5, 0.01), smooth(0.2))
    dt = np.diff(times)
    assert failed == 0
    assert dt[-100:] == pytest.approx(0.2, rel=0.02)
    assert times[-1] == 40.0


@pytest.mark.parametrize(("error", "next_step"), [(0.0, 4.0**0.1), (0.9, 3.0 ** (-1.0 / 6.0)), (0.3, 1.0)])
def test_sizes_go_half_of_the_way_down_and_a_tenth_of_it_up(error: float, next_step: float) -> None:
    """In the logarithm; up at most to four times the step, down to where a third of its error would be left."""
    steps = AutoSteps(1000.0, TOLERANCE, 1e-5, 1.0)
    assert not steps.rejection(error * TOLERANCE)
    steps.accept(easy=True)
    assert steps.dt == pytest.approx(next_step, rel=2e-3)


@pytest.mark.parametrize(("error", "again"), [(1e9, 0.2), (8.0 * 0.3, 0.5), (1.0001, 0.3 ** (1.0 / 3.0))])
def test_what_errs_too_much_is_tried_again_with_what_fits_but_no_less_than_a_fifth(error: float, again: float) -> None:
    steps = AutoSteps(1000.0, TOLERANCE, 1e-5, 1.0)
    assert steps.rejection(error * TOLERANCE)
    assert steps.cut()
    assert steps.dt == pytest.approx(again, rel=2e-3)


def test_too_long_a_first_step_is_tried_again_at_once_with_the_right_size() -> None:
    times, failed = walk(AutoSteps(100.0, TOLERANCE, 1e-5, 1.0), smooth(0.3))
    assert failed == 1
    assert times[0] == pytest.approx(0.3, rel=0.02)


def test_sudden_errors_shorten_steps_and_leave_no_trace() -> None:
    """An impact of 0.1 s asks for steps a hundred times shorter."""

    def error(t: float, dt: float) -> float:
        struck = t > 20.0 and t - dt < 20.1
        return smooth(2e-3 if struck else 0.2)(t, dt)

    times, failed = walk(AutoSteps(40.0, TOLERANCE, 1e-5, 0.1), error)
    dt = np.diff(times)
    assert dt[np.array(times[1:]) < 20.0].max() == pytest.approx(0.2, rel=0.05)
    assert dt.min() == pytest.approx(2e-3, rel=0.2)
    assert failed < 5
    assert dt[-20:] == pytest.approx(0.2, rel=0.05)
    assert len(times) < 350


def test_all_stops_are_hit_and_steps_between_them_are_equal() -> None:
    stops = [0.7 * n for n in range(1, 15)]
    times, _ = walk(AutoSteps(10.0, TOLERANCE, 1e-5, 0.2, stops), lambda t, dt: 0.0 if t > 5.0 else smooth(0.2)(t, dt))
    assert set(stops) | {10.0} <= set(times)
    dt, ends = np.diff([0.0, *times]), np.array(times)
    assert dt[(ends > 2.11) & (ends < 4.9)] == pytest.approx(0.175, rel=1e-9)
    assert dt.max() <= 0.5 + 1e-12


def test_stops_that_all_but_meet_are_one() -> None:
    stops = [0.3, 0.1 + 0.2, 10.0 - 1e-12, 12.0, 0.0, -1.0]
    times, _ = walk(AutoSteps(10.0, TOLERANCE, 1e-5, 1.0, stops), lambda t, dt: 0.0)
    assert np.diff(times).min() > 1e-3
    assert times[-1] == 10.0


def test_hard_steps_do_not_grow() -> None:
    times, _ = walk(AutoSteps(1.0, TOLERANCE, 1e-5, 0.01), lambda t, dt: 0.0, easy=False)
    assert np.diff(times).max() == pytest.approx(0.01)


def test_what_fails_for_other_reasons_is_halved_down_to_the_smallest() -> None:
    steps = AutoSteps(100.0, TOLERANCE, 0.3, 1.0)
    sizes = [steps.dt]
    while steps.cut():
        sizes.append(steps.dt)
    assert sizes == pytest.approx([1.0, 0.5, 100.0 / 334], rel=1e-9)


def test_fault_states_error_and_tolerance() -> None:
    line_with(AutoSteps(1.0, TOLERANCE, 1e-5, 0.1).rejection(0.005), "0.005 m", "tolerance of 0.001 m")


def test_output_ramps_and_bends_of_loads_are_hit() -> None:
    surge = {"harmonic": {"amplitude": [1.0, 0.0, 0.0], "period": 3.0, "ramp": 1.7}}
    load = {"distributed": [0.0, 0.0, 1.0], "history": [[0.0, 0.0], [0.9, 1.0]]}
    stage = dynamic(2.0, 0.1, motion={"end": surge}, loads=[load]) | {"time_step": "auto"}
    pipe = {"EA": 1e6, "EI": 500.0, "mass": 60.0, "outer_diameter": 0.2}
    output = {"interval": 0.5, "xdmf_interval": 1.5}
    scene = scene_from_mapping(
        riser_scene(
            stage, pipe=pipe, length=9.0, elements=3, start=prescribed(0, 0, 0), end=prescribed(9, 0, 0), output=output
        )
    )
    assert isinstance(scene.stages[0], DynamicStage)
    assert set(times_to_hit(scene, scene.stages[0])) == {0.0, 0.5, 0.9, 1.0, 1.5, 1.7, 2.0}
