"""The first guess of a step, continued from the steps before it."""

import numpy as np
import pytest

from riser_soil.solve.extrapolation import Extrapolation

TIMES = np.array([0.0, 0.3, 0.5, 0.9])  # unequal steps


def guess(path: np.ndarray, most: int, times: np.ndarray = TIMES) -> float:
    """Increment of the last step, guessed from the positions before it."""
    past = Extrapolation(1, most)
    for increment, dt in zip(np.diff(path)[:-1], np.diff(times)[:-1], strict=True):
        past.accept(np.array([increment]), dt)
    return float(past.increments(times[-1] - times[-2])[0])


def test_nothing_moves_at_first() -> None:
    assert not np.any(Extrapolation(3, most=4).increments(0.1))


def test_smooth_motion_continues_its_parabola() -> None:
    path = 2.0 - 3.0 * TIMES + 4.0 * TIMES**2
    assert guess(path, most=4) == pytest.approx(path[-1] - path[-2], rel=1e-12)


def test_smooth_motion_continues_its_quartic_once_there_are_four_steps() -> None:
    times = np.array([0.0, 0.02, 0.05, 0.07, 0.1, 0.12])
    path = 5.0 * times + times**2 - 2.0 * times**3 + times**4
    assert guess(path, 4, times) == pytest.approx(path[-1] - path[-2], rel=1e-12)


def test_three_steps_continue_a_cubic_whatever_went_before() -> None:
    times = np.array([-1.0, 0.0, 0.02, 0.05, 0.07, 0.1])
    path = 5.0 * times + times**2 - 2.0 * times**3
    path[0] += 7.0
    assert guess(path, 3, times) == pytest.approx(path[-1] - path[-2], rel=1e-12)


def test_what_is_rough_does_not_grow() -> None:
    """An increment that flips each step: the parabola makes three of it, a quartic would make fifteen."""
    path = np.cumsum([0.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    assert guess(path, 4, np.arange(7.0)) == pytest.approx(3.0)


def test_with_contact_the_last_rate_goes_on() -> None:
    path = TIMES**2
    assert guess(path, most=1) == pytest.approx((path[2] - path[1]) / 0.2 * 0.4, rel=1e-12)
