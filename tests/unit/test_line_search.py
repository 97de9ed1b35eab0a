"""Line search at the critical point of the energy: closed forms, and how often it looks."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import pytest

from riser_soil.solve.line_search import FAR, MOST, NEAR, step_length


def counted(slope: Callable[[float], float]) -> tuple[Callable[[float], float], list[float]]:
    looked: list[float] = []

    def look(part: float) -> float:
        looked.append(part)
        return slope(part)

    return look, looked


def linear(end: float, part: float) -> float:
    return -1.0 + part * (1.0 + end)


def test_a_full_step_stays_where_it_ends_near_the_least_energy() -> None:
    for end in (-0.9, 0.0, 0.99 * FAR):
        slope, looked = counted(partial(linear, end))
        assert step_length(-1.0, slope) == 1.0
        assert looked == [1.0]


@pytest.mark.parametrize("stiffer", [4.0, 1e3, 1e9])
def test_a_step_into_something_stiff_ends_where_the_slope_is_nearly_zero(stiffer: float) -> None:
    """Free up to 0.1 of the step, then on a spring: zero at 0.1 + 0.9/stiffer."""
    slope, looked = counted(lambda a: -1.0 + stiffer * max(0.0, a - 0.1))
    part = step_length(-1.0, slope)
    assert len(looked) <= MOST + 1
    assert part < 1.0
    if stiffer < 1e4:
        assert abs(slope(part)) <= NEAR
    else:
        assert part < 0.2


def test_a_step_that_leads_to_nowhere_is_shortened() -> None:
    slope, _ = counted(lambda a: math.inf if a > 0.3 else -1.0 + 5.0 * a)
    part = step_length(-1.0, slope)
    assert 0.0 < part <= 0.3


def test_a_direction_that_climbs_is_left_alone() -> None:
    assert step_length(1.0, lambda a: 10.0 * a) == 1.0
