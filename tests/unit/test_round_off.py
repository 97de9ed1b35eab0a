"""Newton's method at the round-off of its residual."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.solve.round_off import RoundOff

X = np.array([1e-3, 2e-3])  # m


def reached(moves: list[float], norms: list[float], size: float = 1.0) -> list[bool]:
    """After each iteration, in which the first unknown moves by so much [m], of a line of this size [m]."""
    followed = RoundOff(list, size)
    followed.begin()
    x, told = X, []
    for n, move in enumerate([0.0, *moves]):
        x = x + np.array([move, 0.0])
        told.append(followed.reached(x, norms[: n + 1]))
    return told


def test_a_residual_that_stays_while_nothing_moves_is_round_off() -> None:
    assert reached([1e-4, 1e-15, 1e-15], [1.0, 1e-8, 1.1e-8, 0.9e-8]) == [False, False, False, True]


@pytest.mark.parametrize(
    ("moves", "norms"),
    [
        ([1e-4, 1e-12, 1e-12], [1.0, 1e-8, 1.1e-8, 0.9e-8]),  # it still moves by 1e-9 of the step's increments
        ([1e-4, -1e-4, 1e-4], [1.0, 0.9, 1.0, 0.9]),  # to and fro between two places
        ([1e-4, 1e-15, 1e-15], [1.0, 1e-2, 1e-3, 1e-6]),  # the residual falls
        ([1e-4, 1e-15], [1.0, 1e-8, 1.1e-8]),  # it stays once: it may have been at its last iteration before
    ],
)
def test_what_is_not_at_its_round_off_goes_on(moves: list[float], norms: list[float]) -> None:
    assert not any(reached(moves, norms))


def test_a_line_at_rest_moves_by_the_round_off_of_its_places() -> None:
    """Beside increments of 1e-3 m in a step; in one of none at all that is all there is."""
    still, norms = [1e-12, 1e-12, 1e-12], [1e-3, 1e-3, 1e-3, 1e-3]
    assert not any(reached(still, norms, size=10.0))
    assert reached(still, norms, size=1e4) == [False, False, True, True]


def test_a_new_step_begins_anew() -> None:
    followed = RoundOff(list, 1.0)
    followed.reached(X, [1.0])
    followed.begin()
    assert not followed.reached(X, [1.0, 1.0, 1.0])
    assert followed.reached(X, [1.0, 1.0, 1.0])
