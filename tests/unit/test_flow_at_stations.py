"""The water's motion at a pipe's stations: found once for a time and places."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser.trial import Trial
from riser_soil.sea.moving_water import FlowAtStations
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.water import WaterMotion
from tests.support import sample_water
from tests.support.sample_line import Sample, sample


class Counted:
    """Uneven water that counts how often it is asked."""

    def __init__(self) -> None:
        self.times: list[float] = []

    def __call__(self, t: float, x: Array) -> WaterMotion:
        self.times.append(t)
        return sample_water.water(t, x)


def trial_at(at: Sample, t: float, moved: float, rate: float) -> Trial:
    state = at.state(2)
    return at.line.trial(State(t, (1.0 + moved) * state.u, rate * state.v, rate * state.a))


@pytest.mark.parametrize("dimension", [2, 3])
def test_water_is_asked_once_for_a_time_and_places(dimension: int) -> None:
    """Rates may change, and the motion where the step begins is asked for once more at its end."""
    at, water = sample(dimension), Counted()
    stream = FlowAtStations(Pipe(at.line), water)
    first = stream.at(trial_at(at, 1.0, 0.0, 1.0))
    assert stream.at(trial_at(at, 1.0, 0.0, 2.0)) is first
    second = stream.at(trial_at(at, 1.5, 0.1, 2.0))
    third = stream.at(trial_at(at, 1.5, 0.2, 2.0))
    assert stream.at(trial_at(at, 1.0, 0.0, 3.0)) is first
    assert stream.at(trial_at(at, 1.5, 0.2, 3.0)) is third
    assert water.times == [1.0, 1.5, 1.5]
    assert not np.allclose(second.velocity, third.velocity)


@pytest.mark.parametrize("dimension", [2, 3])
def test_motion_is_that_of_the_time_and_the_places(dimension: int) -> None:
    """Whatever was asked before, the same as of a stream that is new."""
    at = sample(dimension)
    used = FlowAtStations(Pipe(at.line), sample_water.water)
    for t, moved in ((1.0, 0.0), (1.5, 0.0), (1.5, 0.1), (1.0, 0.0), (1.0, 0.1), (1.5, 0.1), (1.0, 0.0)):
        trial, new = trial_at(at, t, moved, 1.0), FlowAtStations(Pipe(at.line), sample_water.water)
        for found, expected in zip(used.at(trial), new.at(trial), strict=True):
            assert np.array_equal(found, expected)
