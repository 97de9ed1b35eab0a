"""A line placed at states: what is found there does not depend on where it was before."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.core.part import State
from riser_soil.riser.configuration import Configuration
from riser_soil.riser.placed_line import LineTrials
from tests.support.sample_line import sample


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_line_is_where_its_state_is_whatever_came_before(dimension: int) -> None:
    """Moved, accepted where it is with other rates, moved back, committed."""
    at = sample(dimension)
    moved, still, faster = at.state(1), at.state(2, size=0.0), at.state(3, size=0.0)
    now = at.line.once(LineTrials).now
    other = State(0.9, faster.u, faster.v, still.a)
    for state in (moved, still, faster, State(0.8, faster.u, faster.v, faster.a), other, moved, faster):
        now.move(other, velocities_alone=True)
        now.move(state)
        require_placed(now.at, LineTrials(at.line), state)
    at.line.commit(moved)
    for state in (faster, still):
        now.move(state)
        require_placed(now.at, LineTrials(at.line), state)


def require_placed(at: Configuration, fresh: LineTrials, state: State) -> None:
    fresh.now.move(state)
    placed: tuple[Any, ...] = fresh.now.at
    memory: tuple[Any, ...] = at
    for array, expected in zip(memory, placed, strict=True):
        np.testing.assert_array_equal(array, expected)


def test_it_counts_where_it_is_placed() -> None:
    """Once a state, and anew where what was found is forgotten."""
    at = sample(2)
    trials, state = at.line.once(LineTrials), at.state(1)
    counts = []
    for forgotten in (False, False, True):
        if forgotten:
            trials.forget()
        trials.now.move(state)
        counts.append(trials.now.count)
    assert counts == [1, 1, 2]


def test_a_step_starts_where_the_last_one_ended() -> None:
    trials, times = LineTrials(sample(2).line), []
    for t in (0.5, 0.7, 0.7, 1.0):
        trials.step_to(t)
        times.append((trials.start, trials.end))
    assert times == [(0.5, 0.5), (0.5, 0.7), (0.5, 0.7), (0.7, 1.0)]
